// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A koi that swims: textured, with a skin of nine joints and two morph targets, animated.
#ifndef MCC_TOOLS_SAMPLES_KOI_H_
#define MCC_TOOLS_SAMPLES_KOI_H_

#include "glb_builder.h"

namespace mcc::samples {

/// Makes the fish. It is 2.1 long, looks along +z, and y is up.
GlbBuilder koi();

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_KOI_H_
