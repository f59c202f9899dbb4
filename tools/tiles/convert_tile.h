// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_CONVERT_TILE_H_
#define MCC_TILES_CONVERT_TILE_H_

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mcc/glb.h"
#include "tiles/accuracy.h"

namespace mcc::tiles {

/// What was measured on the positions of a tile.
struct TileFigures {
  uint8_t bits_low = 0;  ///< fewest and most bits of positions; 0: exact
  uint8_t bits_high = 0;
  bool has_positions = false;  ///< false: nothing was compressed
  double promised_error = 0;   ///< the smallest of its models, in metres; 0: none was promised
  double largest_promise = 0;  ///< the largest
  double measured_error = 0;   ///< largest, in metres, at most

  /// Adds what the library measured on one model.
  void add(const gltf::ConvertReport& report, const Accuracy& accuracy);
  /// Adds the figures of another tile.
  void add(const TileFigures& other);
};

/// Chooses the accuracy of a model. Errors: it is not glTF.
using AccuracyChooser = std::function<gltf::Result(std::span<const uint8_t> file,
                                                   const TileModel& model, Accuracy& accuracy)>;

/// Compresses the models in a GLB, b3dm, i3dm or cmpt. `output` stays empty when nothing becomes
/// smaller. `notes` gets what the user should know.
/// Errors: the file is damaged; a model cannot be converted. Safe for untrusted input.
gltf::Result convertTile(std::span<const uint8_t> file, const AccuracyChooser& choose,
                         const gltf::ConvertOptions& options, std::vector<uint8_t>& output,
                         TileFigures& figures, std::vector<std::string>& notes);

}  // namespace mcc::tiles

#endif  // MCC_TILES_CONVERT_TILE_H_
