// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the tiles of a tileset ask of the accuracy of their contents.
#ifndef MCC_TILES_TILE_DEMAND_H_
#define MCC_TILES_TILE_DEMAND_H_

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>

#include "tiles/matrix.h"

namespace mcc::tiles {

enum class UpAxis : uint8_t { kX, kY, kZ };

/// A tile that shows a content.
struct TileUse {
  uint32_t level = 0;  ///< 0: the root; the root of an external tileset is below the tile naming it
  /// The geometric error that the promised error is a share of, in metres. That of a tile without
  /// one is half of its nearest ancestor's. 0: no ancestor has one either.
  double geometric_error = 0;
  Matrix transform = kIdentity;  ///< from the tile to the world; its scale is finite
  UpAxis up_axis = UpAxis::kY;   ///< of the models, which loaders turn so that z is up
};

/// What all tiles that show a content ask of it. Distances are shares of geometric errors, so they
/// are to be multiplied by the share that is promised.
struct TileDemand {
  uint32_t level = 0;  ///< of the first tile that shows it
  UpAxis up_axis = UpAxis::kY;
  bool has_group = false;        ///< false: several tiles show it, and they differ
  uint64_t group = 0;            ///< key of the tiles whose grids can be one
  std::array<double, 3> offset;  ///< from the origin of the group's grid, in the tile's coordinates
  double scale = -1;             ///< no transform makes a vector longer; below 0: no tile shows it
  double world_distance = std::numeric_limits<double>::infinity();  ///< in metres
  double tile_distance = std::numeric_limits<double>::infinity();   ///< in the tile's coordinates
};

/// Collects the demands, and what the tiles of a group have in common: a level, and a transform
/// apart from its translation.
class DemandGroups {
 public:
  /// Adds a tile that shows a content to its demand, and to its group.
  void add(const TileUse& use, TileDemand& demand);

  /// Returns the smallest tile_distance in a group.
  double distanceOf(uint64_t group) const { return groups_.at(group).distance; }
  /// Returns how many groups the tiles of each level form.
  const std::map<uint32_t, uint64_t>& countByLevel() const { return count_by_level_; }
  size_t size() const { return groups_.size(); }

 private:
  struct Group {
    double distance = std::numeric_limits<double>::infinity();
    std::array<double, 3> origin = {};  ///< of its grid in the world: the first tile's translation
  };

  std::unordered_map<uint64_t, Group> groups_;
  std::map<uint32_t, uint64_t> count_by_level_;
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_TILE_DEMAND_H_
