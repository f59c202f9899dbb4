// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a lattice has to cover, and the rounding of weights: the same for documents and for users of
// the writer.
#ifndef MCC_VALUES_ENC_EXTENT_H_
#define MCC_VALUES_ENC_EXTENT_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mcc/types.h"

namespace mcc {

inline constexpr uint32_t kLatticeComponents = 4;

/// Bounding box of floats that share a lattice, with samples of their values.
struct Extent {
  uint32_t component_count = 0;
  float min[kLatticeComponents];
  float max[kLatticeComponents];
  std::vector<float> samples[kLatticeComponents];

  explicit Extent(uint32_t components);

  /// Adds component `at(element, c)` of `count` elements; false when one is NaN or infinite
  /// (nothing is added then).
  template <class At>
  bool add(uint64_t count, const At& at) {
    for (uint64_t i = 0; i < count; ++i) {
      for (uint32_t c = 0; c < component_count; ++c) {
        if (!std::isfinite(at(i, c))) return false;
      }
    }
    const uint64_t sample_step = count / kMaxSamples + 1;
    for (uint64_t i = 0; i < count; ++i) {
      for (uint32_t c = 0; c < component_count; ++c) addValue(c, at(i, c), i % sample_step == 0);
    }
    return true;
  }

  /// Largest side of the box.
  double size() const;
  /// Largest magnitude of a value.
  double farthest() const;
  /// Largest side of the box without the outer percent of the values on either end. Reorders the
  /// samples.
  double innerSize();
  /// Largest magnitude without the outer percent of the values on either end. Reorders the samples.
  double innerFarthest();
  bool isInside(float low, float high) const;

 private:
  static constexpr uint64_t kMaxSamples = 65536;

  void addValue(uint32_t c, float value, bool is_sample);
  /// Finds the ends of a component without the outer percent, if there are enough samples.
  void innerEnds(uint32_t c, double& low, double& high);
};

/// Whether a few far values leave less than half of the bits to the others.
bool isRuinedByOutliers(Extent& extent, uint8_t bits);

/// Fits a lattice of 2^bits points to the largest side of a box, which it begins at the smallest
/// values of. Every value has a point. Returns false when float32 has no such step.
bool fitLattice(const Extent& extent, uint8_t bits, Lattice& lattice);

/// Returns the number of the lattice point of a value along an axis, rounded as the writer rounds:
/// to the nearest, ties upwards.
inline double latticePoint(float value, float origin, float step) {
  return std::floor((double{value} - double{origin}) / double{step} + 0.5);
}

/// The lattice of 0..1 with points at both ends: 0 and 1 stay what they are.
Lattice unitLattice(uint8_t bits);

/// Rounds every number, none of them negative, to a whole one. When their sum is within a quarter
/// of `total` it becomes `total`: all are rounded down and those that lost most go up.
void roundTogether(std::vector<double>& points, double total);

}  // namespace mcc

#endif  // MCC_VALUES_ENC_EXTENT_H_
