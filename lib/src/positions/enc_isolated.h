// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_POSITIONS_ENC_ISOLATED_H_
#define MCC_POSITIONS_ENC_ISOLATED_H_

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "positions/isolated.h"

namespace mcc {

/// Returns the order in which IsolatedCoder codes positions (3 coordinates each). Equal positions
/// keep their order. O(n log n).
inline std::vector<uint32_t> isolatedOrder(std::span<const int32_t> positions) {
  constexpr int32_t kMost = std::numeric_limits<int32_t>::max();
  int32_t low[3] = {kMost, kMost, kMost};
  for (size_t i = 0; i < positions.size(); ++i) low[i % 3] = std::min(low[i % 3], positions[i]);
  std::vector<uint32_t> order(positions.size() / 3);
  std::iota(order.begin(), order.end(), 0);
  const auto at = [positions](uint32_t i) { return positions.data() + 3 * size_t{i}; };
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return comesBefore(at(a), at(b), low); });
  return order;
}

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_ISOLATED_H_
