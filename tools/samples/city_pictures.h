// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The pictures of the city, which are small PNGs with palettes.
#ifndef MCC_TOOLS_SAMPLES_CITY_PICTURES_H_
#define MCC_TOOLS_SAMPLES_CITY_PICTURES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "city_meshes.h"

namespace mcc::samples {

struct Picture {
  std::string name;
  std::vector<uint8_t> png;  ///< empty: its material has a colour alone
};

/// The picture that faces of a surface repeat.
Picture pictureOf(Surface surface);

/// The land from above, north at the top.
Picture pictureOfGround(const CityPlan& plan);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_CITY_PICTURES_H_
