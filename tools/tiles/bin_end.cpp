// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/bin_end.h"

#include "tiles/json_edit.h"

namespace mcc::tiles {

using gltf::Result;

namespace {

constexpr size_t kAlignment = 8;

}  // namespace

Result BinEnd::startGrowing(Json& root) {
  Json& buffers = memberOrNew(root, "buffers", Json::array());
  if (!buffers.is_array()) return gltf::error("/buffers", "must be an array");
  if (buffers.empty()) {
    buffers.push_back(Json::object());
  } else if (!has_bin_ || findMember(buffers[0], "uri") != nullptr) {
    return gltf::error("/buffers/0", "is not the BIN chunk of the GLB, to which tables are added");
  }
  grown_.assign(old_.begin(), old_.end());
  has_grown_ = true;
  return {};
}

Result BinEnd::addView(std::span<const uint8_t> bytes, Json members, Json& root, uint32_t& view) {
  Json& views = memberOrNew(root, "bufferViews", Json::array());
  if (!views.is_array()) return gltf::error("/bufferViews", "must be an array");
  if (!has_grown_) MCC_GLTF_TRY(startGrowing(root));
  grown_.resize((grown_.size() + kAlignment - 1) / kAlignment * kAlignment, 0);
  Json added = Json::object();
  addMember(added, "buffer", 0);
  addMember(added, "byteOffset", grown_.size());
  addMember(added, "byteLength", bytes.size());
  for (auto& [key, value] : members.get_ref<Json::object_t&>()) {
    addMember(added, key, std::move(value));
  }
  grown_.insert(grown_.end(), bytes.begin(), bytes.end());
  memberOrNew(root["buffers"][0], "byteLength", 0) = grown_.size();
  view = static_cast<uint32_t>(views.size());
  views.push_back(std::move(added));
  return {};
}

}  // namespace mcc::tiles
