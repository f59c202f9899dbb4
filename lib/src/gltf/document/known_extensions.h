// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// What we know about the extensions of others: which of them hold numbers of buffer views,
// accessors, vertices or triangles, and where.
#ifndef MCC_GLTF_DOCUMENT_KNOWN_EXTENSIONS_H_
#define MCC_GLTF_DOCUMENT_KNOWN_EXTENSIONS_H_

#include <cstdint>
#include <functional>
#include <string_view>

#include "json/json.h"

namespace mcc::gltf {

/// Whether an extension is on our list: its objects hold no numbers of buffer views or accessors,
/// except where visitTableViews(), visitExtensionAccessors() and the functions of references.h look
/// for them.
bool isKnownExtension(std::string_view name);

/// Whether an object of an extension on our list has only the members that we know. Drafts of the
/// same name may have had others.
bool isUnderstood(std::string_view name, const Json& object);

/// Whether an object of a mesh or primitive means the same in whatever order vertices and triangles
/// are.
bool isOrderFree(std::string_view name, const Json& object);

/// Whether an object of a primitive depends on the order only by the numbers of vertices in the
/// accessors that visitExtensionAccessors() calls kVertexNumbers.
bool isRenumberable(std::string_view name, const Json& object);

/// Whether an extension names nodes because of their meshes.
bool refersToNodes(std::string_view name);

/// What an accessor that an extension of a primitive names is made of.
enum class ExtensionAccessor : uint8_t {
  kVertexNumbers,  ///< nothing but numbers of vertices of the primitive
  kOther,
};

/// Calls visit(number, what) for each accessor number in the extensions of a primitive.
void visitExtensionAccessors(
    const Json& primitive,
    const std::function<void(const Json& number, ExtensionAccessor what)>& visit);

/// Calls visit(number) for each accessor number in the extensions of a mesh itself.
void visitMeshExtensionAccessors(const Json& mesh,
                                 const std::function<void(const Json& number)>& visit);

/// Whether a mesh has EXT_mesh_manifold, which describes all of its primitives once more, as one
/// list of triangles over the same bytes.
bool isManifold(const Json& mesh);

/// Calls visit(number) for each primitive of a mesh that EXT_mesh_primitive_restart draws together
/// with others. Such primitives share the bytes of their indices with their group.
void visitGroupedPrimitives(const Json& mesh, const std::function<void(const Json& number)>& visit);

/// Whether a document may have property tables.
bool mayHaveTables(const Json& root);

/// Calls visit(number) for each number of a buffer view in the property tables of a document.
void visitTableViews(const Json& root, const std::function<void(const Json& number)>& visit);
/// The same for a visitor that changes the numbers.
void editTableViews(Json& root, const std::function<void(Json& number)>& visit);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_KNOWN_EXTENSIONS_H_
