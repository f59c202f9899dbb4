// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The GLB container of glTF 2.0: a 12-byte header and chunks.
#ifndef MCC_GLTF_DOCUMENT_GLB_H_
#define MCC_GLTF_DOCUMENT_GLB_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/result.h"

namespace mcc::gltf {

struct GlbChunk {
  uint32_t type = 0;
  std::span<const uint8_t> bytes;  ///< borrowed from the file
};

struct GlbFile {
  std::span<const uint8_t> json;
  bool has_bin = false;
  std::span<const uint8_t> bin;
  std::vector<GlbChunk> other_chunks;  ///< chunks of types that glTF 2.0 does not define; kept
  bool has_trailing_bytes = false;     ///< bytes follow after the length in the header
};

/// Whether the file starts as a GLB does (and not as JSON).
bool isGlb(std::span<const uint8_t> file);

/// Whether the file starts like the JSON of a glTF: with an object, perhaps after white space or a
/// byte order mark.
bool isJsonText(std::span<const uint8_t> file);

/// Returns the length in the header of a GLB of at least 12 bytes.
uint32_t glbLength(std::span<const uint8_t> file);

/// Splits a file into its chunks; the spans point into `file`. Errors name the byte.
Result readGlb(std::span<const uint8_t> file, GlbFile& glb);

/// Writes a GLB. The JSON chunk is padded with spaces and the BIN chunk with zeros; an empty BIN
/// chunk is left out. Fails above 4 GiB, which a GLB cannot exceed.
Result writeGlb(const std::string& json, std::span<const uint8_t> bin,
                std::span<const GlbChunk> other_chunks, std::vector<uint8_t>& file);

/// The same for a BIN chunk whose bytes come later: `bin` becomes their place in the file, which
/// has zeros.
Result startGlb(const std::string& json, uint64_t bin_bytes, std::span<const GlbChunk> other_chunks,
                std::vector<uint8_t>& file, std::span<uint8_t>& bin);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_GLB_H_
