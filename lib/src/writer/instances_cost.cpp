// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// The stages that count what a piece would take.
#include "writer/instances.h"

namespace mcc {

MCC_ALL_INSTANCES(, CostIo)

}  // namespace mcc
