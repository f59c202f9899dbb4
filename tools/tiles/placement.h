// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_PLACEMENT_H_
#define MCC_TILES_PLACEMENT_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "mcc/result.h"
#include "tiles/matrix.h"
#include "tiles/tile_file.h"

namespace mcc::tiles {

/// How the coordinates of a model's meshes become those of its tile.
struct Placement {
  double scale = 1;  ///< no vector becomes longer than by this
  /// From the meshes to the model. Empty where a model has several such matrices, or where they
  /// change: meshes under different nodes, instances, skins, animations.
  std::optional<Matrix> matrix;
  double farthest = 0;  ///< largest absolute coordinate, as far as the accessors state bounds
  std::string caveat;   ///< what `scale` leaves out; empty: nothing
};

/// Finds the placement of a model: `glb` or the JSON of a .gltf. Errors: it is not glTF.
gltf::Result placementOf(std::span<const uint8_t> file, const TileModel& model,
                         Placement& placement);

}  // namespace mcc::tiles

#endif  // MCC_TILES_PLACEMENT_H_
