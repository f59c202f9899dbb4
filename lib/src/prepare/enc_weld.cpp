// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "prepare/enc_weld.h"

#include <bit>
#include <cstring>

namespace mcc {
namespace {

struct Key {
  uint32_t bits[3];
  bool operator==(const Key&) const = default;
};

Key positionKey(const AttributeView& positions, uint32_t wedge, bool exact, bool& is_nan) {
  Key key{};
  const uint32_t bytes = componentBytes(positions.format.component_type);
  const uint8_t* element =
      static_cast<const uint8_t*>(positions.data) + positions.stride_bytes * wedge;
  is_nan = false;
  for (uint32_t c = 0; c < 3; ++c) {
    std::memcpy(&key.bits[c], element + c * bytes, bytes);
    if (positions.format.component_type != ComponentType::kFloat32) continue;
    if (!exact && key.bits[c] == 0x80000000u) key.bits[c] = 0;
    is_nan |= (key.bits[c] & 0x7fffffffu) > 0x7f800000u;
  }
  return key;
}

uint64_t hashOf(const Key& key) {
  uint64_t h = key.bits[0];
  h = (h ^ (h >> 32)) * 0x9e3779b97f4a7c15ull + key.bits[1];
  h = (h ^ (h >> 29)) * 0xbf58476d1ce4e5b9ull + key.bits[2];
  h = (h ^ (h >> 32)) * 0x94d049bb133111ebull;
  return h ^ (h >> 31);
}

}  // namespace

PositionClasses weldPositions(const AttributeView& positions, uint32_t wedge_count, bool exact) {
  PositionClasses result;
  result.class_of_wedge.resize(wedge_count);
  const size_t table_size = std::bit_ceil(size_t{wedge_count} * 2 + 1);
  std::vector<uint32_t> table(table_size, kNone);  // the first wedge of each class
  for (uint32_t w = 0; w < wedge_count; ++w) {
    bool is_nan = false;
    const Key key = positionKey(positions, w, exact, is_nan);
    if (is_nan) {
      result.class_of_wedge[w] = result.class_count++;
      continue;
    }
    size_t slot = hashOf(key) & (table_size - 1);
    for (;; slot = (slot + 1) & (table_size - 1)) {
      bool other_nan = false;
      if (table[slot] == kNone) {
        table[slot] = w;
        result.class_of_wedge[w] = result.class_count++;
        break;
      }
      if (positionKey(positions, table[slot], exact, other_nan) == key) {
        result.class_of_wedge[w] = result.class_of_wedge[table[slot]];
        break;
      }
    }
  }
  return result;
}

}  // namespace mcc
