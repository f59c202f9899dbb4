// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/feature_ids.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "gltf/document/accessors.h"
#include "gltf/document/references.h"
#include "tiles/json_edit.h"

namespace mcc::tiles {
namespace {

using gltf::Result;

constexpr char kFeatureIds[] = "_FEATURE_ID_0";

/// Component types of glTF, as numbers of its JSON.
constexpr uint32_t kUnsignedByte = 5121;
constexpr uint32_t kUnsignedShort = 5123;
constexpr uint32_t kFloat = 5126;

constexpr uint32_t kArrayBuffer = 34962;  ///< target of buffer views of attributes

/// The types that EXT_mesh_features names for attributes.
bool isTypeOfFeatureIds(ComponentType type) {
  return type == ComponentType::kUint8 || type == ComponentType::kUint16 ||
         type == ComponentType::kFloat32;
}

/// Whether every element begins at a multiple of four bytes, as glTF asks of vertex attributes.
bool isAligned(const gltf::Document& document, const gltf::Accessor& accessor) {
  if (accessor.view == kNone) return true;
  const gltf::BufferView& view = document.views[accessor.view];
  const uint64_t explicit_stride = view.isCoded() ? view.coding.stride : view.stride;
  const uint64_t stride = explicit_stride != 0 ? explicit_stride : accessor.elementBytes();
  const uint64_t start = view.isCoded() ? accessor.offset : view.offset + accessor.offset;
  return stride % 4 == 0 && start % 4 == 0;
}

class Converter {
 public:
  Converter(uint64_t batch_count, gltf::Document& document, BinEnd& bin)
      : batch_count_(batch_count), document_(document), bin_(bin) {}

  Result convertPrimitive(Json& primitive, bool& has_ids);

 private:
  /// What an accessor of batch ids becomes.
  struct FeatureIds {
    uint32_t accessor = 0;
    uint64_t feature_count = 0;
    bool is_rewritten = false;
  };

  Result convertAccessor(uint32_t index, FeatureIds& made);
  Result readIds(uint32_t index, std::vector<uint32_t>& ids);
  Result writeIds(const std::vector<uint32_t>& ids, uint32_t& index);

