// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Chooses how accurately the positions of each tile are kept, from the tiles' geometric errors.
#ifndef MCC_TILES_ACCURACY_H_
#define MCC_TILES_ACCURACY_H_

#include <optional>
#include <string>
#include <vector>

#include "mcc/gltf.h"
#include "tiles/placement.h"
#include "tiles/tileset.h"

namespace mcc::tiles {

/// How accurately the positions of a model are kept.
struct Accuracy {
  double promised_error = 0;  ///< in metres; 0: none, the bits of the options decide
  double scale = 1;           ///< metres per unit of the model's meshes, at most
  double step = 0;            ///< of the lattice it shares with others; 0: it shares none
  std::string note;           ///< what the user should know; may be empty

  /// Sets the options that concern positions.
  void applyTo(gltf::ConvertOptions& options) const;
  /// Returns a text that is equal for equal accuracies.
  std::string key() const;
};

/// What is known about a content before it is converted.
struct Survey {
  std::vector<Placement> placements;  ///< one for each model in it; empty: it is copied
};

/// The accuracies of a tileset.
struct Accuracies {
  std::vector<std::vector<Accuracy>> of_models;  ///< for each content, those of its models
  std::vector<std::string> notes;                ///< about whole levels
};

/// Chooses the accuracy of each model of each content.
/// error_share  of a tile's geometric error is promised.
Accuracies chooseAccuracies(const Tileset& tileset, const std::vector<Survey>& surveys,
                            double error_share);

/// Returns the largest power of two that a step can be, so that no point is farther from a lattice
/// than `distance`.
double stepFor(double distance);

}  // namespace mcc::tiles

#endif  // MCC_TILES_ACCURACY_H_
