// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// The stages that decode payloads of a single coder.
#include "reader/instances.h"

#if !defined(MCC_COMPACT)
namespace mcc {

MCC_ALL_INSTANCES(, CompactIo)
MCC_MODES_INSTANCE(, CompactIo, kAnyModes)

}  // namespace mcc
#endif
