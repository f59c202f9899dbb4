// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// The inner loops that decode positions, compiled for usual choices of the encoder.
#include "reader/instances.h"

#if !defined(MCC_COMPACT)
namespace mcc {

#define MCC_INSTANCE(which, modes) MCC_MODES_INSTANCE(, StreamsIo, fixedModes(which, modes))
MCC_PLAIN_MODES(MCC_INSTANCE)

}  // namespace mcc
#endif
