// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/glb.h"

#include <algorithm>
#include <string_view>

namespace mcc::gltf {
namespace {

constexpr uint32_t kMagic = 0x46546c67;      // "glTF"
constexpr uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr uint32_t kBinChunk = 0x004e4942;   // "BIN"
constexpr uint64_t kHeaderBytes = 12;
constexpr uint64_t kChunkHeaderBytes = 8;

uint32_t readU32(std::span<const uint8_t> file, uint64_t offset) {
  const uint8_t* p = file.data() + offset;
  return uint32_t{p[0]} | uint32_t{p[1]} << 8 | uint32_t{p[2]} << 16 | uint32_t{p[3]} << 24;
}

void appendU32(std::vector<uint8_t>& file, uint64_t value) {
  for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<uint8_t>(value >> shift));
}

std::string byte(uint64_t offset) { return "byte " + std::to_string(offset); }

uint64_t padded(uint64_t bytes) { return (bytes + 3) & ~uint64_t{3}; }

Result readHeader(std::span<const uint8_t> file, GlbFile& glb, uint64_t& length) {
  if (file.size() < kHeaderBytes) {
    return error(byte(file.size()), "the file ends inside the GLB header");
  }
  const uint32_t version = readU32(file, 4);
  if (version != 2) {
    return error("byte 4", "GLB version " + std::to_string(version) +
                               "; only version 2 (glTF 2.0) can be read");
  }
  length = glbLength(file);
  if (length > file.size()) {
    return error("byte 8", "the header says " + std::to_string(length) +
                               " bytes but the file has " + std::to_string(file.size()) +
                               ": it is truncated");
  }
  if (length < kHeaderBytes + kChunkHeaderBytes || length % 4 != 0) {
    return error("byte 8", "the length " + std::to_string(length) + " is not valid for a GLB");
  }
  glb.has_trailing_bytes = file.size() > length;
  return {};
}

Result storeChunk(const GlbChunk& chunk, uint64_t number, uint64_t offset, GlbFile& glb) {
  if ((number == 0) != (chunk.type == kJsonChunk)) {
    return error(byte(offset), number == 0 ? "the first chunk of a GLB must be its JSON"
                                           : "there is a second JSON chunk");
  }
  if (number == 0) {
    glb.json = chunk.bytes;
  } else if (chunk.type != kBinChunk) {
    glb.other_chunks.push_back(chunk);
  } else if (glb.has_bin) {
    return error(byte(offset), "there is a second BIN chunk");
  } else {
    glb.has_bin = true;
    glb.bin = chunk.bytes;
  }
  return {};
}

/// Appends a chunk and returns where its bytes go, which have the value of its padding.
uint64_t appendChunk(std::vector<uint8_t>& file, uint32_t type, uint64_t bytes, uint8_t padding) {
  appendU32(file, padded(bytes));
  appendU32(file, type);
  const uint64_t offset = file.size();
  file.resize(offset + padded(bytes), padding);
  return offset;
}

void appendChunk(std::vector<uint8_t>& file, uint32_t type, std::span<const uint8_t> bytes,
                 uint8_t padding) {
  const uint64_t offset = appendChunk(file, type, bytes.size(), padding);
  std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<ptrdiff_t>(offset));
}

}  // namespace

bool isGlb(std::span<const uint8_t> file) { return file.size() >= 4 && readU32(file, 0) == kMagic; }

bool isJsonText(std::span<const uint8_t> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string_view::npos && text[first] == '{';
}

uint32_t glbLength(std::span<const uint8_t> file) { return readU32(file, 8); }

Result readGlb(std::span<const uint8_t> file, GlbFile& glb) {
  glb = {};
  if (!isGlb(file)) return error("byte 0", "this is not a GLB file");
  uint64_t length = 0;
  MCC_GLTF_TRY(readHeader(file, glb, length));
  uint64_t offset = kHeaderBytes;
  for (uint64_t number = 0; offset < length; ++number) {
    if (length - offset < kChunkHeaderBytes) {
      return error(byte(offset), "the file ends inside a chunk header");
    }
    const uint64_t chunk_bytes = readU32(file, offset);
    if (chunk_bytes % 4 != 0) {
      return error(byte(offset),
                   "the chunk length " + std::to_string(chunk_bytes) + " is not a multiple of 4");
    }
    if (chunk_bytes > length - offset - kChunkHeaderBytes) {
      return error(byte(offset), "the chunk of " + std::to_string(chunk_bytes) +
                                     " bytes runs past the end of the file");
    }
    const GlbChunk chunk = {readU32(file, offset + 4),
                            file.subspan(offset + kChunkHeaderBytes, chunk_bytes)};
    MCC_GLTF_TRY(storeChunk(chunk, number, offset, glb));
    offset += kChunkHeaderBytes + chunk_bytes;
  }
  return {};
}

Result startGlb(const std::string& json, uint64_t bin_bytes, std::span<const GlbChunk> other_chunks,
                std::vector<uint8_t>& file, std::span<uint8_t>& bin) {
  uint64_t length = kHeaderBytes + kChunkHeaderBytes + padded(json.size());
  if (bin_bytes != 0) length += kChunkHeaderBytes + padded(bin_bytes);
  for (const GlbChunk& chunk : other_chunks)
    length += kChunkHeaderBytes + padded(chunk.bytes.size());
  if (length > 0xffffffffu) {
    return error("", "the result needs " + std::to_string(length) +
                         " bytes; a GLB cannot be larger than 4 GiB");
  }
  file.clear();
  file.reserve(length);
  appendU32(file, kMagic);
  appendU32(file, 2);
  appendU32(file, length);
  const std::span text(reinterpret_cast<const uint8_t*>(json.data()), json.size());
  appendChunk(file, kJsonChunk, text, ' ');
  const uint64_t offset = bin_bytes == 0 ? 0 : appendChunk(file, kBinChunk, bin_bytes, 0);
  for (const GlbChunk& chunk : other_chunks) appendChunk(file, chunk.type, chunk.bytes, 0);
  bin = std::span(file).subspan(offset, bin_bytes);
  return {};
}

Result writeGlb(const std::string& json, std::span<const uint8_t> bin,
                std::span<const GlbChunk> other_chunks, std::vector<uint8_t>& file) {
  std::span<uint8_t> place;
  MCC_GLTF_TRY(startGlb(json, bin.size(), other_chunks, file, place));
  std::copy(bin.begin(), bin.end(), place.begin());
  return {};
}

}  // namespace mcc::gltf
