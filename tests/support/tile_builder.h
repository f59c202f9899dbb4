// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writes the containers of 3D Tiles, for tests and for the program that makes samples/city.
#ifndef MCC_TESTS_SUPPORT_TILE_BUILDER_H_
#define MCC_TESTS_SUPPORT_TILE_BUILDER_H_

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "support/gltf_builder.h"

namespace mcc::test {

using Bytes = std::vector<uint8_t>;
using gltf::Json;
using gltf::test::append;  // of numbers

inline void appendText(Bytes& to, const std::string& text) {
  to.insert(to.end(), text.begin(), text.end());
}

inline void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

inline void padTo8(Bytes& bytes) { bytes.resize((bytes.size() + 7) / 8 * 8, 0); }

/// Pads JSON so that what follows a header of `header_bytes` and it is at a multiple of 8.
inline std::string paddedJson(std::string text, size_t header_bytes) {
  while ((header_bytes + text.size()) % 8 != 0) text += ' ';
  return text;
}

/// Writes the length of a tile into its header.
inline void setLength(Bytes& tile) {
  Bytes length;
  append(length, tile.size());
  std::copy(length.begin(), length.end(), tile.begin() + 8);
}

/// The four tables of a b3dm or i3dm.
struct Tables {
  std::string feature_json;
  Bytes feature_binary;
  std::string batch_json;
  Bytes batch_binary;
};

/// A tile with the magic of a b3dm, an i3dm, whose glTF is embedded, or a pnts.
inline Bytes makeModelTile(const std::string& magic, const Tables& tables, const Bytes& glb) {
  Bytes tile;
  appendText(tile, magic);
  append(tile, 1);
  append(tile, 0);
  for (const size_t size : {tables.feature_json.size(), tables.feature_binary.size(),
                            tables.batch_json.size(), tables.batch_binary.size()}) {
    append(tile, size);
  }
  if (magic == "i3dm") append(tile, 1);
  appendText(tile, tables.feature_json);
  append(tile, tables.feature_binary);
  appendText(tile, tables.batch_json);
  append(tile, tables.batch_binary);
  append(tile, glb);
  padTo8(tile);
  setLength(tile);
  return tile;
}

inline Bytes makeCmpt(const std::vector<Bytes>& inner) {
  Bytes tile;
  appendText(tile, "cmpt");
  append(tile, 1);
  append(tile, 0);
  append(tile, inner.size());
  for (const Bytes& one : inner) append(tile, one);
  setLength(tile);
  return tile;
}

/// `text` and `binary` are already padded.
inline Bytes makeSubtree(const std::string& text, const Bytes& binary) {
  Bytes file;
  appendText(file, "subt");
  append(file, 1);
  append(file, text.size(), 8);
  append(file, binary.size(), 8);
  appendText(file, text);
  append(file, binary);
  return file;
}

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_TILE_BUILDER_H_
