// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The containers of 3D Tiles around glTF: b3dm, i3dm, and cmpt with tiles of any kind inside.
#ifndef MCC_TILES_TILE_FILE_H_
#define MCC_TILES_TILE_FILE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mcc/result.h"
#include "mcc/types.h"

namespace mcc::tiles {

enum class TileKind : uint8_t { kGlb, kJson, kB3dm, kI3dm, kCmpt, kOther };

/// Tells the kind of a file by its first bytes. kJson may be a glTF, a tileset, or anything else.
TileKind kindOf(std::span<const uint8_t> file);

/// A glTF inside of a tile.
struct TileModel {
  uint64_t begin = 0;  ///< of its bytes in the file
  uint64_t end = 0;
  std::array<double, 3> center = {};  ///< RTC_CENTER, which moves the model
  bool is_instanced = false;          ///< an i3dm places it
  double instance_scale = 1;          ///< the largest scale of an instance
};

/// The models of a tile that has been read, and where they are.
class TileFile {
 public:
  /// Reads the headers, which are checked against the length of the file. `file` is borrowed.
  /// Errors name the byte. A model that a header names by a URI is none of the models; `hasUri()`
  /// tells of it. Safe for untrusted input, without recursion.
  gltf::Result read(std::span<const uint8_t> file);

  const std::vector<TileModel>& models() const { return models_; }
  bool hasUri() const { return has_uri_; }

  /// Returns the file with other models. An empty one leaves the model as it was. Tables are kept
  /// byte for byte; paddings, lengths and the alignment to 8 bytes become those that the
  /// specification asks for.
  /// Errors: the result would have 4 GiB.
  gltf::Result rebuild(const std::vector<std::vector<uint8_t>>& models,
                       std::vector<uint8_t>& file) const;

 private:
  /// A tile, alone or inside of a cmpt. Every tile comes after the one it is inside of.
  struct Node {
    TileKind kind = TileKind::kOther;
    uint64_t begin = 0;
    uint64_t end = 0;
    uint32_t parent = 0;
    uint32_t depth = 0;
    uint32_t model = kNone;  ///< index into models_
    uint64_t table_begin = 0;
    std::array<uint32_t, 4> table_bytes = {};  ///< feature JSON and binary, batch JSON and binary
  };

  gltf::Result readNode(uint32_t index);
  gltf::Result readModelTile(Node& node);
  gltf::Result readFeatures(const Node& node, TileModel& model) const;
  gltf::Result readComposite(uint32_t index);
  void appendModelTile(const Node& node, const std::vector<uint8_t>& model,
                       std::vector<uint8_t>& tile) const;

  std::span<const uint8_t> file_;
  std::vector<Node> nodes_;
  std::vector<TileModel> models_;
  bool has_uri_ = false;
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_TILE_FILE_H_
