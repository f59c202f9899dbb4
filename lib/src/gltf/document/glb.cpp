// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/glb.h"

#include <algorithm>
#include <string_view>

namespace mcc::gltf {
namespace {

constexpr uint32_t kMagic = 0x46546c67;  // "glTF"
constexpr uint64_t kMaxGlb2Bytes = 0xffffffffu;

/// What distinguishes the two versions. Their numbers are those of the specifications.
struct Framing {
  uint32_t version;
  uint64_t header_bytes;
  uint64_t chunk_header_bytes;
  uint64_t alignment;  ///< of the beginning of each chunk
};
constexpr Framing kGlb2 = {2, 12, 8, 4};
constexpr Framing kGlb3 = {3, 16, 16, 8};

uint32_t readU32(std::span<const uint8_t> file, uint64_t offset) {
  const uint8_t* p = file.data() + offset;
  return uint32_t{p[0]} | uint32_t{p[1]} << 8 | uint32_t{p[2]} << 16 | uint32_t{p[3]} << 24;
}

uint64_t readU64(std::span<const uint8_t> file, uint64_t offset) {
  return uint64_t{readU32(file, offset)} | uint64_t{readU32(file, offset + 4)} << 32;
}

void appendU32(std::vector<uint8_t>& file, uint64_t value) {
  for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<uint8_t>(value >> shift));
}

std::string byte(uint64_t offset) { return sentence("byte ", offset); }

uint64_t padded(uint64_t bytes, uint64_t alignment) {
  return (bytes + alignment - 1) & ~(alignment - 1);
}

Result readFraming(std::span<const uint8_t> file, Framing& framing) {
  if (file.size() < kGlb2.header_bytes) {
    return error(byte(file.size()), "the file ends inside the GLB header");
  }
  const uint32_t version = glbVersion(file);
  if (version != 2 && version != 3) {
    return error("byte 4", "GLB version ", version,
                 "; only versions 2 (glTF 2.0) and 3 (glTF 2.1) can be read");
  }
  framing = version == 2 ? kGlb2 : kGlb3;
  if (file.size() < framing.header_bytes) {
    return error(byte(file.size()), "the file ends inside the GLB header");
  }
  return {};
}

Result readLength(std::span<const uint8_t> file, const Framing& framing, uint64_t& length) {
  length = glbLength(file);
  if (length > file.size()) {
    return error("byte 8", "the header says ", length, " bytes but the file has ", file.size(),
                 ": it is truncated");
  }
  const bool is_aligned = framing.version == 3 || length % framing.alignment == 0;
  if (length < framing.header_bytes + framing.chunk_header_bytes || !is_aligned) {
    return error("byte 8", "the length ", length, " is not valid for a GLB");
  }
  return {};
}

/// Reads the chunk at an offset, whose header is inside of `file`, which ends where the GLB does.
Result readChunk(std::span<const uint8_t> file, uint64_t offset, const Framing& framing,
                 GlbChunk& chunk) {
  const bool is_glb2 = framing.version == 2;
  const uint64_t bytes = is_glb2 ? readU32(file, offset) : readU64(file, offset + 8);
  chunk.type = readU32(file, offset + (is_glb2 ? 4 : 0));
  if (is_glb2 && bytes % framing.alignment != 0) {
    return error(byte(offset), "the chunk length ", bytes, " is not a multiple of 4");
  }
  if (bytes > file.size() - offset - framing.chunk_header_bytes) {
    return error(byte(offset), "the chunk of ", bytes, " bytes runs past the end of the file");
  }
  chunk.bytes = file.subspan(offset + framing.chunk_header_bytes, bytes);
  const uint32_t encoding = is_glb2 ? 0 : readU32(file, offset + 4);
  if (encoding == 0) return {};
  return error(byte(offset + 4), "the chunk has the encoding ", encoding,
               "; only chunks without encoding (0) can be read");
}

/// Version 2 has the JSON first, and at most one BIN chunk.
Result checkGlb2Chunk(const GlbFile& glb, uint64_t offset) {
  const size_t number = glb.chunks.size() - 1;
  const uint32_t type = glb.chunks.back().type;
  if ((number == 0) != (type == kJsonChunk)) {
    return error(byte(offset), number == 0 ? "the first chunk of a GLB must be its JSON"
                                           : "there is a second JSON chunk");
  }
  if (type == kBinChunk && glb.has_bin) {
    return error(byte(offset), "there is a second BIN chunk");
  }
  return {};
}

/// Finds the JSON, and the BIN chunk that the first buffer has without naming it: in version 3 that
/// is chunk 1 after JSON in chunk 0.
void findParts(GlbFile& glb, size_t number) {
  const GlbChunk& chunk = glb.chunks[number];
  const bool has_json = glb.json.data() != nullptr;
  if (chunk.type == kJsonChunk && !has_json) {
    glb.json = chunk.bytes;
    glb.json_chunk = number;
  }
  const bool is_implicit = glb.version == 2 || (number == 1 && glb.chunks[0].type == kJsonChunk);
  if (chunk.type != kBinChunk || !is_implicit) return;
  glb.has_bin = true;
  glb.bin_chunk = number;
  glb.bin = chunk.bytes;
}

/// Appends a chunk of `length` bytes, and what it takes to the beginning of the next one, all with
/// the value of its padding. Returns where they are.
uint64_t appendChunk(std::vector<uint8_t>& file, const Framing& framing, uint32_t type,
                     uint64_t length, uint8_t padding) {
  if (framing.version == 2) {
    appendU32(file, length);
    appendU32(file, type);
  } else {
    appendU32(file, type);
    appendU32(file, 0);  // not encoded
    appendU32(file, length);
    appendU32(file, length >> 32);
  }
  const uint64_t offset = file.size();
  file.resize(offset + padded(length, framing.alignment), padding);
  return offset;
}

void copyTo(std::vector<uint8_t>& file, uint64_t offset, std::span<const uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<ptrdiff_t>(offset));
}

