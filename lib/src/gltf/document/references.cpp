// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/references.h"

#include <array>
#include <cctype>

#include "mcc/glb.h"

namespace mcc::gltf {
namespace {

// ---- What we know about extensions

constexpr char kRestartExtension[] = "EXT_mesh_primitive_restart";

/// Some names of members; the rest is empty.
using Names = std::array<std::string_view, 9>;

/// Whether an object has no members but these.
bool hasOnly(const Json& object, const Names& names, const Names& others = {}) {
  if (!object.is_object()) return false;
  const auto isOneOf = [](const Names& known, const std::string& key) {
    return !key.empty() && std::find(known.begin(), known.end(), key) != known.end();
  };
  for (const auto& [key, value] : object.items()) {
    if (!isOneOf(names, key) && !isOneOf(others, key)) return false;
  }
  return true;
}

/// The same, where any object may also have extras and extensions, which are looked at apart.
bool hasOnlyWithExtras(const Json& object, const Names& names) {
  return hasOnly(object, names, {"extras", "extensions"});
}

/// Whether these are groups of primitives that are named by numbers. Nothing else in their mesh
/// depends on an order.
bool areGroups(const Json& restart) {
  if (!hasOnlyWithExtras(restart, {"primitiveGroups"})) return false;
  const Json& groups = restart["primitiveGroups"];
  return groups.is_array() && std::all_of(groups.begin(), groups.end(), [](const Json& group) {
           const Json& primitives = group["primitives"];
           uint64_t number = 0;
           return hasOnlyWithExtras(group, {"primitives", "indices", "name"}) &&
                  primitives.is_array() &&
                  std::all_of(primitives.begin(), primitives.end(),
                              [&](const Json& primitive) { return asUnsigned(primitive, number); });
         });
}

/// Whether every set of feature ids is an attribute, which moves with its vertices, or a texture.
/// Without either, the id of a vertex is its number.
bool hasExplicitIds(const Json& features) {
  if (!hasOnly(features, {"featureIds"})) return false;
  const Json& sets = arrayOf(features, "featureIds");
  return !sets.empty() && std::all_of(sets.begin(), sets.end(), [](const Json& set) {
    return hasOnly(set, {"featureCount", "nullFeatureId", "label", "attribute", "texture",
                         "propertyTable"}) &&
           (set.contains("attribute") || set.contains("texture"));
  });
}

/// Textures are found by texture coordinates, attributes by their names, rows by their numbers.
bool hasOnlyMetadata(const Json& metadata) {
  return hasOnly(metadata, {"propertyTextures", "propertyAttributes", "propertyTable", "index"});
}

bool always(const Json&) { return true; }
bool never(const Json&) { return false; }

/// An extension on our list: its objects hold no numbers of buffer views or accessors, except where
/// the tables below and the functions of references.h look for them.
struct KnownExtension {
  std::string_view name;
  /// Whether an object of meshes or primitives does not depend on the order of vertices and
  /// triangles.
  bool (*is_order_free)(const Json& object) = never;
  bool names_nodes = false;  ///< because of their meshes
};

constexpr bool kNamesNodes = true;

constexpr KnownExtension kKnownExtensions[] = {
    {"ADOBE_materials_clearcoat_specular"},
    {"ADOBE_materials_clearcoat_tint"},
    {"ADOBE_materials_thin_transparency"},
    {"BENTLEY_materials_line_style"},
    {"BENTLEY_materials_planar_fill"},
    {"BENTLEY_materials_point_style"},
    {"CESIUM_RTC"},
    {"CESIUM_primitive_outline"},
    {"CESIUM_tile_edges"},
    {"EXT_accessor_additional_types"},
    {"EXT_instance_features"},
    {"EXT_lights_image_based"},
    {"EXT_mesh_features", hasExplicitIds},
    {"EXT_mesh_gpu_instancing"},
    {kManifoldExtension},
    {"EXT_mesh_primitive_edge_visibility"},
    {kRestartExtension, areGroups},
    {"EXT_meshopt_compression"},
    {kMetadataExtension, hasOnlyMetadata},
    {"EXT_texture_avif"},
    {"EXT_texture_webp"},
    {"KHR_accessor_float16"},
    {"KHR_accessor_float64"},
    {"KHR_animation_pointer", never, kNamesNodes},
    {"KHR_draco_mesh_compression", always},  // removed with the data that it describes
    {"KHR_gaussian_splatting"},
    {"KHR_lights_punctual"},
    {"KHR_materials_variants", always},         // materials of the whole primitive
    {"KHR_mesh_collapse_compression", always},  // our own
    {"KHR_mesh_quantization"},
    {"KHR_meshopt_compression"},
    {"KHR_node_hoverability"},
    {"KHR_node_selectability"},
    {"KHR_node_visibility"},
    {"KHR_texture_basisu"},
    {"KHR_texture_transform"},
    {"KHR_xmp", always},          // names a packet of metadata
    {"KHR_xmp_json_ld", always},  // the same
    {"MSFT_lod", never, kNamesNodes},
    {"MSFT_packing_normalRoughnessMetallic"},
    {"MSFT_packing_occlusionRoughnessMetallic"},
    {"MSFT_texture_dds"},
    {"VRM", never, kNamesNodes},
    {"VRMC_materials_mtoon"},
    {"VRMC_node_constraint", never, kNamesNodes},
    {"VRMC_springBone", never, kNamesNodes},
    {"VRMC_vrm", never, kNamesNodes},
};

/// The members of objects of extensions on our list, and of what is in them, where drafts of the
/// same name, or others, may have numbers of accessors, buffer views or vertices.
struct KnownMembers {
  std::string_view extension;
  std::string_view path;  ///< from the object of the extension on
  Names names;
};

constexpr KnownMembers kKnownMembers[] = {
    {"CESIUM_primitive_outline", "", {"indices"}},
    {"CESIUM_tile_edges", "", {"left", "bottom", "right", "top"}},
    {"EXT_instance_features", "", {"featureIds"}},
    {"EXT_mesh_features", "", {"featureIds"}},
    {kManifoldExtension, "", {"manifoldPrimitive", "mergeIndices", "mergeValues"}},
    {kManifoldExtension, "manifoldPrimitive", {"attributes", "indices", "mode"}},
    {"EXT_mesh_primitive_edge_visibility",
     "",
     {"visibility", "material", "lineStrings", "silhouetteMates", "silhouetteNormals"}},
    {"EXT_mesh_primitive_edge_visibility", "lineStrings/[]", {"indices", "material"}},
    {kMetadataExtension,
     "",
     {"schema", "schemaUri", "propertyTables", "propertyTextures", "propertyAttributes",
      "propertyTable", "index"}},
    {kMetadataExtension, "propertyTables/[]", {"name", "class", "count", "properties"}},
    {kMetadataExtension,
     "propertyTables/[]/properties/{}",
     {"values", "arrayOffsets", "stringOffsets", "arrayOffsetType", "stringOffsetType", "offset",
      "scale", "max", "min"}},
    {"KHR_gaussian_splatting", "", {"kernel", "colorSpace", "projection", "sortingMethod"}},
};

/// A place in a primitive's extension that is the number of an accessor.
struct AccessorMember {
  std::string_view extension;
  std::string_view path;
  ExtensionAccessor what;
};

constexpr AccessorMember kAccessorMembers[] = {
    {"CESIUM_primitive_outline", "indices", ExtensionAccessor::kVertexNumbers},
    {"CESIUM_tile_edges", "left", ExtensionAccessor::kVertexNumbers},
    {"CESIUM_tile_edges", "bottom", ExtensionAccessor::kVertexNumbers},
    {"CESIUM_tile_edges", "right", ExtensionAccessor::kVertexNumbers},
    {"CESIUM_tile_edges", "top", ExtensionAccessor::kVertexNumbers},
    // Two bits for each edge of each triangle, and what belongs to these edges.
    {"EXT_mesh_primitive_edge_visibility", "visibility", ExtensionAccessor::kOther},
    {"EXT_mesh_primitive_edge_visibility", "silhouetteMates", ExtensionAccessor::kOther},
    {"EXT_mesh_primitive_edge_visibility", "silhouetteNormals", ExtensionAccessor::kOther},
    {"EXT_mesh_primitive_edge_visibility", "lineStrings/[]/indices", ExtensionAccessor::kOther},
};

const KnownExtension* findKnown(std::string_view name) {
  const auto found =
      std::find_if(std::begin(kKnownExtensions), std::end(kKnownExtensions),
                   [&](const KnownExtension& extension) { return extension.name == name; });
  return found == std::end(kKnownExtensions) ? nullptr : found;
}

bool isKnownExtension(std::string_view name) {
  return name.starts_with("KHR_materials_") || findKnown(name) != nullptr;
}

/// Whether an object of an extension has only the members that we know.
bool isUnderstood(std::string_view name, const Json& object) {
  if (name == kRestartExtension) return areGroups(object);
  bool is_understood = isKnownExtension(name);
  for (const KnownMembers& known : kKnownMembers) {
    if (known.extension != name) continue;
    const bool is_of_kind = visitPath(&object, known.path, [&](const Json& part) {
      is_understood = is_understood && hasOnlyWithExtras(part, known.names);
    });
    is_understood = is_understood && is_of_kind;
  }
  return is_understood;
}

/// Whether an object of a primitive depends on the order only by the numbers of vertices in
/// accessors.
bool isRenumberable(std::string_view name, const Json& object) {
  if (!object.is_object() || object.empty()) return false;
  for (const auto& [key, value] : object.items()) {
    const auto isRow = [&, &member = key](const AccessorMember& known) {
      return known.extension == name && known.path == member &&
             known.what == ExtensionAccessor::kVertexNumbers;
    };
    if (std::none_of(std::begin(kAccessorMembers), std::end(kAccessorMembers), isRow)) return false;
  }
  return true;
}

// ---- What we do not understand

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

}  // namespace

void visitExtensionAccessors(const Json& primitive,
                             const std::function<void(const Json&, ExtensionAccessor)>& visit) {
  for (const AccessorMember& known : kAccessorMembers) {
    visitPath(extensionOf(primitive, known.extension), known.path,
              [&](const Json& number) { visit(number, known.what); });
  }
}

bool isMissing(const Json& number, size_t accessor_count) {
  uint64_t accessor = 0;
  return asUnsigned(number, accessor) && accessor >= accessor_count;
}

void hideMissingAccessors(size_t accessor_count, Json& root) {
  bool is_any_missing = false;  // whoever looks for places to change makes a copy of them
  visitAccessorReferences(std::as_const(root), [&](const Json& number) {
    is_any_missing |= isMissing(number, accessor_count);
  });
  if (!is_any_missing) return;
  visitAccessorReferences(root, [&](Json& number) {
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
  foreign.has_tables = extensionOf(root, kMetadataExtension) != nullptr;
  foreign.has_wide_accessors = hasWideAccessors(root);
  for (const std::string& name : extensionNames(root, "extensionsUsed")) {
    if (!isKnownExtension(name)) keepNumbersFor(foreign, name);
  }
  return foreign;
}

std::string orderDependentPart(const Json& mesh_or_primitive, NumbersOfVertices numbers) {
  for (const auto& [name, value] : mesh_or_primitive["extensions"].items()) {
    const KnownExtension* known = findKnown(name);
    const bool is_free = (known != nullptr && known->is_order_free(value)) ||
                         (numbers == NumbersOfVertices::kCanChange && isRenumberable(name, value));
    if (!is_free) return name;
  }
  return orderWordOf(mesh_or_primitive["extras"]);
}

std::string unknownExtension(const Json& object) {
  for (const auto& [name, value] : object["extensions"].items()) {
    if (!isKnownExtension(name)) return name;
  }
  return "";
}

std::vector<std::string> extensionNames(const Json& root, const char* list) {
  std::vector<std::string> names;
  for (const Json& name : arrayOf(root, list)) {
    if (name.is_string()) names.push_back(name.text());
  }
  return names;
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

void listExtension(Json& root, const char* name, bool is_used_and_required) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (!is_used_and_required) {
      removeExtensionName(root, list, name);
      continue;
    }
    Json& names = root[list];
    if (!names.is_array()) names = Json::array();
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
}

std::string nodeDependentExtension(const Json& root, const ForeignReferences& foreign) {
  if (!foreign.extension.empty()) return foreign.extension;
  for (const std::string& name : extensionNames(root, "extensionsUsed")) {
    const KnownExtension* known = findKnown(name);
    if (known != nullptr && known->names_nodes) return name;
  }
  return "";
}

}  // namespace mcc::gltf
