// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/check_json.h"

#include <algorithm>
#include <set>

#include "gltf/document/accessors.h"
#include "gltf/document/known_extensions.h"
#include "gltf/document/rebuild.h"
#include "gltf/document/references.h"

namespace mcc::gltf {
namespace {

using Member = std::pair<const std::string, Json>;

/// Returns the members of an object sorted by key; those with the same key stay in the order of the
/// object.
std::vector<const Member*> sortedMembers(const Json& object) {
  std::vector<const Member*> members;
  for (const Member& member : object.get_ref<const Json::object_t&>()) members.push_back(&member);
  std::stable_sort(members.begin(), members.end(),
                   [](const Member* a, const Member* b) { return a->first < b->first; });
  return members;
}

/// Whether two values differ. `path` is extended to the place of the difference.
bool differs(const Json& a, const Json& b, std::string& path) {
  if (!a.is_structured() || a.type() != b.type()) return !(a == b);
  if (a.size() != b.size()) return true;
  const size_t length = path.size();
  if (a.is_array()) {
    for (size_t i = 0; i < a.size(); ++i) {
      path += "/" + std::to_string(i);
      if (differs(a[i], b[i], path)) return true;
      path.resize(length);
    }
    return false;
  }
  const std::vector<const Member*> in_a = sortedMembers(a);
  const std::vector<const Member*> in_b = sortedMembers(b);
  for (size_t i = 0; i < in_a.size(); ++i) {
    path = at(path, in_a[i]->first);
    if (in_a[i]->first != in_b[i]->first || differs(in_a[i]->second, in_b[i]->second, path)) {
      return true;
    }
    path.resize(length);
  }
  return false;
}

void eraseAll(Json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) object.erase(key);
}

void eraseGeometry(Json& primitive) {
  eraseAll(primitive, {"attributes", "indices", "mode", "targets"});
  const auto extensions = primitive.find("extensions");
  if (extensions == primitive.end()) return;
  extensions->erase(kExtensionName);
  extensions->erase(kMeshExtension);
  if (extensions->empty()) primitive.erase("extensions");
}

/// Returns the document without what a conversion may change: numbers and places of buffer views,
/// and the compressed geometry itself. Accessors from `accessor_count` on are ours and are left
/// out.
Json withoutGeometry(const Document& document, const std::vector<ExtensionUse>& uses,
                     const std::set<uint32_t>& touched, size_t accessor_count) {
  Json json = document.json;
  eraseAll(json, {"buffers", "bufferViews"});
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    for (const char* name : kViewExtensions) removeExtensionName(json, list, name);
    removeExtensionName(json, list, kMeshExtension);
    removeExtensionName(json, list, kExtensionName);
  }
  editViewReferences(json, [](Json& number, uint32_t) { number = 0; });
  for (const ExtensionUse& use : uses) {
    eraseGeometry(json["meshes"][use.mesh]["primitives"][use.primitive]);
  }
  if (json.find("accessors") == json.end()) return json;
  Json accessors = Json::array();
  for (uint32_t i = 0; i < std::min(accessor_count, json["accessors"].size()); ++i) {
    Json accessor = std::move(json["accessors"][i]);
    accessor.erase("byteOffset");
    if (Json* sparse = accessor.contains("sparse") ? &accessor["sparse"] : nullptr) {
      (*sparse)["indices"].erase("byteOffset");
      (*sparse)["values"].erase("byteOffset");
    }
    if (touched.count(i) != 0) {
      eraseAll(accessor, {"bufferView", "sparse", "min", "max", "count", "componentType"});
    }
    accessors.push_back(std::move(accessor));
  }
  if (accessors.empty()) {
    json.erase("accessors");
  } else {
    json["accessors"] = std::move(accessors);
  }
  return json;
}

std::span<const uint8_t> viewBytes(const Document& document, uint64_t view) {
  const BufferView& range = document.views[view];
  return document.buffers[range.buffer].subspan(range.offset, range.length);
}

