// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tile_demand.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "tiles/part.h"

namespace mcc::tiles {
namespace {

/// Two groups of one key, of which the chance is 2^-64, would only share the smaller distance.
uint64_t groupKey(const TileUse& use) {
  double linear[9];
  for (size_t i = 0; i < 9; ++i) linear[i] = use.transform[i / 3 * 4 + i % 3] + 0.0;  // no -0
  std::string key(sizeof(linear), '\0');
  std::memcpy(key.data(), linear, sizeof(linear));
  key += std::to_string(use.level) + "xyz"[static_cast<size_t>(use.up_axis)];
  return jobs::hashOf(key);
}

}  // namespace

void DemandGroups::add(const TileUse& use, TileDemand& demand) {
  const uint64_t key = groupKey(use);
  const std::array<double, 3> translation = {use.transform[12], use.transform[13],
                                             use.transform[14]};
  const auto [known, is_new] = groups_.try_emplace(key);
  Group& group = known->second;
  if (is_new) {
    group.origin = translation;
    ++count_by_level_[use.level];
  }
  std::array<double, 3> offset = {translation[0] - group.origin[0],
                                  translation[1] - group.origin[1],
                                  translation[2] - group.origin[2]};
  Matrix inverse;
  const bool has_inverse = invertLinear(use.transform, inverse);
  if (has_inverse) offset = transformed(inverse, offset);
  if (demand.scale < 0) {
    demand.level = use.level;
    demand.up_axis = use.up_axis;
    demand.has_group = has_inverse;
    demand.group = key;
    demand.offset = offset;
  } else if (demand.group != key || demand.offset != offset) {
    demand.has_group = false;
  }
  const double scale = largestScale(use.transform);
  demand.scale = std::max(demand.scale, scale);
  if (use.geometric_error == 0) return;
  // A scale so large that the distance would become 0 must not look like a tile without an error.
  const double tile_distance =
      std::max(use.geometric_error / scale, std::numeric_limits<double>::min());
  demand.world_distance = std::min(demand.world_distance, use.geometric_error);
  demand.tile_distance = std::min(demand.tile_distance, tile_distance);
  group.distance = std::min(group.distance, tile_distance);
}

}  // namespace mcc::tiles
