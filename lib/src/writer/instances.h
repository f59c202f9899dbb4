// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stages that are compiled for the writer in stages.cpp, see reader/instances.h.
#ifndef MCC_WRITER_INSTANCES_H_
#define MCC_WRITER_INSTANCES_H_

#include "entropy/enc_coder.h"
#include "reader/instances.h"

namespace mcc {

MCC_ALL_INSTANCES(extern, EncoderIo)
MCC_MODES_INSTANCE(extern, EncoderIo, kAnyModes)

}  // namespace mcc

#endif  // MCC_WRITER_INSTANCES_H_
