// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The GLB container of glTF 2.0: a 12-byte header and chunks.
#ifndef MCC_GLTF_GLB_H_
#define MCC_GLTF_GLB_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/result.h"

namespace mcc::gltf {

struct GlbChunk {
  uint32_t type = 0;
  std::span<const uint8_t> bytes;  ///< borrowed from the file
};

struct GlbFile {
  std::span<const uint8_t> json;
  bool has_bin = false;
  std::span<const uint8_t> bin;
  std::vector<GlbChunk> other_chunks;  ///< of types glTF 2.0 does not define; kept
  bool has_trailing_bytes = false;     ///< after the length of the header
};

/// Whether the file starts as a GLB does (and not as JSON).
bool isGlb(std::span<const uint8_t> file);

/// Whether the file starts as JSON of glTF does: with an object, perhaps after white space or a byte order mark.
bool isJsonText(std::span<const uint8_t> file);

/// Length that the header of a GLB of at least 12 bytes states.
uint32_t glbLength(std::span<const uint8_t> file);

/// Splits a file into its chunks; the spans point into `file`. Errors name the byte.
Result readGlb(std::span<const uint8_t> file, GlbFile& glb);

/// Writes a GLB: JSON chunk padded with spaces, BIN chunk (left out when empty) with zeros.
/// Fails above the 4 GiB a GLB can be.
Result writeGlb(const std::string& json, std::span<const uint8_t> bin,
                std::span<const GlbChunk> other_chunks, std::vector<uint8_t>& file);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_GLB_H_
