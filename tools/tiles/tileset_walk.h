// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Walks the tiles of a tileset of 3D Tiles: explicit and implicit ones, and those of external
// tilesets.
#ifndef MCC_TILES_TILESET_WALK_H_
#define MCC_TILES_TILESET_WALK_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mcc/result.h"
#include "mcc/types.h"
#include "tiles/file_table.h"
#include "tiles/part.h"
#include "tiles/tile_demand.h"

namespace mcc::tiles {

/// How many tiles are visited unless the user asks for more. Tilesets can name each other, so that
/// a few small files have any number of tiles.
inline constexpr uint64_t kMostTiles = uint64_t{1} << 24;

/// How much work a walk was.
struct WalkWork {
  uint64_t file_count = 0;    ///< that were opened
  uint64_t parse_count = 0;   ///< of JSON
  uint64_t tile_count = 0;    ///< tiles that were visited
  uint64_t naming_count = 0;  ///< visits of tiles that name an external tileset
};

/// What the tiles say about files. The walk keeps nothing of a tile, so memory depends on the
/// number of files and on the size of the largest tileset file, but not on the number of tiles.
///
/// An external tileset may be named many times, as are those of a forest's trees. It is visited
/// once for each place: level, transform and geometric error. Its file is read once, unless the
/// tilesets take more than some megabytes. The work is then linear in the bytes of the tilesets and
/// subtrees, and in the tiles of all places, which max_tiles limits. Failures are found, and
/// listed, at the first place of a tileset.
class TilesetWalk {
 public:
  /// Walks a tileset, without recursion. Parts that are malformed are listed in failures() and left
  /// out.
  /// folder  of the tileset; files outside of it are not read.
  /// name    of its JSON in the folder
  /// files   of the folder, those of `part` at least
  /// Errors: the first tileset cannot be read; external tilesets form a cycle; there are more than
  /// `max_tiles` tiles; external tilesets that contain others have many more places than fit the
  /// bytes of all. Safe for untrusted input.
  gltf::Result run(const std::filesystem::path& folder, const std::string& name,
                   const FileTable& files, const Part& part, uint64_t max_tiles);

  /// Returns what the tiles ask of a file; null when no tile shows it.
  const TileDemand* demandOf(uint32_t file) const {
    return demand_numbers_[file] == kNone ? nullptr : &demands_[demand_numbers_[file]];
  }
  const DemandGroups& groups() const { return groups_; }
  const std::vector<uint32_t>& tilesets() const { return tilesets_; }  ///< files, each once
  const std::vector<uint64_t>& levelTiles() const { return level_tiles_; }
  uint64_t remoteCount() const { return remote_count_; }  ///< contents on servers or in data URIs
  const std::vector<gltf::Result>& failures() const { return failures_; }  ///< the first 1,000
  uint64_t failureCount() const { return failure_count_; }
  const WalkWork& work() const { return work_; }

 private:
  friend class TilesetWalker;

  std::vector<uint32_t> demand_numbers_;  ///< by file
  std::vector<TileDemand> demands_;
  DemandGroups groups_;
  std::vector<uint32_t> tilesets_;
  std::vector<uint64_t> level_tiles_;
  uint64_t remote_count_ = 0;
  std::vector<gltf::Result> failures_;
  uint64_t failure_count_ = 0;
  WalkWork work_;
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_TILESET_WALK_H_
