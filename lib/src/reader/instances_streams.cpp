// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// The stages that decode payloads of three streams.
#include "reader/instances.h"

#if !defined(MCC_COMPACT)
namespace mcc {

MCC_ALL_INSTANCES(, StreamsIo)

}  // namespace mcc
#endif
