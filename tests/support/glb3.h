// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// GLB files of version 3, byte by byte from the draft and without the library, so that tests of
// reading do not depend on writing.
#ifndef MCC_TESTS_SUPPORT_GLB3_H_
#define MCC_TESTS_SUPPORT_GLB3_H_

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mcc::gltf::test {

struct Chunk3 {
  std::string type;  ///< four characters
  std::vector<uint8_t> bytes;
  uint32_t encoding = 0;
};

inline void append(std::vector<uint8_t>& file, uint64_t value, size_t byte_count) {
  for (size_t i = 0; i < byte_count; ++i) file.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

/// Padding follows each chunk, also the last one, and counts in the length of the file alone.
inline std::vector<uint8_t> glb3Of(const std::vector<Chunk3>& chunks) {
  std::vector<uint8_t> file = {'g', 'l', 'T', 'F', 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  for (const Chunk3& chunk : chunks) {
    file.insert(file.end(), chunk.type.begin(), chunk.type.end());
    append(file, chunk.encoding, 4);
    append(file, chunk.bytes.size(), 8);
    file.insert(file.end(), chunk.bytes.begin(), chunk.bytes.end());
    file.resize((file.size() + 7) / 8 * 8, 0);
  }
  std::vector<uint8_t> length;
  append(length, file.size(), 8);
  std::copy(length.begin(), length.end(), file.begin() + 8);
  return file;
}

inline Chunk3 jsonChunk(const std::string& text) { return {"JSON", {text.begin(), text.end()}, 0}; }
inline Chunk3 binChunk(std::vector<uint8_t> bytes) {
  return {std::string("BIN\0", 4), std::move(bytes), 0};
}

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_SUPPORT_GLB3_H_
