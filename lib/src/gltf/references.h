// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Who refers to buffer views and accessors, in the document and in parts of it we do not
// understand.
#ifndef MCC_GLTF_REFERENCES_H_
#define MCC_GLTF_REFERENCES_H_

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/document.h"
#include "gltf/primitives.h"

namespace mcc::gltf {

/// References from extras and from extensions that are not on our list. What looks like a reference
/// there ("bufferView": 3, "myAccessors": [1, 2]) is taken for one.
struct ForeignReferences {
  /// There is something we do not understand: buffer views keep their numbers and all their bytes.
  bool keep_numbers = false;
  std::string reason;     ///< the first extension or path that made keep_numbers true
  std::string extension;  ///< the first extension that is not on our list
  std::set<uint64_t> views;
  std::set<uint64_t> accessors;
};

ForeignReferences findForeignReferences(const Json& root);

/// Calls `visit` with every number of a buffer view in the places glTF 2.0 and the extensions on
/// our list have them. `accessor` is the accessor the reference belongs to, or kNone.
void visitViewReferences(const Json& root,
                         const std::function<void(const Json& number, uint32_t accessor)>& visit);
/// The same for a visitor that changes the numbers.
void editViewReferences(Json& root,
                        const std::function<void(Json& number, uint32_t accessor)>& visit);

/// What of a mesh or primitive depends on the order of vertices or triangles as far as we know: the first extension that is
/// not on our list, a key of its extras that looks like it ("drawRange"), or an empty string.
std::string orderDependentPart(const Json& mesh_or_primitive);

/// The first extension of an object that is not on our list, or an empty string.
std::string unknownExtension(const Json& object);

/// Extension of the document that may refer to nodes and expect their meshes there: the first one, or an empty string.
std::string nodeDependentExtension(const Json& root, const ForeignReferences& foreign);

/// Extensions that code the elements of buffer views.
inline constexpr const char* kViewExtensions[] = {"EXT_meshopt_compression",
                                                  "KHR_meshopt_compression"};
/// The extension that codes primitives, besides ours.
inline constexpr char kMeshExtension[] = "KHR_draco_mesh_compression";

/// Adds a name to a list of extensions, or removes it; an empty list goes.
void addExtensionName(Json& root, const char* list, const char* name);
void removeExtensionName(Json& root, const char* list, const char* name);

/// Marks accessors used by anything but mesh primitives: skins, animations, instancing, foreign
/// uses.
void markAccessorsOutsideMeshes(const Document& document, const ForeignReferences& foreign,
                                std::vector<bool>& is_used);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_REFERENCES_H_
