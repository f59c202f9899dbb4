// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exact vectors of unit length near a prediction: two components by the distance of their floats,
// as ordered integers, from the predicted ones, the longest from the other two. [A.10.15]
#ifndef MCC_EXACT_VECTORS_H_
#define MCC_EXACT_VECTORS_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "entropy/models.h"
#include "exact/grid.h"
#include "mesh/dequantize.h"
#include "positions/residual.h"
#include "values/value_memory.h"

namespace mcc {

inline int32_t orderedFromFloat(float value) {
  return orderedFromBits(std::bit_cast<uint32_t>(value));
}
/// What is not finite counts as 0.
inline double finiteValue(int32_t ordered) {
  const uint32_t bits = bitsFromOrdered(ordered);
  return (bits & 0x7f800000u) == 0x7f800000u ? 0.0
                                             : static_cast<double>(std::bit_cast<float>(bits));
}
/// Distance of a finite float from the next one away from 0. [A.10.9]
inline double lastPlaceOf(int32_t ordered) {
  const uint32_t exponent = (bitsFromOrdered(ordered) >> 23) & 255;
  return powerOfTwo((exponent == 0 ? 1 : static_cast<int32_t>(exponent)) - 150);
}

inline double dot(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline void cross(const double* a, const double* b, double* to) {
  to[0] = a[1] * b[2] - a[2] * b[1];
  to[1] = a[2] * b[0] - a[0] * b[2];
  to[2] = a[0] * b[1] - a[1] * b[0];
}
/// Length 1; false, and all zeros, if the vector has no direction.
inline bool makeUnit(double* v) {
  const double square = dot(v, v);
  const bool fine = square > 1e-290 && square < 1e290;
  const double inverse = fine ? 1.0 / std::sqrt(square) : 0.0;
  for (int s = 0; s < 3; ++s) v[s] = fine ? v[s] * inverse : 0.0;
  return fine;
}

/// What is known of the errors of a vector's prediction, for those of its neighbours.
struct VectorError {
  float size = 0;    ///< of the components coded by themselves, absolute
  float places = 0;  ///< of the others, in units of their last places
};

/// Work space of the coders of exact vectors.
struct VectorWork {
  double* sums;         ///< 3 per wedge for normals, 4 for tangents
  VectorError* errors;  ///< by wedge
};

struct VectorModels {
  TokenRow row[3][kScaleBuckets];  ///< [component as coded]
  MemoryModels memory;

  bool is_ready = false;

  /// Before the first use: most payloads have no exact vectors.
  void prepare() {
    if (is_ready) return;
    is_ready = true;
    for (auto& component : row) {
      std::copy_n(InitialRowTable::table.plain, kScaleBuckets, component);
    }
  }
};

template <class Io>
class VectorCoder {
 public:
  VectorCoder(Io& io, VectorModels& models) : io_(io), models_(models) { models_.prepare(); }

  /// `predicted`: of length 1 or 0. `value`: three ordered floats. `error`: expected, then that of
  /// this vector. `normal`: unit vector that the prediction is, and the vector may be,
  /// perpendicular to; or null.
  void code(const double* predicted, const double* normal, VectorError& error, int32_t* value) {
    if (normal != nullptr) {
      codeInPlane(predicted, normal, error, value);
    } else {
      codeComponents(predicted, error, value);
    }
  }

 private:
  void codeComponents(const double* predicted, VectorError& error, int32_t* value) {
    uint32_t longest = 0;
    for (uint32_t s = 1; s < 3; ++s) {
      if (std::fabs(predicted[s]) > std::fabs(predicted[longest])) longest = s;
    }
    const uint32_t a = longest == 0 ? 1 : 0;
    const uint32_t b = longest == 2 ? 1 : 2;
    const double expected = static_cast<double>(error.size);
    const double of_a = codeComponent<0>(predicted[a], expected, value[a]);
    const double of_b = codeComponent<1>(predicted[b], (expected + of_a) / 2, value[b]);
    error.size = static_cast<float>((of_a + of_b) / 2);
    const double x = finiteValue(value[a]);
    const double y = finiteValue(value[b]);
    const double rest = 1.0 - x * x - y * y;
    const double third = rest > 0 ? std::sqrt(rest) : 0.0;
    double last = predicted[longest] < 0 ? -third : third;
    if (!(std::fabs(last) < 4)) last = 0;
    const double place = lastPlaceOf(orderedFromFloat(static_cast<float>(last)));
    const double missed =
        codeComponent<2>(last, static_cast<double>(error.places) * place, value[longest]);
    error.places = (error.places + static_cast<float>(missed / place)) / 2;
  }

  /// One component by itself, the other two such that the vector is perpendicular to the normal.
  void codeInPlane(const double* predicted, const double* normal, VectorError& error,
                   int32_t* value) {
    double beside[3];
    cross(normal, predicted, beside);
    uint32_t first = 0;  // the one that turns fastest
    for (uint32_t s = 1; s < 3; ++s) {
      if (std::fabs(beside[s]) > std::fabs(beside[first])) first = s;
    }
    const double of_first =
        codeComponent<0>(predicted[first], static_cast<double>(error.size), value[first]);
    error.size = static_cast<float>(of_first);
    const double x = finiteValue(value[first]);
    const double p = predicted[first];
    const double b = beside[first];
    const double reach = p * p + b * b;
    const double rest = reach - x * x;
    const double root = rest > 0 ? std::sqrt(rest) : 0.0;
    const double inverse = reach > 1e-30 ? 1.0 / reach : 0.0;
    const double along = (x * p + std::fabs(b) * root) * inverse;
    const double across = (x * b - (b < 0 ? -p : p) * root) * inverse;
    float missed_places = 0;
    for (uint32_t i = 1; i < 3; ++i) {
      const uint32_t s = (first + i) % 3;
      double last = along * predicted[s] + across * beside[s];
      if (!(std::fabs(last) < 4)) last = 0;
      const double place = lastPlaceOf(orderedFromFloat(static_cast<float>(last)));
      const double expected = static_cast<double>(error.places) * place;
      const double missed = i == 1 ? codeComponent<1>(last, expected, value[s])
                                   : codeComponent<2>(last, expected, value[s]);
      missed_places += static_cast<float>(missed / place);
    }
    error.places = (error.places + missed_places / 2) / 2;
  }

  /// Returns what the prediction missed, in multiples of its last place.
  template <uint32_t kSlot>
  double codeComponent(double predicted, double expected, int32_t& value) {
    const int32_t from = orderedFromFloat(static_cast<float>(predicted));
    const double place = lastPlaceOf(from);
    const double scale = 16.0 * expected / place;
    const uint32_t bucket = scaleBucket(static_cast<float>(scale < 2e9 ? scale : 2e9));
    const uint32_t target = static_cast<uint32_t>(value) - static_cast<uint32_t>(from);
    const int32_t residual = codeScaledResidual<kSlot>(io_, models_.row[kSlot][bucket], bucket,
                                                       static_cast<int32_t>(target));
    value = static_cast<int32_t>(static_cast<uint32_t>(from) + static_cast<uint32_t>(residual));
    const double size = static_cast<double>(residual) * place;
    const double absolute = size < 0 ? -size : size;
    return absolute < 2 ? absolute : 2;
  }

  Io& io_;
  VectorModels& models_;
};

}  // namespace mcc

#endif  // MCC_EXACT_VECTORS_H_
