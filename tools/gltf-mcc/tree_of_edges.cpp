// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tree_of_edges.h"

#include <algorithm>

#include "gltf/decompress/coded_input.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/accessors.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"
#include "mcc/writer.h"

namespace mcc::tool {
namespace {

using namespace gltf;

/// Collects the mc-edges of one piece in decoding order, while a payload is decoded.
struct EdgeTaker {
  uint32_t wanted_piece = 0;
  std::vector<McTree::Edge> edges;

  static void take(void* user, uint32_t piece, uint32_t vertex, uint32_t from) {
    auto& taker = *static_cast<EdgeTaker*>(user);
    if (piece == taker.wanted_piece) taker.edges.push_back({vertex, from});
  }
};

/// Puts the edges into the order of the collapse, which decoding runs backwards. The end that was
/// contracted first becomes the parent; only edges to the leaf of a twig arrive the other way
/// round.
std::vector<McTree::Edge> inCollapseOrder(std::vector<McTree::Edge> edges, size_t vertex_count) {
  std::reverse(edges.begin(), edges.end());
  std::vector<bool> is_met(vertex_count, false);
  for (McTree::Edge& edge : edges) {
    if (!is_met[edge.parent] && is_met[edge.child]) std::swap(edge.parent, edge.child);
    is_met[edge.parent] = is_met[edge.child] = true;
  }
  return edges;
}

/// Reads POSITION of a primitive.
Result readPositions(const Document& document, const Primitive& primitive,
                     std::vector<float>& positions) {
  const std::string where = primitive.ref.path();
  const auto found =
      std::find_if(primitive.attributes.begin(), primitive.attributes.end(),
                   [](const auto& a) { return a.target == kNone && a.name == "POSITION"; });
  if (found == primitive.attributes.end()) return error(where, "has no POSITION");
  if (found->accessor == kNone) return primitive.fault;
  AccessorData elements;
  MCC_GLTF_TRY(readAccessor(document, found->accessor, elements));
  const Accessor& accessor = document.accessors[found->accessor];
  if (accessor.componentCount() != 3)
    return error(where, "POSITION does not have three components");
  const uint32_t bytes = componentBytes(accessor.component_type);
  for (uint64_t i = 0; i < elements.count; ++i) {
    const uint8_t* element = elements.element(i).data();
    for (uint32_t c = 0; c < 3; ++c) {
      const double value = componentValue(element + c * bytes, accessor.component_type);
      positions.push_back(static_cast<float>(value));
    }
  }
  return {};
}

/// Makes the tree of a primitive with a payload. It is the tree of the whole piece, which may hold
/// other primitives, too.
Result treeOfPayload(const Document& document, const ExtensionUse& use, McTree& tree) {
  const std::string where = use.path + "/bufferView";
  const std::span<const uint8_t> payload = payloadBytes(document, use.view);
  tree.payload.assign(payload.begin(), payload.end());
  DecodedPayload decoded;
  MCC_GLTF_TRY(toResult(decoded.payload.open(tree.payload), where));
  MCC_GLTF_TRY(
      checkAgainstPayload(document, PayloadUse{use.view, {&use}, {}}, decoded.payload.info()));
  EdgeTaker taker;
  taker.wanted_piece = static_cast<uint32_t>(use.piece);
  tree.piece = taker.wanted_piece;
  mcc::DecodeOptions options;
  options.mc_edge = EdgeTaker::take;
  options.mc_edge_user = &taker;
  MCC_GLTF_TRY(toResult(decodePieces(decoded, options), where));
  const DecodedPiece& piece = decoded.pieces[use.piece];
  for (const std::vector<uint32_t>& part : piece.parts) {
    tree.indices.insert(tree.indices.end(), part.begin(), part.end());
  }
  const PieceInfo& info = decoded.payload.info().pieces[use.piece];
  tree.edges = inCollapseOrder(std::move(taker.edges), info.wedge_count);
  for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
    if (attribute.name != "POSITION" || attribute.target != kNone) continue;
    const std::vector<uint8_t>& bytes = piece.attributes[attribute.id];
    const ComponentType type = info.attributes[attribute.id].format.component_type;
    for (size_t at = 0; at < bytes.size(); at += componentBytes(type)) {
      tree.positions.push_back(static_cast<float>(componentValue(bytes.data() + at, type)));
    }
    return {};
  }
  MCC_GLTF_TRY(
      readPositions(document, document.primitive({use.mesh, use.primitive}), tree.positions));
  const bool is_whole = tree.positions.size() == size_t{3} * info.wedge_count;
  return is_whole ? Result{} : error(use.path, "POSITION does not have the payload's vertices");
}

Result readTriangles(const Document& document, const Primitive& primitive, size_t vertex_count,
                     std::vector<uint32_t>& triangles) {
  const std::string where = primitive.ref.path();
  uint64_t mode = 4;
  MCC_GLTF_TRY(readOptionalUnsigned(*primitive.json, "mode", where, 6, mode));
  if (mode < 4) return error(where, "has points or lines, not triangles");
  if (primitive.indices != kNone) {
    MCC_GLTF_TRY(readIndices(document, primitive.indices, triangles));
  } else if (findMember(*primitive.json, "indices") != nullptr) {
    return primitive.fault;
  } else {
    for (uint32_t i = 0; i < vertex_count; ++i) triangles.push_back(i);
  }
  if (!expandTriangles(mode, triangles)) return error(where, "its indices make no triangles");
  const bool is_inside = std::all_of(triangles.begin(), triangles.end(),
                                     [&](uint32_t index) { return index < vertex_count; });
  return is_inside ? Result{} : error(at(where, "indices"), "an index is not below the count");
}

/// Makes the tree of any other primitive: its triangles are encoded in memory and decoded again.
Result treeOfTriangles(const Document& document, const Primitive& primitive, McTree& tree) {
  const std::string where = primitive.ref.path();
  MCC_GLTF_TRY(readPositions(document, primitive, tree.positions));
  std::vector<uint32_t> triangles;
  const size_t vertex_count = tree.positions.size() / 3;
  MCC_GLTF_TRY(readTriangles(document, primitive, vertex_count, triangles));
  const AttributeView position{{}, tree.positions.data(), 3 * sizeof(float)};
  const PartView part{triangles};
  const PieceView piece{static_cast<uint32_t>(vertex_count), {&position, 1}, {&part, 1}};
  EncodeOptions encode_options;
  encode_options.indices_only = true;
  encode_options.keep_vertex_order = true;
  EncodeResult encoded;
  MCC_GLTF_TRY(toResult(encode({&piece, 1}, encode_options, encoded), where));
  DecodedPayload decoded;
  MCC_GLTF_TRY(toResult(decoded.payload.open(encoded.payload), where));
  EdgeTaker taker;
  mcc::DecodeOptions options;
  options.mc_edge = EdgeTaker::take;
  options.mc_edge_user = &taker;
  MCC_GLTF_TRY(toResult(decodePieces(decoded, options), where));
  tree.edges = inCollapseOrder(std::move(taker.edges), vertex_count);
  tree.indices = std::move(decoded.pieces[0].parts[0]);
  return {};
}

/// Checks that there is such a primitive.
Result checkRef(const Document& document, const PrimitiveRef& ref) {
  const Json& meshes = arrayOf(document.json, "meshes");
  if (meshes.empty()) return error("", "the file has no meshes");
  if (ref.mesh >= meshes.size()) {
    return error("", "there is no mesh " + std::to_string(ref.mesh) + "; the last is " +
                         std::to_string(meshes.size() - 1));
  }
  const size_t count = arrayOf(meshes[ref.mesh], "primitives").size();
  if (ref.primitive < count) return {};
  return error(at("/meshes", ref.mesh), "there is no primitive " + std::to_string(ref.primitive) +
                                            "; there are " + std::to_string(count));
}

Result findTree(const Input& input, const PrimitiveRef& ref, const ForeignDecoders& decoders,
                McTree& tree) {
  tree = {};
  Document document;
  MCC_GLTF_TRY(loadDocument(input.bytes, input.read_file, document));
  document.decoded = DecodedBytes(0, document.source_bytes);
  MCC_GLTF_TRY(decodeViews(decoders, document));
  MCC_GLTF_TRY(decodeMeshes(decoders, document));
  MCC_GLTF_TRY(checkRef(document, ref));
  std::vector<ExtensionUse> uses;
  MCC_GLTF_TRY(findExtensionUses(document, uses));
  for (const ExtensionUse& use : uses) {
    if (use.mesh == ref.mesh && use.primitive == ref.primitive) {
      tree.is_of_payload = true;
      return treeOfPayload(document, use, tree);
    }
  }
  return treeOfTriangles(document, document.primitive(ref), tree);
}

}  // namespace

gltf::Result mcTree(const gltf::Source& source, uint32_t mesh, uint32_t primitive,
                    const gltf::ForeignDecoders& decoders, McTree& tree) {
  return gltf::guarded([&]() -> gltf::Result {
    gltf::Input input;
    MCC_GLTF_TRY(input.open(source));
    const gltf::Result found = findTree(input, {mesh, primitive}, decoders, tree);
    return input.read_file ? gltf::inFile(source.path, found) : found;
  });
}

}  // namespace mcc::tool
