// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Small changes to JSON whose members keep their order. Nothing here searches an object to add a
// member, so that many additions take linear time.
#ifndef MCC_TILES_JSON_EDIT_H_
#define MCC_TILES_JSON_EDIT_H_

#include <string>
#include <string_view>
#include <utility>

#include "gltf/document/json.h"

namespace mcc::tiles {

using gltf::Json;

/// Returns the member `key` of an object, or null when there is none or `json` is not an object.
inline Json* findMember(Json& json, std::string_view key) {
  return const_cast<Json*>(gltf::findMember(json, key));
}

/// Adds a member to the end of an object that has no such member, and returns it.
inline Json& addMember(Json& object, std::string key, Json value) {
  auto& members = object.get_ref<Json::object_t&>();
  members.emplace_back(std::move(key), std::move(value));
  return members.back().second;
}

/// Returns a member of an object, which is added as `value` when it is missing.
inline Json& memberOrNew(Json& object, const std::string& key, Json value) {
  Json* found = findMember(object, key);
  return found != nullptr ? *found : addMember(object, key, std::move(value));
}

/// Gives the members `from` of an object the key `to`. They keep their places.
inline void renameMember(Json& object, const std::string& from, const std::string& to) {
  Json::object_t renamed;
  for (auto& [key, value] : object.get_ref<Json::object_t&>()) {
    renamed.emplace_back(key == from ? to : key, std::move(value));
  }
  object = std::move(renamed);
}

}  // namespace mcc::tiles

#endif  // MCC_TILES_JSON_EDIT_H_
