// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The triangle primitives of a glTF file as every codec gets them.
#ifndef MCC_TOOLS_BENCH_GEOMETRY_H_
#define MCC_TOOLS_BENCH_GEOMETRY_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gltf/compress/compress.h"
#include "gltf/compress/savings.h"
#include "mcc/glb.h"
#include "mcc/writer.h"

namespace mcc::bench {

/// Whether Draco cannot take an attribute: morph targets, more than four components.
bool isLeftOut(const AttributeFormat& format);

/// One piece of a payload: wedges, attributes, one triangle list per glTF primitive. What Draco
/// cannot take is left out here, for all codecs.
struct PieceInput {
  uint32_t wedge_count = 0;
  std::vector<AttributeView> source;  ///< what codecs get, and what errors are measured against
  std::vector<std::string> labels;    ///< "POSITION", "TEXCOORD_1"
  std::vector<PartView> parts;
  bool has_left_out = false;

  PieceView view() const { return {wedge_count, source, parts}; }
};

/// What goes into one of our payloads.
struct PayloadInput {
  std::vector<PieceInput> pieces;
};

struct Geometry {
  Geometry() = default;
  Geometry(const Geometry&) = delete;  // the views point into the members
  Geometry& operator=(const Geometry&) = delete;

  std::vector<uint8_t> file;  ///< what `document` borrows, unless somebody else has it
  gltf::Document document;
  /// Everything as `convert` codes it, left-out attributes too.
  std::vector<gltf::EncodedPayload> payloads;
  std::vector<PayloadInput> inputs;  ///< one per payload
  std::vector<std::string> notes;  ///< primitives that no payload takes, attributes that stay exact
  uint64_t triangle_count = 0;
  uint64_t wedge_count = 0;   ///< glTF vertices
  uint64_t vertex_count = 0;  ///< distinct positions
  bool has_left_out = false;
  Preference prefer = Preference::kBalanced;  ///< of our encoder, and its blocks
  uint32_t block_triangles = kBlocksByPreference;
};

/// Whether a primitive takes part.
using PrimitiveFilter = std::function<bool(uint32_t mesh, uint32_t primitive)>;

/// Whether our own payloads are needed as well, or only what other codecs get.
enum class OurPayloads : uint8_t { kEncoded, kLeftOut };

/// Quantises and encodes a file as `convert` does, but keeps payloads that gain nothing.
/// path    names the file in messages; the buffers of a .gltf are next to it.
/// file    its bytes, see gltf::readFile(); `geometry` borrows them.
/// wanted  null: all triangle primitives. A primitive counts once however often it is used; those
///         with the same attributes share a piece, those with the same indices too are one.
/// ours    when they are left out, Geometry::payloads has plans without results, and vertex_count
///         stays 0.
/// Errors: as convertFile(). A file without triangle primitives is not an error; `inputs` is then
/// empty.
gltf::Result loadGeometry(const std::filesystem::path& path, std::span<const uint8_t> file,
                          const gltf::ConvertOptions& options, const PrimitiveFilter& wanted,
                          Geometry& geometry, OurPayloads ours = OurPayloads::kEncoded);

/// A piece of a plan; with `keep_all` nothing is left out. Borrows from the plan.
PieceInput makePiece(const gltf::PiecePlan& plan, bool keep_all);

/// A part of a piece: one glTF primitive, the unit the other codecs work on.
struct PrimitiveInput {
  const PieceInput* piece = nullptr;
  size_t part = 0;
};

std::vector<PrimitiveInput> primitivesOf(const Geometry& geometry);

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_GEOMETRY_H_
