// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Vertices of sheets as places, by which tests compare what documents mean in whatever order their
// vertices and triangles come.
#ifndef MCC_TESTS_GLTF_PLACES_H_
#define MCC_TESTS_GLTF_PLACES_H_

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "gltf/round_trip.h"

namespace mcc::gltf::test {

inline constexpr uint32_t kSize = 20;  ///< of the sheets
inline constexpr uint32_t kRow = kSize + 1;

/// A vertex of a sheet by its column and row, which no rounding of its position changes.
using Place = std::array<long, 2>;
using Triangle = std::array<Place, 3>;

inline std::vector<Place> placesOf(const std::vector<uint8_t>& file, uint32_t positions) {
  const std::vector<float> values = floatsInOrder(file, positions);
  std::vector<Place> places;
  for (size_t i = 0; i < values.size(); i += 3) {
    places.push_back({std::lround(values[i] * kSize), std::lround(values[i + 1] * kSize)});
  }
  return places;
}

/// Returns the numbers that an accessor of unsigned integers holds.
inline std::vector<uint32_t> numbersOf(const std::vector<uint8_t>& file, uint32_t accessor) {
  std::vector<uint32_t> numbers;
  for (const std::string& element : elementsInOrder(file, accessor)) {
    numbers.push_back(0);
    std::memcpy(&numbers.back(), element.data(), element.size());
  }
  return numbers;
}

inline std::vector<ConvertOptions> exactAndRounded() { return {lossless(), ConvertOptions{}}; }

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_GLTF_PLACES_H_