struct Parts {
  std::string_view json;
  uint64_t bin_bytes;
  std::span<const GlbChunk> others;

  bool holds(const GlbChunk& chunk, const Framing& framing) const {
    return framing.version == 3 || fitsGlb2(chunk);
  }

  uint64_t length(const Framing& framing) const {
    const auto chunkBytes = [&](uint64_t bytes) {
      return framing.chunk_header_bytes + padded(bytes, framing.alignment);
    };
    uint64_t length = framing.header_bytes + chunkBytes(json.size());
    if (bin_bytes != 0) length += chunkBytes(bin_bytes);
    for (const GlbChunk& chunk : others) {
      if (holds(chunk, framing)) length += chunkBytes(chunk.bytes.size());
    }
    return length;
  }
};

Result chooseFraming(const Parts& parts, uint32_t version, Framing& framing) {
  if (version != kSmallestGlbVersion && version != 2 && version != 3) {
    return error("", "the version of a GLB is 2 or 3, not ", version);
  }
  const uint64_t length = parts.length(kGlb2);
  const bool fits = length <= kMaxGlb2Bytes;
  if (version == 2 && !fits) {
    return error("", "the result needs ", length,
                 " bytes; a GLB of version 2 cannot be larger than 4 GiB, one of version 3 "
                 "can");
  }
  framing = version == 3 || !fits ? kGlb3 : kGlb2;
  return {};
}

}  // namespace

bool isGlb(std::span<const uint8_t> file) { return file.size() >= 4 && readU32(file, 0) == kMagic; }

bool isJsonText(std::span<const uint8_t> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string_view::npos && text[first] == '{';
}

uint32_t glbVersion(std::span<const uint8_t> file) { return readU32(file, 4); }

uint64_t glbLength(std::span<const uint8_t> file) {
  return glbVersion(file) == 3 ? readU64(file, 8) : readU32(file, 8);
}

