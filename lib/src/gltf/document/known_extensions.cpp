// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/known_extensions.h"

#include <algorithm>
#include <initializer_list>

#include "gltf/document/references.h"

namespace mcc::gltf {
namespace {

/// The extension whose property tables lie in buffer views.
constexpr char kMetadataExtension[] = "EXT_structural_metadata";
constexpr char kManifoldExtension[] = "EXT_mesh_manifold";
constexpr char kRestartExtension[] = "EXT_mesh_primitive_restart";

using Names = std::initializer_list<std::string_view>;

bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether an object has no members but these.
bool hasOnly(const Json& object, const Names& names, const Names& others = {}) {
  if (!object.is_object()) return false;
  for (const auto& [key, value] : object.items()) {
    if (!contains(names, key) && !contains(others, key)) return false;
  }
  return true;
}

/// The same, where any object may also have extras and extensions, which are looked at apart.
bool hasOnlyWithExtras(const Json& object, const Names& names) {
  return hasOnly(object, names, {"extras", "extensions"});
}

/// The members of tables and their properties that the ratified version has. Drafts named buffer
/// views in others.
bool areTablesUnderstood(const Json& metadata) {
  const Json* tables = findMember(metadata, "propertyTables");
  if (tables == nullptr) return true;
  if (!tables->is_array()) return false;
  for (const Json& table : *tables) {
    if (!hasOnlyWithExtras(table, {"name", "class", "count", "properties"})) return false;
    const Json* properties = findMember(table, "properties");
    if (properties == nullptr) continue;
    if (!properties->is_object()) return false;
    for (const Json& property : *properties) {
      const bool is_known =
          hasOnlyWithExtras(property, {"values", "arrayOffsets", "stringOffsets", "arrayOffsetType",
                                       "stringOffsetType", "offset", "scale", "max", "min"});
      if (!is_known) return false;
    }
  }
  return true;
}

bool areLineStringsUnderstood(const Json& visibility) {
  const Json* strings = findMember(visibility, "lineStrings");
  if (strings == nullptr) return true;
  if (!strings->is_array()) return false;
  return std::all_of(strings->begin(), strings->end(), [](const Json& line_string) {
    return hasOnlyWithExtras(line_string, {"indices", "material"});
  });
}

/// Whether these are groups of primitives that are named by numbers. Nothing else in their mesh
/// depends on an order.
bool areGroups(const Json& restart) {
  if (!hasOnlyWithExtras(restart, {"primitiveGroups"})) return false;
  const Json* groups = findMember(restart, "primitiveGroups");
  if (groups == nullptr || !groups->is_array()) return false;
  return std::all_of(groups->begin(), groups->end(), [](const Json& group) {
    if (!hasOnlyWithExtras(group, {"primitives", "indices", "name"})) return false;
    const Json* primitives = findMember(group, "primitives");
    uint64_t number = 0;
    return primitives != nullptr && primitives->is_array() &&
           std::all_of(primitives->begin(), primitives->end(),
                       [&](const Json& primitive) { return asUnsigned(primitive, number); });
  });
}

/// Whether every set of feature ids is an attribute, which moves with its vertices, or a texture.
/// Without either, the id of a vertex is its number.
bool hasExplicitIds(const Json& features) {
  if (!hasOnly(features, {"featureIds"})) return false;
  const Json* sets = findMember(features, "featureIds");
  if (sets == nullptr || !sets->is_array() || sets->empty()) return false;
  return std::all_of(sets->begin(), sets->end(), [](const Json& set) {
    return hasOnly(set, {"featureCount", "nullFeatureId", "label", "attribute", "texture",
                         "propertyTable"}) &&
           (findMember(set, "attribute") != nullptr || findMember(set, "texture") != nullptr);
  });
}

/// Textures are found by texture coordinates, attributes by their names, rows by their numbers.
bool hasOnlyMetadata(const Json& metadata) {
  return hasOnly(metadata, {"propertyTextures", "propertyAttributes", "propertyTable", "index"});
}

bool hasOnlyFeatureIds(const Json& object) { return hasOnlyWithExtras(object, {"featureIds"}); }
bool always(const Json&) { return true; }
bool never(const Json&) { return false; }

/// An extension on our list.
struct KnownExtension {
  std::string_view name;
  /// Looks for members that we do not know.
  bool (*is_understood)(const Json& object) = always;
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
    {"CESIUM_primitive_outline",
     [](const Json& object) { return hasOnlyWithExtras(object, {"indices"}); }},
    {"CESIUM_tile_edges",
     [](const Json& object) {
       return hasOnlyWithExtras(object, {"left", "bottom", "right", "top"});
     }},
    {"EXT_accessor_additional_types"},
    {"EXT_instance_features", hasOnlyFeatureIds},
    {"EXT_lights_image_based"},
    {"EXT_mesh_features", hasOnlyFeatureIds, hasExplicitIds},
    {"EXT_mesh_gpu_instancing"},
    {kManifoldExtension,
     [](const Json& object) {
       if (!hasOnlyWithExtras(object, {"manifoldPrimitive", "mergeIndices", "mergeValues"})) {
         return false;
       }
       const Json* primitive = findMember(object, "manifoldPrimitive");
       return primitive == nullptr ||
              hasOnlyWithExtras(*primitive, {"attributes", "indices", "mode"});
     }},
    {"EXT_mesh_primitive_edge_visibility",
     [](const Json& object) {
       return hasOnlyWithExtras(object, {"visibility", "material", "lineStrings", "silhouetteMates",
                                         "silhouetteNormals"}) &&
              areLineStringsUnderstood(object);
     }},
    {kRestartExtension, areGroups, areGroups},
    {"EXT_meshopt_compression"},
    {kMetadataExtension,
     [](const Json& object) {
       return hasOnlyWithExtras(object,
                                {"schema", "schemaUri", "propertyTables", "propertyTextures",
                                 "propertyAttributes", "propertyTable", "index"}) &&
              areTablesUnderstood(object);
     },
     hasOnlyMetadata},
    {"EXT_texture_avif"},
    {"EXT_texture_webp"},
    {"KHR_accessor_float16"},
    {"KHR_accessor_float64"},
    {"KHR_animation_pointer", always, never, kNamesNodes},
    {"KHR_draco_mesh_compression", always, always},  // removed with the data that it describes
    {"KHR_gaussian_splatting",
     [](const Json& object) {
       return hasOnlyWithExtras(object, {"kernel", "colorSpace", "projection", "sortingMethod"});
     }},
    {"KHR_lights_punctual"},
    {"KHR_materials_variants", always, always},         // materials of the whole primitive
    {"KHR_mesh_collapse_compression", always, always},  // our own
    {"KHR_mesh_quantization"},
    {"KHR_meshopt_compression"},
    {"KHR_node_hoverability"},
    {"KHR_node_selectability"},
    {"KHR_node_visibility"},
    {"KHR_texture_basisu"},
    {"KHR_texture_transform"},
    {"KHR_xmp", always, always},          // names a packet of metadata
    {"KHR_xmp_json_ld", always, always},  // the same
    {"MSFT_lod", always, never, kNamesNodes},
    {"MSFT_packing_normalRoughnessMetallic"},
    {"MSFT_packing_occlusionRoughnessMetallic"},
    {"MSFT_texture_dds"},
    {"VRM", always, never, kNamesNodes},
    {"VRMC_materials_mtoon"},
    {"VRMC_node_constraint", always, never, kNamesNodes},
    {"VRMC_springBone", always, never, kNamesNodes},
    {"VRMC_vrm", always, never, kNamesNodes},
};

const KnownExtension* findKnown(std::string_view name) {
  const auto found =
      std::find_if(std::begin(kKnownExtensions), std::end(kKnownExtensions),
                   [&](const KnownExtension& extension) { return extension.name == name; });
  return found == std::end(kKnownExtensions) ? nullptr : found;
}

/// A member of a primitive's extension that is the number of an accessor.
struct AccessorMember {
  std::string_view extension;
  std::string_view member;
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
};

/// Visits the members of property tables that are numbers of buffer views. `J` is Json or const
/// Json.
template <typename J, typename Visit>
void visitTableViewsOf(J& root, const Visit& visit) {
  J* const metadata = member(member(&root, "extensions"), kMetadataExtension);
  visitElements(member(metadata, "propertyTables"), [&](J& table) {
    J* const properties = member(&table, "properties");
    if (properties == nullptr || !properties->is_object()) return;
    for (J& property : *properties) {
      for (const char* key : {"values", "arrayOffsets", "stringOffsets"}) {
        if (J* number = member(&property, key)) visit(*number);
      }
    }
  });
}

}  // namespace

bool isKnownExtension(std::string_view name) {
  return name.starts_with("KHR_materials_") || findKnown(name) != nullptr;
}

bool isUnderstood(std::string_view name, const Json& object) {
  const KnownExtension* known = findKnown(name);
  return known == nullptr ? isKnownExtension(name) : known->is_understood(object);
}

bool isOrderFree(std::string_view name, const Json& object) {
  const KnownExtension* known = findKnown(name);
  return known != nullptr && known->is_order_free(object);
}

bool isRenumberable(std::string_view name, const Json& object) {
  if (!object.is_object()) return false;
  for (const auto& [key, value] : object.items()) {
    const bool is_renumberable =
        std::any_of(std::begin(kAccessorMembers), std::end(kAccessorMembers),
                    [&, &member = key](const AccessorMember& known) {
                      return known.extension == name && known.member == member &&
                             known.what == ExtensionAccessor::kVertexNumbers;
                    });
    if (!is_renumberable) return false;
  }
  return !object.empty();
}

bool refersToNodes(std::string_view name) {
  const KnownExtension* known = findKnown(name);
  return known != nullptr && known->names_nodes;
}

void visitExtensionAccessors(const Json& primitive,
                             const std::function<void(const Json&, ExtensionAccessor)>& visit) {
  for (const AccessorMember& known : kAccessorMembers) {
    const Json* extension = extensionOf(primitive, known.extension);
    const Json* number = extension == nullptr ? nullptr : findMember(*extension, known.member);
    if (number != nullptr) visit(*number, known.what);
  }
  const Json* visibility = extensionOf(primitive, "EXT_mesh_primitive_edge_visibility");
  if (visibility == nullptr) return;
  for (const Json& line_string : arrayOf(*visibility, "lineStrings")) {
    const Json* number = findMember(line_string, "indices");
    if (number != nullptr) visit(*number, ExtensionAccessor::kOther);
  }
}

void visitMeshExtensionAccessors(const Json& mesh, const std::function<void(const Json&)>& visit) {
  const auto visitKey = [&](const Json* object, const char* key) {
    if (const Json* number = member(object, key)) visit(*number);
  };
  if (const Json* restart = extensionOf(mesh, kRestartExtension)) {
    for (const Json& group : arrayOf(*restart, "primitiveGroups")) visitKey(&group, "indices");
  }
  const Json* manifold = extensionOf(mesh, kManifoldExtension);
  visitKey(manifold, "mergeIndices");
  visitKey(manifold, "mergeValues");
  const Json* primitive = member(manifold, "manifoldPrimitive");
  visitKey(primitive, "indices");
  const Json* attributes = member(primitive, "attributes");
  if (attributes == nullptr || !attributes->is_object()) return;
  for (const Json& number : *attributes) visit(number);
}

bool isManifold(const Json& mesh) { return extensionOf(mesh, kManifoldExtension) != nullptr; }

void visitGroupedPrimitives(const Json& mesh, const std::function<void(const Json&)>& visit) {
  const Json* restart = extensionOf(mesh, kRestartExtension);
  if (restart == nullptr) return;
  for (const Json& group : arrayOf(*restart, "primitiveGroups")) {
    for (const Json& number : arrayOf(group, "primitives")) visit(number);
  }
}

bool mayHaveTables(const Json& root) { return extensionOf(root, kMetadataExtension) != nullptr; }

void visitTableViews(const Json& root, const std::function<void(const Json&)>& visit) {
  visitTableViewsOf(root, visit);
}

void editTableViews(Json& root, const std::function<void(Json&)>& visit) {
  visitTableViewsOf(root, visit);
}

}  // namespace mcc::gltf
