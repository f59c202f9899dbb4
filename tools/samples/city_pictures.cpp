// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "city_pictures.h"

#include <algorithm>

#include "png.h"

namespace mcc::samples {
namespace {

using test::Random;

/// A number below `bound` that depends on a place alone.
uint32_t grain(uint32_t x, uint32_t y, uint32_t bound) {
  return Random(uint64_t{y} << 32 | x).below(bound);
}

/// Asks for the color of each pixel.
template <typename ColorAt>
std::vector<uint8_t> paint(uint32_t size, std::span<const Rgb> palette, const ColorAt& color_at) {
  std::vector<uint8_t> pixels;
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) pixels.push_back(color_at(x, y));
  }
  return encodePalettePng(size, size, pixels, palette);
}

// ---- Walls --------------------------------------------------------------------------------------

constexpr std::array<Rgb, 12> kWallPalette = {{{250, 248, 244},
                                               {244, 242, 238},
                                               {236, 234, 230},
                                               {214, 210, 204},
                                               {255, 255, 255},
                                               {58, 74, 92},
                                               {78, 98, 118},
                                               {120, 146, 166},
                                               {92, 112, 84},
                                               {78, 96, 72},
                                               {190, 186, 178},
                                               {228, 206, 140}}};
enum WallColor : uint8_t {
  kPlaster = 0,  // and the two after it
  kLedge = 3,
  kFrame = 4,
  kGlass = 5,  // and the one after it
  kSky = 7,
  kShutter = 8,  // and the one after it
  kSill = 10,
  kLitGlass = 11,
};

constexpr uint32_t kBaySize = 32;

/// One window of a wall; x and y are 0..31, y downwards.
uint8_t wallPixel(uint32_t bay, uint32_t x, uint32_t y, uint8_t plaster) {
  constexpr uint32_t kLeft = 10;
  constexpr uint32_t kRight = 21;
  constexpr uint32_t kTop = 7;
  constexpr uint32_t kBottom = 23;
  if (y == 31) return kLedge;
  if (y == kBottom + 1 && x >= kLeft - 1 && x <= kRight + 1) return kSill;
  if (y < kTop || y > kBottom) return plaster;
  const bool has_shutters = bay != 0;
  const bool is_beside = (x >= kLeft - 5 && x < kLeft) || (x > kRight && x <= kRight + 5);
  if (has_shutters && is_beside) return static_cast<uint8_t>(kShutter + y % 2);
  if (x < kLeft || x > kRight) return plaster;
  const bool is_edge = x == kLeft || x == kRight || y == kTop || y == kBottom;
  if (is_edge || x == 15 || x == 16 || y == 13) return kFrame;
  if (bay == 3) return kLitGlass;
  if (y < 13 && x + y < 25) return kSky;
  return static_cast<uint8_t>(kGlass + (x + y) / 8 % 2);
}

std::vector<uint8_t> paintWall() {
  constexpr uint32_t kBays = 2;
  return paint(kBays * kBaySize, kWallPalette, [](uint32_t x, uint32_t y) {
    const auto plaster = static_cast<uint8_t>(kPlaster + grain(x, y, 3));
    const uint32_t bay = y / kBaySize * kBays + x / kBaySize;
    return wallPixel(bay, x % kBaySize, y % kBaySize, plaster);
  });
}

// ---- Roofs and stones ---------------------------------------------------------------------------

/// Shades of grey, which the colours of the vertices tint.
constexpr std::array<Rgb, 8> kGreys = {{{150, 150, 150},
                                        {178, 178, 178},
                                        {200, 200, 200},
                                        {214, 214, 214},
                                        {226, 226, 226},
                                        {236, 236, 236},
                                        {246, 246, 246},
                                        {255, 255, 255}}};

std::vector<uint8_t> paintRoof() {
  return paint(64, kGreys, [](uint32_t x, uint32_t y) {
    const uint32_t row = y / 8;
    const uint32_t shifted = (x + row % 2 * 4) % 64;
    if (y % 8 == 7) return uint8_t{0};
    if (y % 8 == 6 || shifted % 8 == 7) return uint8_t{2};
    return static_cast<uint8_t>(4 + grain(shifted / 8, row, 4) - (y % 8 == 0 ? 0u : 1u));
  });
}

std::vector<uint8_t> paintStone() {
  return paint(64, kGreys, [](uint32_t x, uint32_t y) {
    const uint32_t row = y / 8;
    const uint32_t shifted = (x + row % 2 * 8) % 64;
    if (y % 8 == 7 || shifted % 16 == 15) return uint8_t{1};
    const uint32_t shade = 4 + grain(shifted / 16, row, 3);
    return static_cast<uint8_t>(shade + (grain(x, y, 4) == 0 ? 1 : 0));
  });
}

// ---- The ground ---------------------------------------------------------------------------------

constexpr std::array<Rgb, 16> kGroundPalette = {{{58, 98, 124},
                                                 {70, 112, 136},   // water
                                                 {196, 184, 146},  // sand
                                                 {112, 142, 74},
                                                 {102, 132, 66},
                                                 {124, 150, 84},  // meadow
                                                 {206, 186, 104},
                                                 {194, 172, 92},  // grain
                                                 {140, 112, 80},
                                                 {128, 102, 74},  // ploughed
                                                 {66, 96, 52},
                                                 {58, 86, 48},     // forest
                                                 {134, 130, 122},  // rock
                                                 {176, 170, 160},
                                                 {166, 160, 150},    // street
                                                 {150, 140, 122}}};  // yard

/// The first color of a kind of ground, and how many it has.
struct Shades {
  uint8_t first = 0;
  uint8_t count = 1;
};

Shades shadesOf(Ground ground) {
  switch (ground) {
    case Ground::kWater: return {0, 2};
    case Ground::kSand: return {2, 1};
    case Ground::kMeadow: return {3, 3};
    case Ground::kGrainField: return {6, 2};
    case Ground::kPloughedField: return {8, 2};
    case Ground::kForest: return {10, 2};
    case Ground::kRock: return {12, 2};
    case Ground::kStreet: return {13, 2};
    case Ground::kYard: return {15, 1};
    case Ground::kGarden: break;
  }
  return {4, 2};
}

}  // namespace

Picture pictureOf(Surface surface) {
  switch (surface) {
    case Surface::kWall: return {"wall", paintWall()};
    case Surface::kRoof: return {"roof", paintRoof()};
    case Surface::kStone: return {"stone", paintStone()};
    case Surface::kLeaves: break;
  }
  return {"leaves", {}};
}

Picture pictureOfGround(const CityPlan& plan) {
  const uint32_t size = plan.size().map_pixels;
  const double pixel = plan.size().extent_m / size;
  const auto color_at = [&](uint32_t x, uint32_t y) {
    const double east = (x + 0.5) * pixel - plan.size().extent_m / 2;
    const double north = plan.size().extent_m / 2 - (y + 0.5) * pixel;
    const Shades shades = shadesOf(plan.groundAt(east, north));
    return static_cast<uint8_t>(shades.first + grain(x, y, shades.count));
  };
  return {"ground", paint(size, kGroundPalette, color_at)};
}

}  // namespace mcc::samples
