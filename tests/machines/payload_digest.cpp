// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// payload-digest FILE...: decodes payloads using only the reader, and prints for each a CRC-32 of
// every index and every element, or the error. tools/check/machines builds it for several machines;
// all must print the same.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <vector>

#include "base/crc32.h"
#include "decoded_payload.h"

namespace {

/// Goes on from the checksum `before` over numbers of `number_bytes` each. The reader stores them
/// in the host's byte order; they count as if they were little-endian, so that all machines print
/// the same.
uint32_t checksumOf(uint32_t before, const void* data, size_t bytes, size_t number_bytes) {
  const uint8_t* begin = static_cast<const uint8_t*>(data);
  if (std::endian::native == std::endian::little) return mcc::crc32({begin, bytes}, before);
  std::vector<uint8_t> swapped(begin, begin + bytes);
  for (size_t i = 0; i < bytes; i += number_bytes) {
    std::reverse(swapped.data() + i, swapped.data() + i + number_bytes);
  }
  return mcc::crc32(swapped, before);
}

void printDigest(const char* name, const std::vector<uint8_t>& bytes) {
  mcc::machines::DecodedPayload decoded;
  const mcc::Status status = decoded.decode(bytes);
  if (!status.ok()) {
    std::printf("%s error %d\n", name, static_cast<int>(status.error));
    return;
  }
  uint32_t checksum = 0;
  for (size_t p = 0; p < decoded.values.size(); ++p) {
    const mcc::PieceInfo& piece = decoded.payload.info().pieces[p];
    for (size_t a = 0; a < decoded.values[p].size(); ++a) {
      const std::vector<uint8_t>& values = decoded.values[p][a];
      const size_t number_bytes = mcc::componentBytes(piece.attributes[a].format.component_type);
      checksum = checksumOf(checksum, values.data(), values.size(), number_bytes);
    }
    for (const auto& i : decoded.indices[p]) {
      checksum = checksumOf(checksum, i.data(), 4 * i.size(), 4);
    }
  }
  std::printf("%s %08x\n", name, static_cast<unsigned>(checksum));
}

}  // namespace

int main(int argc, char** argv) { return mcc::machines::forEachFile(argc, argv, printDigest); }
