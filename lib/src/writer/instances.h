// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stages that are compiled once for each Io of the writer, see reader/instances.h.
#ifndef MCC_WRITER_INSTANCES_H_
#define MCC_WRITER_INSTANCES_H_

#include "entropy/enc_coder.h"
#include "reader/instances.h"

namespace mcc {

MCC_ALL_INSTANCES(extern, CostIo)
MCC_ALL_INSTANCES(extern, EncoderIo)

}  // namespace mcc

#endif  // MCC_WRITER_INSTANCES_H_
