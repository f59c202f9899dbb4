// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Chooses how accurately the positions of a tile are kept, from the geometric errors of the tiles
// that show it.
#ifndef MCC_TILES_ACCURACY_H_
#define MCC_TILES_ACCURACY_H_

#include <string>

#include "mcc/glb.h"
#include "tiles/placement.h"
#include "tiles/tile_demand.h"

namespace mcc::tiles {

/// How accurately the positions of a model are kept.
struct Accuracy {
  double promised_error = 0;  ///< in metres; 0: none, the bits of the options decide
  double scale = 1;           ///< metres per unit of the model's meshes, at most
  Lattice lattice;            ///< shared with other tiles; its step is 0 where it shares none
  std::string note;           ///< what the user should know; may be empty

  /// Sets the options that concern positions.
  void applyTo(gltf::ConvertOptions& options) const;
};

/// Chooses the accuracy of a model. It depends on nothing but the arguments, so that every part of
/// a tileset can be converted alone.
/// error_share  of the geometric errors is promised; 0: nothing is, the bits are fixed.
Accuracy chooseAccuracy(const TileDemand& demand, const DemandGroups& groups,
                        const TileModel& model, const Placement& placement, double error_share);

/// Returns the largest power of two that a step can be, so that no point is farther from a lattice
/// than `distance`.
double stepFor(double distance);

}  // namespace mcc::tiles

#endif  // MCC_TILES_ACCURACY_H_
