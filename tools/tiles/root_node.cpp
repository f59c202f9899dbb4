// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/root_node.h"

#include <map>
#include <utility>
#include <vector>

#include "tiles/json_edit.h"

namespace mcc::tiles {
namespace {

using gltf::Result;

/// The axes of a glTF after a rotation, as columns of a matrix. The loader of a glTF in 3D
/// Tiles 1.1 turns (x, y, z) to (x, -z, y). What it did to models whose x or z points up follows
/// from these rotations and its own.
constexpr double kRotationOfX[9] = {0, 1, 0, 0, 0, -1, -1, 0, 0};
constexpr double kRotationOfZ[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};

Json numbersOf(const std::vector<double>& numbers) {
  Json json = Json::array();
  for (const double number : numbers) json.push_back(number);
  return json;
}

/// Returns the node without its children.
Json nodeOf(const std::array<double, 3>& center, const double* rotation) {
  // Subtracting from zero leaves no negative zero.
  const std::array<double, 3> moved = {center[0], center[2], 0 - center[1]};
  Json node = Json::object();
  if (rotation == nullptr) {
    addMember(node, "translation", numbersOf({moved[0], moved[1], moved[2]}));
    return node;
  }
  const double* r = rotation;
  addMember(node, "matrix",
            numbersOf({r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], r[7], r[8], 0, moved[0],
                       moved[1], moved[2], 1}));
  return node;
}

/// The new nodes, each of which is above a list of nodes.
class Wrapper {
 public:
  Wrapper(Json node, Json& nodes) : node_(std::move(node)), nodes_(nodes), old_(nodes.size()) {}

  /// Gives a scene a new node, or that of a scene with the same list of nodes.
  Result wrap(Json& scene) {
    Json* list = findMember(scene, "nodes");
    if (list == nullptr || (list->is_array() && list->empty())) return {};
    const std::string key = gltf::printJson(*list);
    auto found = above_.find(key);
    if (found == above_.end()) {
      MCC_GLTF_TRY(claim(*list));
      Json added = node_;
      addMember(added, "children", *list);
      found = above_.emplace(key, nodes_.size()).first;
      nodes_.push_back(std::move(added));
    }
    *list = Json::array();
    list->push_back(found->second);
    return {};
  }

 private:
  /// Checks the nodes of a list, none of which may be in another.
  Result claim(const Json& list) {
    if (!list.is_array()) return gltf::error("", "its nodes are not an array");
    for (const Json& element : list) {
      uint64_t number = 0;
      MCC_GLTF_TRY(gltf::readUnsigned(element, "nodes", kMostNumber, number));
      if (number >= old_) return gltf::error("", "one of its nodes does not exist");
      if (!claimed_.emplace(number, true).second) {
        return gltf::error("", "it shares nodes with another list, so that none can be above both");
      }
    }
    return {};
  }

  static constexpr uint64_t kMostNumber = 0xffffffff;

  Json node_;
  Json& nodes_;
  size_t old_ = 0;
  std::map<std::string, size_t> above_;  ///< numbers of the new nodes, by the list below
  std::map<uint64_t, bool> claimed_;
};

}  // namespace

Result addRootNode(const std::array<double, 3>& center, const std::string& up_axis, Json& root) {
  const double* rotation = nullptr;
  if (up_axis == "X") {
    rotation = kRotationOfX;
  } else if (up_axis == "Z") {
    rotation = kRotationOfZ;
  } else if (up_axis != "Y" && !up_axis.empty()) {
    return gltf::error("gltfUpAxis", "\"" + up_axis + "\" is not X, Y or Z");
  }
  if (rotation == nullptr && center == std::array<double, 3>{}) return {};
  Json* nodes = findMember(root, "nodes");
  Json* scenes = findMember(root, "scenes");
  if (nodes == nullptr || !nodes->is_array() || scenes == nullptr || !scenes->is_array() ||
      scenes->empty()) {
    return gltf::error("/scenes", "there is no scene whose nodes could be moved");
  }
  Wrapper wrapper(nodeOf(center, rotation), *nodes);
  for (size_t i = 0; i < scenes->size(); ++i) {
    const Result wrapped = wrapper.wrap((*scenes)[i]);
    if (!wrapped.ok()) return gltf::error(gltf::at("/scenes", i), wrapped.message());
  }
  return {};
}

}  // namespace mcc::tiles
