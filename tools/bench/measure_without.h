// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures what the choices of our encoder gain: a file's bytes and decoding time with all of them
// and without some.
#ifndef MCC_TOOLS_BENCH_MEASURE_WITHOUT_H_
#define MCC_TOOLS_BENCH_MEASURE_WITHOUT_H_

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/geometry.h"
#include "foreign/foreign_mesh.h"
#include "format/features.h"

namespace mcc::bench {

/// Features that are switched off together: a row of the table.
struct Ablation {
  std::string name;  ///< "palette", "palette+planes"
  FeatureSet without;
};

/// Reads "palette,fold+shear" (two ablations, the second of two features) or "all" (one for every
/// feature). Returns the first name that is not a feature, or an empty text.
std::string parseAblations(std::string_view text, std::vector<Ablation>& ablations);

/// Names of all features, separated by commas.
std::string featureNames();

/// A file with and without the features of one ablation.
struct AblationFigures {
  uint64_t bytes = 0;
  /// CPU seconds, the least of several rounds in which both take turns; 0 where the bytes are those
  /// with all features.
  double decode_seconds = 0;
  double full_decode_seconds = 0;
};

struct WithoutFigures {
  std::string name;
  uint64_t triangle_count = 0;
  uint64_t full_bytes = 0;
  std::vector<AblationFigures> ablations;  ///< in the order of the question
};

/// Encodes everything of a file, left-out attributes too, once with all features and once per
/// ablation, and decodes what differs.
foreign::Outcome measureWithout(const std::string& name, const Geometry& geometry,
                                const std::vector<Ablation>& ablations, uint32_t run_count,
                                const std::function<void(const std::string&)>& progress,
                                WithoutFigures& figures);

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_MEASURE_WITHOUT_H_
