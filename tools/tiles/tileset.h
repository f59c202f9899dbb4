// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads a tileset of 3D Tiles with the external tilesets that its tiles name.
#ifndef MCC_TILES_TILESET_H_
#define MCC_TILES_TILESET_H_

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mcc/gltf.h"
#include "tiles/matrix.h"

namespace mcc::tiles {

/// A tile that shows a content.
struct TileUse {
  uint32_t level = 0;  ///< 0: the root; the root of an external tileset is below the tile naming it
  /// The geometric error that the promised error is a share of, in metres. That of a tile without
  /// one is half of its nearest ancestor's. 0: no ancestor has one either.
  double geometric_error = 0;
  Matrix transform = kIdentity;  ///< from the tile to the world
  std::string up_axis;           ///< gltfUpAxis, as stated
};

/// A file that tiles show.
struct TileContent {
  std::string path;   ///< relative to the folder of the tileset, with '/'
  std::string where;  ///< the first place that names it: file and JSON path
  std::vector<TileUse> uses;
};

/// Everything that the tilesets say about files.
struct Tileset {
  std::vector<TileContent> contents;   ///< sorted by path; external tilesets are not among them
  std::vector<uint64_t> level_tiles;   ///< number of tiles by level
  uint64_t implicit_count = 0;         ///< tiles with implicitTiling, whose contents are not listed
  uint64_t remote_count = 0;           ///< contents on servers or in data URIs
  std::vector<gltf::Result> failures;  ///< what is wrong in parts that are left out
};

/// Whether a file is the JSON of a tileset.
bool isTileset(std::span<const uint8_t> file);

/// Reads a tileset and its external tilesets, without recursion. Parts that are malformed are
/// listed in `failures` and left out.
/// Errors: the first tileset cannot be read; external tilesets form a cycle; there are too many
/// tiles. Safe for untrusted input.
gltf::Result readTileset(const std::filesystem::path& file, Tileset& tileset);

}  // namespace mcc::tiles

#endif  // MCC_TILES_TILESET_H_
