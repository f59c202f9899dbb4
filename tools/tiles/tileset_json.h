// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads the JSON of one tileset as tables, without keeping the document: a tile takes some 50 bytes
// here, and thousands as a tree of JSON values.
#ifndef MCC_TILES_TILESET_JSON_H_
#define MCC_TILES_TILESET_JSON_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mcc/result.h"
#include "mcc/types.h"
#include "tiles/matrix.h"

namespace mcc::tiles {

/// The members of a tile's implicitTiling, or of its extension 3DTILES_implicit_tiling.
struct ImplicitTiling {
  uint32_t tile = kNone;
  std::string scheme;    ///< "QUADTREE" or "OCTREE"
  std::string subtrees;  ///< the template of their URIs
  uint64_t subtree_levels = 0;
  uint64_t available_levels = 0;
};

/// The tables of a tileset. A tile comes after its parent, and children are in their order.
struct TilesetJson {
  struct Tile {
    uint32_t parent = kNone;
    uint32_t child_number = 0;   ///< among its parent's children
    uint32_t transform = kNone;  ///< index into `transforms`; kNone: the identity
    bool is_transform_wrong = false;
    double geometric_error = -1;  ///< below 0: it has none, or what is there is not one
  };

  enum class ContentPlace : uint8_t { kContent, kContents, kMultipleContent, kMultipleContents };

  struct Content {
    uint32_t tile = 0;
    ContentPlace place = ContentPlace::kContent;
    uint32_t number = 0;     ///< in its list
    uint32_t uri_begin = 0;  ///< in `texts`
    uint32_t uri_length = 0;
    bool is_uri_wrong = true;  ///< it has no URI that is a string
    bool is_url = false;       ///< the member is called url, as until version 1.0
  };

  /// Something in a tile that is left out.
  struct Wrong {
    uint32_t tile = 0;
    std::string member;  ///< its path in the tile
    const char* what = "";
  };

  std::vector<Tile> tiles;
  std::vector<Content> contents;
  std::vector<Matrix> transforms;
  std::vector<ImplicitTiling> implicit;
  std::vector<Wrong> wrong_places;  ///< the first 1,000
  uint64_t wrong_count = 0;         ///< of all
  std::string texts;
  double geometric_error = -1;  ///< of the tileset
  std::string up_axis;          ///< asset.gltfUpAxis
  std::string schema_uri;
  uint64_t schema_begin = 0;  ///< bytes of the object `schema` in the file; equal: it has none
  uint64_t schema_end = 0;

  std::string_view uriOf(const Content& content) const {
    return std::string_view(texts).substr(content.uri_begin, content.uri_length);
  }
  /// Returns the JSON path of a tile, or of a content, for messages: of a tile that is deeper than
  /// 32 levels, the first and the last 16.
  std::string pathOfTile(uint32_t tile) const;
  std::string pathOf(const Content& content) const;
};

/// Reads a tileset of any depth without recursion. What is malformed in a tile is marked there.
/// folder, name  as NamedFile::open() takes them
/// Errors: the file cannot be read; it is not JSON, with the byte; it has no root; it has more than
/// `max_tiles` tiles. Safe for untrusted input: memory is at most a small multiple of the file.
gltf::Result readTilesetJson(const std::filesystem::path& folder, const std::string& name,
                             uint64_t max_tiles, TilesetJson& tileset);

/// Whether a file is the JSON of a tileset: it is an object with an object `root`. Reads no farther
/// than to that. False when it cannot be read.
bool isTilesetFile(const std::filesystem::path& folder, const std::string& name);

}  // namespace mcc::tiles

#endif  // MCC_TILES_TILESET_JSON_H_
