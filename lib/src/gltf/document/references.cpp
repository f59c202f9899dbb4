// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/references.h"

#include <algorithm>
#include <cctype>
#include <type_traits>

#include "gltf/document/known_extensions.h"
#include "mcc/glb.h"

namespace mcc::gltf {
namespace {

bool containsIgnoringCase(const std::string& text, std::string_view word) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), word.begin(), word.end(), same) != text.end();
}

/// Words that suggest that a key in extras counts vertices or triangles.
constexpr std::string_view kOrderWords[] = {"face",  "first",  "group",    "index",   "indices",
                                            "range", "vertex", "vertices", "triangle"};

/// Returns the first key in extras that has such a word and a value other than text, or an empty
/// string.
std::string orderWordOf(const Json& json) {
  if (!json.is_structured()) return "";
  for (const auto& [key, value] : json.items()) {
    const bool is_named =
        json.is_object() && !value.is_string() &&
        std::any_of(std::begin(kOrderWords), std::end(kOrderWords),
                    [&name = key](auto word) { return containsIgnoringCase(name, word); });
    const std::string found = is_named ? key : orderWordOf(value);
    if (!found.empty()) return found;
  }
  return "";
}

void keepNumbers(ForeignReferences& foreign, const std::string& reason) {
  if (!foreign.keep_numbers) foreign.reason = reason;
  foreign.keep_numbers = true;
}

void keepNumbersFor(ForeignReferences& foreign, const std::string& extension) {
  keepNumbers(foreign, extension);
  if (foreign.extension.empty()) foreign.extension = extension;
}

/// What the keys above a value say that its numbers are.
struct Meaning {
  bool is_view = false;
  bool is_accessor = false;
};

/// Collects the references in extras and unknown extensions. Visits every value once.
void walkForeign(const Json& json, Meaning meaning, ForeignReferences& foreign) {
  uint64_t number = 0;
  if (json.is_array()) {
    for (const Json& value : json) walkForeign(value, meaning, foreign);
  } else if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      Meaning below = meaning;
      if (containsIgnoringCase(key, "bufferView")) {
        below.is_view = true;
        keepNumbers(foreign, "\"" + key + "\"");
      } else if (containsIgnoringCase(key, "accessor")) {
        below.is_accessor = true;
      }
      walkForeign(value, below, foreign);
    }
  } else if ((meaning.is_view || meaning.is_accessor) && asUnsigned(json, number)) {
    if (meaning.is_view) foreign.views.insert(number);
    if (meaning.is_accessor) foreign.accessors.insert(number);
  }
}

void walkKnown(const Json& json, ForeignReferences& foreign) {
  if (json.is_array()) {
    for (const Json& value : json) walkKnown(value, foreign);
  }
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    if (key == "extras") {
      walkForeign(value, {}, foreign);
    } else if (key == "extensions" && value.is_object()) {
      for (const auto& [name, extension] : value.items()) {
        if (isUnderstood(name, extension)) {
          walkKnown(extension, foreign);
        } else {
          keepNumbersFor(foreign, name);
          walkForeign(extension, {}, foreign);
        }
      }
    } else {
      walkKnown(value, foreign);
    }
  }
}

template <typename J, typename Visit>
void visitMember(J* object, const char* key, uint32_t accessor, const Visit& visit) {
  if (J* number = member(object, key); number != nullptr) visit(*number, accessor);
}

template <typename J, typename Visit>
void visitViewReferencesOf(J& root, const Visit& visit) {
  uint32_t number = 0;
  visitElements(member(&root, "accessors"), [&](J& accessor) {
    visitMember(&accessor, "bufferView", number, visit);
    J* sparse = member(&accessor, "sparse");
    visitMember(member(sparse, "indices"), "bufferView", number, visit);
    visitMember(member(sparse, "values"), "bufferView", number, visit);
    ++number;
  });
  visitElements(member(&root, "images"),
                [&](J& image) { visitMember(&image, "bufferView", kNone, visit); });
  visitElements(member(&root, "meshes"), [&](J& mesh) {
    visitElements(member(&mesh, "primitives"), [&](J& primitive) {
      J* extensions = member(&primitive, "extensions");
      J* ours = member(extensions, kExtensionName);
      visitMember(ours, "bufferView", kNone, visit);
      visitMember(member(ours, "preview"), "bufferView", kNone, visit);
      visitMember(member(extensions, kMeshExtension), "bufferView", kNone, visit);
    });
  });
  if constexpr (std::is_const_v<J>) {
    visitTableViews(root, [&](J& view) { visit(view, kNone); });
  } else {
    editTableViews(root, [&](J& view) { visit(view, kNone); });
  }
}

}  // namespace

