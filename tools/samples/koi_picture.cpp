// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "koi_picture.h"

#include <algorithm>
#include <array>

#include "koi_shape.h"
#include "png.h"

namespace mcc::samples {
namespace {

constexpr uint32_t kWidth = 320;
constexpr uint32_t kHeight = 160;

/// A part of the picture. Places stay half a pixel inside.
struct Area {
  uint32_t x = 0;
  uint32_t y = 0;
  uint32_t width = 0;
  uint32_t height = 0;

  bool has(uint32_t px, uint32_t py) const {
    return px >= x && py >= y && px < x + width && py < y + height;
  }
  TexturePlace place(double s, double t) const {
    return {static_cast<float>((x + 0.5 + s * (width - 1)) / kWidth),
            static_cast<float>((y + 0.5 + t * (height - 1)) / kHeight)};
  }
};

constexpr Area kBody = {0, 0, 240, 160};
constexpr Area kFin = {240, 0, 60, 160};
constexpr Area kEye = {300, 0, 20, 80};
constexpr Area kBarbel = {300, 80, 20, 80};

constexpr std::array<Rgb, 16> kPalette = {{{253, 250, 244},
                                           {240, 232, 222},
                                           {218, 205, 192},
                                           {184, 166, 152},
                                           {255, 118, 38},
                                           {242, 88, 22},
                                           {212, 62, 14},
                                           {160, 42, 12},
                                           {78, 74, 80},
                                           {48, 44, 50},
                                           {26, 24, 30},
                                           {255, 238, 224},
                                           {248, 206, 172},
                                           {236, 160, 112},
                                           {226, 178, 62},
                                           {10, 10, 14}}};
/// The first of several shades in the palette, from light to dark.
struct Tone {
  uint8_t first = 0;
  uint8_t count = 1;
};
constexpr Tone kWhite = {0, 4};
constexpr Tone kOrange = {4, 4};
constexpr Tone kInk = {8, 3};
constexpr Tone kRay = {11, 3};
constexpr Tone kGold = {14, 1};
constexpr Tone kPupil = {15, 1};

/// Chooses one of the shades; those between two are dithered. shade: 0 .. 1.
uint8_t shaded(Tone tone, double shade, uint32_t x, uint32_t y) {
  constexpr std::array<uint8_t, 16> kOrder = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  const double threshold = (kOrder[y % 4 * 4 + x % 4] + 0.5) / 16;
  const double step = std::clamp(shade, 0.0, 1.0) * (tone.count - 1);
  const auto lower = static_cast<uint32_t>(step);
  const bool is_upper = step - lower > threshold && lower + 1 < tone.count;
  return static_cast<uint8_t>(tone.first + lower + (is_upper ? 1 : 0));
}

/// Patches of orange and ink on white, in space, so that they meet at the seam.
Tone toneOfBody(const Vec3& p) {
  const Vec3 warped =
      p + Vec3{0.06 * noise(p * 6, 71), 0.06 * noise(p * 6, 72), 0.06 * noise(p * 6, 73)};
  const double back = 0.9 * p.y;
  const double ink = noise(warped * 3.4 + Vec3{0.4, 0, 0.3}, 41) + 0.3 * noise(warped * 9, 42);
  if (p.y > -0.05 && p.z < 0.6 && ink > 0.36) return kInk;
  const double orange = noise(warped * 2.3 + Vec3{0, 0, 0.55}, 31) + 0.25 * noise(warped * 7, 32);
  return orange + back > 0.16 ? kOrange : kWhite;
}

/// How dark the scales make a place: each ends in an arc that lies on the row after it.
double shadeOfScales(double along, double around) {
  constexpr double kRows = 28;
  constexpr double kColumns = 24;
  const double row = along * kRows;
  double shade = 0;
  for (int before = 0; before < 2; ++before) {
    const double n = std::floor(row) - before;
    const double column = around * kColumns + (static_cast<int64_t>(n) % 2 == 0 ? 0 : 0.5);
    const double dx = row - n - 0.35;
    const double dy = 2 * (column - std::floor(column)) - 1;
    const double distance = std::sqrt(dx * dx * 0.8 + dy * dy * 0.75);
    if (distance > 1) continue;
    shade = std::clamp((distance - 0.55) / 0.45, 0.0, 1.0);
  }
  return shade * shade;
}

uint8_t bodyPixel(uint32_t x, uint32_t y) {
  const double along = static_cast<double>(x) / (kBody.width - 1);
  const double around = static_cast<double>(y) / (kBody.height - 1);
  const Vec3 p = koiPoint(along, around);
  const double edge = gillEdge(around);
  if (along < 0.008) return kPupil.first;  // the mouth
  double shade = 0.12 + 0.1 * noise(p * 30, 51);
  if (along > edge + 0.02) shade += 0.75 * shadeOfScales(along, around);
  const double from_edge = along - edge;
  const double side = test::turn(around).sin;
  if (from_edge > -0.008 && from_edge < 0.012) shade += 0.7 * side * side * side * side;
  if (along < 0.02) shade += 0.35;
  shade += 0.25 * std::max(0.0, -p.y - 0.08) / 0.15;  // the belly is in the shadow
  return shaded(toneOfBody(p), shade, x, y);
}

uint8_t finPixel(uint32_t x, uint32_t y) {
  constexpr double kRays = 13;
  const double outward = static_cast<double>(x - kFin.x) / (kFin.width - 1);
  const double across = static_cast<double>(y) / (kFin.height - 1);
  const double ray = across * kRays - std::floor(across * kRays);
  const double from_ray = std::abs(2 * ray - 1);
  const double root = 0.75 * (1 - outward) * (1 - outward);
  return shaded(kRay,
                root + 0.45 * from_ray * from_ray + 0.12 * noise({across * 40, outward * 9, 0}, 61),
                x, y);
}

uint8_t eyePixel(uint32_t x, uint32_t y) {
  const double from_axis = static_cast<double>(x - kEye.x) / (kEye.width - 1);
  if (from_axis < 0.5) return kPupil.first;
  if (from_axis < 0.78) return kGold.first;
  return shaded(kInk, 0.3 + from_axis / 2, x, y);
}

uint8_t pixel(uint32_t x, uint32_t y) {
  if (kBody.has(x, y)) return bodyPixel(x, y);
  if (kFin.has(x, y)) return finPixel(x, y);
  if (kEye.has(x, y)) return eyePixel(x, y);
  return shaded(kRay, 0.8, x, y);
}

}  // namespace

TexturePlace placeOnBody(double along, double around) { return kBody.place(along, around); }

TexturePlace placeOnFin(double across, double outward) { return kFin.place(outward, across); }

TexturePlace placeOnEye(double from_axis, double around) { return kEye.place(from_axis, around); }

TexturePlace placeOnBarbel(double along, double around) { return kBarbel.place(along, around); }

std::vector<uint8_t> koiPicture() {
  std::vector<uint8_t> pixels;
  pixels.reserve(kWidth * kHeight);
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) pixels.push_back(pixel(x, y));
  }
  return encodePalettePng(kWidth, kHeight, pixels, kPalette);
}

}  // namespace mcc::samples
