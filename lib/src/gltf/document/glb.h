// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The GLB container: a header and chunks. Version 2 is that of glTF 2.0. Version 3, with lengths of
// 64 bits and any number of BIN chunks, follows the draft of glTF 2.1 that docs/gltf-2.1.md names.
#ifndef MCC_GLTF_DOCUMENT_GLB_H_
#define MCC_GLTF_DOCUMENT_GLB_H_

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "host/result.h"

namespace mcc::gltf {

inline constexpr uint32_t kJsonChunk = 0x4e4f534a;  ///< type of a chunk, "JSON"
inline constexpr uint32_t kBinChunk = 0x004e4942;   ///< type of a chunk, "BIN"

/// What may be asked for as the version of a GLB that is written: 2, or 3 where the file needs more
/// than the 4 GiB of version 2.
inline constexpr uint32_t kSmallestGlbVersion = 0;

struct GlbChunk {
  uint32_t type = 0;
  std::span<const uint8_t> bytes;  ///< borrowed from the file
};

struct GlbFile {
  uint32_t version = 2;
  std::vector<GlbChunk> chunks;  ///< all of them; `buffers[].chunk` is a number in this list
  size_t json_chunk = 0;         ///< number of the first JSON chunk, which is the document
  std::span<const uint8_t> json;
  bool has_bin = false;  ///< there is a BIN chunk for a first buffer that names none
  size_t bin_chunk = 0;  ///< its number
  std::span<const uint8_t> bin;
  bool has_trailing_bytes = false;  ///< bytes follow after the length in the header

  /// Returns the chunks that are neither the document nor a buffer of it, in the order of the file.
  /// used_chunks  the numbers of those with the bytes of buffers
  std::vector<GlbChunk> otherChunks(const std::set<size_t>& used_chunks) const;
};

/// Whether the file starts as a GLB does (and not as JSON).
bool isGlb(std::span<const uint8_t> file);

/// Whether the file starts like the JSON of a glTF: with an object, perhaps after white space or a
/// byte order mark.
bool isJsonText(std::span<const uint8_t> file);

/// The bytes of the header that glbLength() needs.
inline constexpr uint64_t kGlbHeaderBytes = 16;

/// Returns the version in the header of a GLB, of which there are at least kGlbHeaderBytes, whether
/// it can be read or not.
uint32_t glbVersion(std::span<const uint8_t> file);

/// Returns the length in the header of a GLB, of which there are at least kGlbHeaderBytes.
uint64_t glbLength(std::span<const uint8_t> file);

/// Splits a file into its chunks; the spans point into `file`. Errors name the byte. Work and
/// memory are proportional to the number of chunks, which have 8 or 16 bytes each at least.
Result readGlb(std::span<const uint8_t> file, GlbFile& glb);

/// Whether a GLB of version 2 can hold a chunk besides its JSON and its BIN chunk. It has one of
/// each.
bool fitsGlb2(const GlbChunk& other_chunk);

/// Writes a GLB. The JSON chunk is padded with spaces and the BIN chunk with zeros; an empty BIN
/// chunk is left out. The document is chunk 0 and its buffer chunk 1, so that `buffers[0]` need not
/// name it.
/// version  2, 3 or kSmallestGlbVersion. Version 2 leaves out chunks that it cannot hold.
/// Errors: another version; version 2 would have more than 4 GiB.
Result writeGlb(const std::string& json, std::span<const uint8_t> bin,
                std::span<const GlbChunk> other_chunks, std::vector<uint8_t>& file,
                uint32_t version = kSmallestGlbVersion);

/// The same for a BIN chunk whose bytes come later: `bin` becomes their place in the file, which
/// has zeros.
Result startGlb(const std::string& json, uint64_t bin_bytes, std::span<const GlbChunk> other_chunks,
                std::vector<uint8_t>& file, std::span<uint8_t>& bin,
                uint32_t version = kSmallestGlbVersion);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_GLB_H_