  uint64_t batch_count_ = 0;
  gltf::Document& document_;
  BinEnd& bin_;
  std::map<uint32_t, FeatureIds> made_;  ///< by accessor of batch ids
  uint64_t read_count_ = 0;              ///< ids read from all accessors
};

/// Reads ids, which must all be rows of the table.
Result Converter::readIds(uint32_t index, std::vector<uint32_t>& ids) {
  const gltf::Accessor& accessor = document_.accessors[index];
  const std::string path = gltf::at("/accessors", index);
  if (accessor.componentCount() != 1 || accessor.normalized) {
    return gltf::error(path, "batch ids must be SCALAR and not normalized");
  }
  const std::string unreadable = gltf::whyUnreadable(document_, accessor);
  if (!unreadable.empty()) return gltf::error(path, "its batch ids cannot be read: " + unreadable);
  // Accessors may share bytes, so that their counts have no bound in the file.
  constexpr uint64_t kMostPerByte = 16;
  constexpr uint64_t kMostAnyway = uint64_t{1} << 22;
  read_count_ += accessor.count;
  if (read_count_ > kMostAnyway && read_count_ / kMostPerByte > document_.source_bytes &&
      accessor.decoded == kNone) {
    return gltf::error(path, "the accessors of batch ids claim more elements than the file holds");
  }
  gltf::AccessorData data;
  MCC_GLTF_TRY(gltf::readAccessor(document_, index, data));
  ids.reserve(data.count);
  for (uint64_t i = 0; i < data.count; ++i) {
    const double id = gltf::componentValue(data.element(i).data(), accessor.component_type);
    if (!(id >= 0 && id < static_cast<double>(batch_count_)) || id != std::floor(id)) {
      return gltf::error(path, "a batch id is not a whole number below BATCH_LENGTH");
    }
    ids.push_back(static_cast<uint32_t>(id));
  }
  if (ids.empty()) return gltf::error(path, "there are no batch ids in it");
  return {};
}

/// Writes ids as the smallest type that glTF allows for attributes, each at a multiple of four.
Result Converter::writeIds(const std::vector<uint32_t>& ids, uint32_t& index) {
  const uint32_t largest = *std::max_element(ids.begin(), ids.end());
  if (largest >= uint32_t{1} << 24) {
    return gltf::error("", "a batch id is 2^24 or more, which attributes of glTF 2.0 cannot hold");
  }
  const uint32_t type = largest <= 0xff     ? kUnsignedByte
                        : largest <= 0xffff ? kUnsignedShort
                                            : kFloat;
  std::vector<uint8_t> bytes;
  bytes.reserve(4 * ids.size());
  for (const uint32_t id : ids) {
    const uint32_t bits = type == kFloat ? std::bit_cast<uint32_t>(static_cast<float>(id)) : id;
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<uint8_t>(bits >> shift));
  }
  uint32_t view = 0;
  Json members = Json::object();
  addMember(members, "byteStride", 4);
  addMember(members, "target", kArrayBuffer);
  MCC_GLTF_TRY(bin_.addView(bytes, std::move(members), document_.json, view));
  Json& accessors = document_.json["accessors"];
  index = static_cast<uint32_t>(accessors.size());
  Json added = Json::object();
  addMember(added, "bufferView", view);
  addMember(added, "componentType", type);
  addMember(added, "count", ids.size());
  addMember(added, "type", "SCALAR");
  accessors.push_back(std::move(added));
  return {};
}

Result Converter::convertAccessor(uint32_t index, FeatureIds& made) {
  if (const auto found = made_.find(index); found != made_.end()) {
    made = found->second;
    return {};
  }
  std::vector<uint32_t> ids;
  MCC_GLTF_TRY(readIds(index, ids));
  const gltf::Accessor& accessor = document_.accessors[index];
  made.accessor = index;
  made.is_rewritten =
      !isTypeOfFeatureIds(accessor.component_type) || !isAligned(document_, accessor);
  if (made.is_rewritten) MCC_GLTF_TRY(writeIds(ids, made.accessor));
  std::sort(ids.begin(), ids.end());
  made.feature_count = static_cast<uint64_t>(std::unique(ids.begin(), ids.end()) - ids.begin());
  made_[index] = made;
  return {};
}

/// Returns the name of the batch ids among the attributes of a primitive, or an error where another
/// part of the primitive knows them by name or has feature ids already.
Result findName(const Json& primitive, std::string& name) {
  const Json* attributes = gltf::findMember(primitive, "attributes");
  if (attributes == nullptr || !attributes->is_object()) return {};
  for (const auto& [key, value] : attributes->get_ref<const Json::object_t&>()) {
    if (key == "_BATCHID" || key == "BATCHID") {
      if (!name.empty()) return gltf::error("", "it has both _BATCHID and BATCHID");
      name = key;
    }
  }
  if (name.empty()) return {};
  for (const auto& [key, value] : attributes->get_ref<const Json::object_t&>()) {
    if (key.starts_with("_FEATURE_ID_") || key.starts_with("FEATURE_ID_")) {
      return gltf::error("", "it has feature ids next to its batch ids");
    }
  }
  for (const Json& target : gltf::arrayOf(primitive, "targets")) {
    if (gltf::findMember(target, name) != nullptr) {
      return gltf::error("", "a morph target changes its batch ids");
    }
  }
  const Json* extensions = gltf::findMember(primitive, "extensions");
  if (extensions == nullptr) return {};
  if (!extensions->is_object()) return gltf::error("", "its extensions are not an object");
  for (const auto& [key, extension] : extensions->get_ref<const Json::object_t&>()) {
    const Json* names = gltf::findMember(extension, "attributes");
    if (key != gltf::kMeshExtension && names != nullptr &&
        gltf::findMember(*names, name) != nullptr) {
      return gltf::error("", "its extension " + key + " has batch ids");
    }
  }
  return {};
}

Result Converter::convertPrimitive(Json& primitive, bool& has_ids) {
  std::string name;
  MCC_GLTF_TRY(findName(primitive, name));
  if (name.empty()) return {};
  has_ids = true;
  Json& attributes = *findMember(primitive, "attributes");
  uint64_t index = 0;
  MCC_GLTF_TRY(gltf::readUnsigned(attributes, name, "attributes", kNone, index));
  if (index >= document_.accessors.size()) return gltf::error("", "its accessor does not exist");
  FeatureIds made;
  MCC_GLTF_TRY(convertAccessor(static_cast<uint32_t>(index), made));
  Json& extensions = memberOrNew(primitive, "extensions", Json::object());
  Json* draco = findMember(extensions, gltf::kMeshExtension);
  Json* coded = draco == nullptr ? nullptr : findMember(*draco, "attributes");
  if (coded != nullptr && findMember(*coded, name) != nullptr) {
    if (made.is_rewritten) {
      return gltf::error("", "Draco codes its batch ids with a type that feature ids cannot have");
    }
    renameMember(*coded, name, kFeatureIds);
  }
  Json& renamed = *findMember(primitive, "attributes");  // adding a member moves the others
  renameMember(renamed, name, kFeatureIds);
  *findMember(renamed, kFeatureIds) = made.accessor;
  Json set = Json::object();
  addMember(set, "featureCount", made.feature_count);
  addMember(set, "attribute", 0);
  addMember(set, "propertyTable", 0);
  Json features = Json::object();
  addMember(features, "featureIds", Json::array()).push_back(std::move(set));
  addMember(*findMember(primitive, "extensions"), "EXT_mesh_features", std::move(features));
  return {};
}

}  // namespace

Result convertBatchIds(uint64_t batch_count, gltf::Document& document, BinEnd& bin, bool& has_ids) {
  has_ids = false;
  Json* meshes = findMember(document.json, "meshes");
  if (meshes == nullptr || !meshes->is_array()) return {};
  Converter converter(batch_count, document, bin);
  for (size_t m = 0; m < document.json["meshes"].size(); ++m) {
    // Each look-up begins at the root, because members that are added there move the others.
    Json* primitives = findMember(document.json["meshes"][m], "primitives");
    const size_t primitive_count =
        primitives != nullptr && primitives->is_array() ? primitives->size() : 0;
    for (size_t p = 0; p < primitive_count; ++p) {
      Json& primitive = document.json["meshes"][m]["primitives"][p];
      const Result done = converter.convertPrimitive(primitive, has_ids);
      if (!done.ok()) return gltf::error(gltf::primitivePath(m, p), done.message());
    }
  }
  return {};
}

}  // namespace mcc::tiles
