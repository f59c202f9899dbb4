// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The picture on the koi, and where its parts are.
#ifndef MCC_TOOLS_SAMPLES_KOI_PICTURE_H_
#define MCC_TOOLS_SAMPLES_KOI_PICTURE_H_

#include <cstdint>
#include <vector>

namespace mcc::samples {

struct TexturePlace {
  float u = 0;
  float v = 0;
};

/// See koi_shape.h for the parameters.
TexturePlace placeOnBody(double along, double around);
TexturePlace placeOnFin(double across, double outward);
/// from_axis: 0 in the middle of the pupil, 1 at the rim of the eye.
TexturePlace placeOnEye(double from_axis, double around);
TexturePlace placeOnBarbel(double along, double around);

/// Paints the picture, as PNG.
std::vector<uint8_t> koiPicture();

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_KOI_PICTURE_H_
