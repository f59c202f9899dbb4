// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_FOREIGN_DECODERS_H_
#define MCC_TOOLS_FOREIGN_DECODERS_H_

#include "mcc/glb.h"

namespace mcc::foreign {

/// Draco and meshoptimizer for convertGlb(), as far as the installed versions know what is in the
/// file.
gltf::ForeignDecoders foreignDecoders();

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_DECODERS_H_
