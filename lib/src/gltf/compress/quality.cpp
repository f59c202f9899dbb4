// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/codings.h"
#include "gltf/compress/texture_uses.h"

namespace mcc::gltf {
namespace {

constexpr double kUsualPixels = 4096;
constexpr double kUsualRadians = 0.25 / 180 * std::numbers::pi;

/// Returns the fewest bits, in a range, for which error(bits) is small enough; the most otherwise.
template <class Error>
uint8_t fewestBits(uint32_t least, uint32_t most, double largest, const Error& error) {
  uint32_t bits = least;
  while (bits < most && error(bits) > largest) ++bits;
  return static_cast<uint8_t>(bits);
}

double texelError(double texels) { return 0.25 / StatedErrors::countedTexels(texels); }

}  // namespace

StatedErrors::StatedErrors(double pixels)
    : share(1 / pixels),
      radians(kUsualRadians * std::sqrt(kUsualPixels / pixels)),
      weight(2 / pixels) {}

double StatedErrors::countedTexels(double texels) {
  constexpr double kFewestTexels = 1024;
  return texels == 0 ? TextureUses::kUsualTexels : std::max(texels, kFewestTexels);
}

double StatedErrors::texcoord(double texels, double range) const {
  return std::max(texelError(texels), 0.25 * share * std::min(range, 1.0));
}

bool StatedErrors::isPixel(double texels, double range) const {
  return texcoord(texels, range) > texelError(texels);
}

/// There are 2^bits - 1 points per axis. Half a cell along both axes moves a point of the
/// octahedron by sqrt(6) half cells, and its faces are 1/sqrt(3) from the centre.
double octahedralBound(uint32_t bits) {
  const double half_cell = 1.0 / static_cast<double>((uint64_t{1} << bits) - 2);
  return std::sqrt(18.0) * half_cell * (1 + half_cell) + 1e-6;
}

uint8_t octahedralBitsFor(double radians) {
  return fewestBits(kMinUnitBits, kMaxUnitBits, radians, octahedralBound);
}

uint8_t unitBitsFor(double step) {
  return fewestBits(1, kMaxLatticeBits, step, [](uint32_t bits) {
    return 1 / (std::ldexp(1.0, static_cast<int>(bits)) - 1);
  });
}

}  // namespace mcc::gltf
