// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/check_json.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "gltf/check/same_bytes.h"
#include "gltf/document/accessors.h"
#include "gltf/document/known_extensions.h"
#include "gltf/document/rebuild.h"
#include "gltf/document/references.h"

namespace mcc::gltf {
namespace {

/// Returns the numbers of an object's members sorted by key; those with the same key stay in the
/// order of the object.
std::vector<size_t> sortedMembers(const Json& object) {
  std::vector<size_t> members(object.size());
  std::iota(members.begin(), members.end(), size_t{0});
  std::stable_sort(members.begin(), members.end(),
                   [&](size_t a, size_t b) { return object.keyAt(a) < object.keyAt(b); });
  return members;
}

/// Whether two values differ. `path` is extended to the place of the difference.
bool differs(const Json& a, const Json& b, std::string& path) {
  if (!a.is_structured() || a.kind() != b.kind()) return !(a == b);
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
  const std::vector<size_t> in_a = sortedMembers(a);
  const std::vector<size_t> in_b = sortedMembers(b);
  for (size_t i = 0; i < in_a.size(); ++i) {
    const std::string& key = a.keyAt(in_a[i]);
    path = at(path, key);
    if (key != b.keyAt(in_b[i]) || differs(a[in_a[i]], b[in_b[i]], path)) return true;
    path.resize(length);
  }
  return false;
}

void eraseAll(Json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) object.erase(key);
}

void eraseFrom(Json& json, const char* key) {
  if (json.is_object()) json.erase(key);
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
  hideMissingAccessors(document.accessors.size(), json);
  if (!uses.empty()) {
    Json& meshes = json["meshes"];
    for (const ExtensionUse& use : uses) {
      eraseGeometry(meshes[use.mesh]["primitives"][use.primitive]);
    }
  }
  if (json.find("accessors") == json.end()) return json;
  Json old_accessors = std::move(json["accessors"]);
  Json accessors = Json::array();
  for (uint32_t i = 0; i < std::min(accessor_count, old_accessors.size()); ++i) {
    Json accessor = std::move(old_accessors[i]);
    accessor.erase("byteOffset");
    if (const auto sparse = accessor.find("sparse"); sparse != accessor.end()) {
      for (const char* part : {"indices", "values"}) {
        if (findMember(*sparse, part) != nullptr) eraseFrom((*sparse)[part], "byteOffset");
      }
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

ByteRange viewRange(const Document& document, uint64_t view) {
  const BufferView& range = document.views[view];
  return {range.buffer, range.offset, range.offset + range.length};
}

/// Compares the bytes of everything that a conversion must not change.
class BytesChecker {
 public:
  BytesChecker(const Document& source, const Document& decoded)
      : source_(source), decoded_(decoded), bytes_(source, decoded) {}

  void addAccessor(uint32_t index) {
    const Accessor& a = source_.accessors[index];
    if (!a.is_known_type || (a.view == kNone && a.sparse.count == 0)) return;
    const Accessor& b = decoded_.accessors[index];
    const bool is_same = a.fault.ok() == b.fault.ok() && a.count == b.count &&
                         a.elementBytes() == b.elementBytes() &&
                         strideOf(source_, a) == strideOf(decoded_, b);
    const std::vector<ByteRange> in_source = accessorRanges(source_, index, false);
    const std::vector<ByteRange> in_decoded = accessorRanges(decoded_, index, false);
    if (!is_same || in_source.size() != in_decoded.size()) {
      return addDifference("/accessors", index, "has another size");
    }
    if (!sameCodings(a, b)) return addDifference("/accessors", index, "the coded bytes changed");
    for (size_t i = 0; i < in_source.size(); ++i) {
      add(in_source[i], in_decoded[i], "/accessors", index, "its elements changed");
    }
  }

  void addImages() {
    const Json& images = arrayOf(source_.json, "images");
    const Json& new_images = arrayOf(decoded_.json, "images");
    for (size_t i = 0; i < images.size(); ++i) {
      const Json* number = findMember(images[i], "bufferView");
      if (number == nullptr) continue;
      const Json* new_number = findMember(new_images[i], "bufferView");
      addViews(number, new_number, "/images", i, "the image changed");
    }
  }

  /// Adds the property tables. Their views have names of their own.
  void addTables() {
    const auto numbersOf = [](const Document& document) {
      std::vector<const Json*> numbers;
      visitTableViews(document.json, [&](const Json& number) { numbers.push_back(&number); });
      return numbers;
    };
    const std::vector<const Json*> old_numbers = numbersOf(source_);
    const std::vector<const Json*> new_numbers = numbersOf(decoded_);
    if (old_numbers.size() != new_numbers.size()) {
      return addDifference("/extensions", 0, "a property table is lost");
    }
    for (size_t i = 0; i < old_numbers.size(); ++i) {
      uint64_t view = 0;
      if (!asUnsigned(*old_numbers[i], view)) continue;
      addViews(old_numbers[i], new_numbers[i], "/bufferViews", view, "a property table changed");
    }
  }

  void addView(uint32_t view) {
    if (view >= decoded_.views.size()) {
      return addDifference("/bufferViews", view, "the bytes changed");
    }
    add(viewRange(source_, view), viewRange(decoded_, view), "/bufferViews", view,
        "the bytes changed");
  }

  Result run() {
    const size_t first = std::min(bytes_.firstDifference(), first_);
    if (first == SameBytes::kNothing) return {};
    return error(at(places_[first].array, places_[first].index), places_[first].what);
  }

 private:
  struct Place {
    const char* array;
    uint64_t index;
    const char* what;
  };

  static uint64_t strideOf(const Document& document, const Accessor& accessor) {
    return accessor.view == kNone ? 0 : document.views[accessor.view].stride;
  }

  void add(const ByteRange& in_source, const ByteRange& in_decoded, const char* array,
           uint64_t index, const char* what) {
    bytes_.add(in_source, in_decoded, places_.size());
    places_.push_back({array, index, what});
  }

  void addDifference(const char* array, uint64_t index, const char* what) {
    first_ = std::min(first_, places_.size());
    places_.push_back({array, index, what});
  }

  /// Adds the views that two members name. A view that does not exist was wrong in the source, too.
  void addViews(const Json* number, const Json* new_number, const char* array, uint64_t index,
                const char* what) {
    uint64_t old_view = 0;
    uint64_t new_view = 0;
    if (!asUnsigned(*number, old_view) || old_view >= source_.views.size()) return;
    const bool exists = new_number != nullptr && asUnsigned(*new_number, new_view) &&
                        new_view < decoded_.views.size();
    if (!exists) return addDifference(array, index, what);
    add(viewRange(source_, old_view), viewRange(decoded_, new_view), array, index, what);
  }

  /// Whether views that another codec compressed are described as they were.
  bool sameCodings(const Accessor& a, const Accessor& b) const {
    if ((a.view == kNone) != (b.view == kNone)) return false;
    bool is_same = a.view == kNone || sameCoding(a.view, b.view);
    if (a.sparse.count != 0 && b.sparse.count != 0) {
      is_same &= sameCoding(a.sparse.index_view, b.sparse.index_view) &&
                 sameCoding(a.sparse.value_view, b.sparse.value_view);
    }
    return is_same;
  }

  bool sameCoding(uint32_t source_view, uint32_t decoded_view) const {
    const ViewCoding& a = source_.views[source_view].coding;
    const ViewCoding& b = decoded_.views[decoded_view].coding;
    return a.extension == b.extension && a.mode == b.mode && a.filter == b.filter &&
           a.count == b.count && a.stride == b.stride;
  }

  const Document& source_;
  const Document& decoded_;
  SameBytes bytes_;
  std::vector<Place> places_;  ///< of the pairs, by number
  size_t first_ = SameBytes::kNothing;
};

/// Where views keep their numbers, adds every view, except those that only compressed accessors
/// used and payloads of the source, which are decoded.
Result addViews(const Document& source, const std::set<uint32_t>& touched, BytesChecker& checker) {
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
  for (uint32_t view = 0; view < source.views.size(); ++view) {
    if (!is_freed[view]) checker.addView(view);
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
  BytesChecker checker(source, decoded);
  for (uint32_t i = 0; i < count; ++i) {
    if (touched.count(i) == 0) checker.addAccessor(i);
  }
  checker.addImages();
  checker.addTables();
  MCC_GLTF_TRY(addViews(source, touched, checker));
  return checker.run();
}

}  // namespace mcc::gltf
