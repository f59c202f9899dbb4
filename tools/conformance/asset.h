// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Turns sources into payloads and GLB files, with what a decoder has to find in them.
#ifndef MCC_TOOLS_CONFORMANCE_ASSET_H_
#define MCC_TOOLS_CONFORMANCE_ASSET_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "json/json.h"
#include "mcc/reader.h"
#include "support/gltf_builder.h"
#include "writer/settings.h"

namespace mcc::conformance {

using gltf::Json;

/// An attribute of a source and its place in the document.
struct NamedAttribute {
  std::string name;         ///< "POSITION"
  uint32_t target = kNone;  ///< morph target; kNone: the base mesh
  std::string type;         ///< of the accessor, "VEC3"
  AttributeFormat format;   ///< follows from name, target and type
  std::vector<uint8_t> bytes;
  uint8_t bits = 0;  ///< 0: exact
  std::optional<Lattice> lattice;

  template <class T>
  void append(T value) {
    const auto* first = reinterpret_cast<const uint8_t*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
  }
  /// The lowest bytes of an integer, as many as a component has.
  void appendInteger(int64_t value) {
    for (uint32_t k = 0; k < componentBytes(format.component_type); ++k)
      append(static_cast<uint8_t>(value >> (8 * k)));
  }
};

/// An attribute without elements yet. `target` as in NamedAttribute.
NamedAttribute makeAttribute(const std::string& name, uint32_t target, const std::string& type,
                             ComponentType component_type, bool normalized = false);

struct SourcePiece {
  uint32_t wedge_count = 0;
  std::vector<NamedAttribute> attributes;  ///< POSITION first
  std::vector<std::vector<uint32_t>> parts;
};

/// Settings without what later versions of the format added.
EncodeSettings ofVersion10();

struct Source {
  std::string name;   ///< of the file, without extension
  std::string shows;  ///< one sentence
  std::vector<SourcePiece> pieces;
  EncodeSettings options = ofVersion10();
};

/// What a primitive names of a piece.
struct PieceNames {
  std::vector<NamedAttribute> coded;     ///< as many as the piece has; without a name: left unnamed
  std::vector<NamedAttribute> ordinary;  ///< with elements in decoded order
};

struct Asset {
  std::string name;
  std::string shows;
  std::vector<uint8_t> payload;
  std::vector<PieceNames> pieces;
  bool numbers_with_fractions = false;  ///< the JSON has 1.0 for 1
};

/// Encodes, decodes and compares with the source; throws where they differ.
Asset encodeSource(const Source& source);

/// Returns the bytes of a payload, from hexadecimal digits, and the asset whose payload it was made
/// from: one of the same size that differs in a few bytes. Throws if there is none.
std::vector<uint8_t> bytesOf(const std::string& hex);
const Asset& closestTo(const std::vector<uint8_t>& payload, std::span<const Asset> assets);

/// Letters and digits in lower case, and a single underscore for what is between them.
std::string slug(const std::string& text);

/// The file: one mesh, one primitive for each part that has triangles.
std::vector<uint8_t> makeGlb(const Asset& asset);

/// The same before it is written; the bytes are padded.
gltf::test::Builder documentOf(const Asset& asset);

/// The member "primitives" of the manifest: counts and hashes of what decodes.
Json expectedOf(const Asset& asset);

}  // namespace mcc::conformance

#endif  // MCC_TOOLS_CONFORMANCE_ASSET_H_
