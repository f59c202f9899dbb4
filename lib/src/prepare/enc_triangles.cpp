// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "prepare/enc_triangles.h"

#include <algorithm>
#include <bit>

namespace mcc {
namespace {

struct Triple {
  uint32_t wedge[3];
  uint32_t part;
  bool operator==(const Triple&) const = default;
};

/// Rotates a triangle to begin with its smallest wedge; the orientation stays.
Triple canonical(const uint32_t* w, uint32_t part) {
  if (w[0] < w[1] && w[0] < w[2]) return {{w[0], w[1], w[2]}, part};
  if (w[1] < w[2]) return {{w[1], w[2], w[0]}, part};
  return {{w[2], w[0], w[1]}, part};
}

uint64_t hashOf(const Triple& t) {
  uint64_t h = (uint64_t{t.wedge[0]} << 32 | t.wedge[1]) * 0x9e3779b97f4a7c15ull;
  h = (h ^ (h >> 29) ^ (uint64_t{t.wedge[2]} << 32 | t.part)) * 0xbf58476d1ce4e5b9ull;
  return h ^ (h >> 32);
}

}  // namespace

SortedTriangles sortTriangles(std::span<const PartView> parts, uint32_t wedge_count) {
  SortedTriangles result;
  size_t triangle_count = 0;
  for (const PartView& part : parts) triangle_count += part.indices.size() / 3;
  result.wedges.reserve(3 * triangle_count);
  const size_t table_size = std::bit_ceil(2 * triangle_count + 1);
  std::vector<uint32_t> table(table_size, kNone);
  std::vector<uint8_t> used(wedge_count, 0);
  for (uint32_t p = 0; p < parts.size(); ++p) {
    const std::span<const uint32_t> indices = parts[p].indices;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
      const uint32_t* w = indices.data() + i;
      if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) {
        result.listed.push_back({{w[0], w[1], w[2]}, p});
        continue;
      }
      const Triple triple = canonical(w, p);
      size_t slot = hashOf(triple) & (table_size - 1);
      while (table[slot] != kNone) {
        const uint32_t other = table[slot];
        if (canonical(&result.wedges[3 * size_t{other}], result.part[other]) == triple) break;
        slot = (slot + 1) & (table_size - 1);
      }
      if (table[slot] != kNone) {
        result.duplicates.push_back(table[slot]);
        continue;
      }
      table[slot] = static_cast<uint32_t>(result.part.size());
      result.wedges.insert(result.wedges.end(), w, w + 3);
      result.part.push_back(p);
      for (int k = 0; k < 3; ++k) used[w[k]] = 1;
    }
  }
  for (uint32_t w = 0; w < wedge_count; ++w) {
    if (used[w] == 0) result.isolated.push_back(w);
  }
  return result;
}

}  // namespace mcc