namespace {

/// Visits the numbers of accessors in the places that glTF 2.0 and EXT_mesh_gpu_instancing define.
template <typename J, typename Visit>
void visitAccessorReferencesOf(J& root, const Visit& visit) {
  const auto visitAll = [&](J* map) {
    if (map == nullptr || !map->is_object()) return;
    for (J& number : *map) visit(number);
  };
  const auto visitKey = [&](J* object, const char* key) {
    if (J* number = member(object, key)) visit(*number);
  };
  visitElements(member(&root, "meshes"), [&](J& mesh) {
    visitElements(member(&mesh, "primitives"), [&](J& primitive) {
      visitAll(member(&primitive, "attributes"));
      visitElements(member(&primitive, "targets"), [&](J& target) { visitAll(&target); });
      visitKey(&primitive, "indices");
    });
  });
  visitElements(member(&root, "skins"), [&](J& skin) { visitKey(&skin, "inverseBindMatrices"); });
  visitElements(member(&root, "animations"), [&](J& animation) {
    visitElements(member(&animation, "samplers"), [&](J& sampler) {
      visitKey(&sampler, "input");
      visitKey(&sampler, "output");
    });
  });
  visitElements(member(&root, "nodes"), [&](J& node) {
    visitAll(member(member(member(&node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes"));
  });
}

bool isMissing(const Json& number, size_t accessor_count) {
  uint64_t accessor = 0;
  return asUnsigned(number, accessor) && accessor >= accessor_count;
}

}  // namespace

void visitMissingAccessors(const Json& root, size_t accessor_count,
                           const std::function<void(const Json& number)>& visit) {
  visitAccessorReferencesOf(root, [&](const Json& number) {
    if (isMissing(number, accessor_count)) visit(number);
  });
}

void hideMissingAccessors(size_t accessor_count, Json& root) {
  bool is_any_missing = false;  // whoever looks for places to change makes a copy of them
  visitMissingAccessors(root, accessor_count, [&](const Json&) { is_any_missing = true; });
  if (!is_any_missing) return;
  visitAccessorReferencesOf(root, [&](Json& number) {
    if (isMissing(number, accessor_count)) number = kNone;
  });
}

bool hasWideAccessors(const Json& root) {
  const Json& accessors = arrayOf(root, "accessors");
  return std::any_of(accessors.begin(), accessors.end(), [](const Json& accessor) {
    uint64_t type = 0;
    return asUnsigned(findMember(accessor, "componentType"), type) &&
           (type == 5130 || type == 5134 || type == 5135);
  });
}

ForeignReferences findForeignReferences(const Json& root) {
  ForeignReferences foreign;
  walkKnown(root, foreign);
  foreign.has_tables = mayHaveTables(root);
  foreign.has_wide_accessors = hasWideAccessors(root);
  for (const Json& name : arrayOf(root, "extensionsUsed")) {
    if (name.is_string() && !isKnownExtension(name.get<std::string>())) {
      keepNumbersFor(foreign, name.get<std::string>());
    }
  }
  return foreign;
}

void visitViewReferences(const Json& root,
                         const std::function<void(const Json&, uint32_t)>& visit) {
  visitViewReferencesOf(root, visit);
}

void editViewReferences(Json& root, const std::function<void(Json&, uint32_t)>& visit) {
  visitViewReferencesOf(root, visit);
}

std::string orderDependentPart(const Json& mesh_or_primitive, NumbersOfVertices numbers) {
  if (const Json* extensions = findMember(mesh_or_primitive, "extensions");
      extensions != nullptr && extensions->is_object()) {
    for (const auto& [name, value] : extensions->items()) {
      const bool is_free = isOrderFree(name, value) || (numbers == NumbersOfVertices::kCanChange &&
                                                        isRenumberable(name, value));
      if (!is_free) return name;
    }
  }
  const Json* extras = findMember(mesh_or_primitive, "extras");
  return extras == nullptr ? "" : orderWordOf(*extras);
}

std::string unknownExtension(const Json& object) {
  const Json* extensions = findMember(object, "extensions");
  if (extensions == nullptr || !extensions->is_object()) return "";
  for (const auto& [name, value] : extensions->items()) {
    if (!isKnownExtension(name)) return name;
  }
  return "";
}

void addExtensionName(Json& root, const char* list, const char* name) {
  Json& names = root[list];
  if (!names.is_array()) names = Json::array();
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

void removeExtensionName(Json& root, const char* list, const char* name) {
  const auto found = root.find(list);
  if (found == root.end() || !found->is_array()) return;
  Json others = Json::array();
  for (const Json& other : *found) {
    if (other != name) others.push_back(other);
  }
  if (others.empty()) {  // also when it was empty before, which glTF forbids
    root.erase(list);
  } else {
    *found = std::move(others);
  }
}

std::string nodeDependentExtension(const Json& root, const ForeignReferences& foreign) {
  if (!foreign.extension.empty()) return foreign.extension;
  for (const Json& name : arrayOf(root, "extensionsUsed")) {
    if (name.is_string() && refersToNodes(name.text())) {
      return name.get<std::string>();
    }
  }
  return "";
}

}  // namespace mcc::gltf