bool fitsGlb2(const GlbChunk& other_chunk) {
  return other_chunk.type != kJsonChunk && other_chunk.type != kBinChunk;
}

std::vector<GlbChunk> GlbFile::otherChunks(const std::set<size_t>& used_chunks) const {
  std::vector<GlbChunk> others;
  for (size_t number = 0; number < chunks.size(); ++number) {
    // In version 2, a BIN chunk is always that of a buffer, or belongs to nothing.
    const bool is_bin = version == 2 && chunks[number].type == kBinChunk;
    if (number == json_chunk || is_bin || used_chunks.contains(number)) continue;
    others.push_back(chunks[number]);
  }
  return others;
}

Result readGlb(std::span<const uint8_t> file, GlbFile& glb) {
  glb = {};
  if (!isGlb(file)) return error("byte 0", "this is not a GLB file");
  Framing framing;
  MCC_GLTF_TRY(readFraming(file, framing));
  glb.version = framing.version;
  uint64_t length = 0;
  MCC_GLTF_TRY(readLength(file, framing, length));
  glb.has_trailing_bytes = file.size() > length;
  file = file.first(length);
  for (uint64_t offset = framing.header_bytes; offset < length;) {
    if (length - offset < framing.chunk_header_bytes) {
      return error(byte(offset), "the file ends inside a chunk header");
    }
    MCC_GLTF_TRY(readChunk(file, offset, framing, glb.chunks.emplace_back()));
    if (framing.version == 2) MCC_GLTF_TRY(checkGlb2Chunk(glb, offset));
    findParts(glb, glb.chunks.size() - 1);
    // In version 3 the padding before the next chunk does not count as part of this one.
    offset = padded(offset + framing.chunk_header_bytes + glb.chunks.back().bytes.size(),
                    framing.alignment);
  }
  return glb.json.data() != nullptr ? Result() : error("byte 16", "there is no JSON chunk");
}

Result startGlb(const std::string& json, uint64_t bin_bytes, std::span<const GlbChunk> other_chunks,
                std::vector<uint8_t>& file, std::span<uint8_t>& bin, uint32_t version) {
  const Parts parts = {json, bin_bytes, other_chunks};
  Framing framing;
  MCC_GLTF_TRY(chooseFraming(parts, version, framing));
  const uint64_t length = parts.length(framing);
  file.clear();
  file.reserve(length);
  appendU32(file, kMagic);
  appendU32(file, framing.version);
  appendU32(file, length);
  if (framing.version == 3) appendU32(file, length >> 32);
  const std::span text(reinterpret_cast<const uint8_t*>(json.data()), json.size());
  const uint64_t alignment = framing.alignment;
  copyTo(file, appendChunk(file, framing, kJsonChunk, padded(text.size(), alignment), ' '), text);
  const uint64_t offset =
      bin_bytes == 0 ? 0 : appendChunk(file, framing, kBinChunk, padded(bin_bytes, alignment), 0);
  for (const GlbChunk& chunk : other_chunks) {
    if (!parts.holds(chunk, framing)) continue;
    // Version 3 pads behind the chunk, so that it keeps its length.
    const uint64_t bytes = chunk.bytes.size();
    const uint64_t stored = framing.version == 2 ? padded(bytes, alignment) : bytes;
    copyTo(file, appendChunk(file, framing, chunk.type, stored, 0), chunk.bytes);
  }
  bin = std::span(file).subspan(offset, bin_bytes);
  return {};
}

Result writeGlb(const std::string& json, std::span<const uint8_t> bin,
                std::span<const GlbChunk> other_chunks, std::vector<uint8_t>& file,
                uint32_t version) {
  std::span<uint8_t> place;
  MCC_GLTF_TRY(startGlb(json, bin.size(), other_chunks, file, place, version));
  std::copy(bin.begin(), bin.end(), place.begin());
  return {};
}

}  // namespace mcc::gltf
