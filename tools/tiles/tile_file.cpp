// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tile_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "gltf/document/glb.h"
#include "host/result.h"
#include "json/json.h"
#include "tiles/little_endian.h"
#include "tiles/matrix.h"

namespace mcc::tiles {
namespace {

using gltf::Json;
using gltf::Result;

constexpr uint64_t kAlignment = 8;
constexpr uint64_t kCommonHeaderBytes = 12;  // magic, version, byteLength
constexpr uint64_t kB3dmHeaderBytes = 28;
constexpr uint64_t kI3dmHeaderBytes = 32;
constexpr uint64_t kCmptHeaderBytes = 16;
constexpr uint64_t kGlbHeaderBytes = 12;
constexpr uint32_t kMostNesting = 64;

void setNumber(std::vector<uint8_t>& bytes, uint64_t at, uint32_t value) {
  for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<uint8_t>(value >> (8 * i));
}

Result wrongAt(uint64_t byte, const std::string& what) {
  return gltf::error("byte " + std::to_string(byte), what);
}

bool startsWith(std::span<const uint8_t> bytes, const char* magic) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), magic, 4) == 0;
}

uint64_t aligned(uint64_t bytes) { return (bytes + kAlignment - 1) / kAlignment * kAlignment; }

void append(std::vector<uint8_t>& to, std::span<const uint8_t> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// Reads the vector RTC_CENTER, which is in the JSON itself or in the binary part of the table.
Result readCenter(const Json& features, std::span<const uint8_t> binary, uint64_t json_at,
                  std::array<double, 3>& center) {
  const Json* given = gltf::findMember(features, "RTC_CENTER");
  if (given == nullptr || readNumbers(*given, center.data(), 3)) return {};
  uint64_t offset = 0;
  const Json* at = gltf::findMember(*given, "byteOffset");
  if (at == nullptr || !gltf::asUnsigned(*at, offset) || offset > binary.size() ||
      binary.size() - offset < 12) {
    return wrongAt(json_at, "RTC_CENTER of the feature table is not three numbers");
  }
  for (size_t c = 0; c < 3; ++c) {
    center[c] = std::bit_cast<float>(numberAt(binary, offset + 4 * c));
    if (!std::isfinite(center[c])) return wrongAt(json_at, "RTC_CENTER is not finite");
  }
  return {};
}

/// Finds the largest scale of the instances, in a member of the feature table with
/// `component_count` floats for each.
Result readScales(const Json& features, const char* name, uint64_t component_count,
                  std::span<const uint8_t> binary, uint64_t json_at, double& largest) {
  const Json* member = gltf::findMember(features, name);
  if (member == nullptr) return {};
  uint64_t instance_count = 0;
  uint64_t offset = 0;
  const Json* count = gltf::findMember(features, "INSTANCES_LENGTH");
  const Json* at = gltf::findMember(*member, "byteOffset");
  const bool is_known = count != nullptr && gltf::asUnsigned(*count, instance_count) &&
                        at != nullptr && gltf::asUnsigned(*at, offset);
  const uint64_t room = is_known && offset <= binary.size() ? binary.size() - offset : 0;
  if (!is_known || instance_count > room / (4 * component_count)) {
    return wrongAt(json_at, std::string(name) + " reaches beyond the feature table");
  }
  double found = 0;
  for (uint64_t i = 0; i < instance_count * component_count; ++i) {
    const auto scale = std::bit_cast<float>(numberAt(binary, offset + 4 * i));
    if (!std::isfinite(scale)) return wrongAt(json_at, std::string(name) + " is not finite");
    found = std::max(found, std::abs(static_cast<double>(scale)));
  }
  if (instance_count != 0) largest *= found;
  return {};
}

}  // namespace

TileKind kindOf(std::span<const uint8_t> file) {
  if (startsWith(file, "glTF")) return TileKind::kGlb;
  if (startsWith(file, "b3dm")) return TileKind::kB3dm;
  if (startsWith(file, "i3dm")) return TileKind::kI3dm;
  if (startsWith(file, "cmpt")) return TileKind::kCmpt;
  return gltf::isJsonText(file) ? TileKind::kJson : TileKind::kOther;
}

Result TileFile::read(std::span<const uint8_t> file) {
  file_ = file;
  nodes_.assign(1, {});
  models_.clear();
  has_uri_ = false;
  nodes_[0].kind = kindOf(file);
  nodes_[0].end = file.size();
  if (nodes_[0].kind == TileKind::kJson || nodes_[0].kind == TileKind::kOther) return {};
  // A GLB may have bytes after it, with which the library deals.
  if (nodes_[0].kind == TileKind::kGlb) {
    nodes_[0].model = 0;
    models_.push_back({0, file.size()});
    return {};
  }
  // The list grows by the tiles of each cmpt, so this visits all.
  for (uint32_t i = 0; i < nodes_.size(); ++i) MCC_GLTF_TRY(readNode(i));
  return {};
}

