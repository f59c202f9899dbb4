// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A tileset of 3D Tiles 1.1: a town, its houses and the land around them, with every kind of tile.
#ifndef MCC_TOOLS_SAMPLES_CITY_H_
#define MCC_TOOLS_SAMPLES_CITY_H_

#include <filesystem>

#include "city_plan.h"

namespace mcc::samples {

/// The city of samples/city.
CitySize smallCity();
/// About 1,000 tiles of a few thousand triangles, for measurements.
CitySize largeCity();

/// Writes the tileset into a folder. Throws std::runtime_error if a file cannot be written.
void writeCity(const std::filesystem::path& folder, const CitySize& size);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_CITY_H_
