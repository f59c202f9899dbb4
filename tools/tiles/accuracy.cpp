// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>

namespace mcc::tiles {
namespace {

constexpr double kMostSteps = 16777216;  // 2^24, up to which float32 has every integer

/// The tiles that share a lattice: those of one level whose meshes have the same coordinates.
struct Group {
  uint32_t level = 0;
  double distance = std::numeric_limits<double>::infinity();  ///< in the coordinates of the meshes
  double farthest = 0;
};

std::string groupKey(const TileUse& use, const Placement& placement) {
  std::string key(sizeof(Matrix) + sizeof(uint32_t), '\0');
  std::memcpy(key.data(), &use.level, sizeof(uint32_t));
  std::memcpy(key.data() + sizeof(uint32_t), use.transform.data(), sizeof(Matrix));
  return key + placement.frame + use.up_axis;
}

/// What the tiles that show a content ask of one of its models.
struct Demand {
  double promised_error = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();
  double scale = 0;
  std::string group;  ///< empty: it has no lattice in common with others
};

Demand demandOf(const TileContent& content, const Placement& placement, double error_share) {
  Demand demand;
  bool is_one_group = !placement.frame.empty();
  for (const TileUse& use : content.uses) {
    const double error = error_share * use.geometric_error;
    const double scale = placement.scale * largestScale(use.transform);
    demand.scale = std::max(demand.scale, scale);
    if (error == 0) continue;
    demand.promised_error = std::min(demand.promised_error, error);
    demand.distance = std::min(demand.distance, error / scale);
    const std::string key = groupKey(use, placement);
    if (!demand.group.empty() && demand.group != key) is_one_group = false;
    demand.group = key;
  }
  if (!is_one_group) demand.group.clear();
  return demand;
}

Accuracy accuracyOf(const Demand& demand, const Placement& placement, const Group* group) {
  Accuracy accuracy;
  accuracy.note = placement.caveat;
  accuracy.scale = demand.scale;
  const bool is_known = std::isfinite(demand.distance) && demand.distance > 0;
  if (!is_known) {
    accuracy.note = "no tile above it has a geometric error; its positions get the default bits";
    return accuracy;
  }
  accuracy.promised_error = demand.promised_error;
  if (group == nullptr) return accuracy;
  const double step = stepFor(group->distance);
  const bool is_float =
      step >= std::numeric_limits<float>::min() && step <= std::numeric_limits<float>::max();
  if (is_float && group->farthest < (kMostSteps - 1) * step) {
    accuracy.step = step;
  } else {
    accuracy.note =
        "its level needs more than 24 bits for one grid of positions, so that borders between "
        "tiles may open by the promised error";
  }
  return accuracy;
}

}  // namespace

double stepFor(double distance) {
  const double largest = 2 * distance / std::sqrt(3.0);
  double step = std::exp2(std::floor(std::log2(largest)));
  if (step * std::sqrt(3.0) / 2 > distance) step /= 2;  // the logarithm was rounded up
  return step;
}

void Accuracy::applyTo(gltf::ConvertOptions& options) const {
  if (promised_error == 0) return;
  if (step != 0) {
    options.position_lattice = Lattice{{0, 0, 0, 0}, static_cast<float>(step)};
  } else {
    options.max_position_error = promised_error / scale;
    options.is_error_relative = false;
  }
}

std::string Accuracy::key() const {
  std::string text(3 * 24 + 8, '\0');
  text.resize(
      static_cast<size_t>(std::max(0, std::snprintf(text.data(), text.size(), "%.17g %.17g %.17g",
                                                    promised_error, scale, step))));
  return text;
}

Accuracies chooseAccuracies(const Tileset& tileset, const std::vector<Survey>& surveys,
                            double error_share) {
  std::vector<std::vector<Demand>> demands(surveys.size());
  std::map<std::string, Group> groups;
  for (size_t i = 0; i < surveys.size(); ++i) {
    for (const Placement& placement : surveys[i].placements) {
      const Demand demand = demandOf(tileset.contents[i], placement, error_share);
      demands[i].push_back(demand);
      if (demand.group.empty()) continue;
      Group& group = groups[demand.group];
      group.level = tileset.contents[i].uses[0].level;
      group.distance = std::min(group.distance, demand.distance);
      group.farthest = std::max(group.farthest, placement.farthest);
    }
  }
  Accuracies accuracies;
  accuracies.of_models.resize(surveys.size());
  for (size_t i = 0; i < surveys.size(); ++i) {
    for (size_t m = 0; m < demands[i].size(); ++m) {
      const auto found = groups.find(demands[i][m].group);
      accuracies.of_models[i].push_back(
          accuracyOf(demands[i][m], surveys[i].placements[m],
                     found == groups.end() ? nullptr : &found->second));
    }
  }
  std::map<uint32_t, uint64_t> group_counts;
  for (const auto& [key, group] : groups) ++group_counts[group.level];
  for (const auto& [level, count] : group_counts) {
    if (count == 1) continue;
    accuracies.notes.push_back("the tiles of level " + std::to_string(level) + " have " +
                               std::to_string(count) +
                               " different transforms; borders are exact between tiles of the "
                               "same one, and within the promised errors elsewhere");
  }
  return accuracies;
}

}  // namespace mcc::tiles
