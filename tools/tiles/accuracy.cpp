// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mcc::tiles {
namespace {

constexpr double kMostSteps = 16777216;  // 2^24, up to which float32 has every integer

/// A promise that is even smaller is kept by exact positions, as this one is; 0 would be none.
constexpr double kLeastDistance = std::numeric_limits<double>::min();

/// What is left of a promised distance for the lattice. Where its origin is not 0, the sum of the
/// origin and of a number of steps is rounded to float32, which must be less than the rest.
constexpr double kShareOfLattice = 0.998;

/// From a model's coordinates to its tile's, in which z is up.
const Matrix& modelToTile(UpAxis axis) {
  static constexpr Matrix kFromX = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};
  static constexpr Matrix kFromY = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
  switch (axis) {
    case UpAxis::kX: return kFromX;
    case UpAxis::kZ: return kIdentity;
    case UpAxis::kY: break;
  }
  return kFromY;
}

/// Finds where the lattice of a tile's group has a point in the coordinates of the meshes. Returns
/// false when they cannot have one.
bool findOrigin(const TileDemand& demand, const TileModel& model, const Matrix& mesh_to_model,
                double step, Lattice& lattice) {
  Matrix mesh_to_tile = product(modelToTile(demand.up_axis), mesh_to_model);
  Matrix tile_to_mesh;
  if (!invertLinear(mesh_to_tile, tile_to_mesh)) return false;
  std::array<double, 3> shift = transformed(mesh_to_tile, {0, 0, 0});
  for (size_t c = 0; c < 3; ++c) shift[c] += model.center[c] + demand.offset[c];
  shift = transformed(tile_to_mesh, shift);
  for (size_t c = 0; c < 3; ++c) {
    const double rest = std::remainder(-shift[c], step);
    if (!std::isfinite(rest)) return false;
    lattice.origin[c] = static_cast<float>(rest) + 0.0f;  // no -0
  }
  lattice.step = static_cast<float>(step);
  return true;
}

constexpr char kNoCommonFrame[] =
    "has parts or tiles with different transforms, so that its borders may open by the promised "
    "error";

}  // namespace

double stepFor(double distance) {
  const double largest = 2 * distance / std::sqrt(3.0);
  double step = std::exp2(std::floor(std::log2(largest)));
  if (step * std::sqrt(3.0) / 2 > distance) step /= 2;  // the logarithm was rounded up
  return step;
}

void Accuracy::applyTo(gltf::ConvertOptions& options) const {
  if (promised_error == 0) return;
  if (lattice.step != 0) {
    options.position_lattice = lattice;
  } else {
    options.max_position_error = std::max(promised_error / scale, kLeastDistance);
    options.is_error_relative = false;
  }
}

Accuracy chooseAccuracy(const TileDemand& demand, const DemandGroups& groups,
                        const TileModel& model, const Placement& placement, double error_share) {
  Accuracy accuracy;
  accuracy.note = placement.caveat;
  accuracy.scale = demand.scale * placement.scale;
  if (error_share == 0) return accuracy;
  const double distance =
      std::max(error_share * demand.tile_distance / placement.scale, kLeastDistance);
  if (!std::isfinite(distance)) {
    accuracy.note = "no tile above it has a geometric error; its positions get the default bits";
    return accuracy;
  }
  accuracy.promised_error = error_share * demand.world_distance;
  if (!demand.has_group || !placement.matrix) {
    if (accuracy.note.empty() && !model.is_instanced) accuracy.note = kNoCommonFrame;
    return accuracy;
  }
  const double of_group = error_share * groups.distanceOf(demand.group) / placement.scale;
  const double step = stepFor(kShareOfLattice * of_group);
  const bool is_float =
      step >= std::numeric_limits<float>::min() && step <= std::numeric_limits<float>::max();
  const double rounding = placement.farthest * std::numeric_limits<float>::epsilon();
  Lattice lattice;
  if (is_float && placement.farthest < (kMostSteps - 2) * step &&
      findOrigin(demand, model, *placement.matrix, step, lattice) &&
      (rounding < (1 - kShareOfLattice) * distance ||
       (lattice.origin[0] == 0 && lattice.origin[1] == 0 && lattice.origin[2] == 0))) {
    accuracy.lattice = lattice;
  } else {
    accuracy.note =
        "its level needs more than 24 bits for one lattice of positions, so that borders between "
        "tiles may open by the promised error";
  }
  return accuracy;
}

}  // namespace mcc::tiles