Result TileFile::readNode(uint32_t index) {
  Node& node = nodes_[index];
  const std::span<const uint8_t> bytes = file_.subspan(node.begin, node.end - node.begin);
  if (bytes.size() < kCommonHeaderBytes) {
    return wrongAt(node.begin, "the header of the tile is cut off");
  }
  const bool is_known =
      node.kind == TileKind::kB3dm || node.kind == TileKind::kI3dm || node.kind == TileKind::kCmpt;
  const uint32_t version = numberAt(bytes, 4);
  if (is_known && version != 1) {
    return wrongAt(node.begin + 4, "the tile has version " + std::to_string(version) +
                                       ", and only version 1 is known");
  }
  if (index == 0) {
    // What follows the tile may be its padding, which is made anew, but nothing else.
    const uint64_t length = numberAt(bytes, 8);
    if (length > bytes.size() || bytes.size() - length >= kAlignment) {
      return wrongAt(8, "the tile claims " + std::to_string(length) + " bytes and the file has " +
                            std::to_string(bytes.size()));
    }
    node.end = length;
  }
  switch (node.kind) {
    case TileKind::kB3dm:
    case TileKind::kI3dm: return readModelTile(node);
    case TileKind::kCmpt: return readComposite(index);
    case TileKind::kGlb:
      node.model = static_cast<uint32_t>(models_.size());
      models_.push_back({node.begin, node.end});
      break;
    case TileKind::kJson:
    case TileKind::kOther: break;
  }
  return {};
}

Result TileFile::readModelTile(Node& node) {
  const bool is_i3dm = node.kind == TileKind::kI3dm;
  const uint64_t header_bytes = is_i3dm ? kI3dmHeaderBytes : kB3dmHeaderBytes;
  if (node.end - node.begin < header_bytes) {
    return wrongAt(node.begin, "the header of the tile is cut off");
  }
  node.table_begin = node.begin + header_bytes;
  uint64_t at = node.table_begin;
  for (size_t i = 0; i < 4; ++i) {
    const uint64_t field = node.begin + kCommonHeaderBytes + 4 * i;
    node.table_bytes[i] = numberAt(file_, field);
    if (node.table_bytes[i] > node.end - at) {
      return wrongAt(field, "a table of the tile claims " + std::to_string(node.table_bytes[i]) +
                                " bytes, and only " + std::to_string(node.end - at) + " follow");
    }
    at += node.table_bytes[i];
  }
  if (is_i3dm) {
    const uint32_t format = numberAt(file_, node.begin + 28);
    if (format > 1) return wrongAt(node.begin + 28, "gltfFormat is neither 0 nor 1");
    if (format == 0) {
      has_uri_ = true;
      return {};
    }
  }
  const std::span<const uint8_t> rest = file_.subspan(at, node.end - at);
  if (rest.size() < kGlbHeaderBytes || !startsWith(rest, "glTF")) {
    return wrongAt(at, "there is no GLB where the tables end");
  }
  const uint64_t model_bytes = numberAt(rest, 8);
  if (model_bytes < kGlbHeaderBytes || model_bytes > rest.size()) {
    return wrongAt(at + 8, "the GLB claims " + std::to_string(model_bytes) + " bytes, and " +
                               std::to_string(rest.size()) + " are there");
  }
  TileModel model = {at, at + model_bytes};
  model.is_instanced = is_i3dm;
  MCC_GLTF_TRY(readFeatures(node, model));
  node.model = static_cast<uint32_t>(models_.size());
  models_.push_back(model);
  return {};
}

Result TileFile::readFeatures(const Node& node, TileModel& model) const {
  const auto json_bytes = file_.subspan(node.table_begin, node.table_bytes[0]);
  const auto binary = file_.subspan(node.table_begin + node.table_bytes[0], node.table_bytes[1]);
  if (json_bytes.empty()) return {};
  Json features;
  Result parsed = gltf::parseJson(json_bytes, features);
  if (!parsed.ok() || !features.is_object()) {
    return wrongAt(node.table_begin,
                   "the feature table is not JSON" + (parsed.ok() ? "" : ": " + parsed.message()));
  }
  MCC_GLTF_TRY(readCenter(features, binary, node.table_begin, model.center));
  if (!model.is_instanced) return {};
  MCC_GLTF_TRY(readScales(features, "SCALE", 1, binary, node.table_begin, model.instance_scale));
  return readScales(features, "SCALE_NON_UNIFORM", 3, binary, node.table_begin,
                    model.instance_scale);
}