bool sameBytes(std::span<const uint8_t> a, std::span<const uint8_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// Checks that a view which another codec compressed is as it was.
Result compareCoding(const Document& source, uint32_t source_view, const Document& decoded,
                     uint32_t decoded_view) {
  const std::string path = at("/bufferViews", source_view);
  if (decoded_view == kNone) return error(path, "is lost");
  const ViewCoding& a = source.views[source_view].coding;
  const ViewCoding& b = decoded.views[decoded_view].coding;
  const bool is_same = a.extension == b.extension && a.mode == b.mode && a.filter == b.filter &&
                       a.count == b.count && a.stride == b.stride &&
                       sameBytes(viewBytes(source, source_view), viewBytes(decoded, decoded_view));
  return is_same ? Result{} : error(path, "the coded bytes changed");
}

Result compareAccessor(const Document& source, const Document& decoded, uint32_t index) {
  const std::string path = at("/accessors", index);
  if (!source.accessors[index].is_known_type) return {};
  const uint32_t view = source.accessors[index].view;
  if (view != kNone && source.views[view].isCoded()) {
    return compareCoding(source, view, decoded, decoded.accessors[index].view);
  }
  if (source.accessors[index].view == kNone && source.accessors[index].sparse.count == 0) return {};
  AccessorData a;
  AccessorData b;
  if (!readAccessor(source, index, a).ok()) return {};  // unreadable in the source, too
  MCC_GLTF_TRY(readAccessor(decoded, index, b));
  if (a.count != b.count || a.element_bytes != b.element_bytes) {
    return error(path, "has another size");
  }
  for (uint64_t i = 0; i < a.count; ++i) {
    if (!sameBytes(a.element(i), b.element(i))) {
      return error(path, "element " + std::to_string(i) + " changed");
    }
  }
  return {};
}

Result compareImages(const Document& source, const Document& decoded) {
  const Json& images = arrayOf(source.json, "images");
  for (size_t i = 0; i < images.size(); ++i) {
    const Json* number = findMember(images[i], "bufferView");
    if (number == nullptr) continue;
    uint64_t old_view = 0;
    uint64_t new_view = 0;
    // A number of a view that does not exist was already wrong in the source.
    if (!asUnsigned(*number, old_view) || old_view >= source.views.size()) continue;
    const Json* new_number = findMember(arrayOf(decoded.json, "images")[i], "bufferView");
    const bool is_valid = new_number != nullptr && asUnsigned(*new_number, new_view) &&
                          new_view < decoded.views.size();
    if (!is_valid || !sameBytes(viewBytes(source, old_view), viewBytes(decoded, new_view))) {
      return error(at("/images", i), "the image changed");
    }
  }
  return {};
}

/// Checks that the property tables have the bytes of the source.
Result compareTables(const Document& source, const Document& decoded) {
  const auto viewsOf = [](const Document& document) {
    std::vector<uint64_t> views;
    visitTableViews(document.json, [&](const Json& number) {
      uint64_t view = 0;
      views.push_back(asUnsigned(number, view) ? view : kNone);
    });
    return views;
  };
  const std::vector<uint64_t> old_views = viewsOf(source);
  const std::vector<uint64_t> new_views = viewsOf(decoded);
  if (old_views.size() != new_views.size()) return error("", "a property table is lost");
  for (size_t i = 0; i < old_views.size(); ++i) {
    // A number of a view that does not exist was already wrong in the source.
    if (old_views[i] >= source.views.size()) continue;
    const bool is_same =
        new_views[i] < decoded.views.size() &&
        sameBytes(viewBytes(source, old_views[i]), viewBytes(decoded, new_views[i]));
    if (!is_same) return error(at("/bufferViews", old_views[i]), "a property table changed");
  }
  return {};
}

/// Where views keep their numbers, checks that every view is unchanged, except those that only
/// compressed accessors used and payloads of the source, which are decoded.
Result compareViews(const Document& source, const Document& decoded,
                    const std::set<uint32_t>& touched) {
  const ForeignReferences foreign = findForeignReferences(source.json);
  if (!foreign.keep_numbers) return {};
  std::vector<bool> is_freed;
  for (const ViewUse use : viewUses(source, foreign)) is_freed.push_back(use == ViewUse::kFree);
  std::vector<ExtensionUse> own;
  MCC_GLTF_TRY(findExtensionUses(source, own));
  for (const ExtensionUse& use : own) is_freed[use.view] = true;
  for (const uint32_t index : touched) {
    if (index >= source.accessors.size()) continue;
    const Accessor& accessor = source.accessors[index];
    if (accessor.view != kNone) is_freed[accessor.view] = true;
    if (accessor.decoded_from != kNone) is_freed[accessor.decoded_from] = true;
    if (accessor.sparse.count == 0) continue;
    is_freed[accessor.sparse.index_view] = true;
    is_freed[accessor.sparse.value_view] = true;
  }
  for (size_t view = 0; view < source.views.size(); ++view) {
    if (is_freed[view]) continue;
    if (view >= decoded.views.size() ||
        !sameBytes(viewBytes(source, view), viewBytes(decoded, view))) {
      return error(at("/bufferViews", view), "the bytes changed");
    }
  }
  return {};
}

}  // namespace

bool equalJson(const Json& a, const Json& b) { return firstDifference(a, b).empty(); }

std::string firstDifference(const Json& a, const Json& b) {
  std::string path;
  if (!differs(a, b, path)) return "";
  return path.empty() ? "/" : path;
}

Result compareRest(const Document& source, const Document& decoded,
                   const std::vector<ExtensionUse>& uses, const std::set<uint32_t>& reordered) {
  std::set<uint32_t> touched = reordered;
  for (const ExtensionUse& use : uses) {
    touched.insert(use.indices_accessor);
    for (const auto& attribute : use.attributes) touched.insert(attribute.accessor);
  }
  const size_t count = source.accessors.size();
  const std::string difference = firstDifference(withoutGeometry(source, uses, touched, count),
                                                 withoutGeometry(decoded, uses, touched, count));
  if (!difference.empty()) return error(difference, "the JSON changed");
  for (uint32_t i = 0; i < count; ++i) {
    if (touched.count(i) == 0) MCC_GLTF_TRY(compareAccessor(source, decoded, i));
  }
  MCC_GLTF_TRY(compareImages(source, decoded));
  MCC_GLTF_TRY(compareTables(source, decoded));
  return compareViews(source, decoded, touched);
}

}  // namespace mcc::gltf
