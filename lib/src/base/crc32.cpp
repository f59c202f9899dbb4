// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "base/crc32.h"

#include <cstddef>

#include "base/host.h"

namespace mcc {
namespace {

constexpr uint32_t kPolynomial = 0xedb88320u;
constexpr size_t kSlices = 8;

constexpr uint32_t crcOfBits(uint32_t crc, int bits) {
  for (int bit = 0; bit < bits; ++bit) crc = (crc >> 1) ^ (kPolynomial & (~(crc & 1) + 1));
  return crc;
}

struct SliceTables {
  uint32_t entry[kSlices][256];

  constexpr SliceTables() : entry{} {
    for (uint32_t i = 0; i < 256; ++i) entry[0][i] = crcOfBits(i, 8);
    for (size_t slice = 1; slice < kSlices; ++slice) {
      for (uint32_t i = 0; i < 256; ++i) {
        const uint32_t previous = entry[slice - 1][i];
        entry[slice][i] = (previous >> 8) ^ entry[0][previous & 0xff];
      }
    }
  }
};

#if defined(MCC_COMPACT)

/// From so many bytes on, tables are worth the microseconds that computing them takes; stored ones
/// would not compress.
constexpr size_t kSlicedFrom = 4096;

struct NibbleTable {
  uint32_t entry[16];

  constexpr NibbleTable() : entry{} {
    for (uint32_t i = 0; i < 16; ++i) entry[i] = crcOfBits(i, 4);
  }
};
constexpr NibbleTable kNibbles;

uint32_t crcByNibbles(std::span<const uint8_t> bytes, uint32_t crc) {
  for (const uint8_t byte : bytes) {
    crc ^= byte;
    crc = (crc >> 4) ^ kNibbles.entry[crc & 15];
    crc = (crc >> 4) ^ kNibbles.entry[crc & 15];
  }
  return crc;
}

#else
constexpr SliceTables kTables;
#endif

}  // namespace

uint32_t crc32(std::span<const uint8_t> bytes, uint32_t crc) {
#if defined(MCC_COMPACT)
  if (bytes.size() < kSlicedFrom) return ~crcByNibbles(bytes, ~crc);
  const SliceTables kTables;
#endif
  crc = ~crc;
  const uint8_t* p = bytes.data();
  size_t rest = bytes.size();
  for (; rest >= kSlices; rest -= kSlices, p += kSlices) {
    const uint32_t low =
        crc ^ (uint32_t{p[0]} | uint32_t{p[1]} << 8 | uint32_t{p[2]} << 16 | uint32_t{p[3]} << 24);
    crc = kTables.entry[7][low & 0xff] ^ kTables.entry[6][(low >> 8) & 0xff] ^
          kTables.entry[5][(low >> 16) & 0xff] ^ kTables.entry[4][low >> 24] ^
          kTables.entry[3][p[4]] ^ kTables.entry[2][p[5]] ^ kTables.entry[1][p[6]] ^
          kTables.entry[0][p[7]];
  }
  for (; rest != 0; --rest, ++p) crc = (crc >> 8) ^ kTables.entry[0][(crc ^ *p) & 0xff];
  return ~crc;
}

}  // namespace mcc