Result TileFile::readComposite(uint32_t index) {
  const Node node = nodes_[index];  // a copy, because the list grows
  if (node.end - node.begin < kCmptHeaderBytes) {
    return wrongAt(node.begin, "the header of the tile is cut off");
  }
  if (node.depth >= kMostNesting) {
    return wrongAt(node.begin,
                   "composite tiles are nested deeper than " + std::to_string(kMostNesting));
  }
  const uint32_t tile_count = numberAt(file_, node.begin + 12);
  uint64_t at = node.begin + kCmptHeaderBytes;
  if (tile_count > (node.end - at) / kCommonHeaderBytes) {
    return wrongAt(node.begin + 12, "the tile claims to hold " + std::to_string(tile_count) +
                                        " tiles, for which it is too short");
  }
  for (uint32_t i = 0; i < tile_count; ++i) {
    if (node.end - at < kCommonHeaderBytes) {
      return wrongAt(at, "the inner tile " + std::to_string(i) + " is cut off");
    }
    const uint64_t length = numberAt(file_, at + 8);
    if (length < kCommonHeaderBytes || length > node.end - at) {
      return wrongAt(at + 8, "the inner tile " + std::to_string(i) + " claims " +
                                 std::to_string(length) + " bytes, and " +
                                 std::to_string(node.end - at) + " are there");
    }
    Node inner;
    inner.kind = kindOf(file_.subspan(at, length));
    inner.begin = at;
    inner.end = at + length;
    inner.parent = index;
    inner.depth = node.depth + 1;
    nodes_.push_back(inner);
    at += length;
  }
  if (node.end - at >= kAlignment) {
    return wrongAt(at, std::to_string(node.end - at) + " bytes follow the last inner tile");
  }
  return {};
}

/// Pads each table that has bytes: JSON with spaces, other bytes with zeros.
void TileFile::appendModelTile(const Node& node, const std::vector<uint8_t>& model,
                               std::vector<uint8_t>& tile) const {
  append(tile, file_.subspan(node.begin, node.table_begin - node.begin));
  uint64_t at = node.table_begin;
  for (size_t i = 0; i < 4; ++i) {
    append(tile, file_.subspan(at, node.table_bytes[i]));
    at += node.table_bytes[i];
    if (node.table_bytes[i] == 0) continue;
    const uint64_t padding = aligned(tile.size()) - tile.size();
    tile.insert(tile.end(), padding, i % 2 == 0 ? ' ' : 0);
    setNumber(tile, kCommonHeaderBytes + 4 * i,
              static_cast<uint32_t>(node.table_bytes[i] + padding));
  }
  if (model.empty()) {
    const TileModel& old = models_[node.model];
    append(tile, file_.subspan(old.begin, old.end - old.begin));
  } else {
    append(tile, model);
  }
}

Result TileFile::rebuild(const std::vector<std::vector<uint8_t>>& models,
                         std::vector<uint8_t>& file) const {
  std::vector<std::vector<uint8_t>> tiles(nodes_.size());
  std::vector<std::vector<uint32_t>> inner(nodes_.size());
  for (uint32_t i = 1; i < nodes_.size(); ++i) inner[nodes_[i].parent].push_back(i);
  // What is inside of a tile comes after it in the list and is thus complete here.
  for (size_t i = nodes_.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    std::vector<uint8_t>& tile = tiles[i];
    const bool is_model_tile = node.kind == TileKind::kB3dm || node.kind == TileKind::kI3dm;
    if (is_model_tile && node.model != kNone) {
      appendModelTile(node, models[node.model], tile);
    } else if (node.kind == TileKind::kGlb && !models[node.model].empty()) {
      tile = models[node.model];
      continue;  // a GLB has its length from the library
    } else if (node.kind == TileKind::kCmpt) {
      append(tile, file_.subspan(node.begin, kCmptHeaderBytes));
      for (const uint32_t child : inner[i]) {
        append(tile, tiles[child]);
        tiles[child] = {};
      }
    } else {
      append(tile, file_.subspan(node.begin, node.end - node.begin));
      continue;
    }
    tile.resize(aligned(tile.size()), 0);
    if (tile.size() > UINT32_MAX) return gltf::error("", "the tile would have 4 GiB");
    setNumber(tile, 8, static_cast<uint32_t>(tile.size()));
  }
  file = std::move(tiles[0]);
  return {};
}

}  // namespace mcc::tiles
