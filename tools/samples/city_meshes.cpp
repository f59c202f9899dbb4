// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "city_meshes.h"

#include <algorithm>
#include <cmath>

namespace mcc::samples {
namespace {

using test::turn;

constexpr double kFloor = 3;          // metres
constexpr double kFoundation = -2.5;  // where walls begin, because the ground is not level
constexpr double kBays = 2;           // windows in a row of the picture of a wall
constexpr double kRoofPicture = 4;    // metres that the picture of a roof covers
constexpr double kStonePicture = 6;

constexpr std::array<Rgb, 8> kWallColors = {{{236, 222, 190},
                                             {230, 196, 130},
                                             {226, 150, 110},
                                             {214, 214, 206},
                                             {196, 206, 150},
                                             {160, 190, 206},
                                             {240, 236, 224},
                                             {216, 170, 150}}};
constexpr std::array<Rgb, 5> kRoofColors = {
    {{176, 84, 56}, {150, 66, 44}, {196, 104, 64}, {120, 70, 60}, {92, 96, 108}}};
constexpr Rgb kSandstone = {226, 208, 170};
constexpr Rgb kGranite = {176, 172, 164};
constexpr Rgb kSlate = {84, 94, 112};
constexpr Rgb kBark = {92, 66, 44};
constexpr Rgb kConiferGreen = {40, 84, 46};
constexpr Rgb kLeafGreen = {86, 128, 48};
constexpr Rgb kIron = {60, 64, 70};
constexpr Rgb kLight = {255, 236, 180};
constexpr Rgb kWaterBlue = {90, 140, 180};

/// Colours are stored linear; a square is close enough to the curve of sRGB, and the same
/// everywhere.
int32_t linearOf(uint8_t srgb) { return srgb * srgb / 255; }

/// Adds an upright rectangle with a at its left end and b at its right one, as seen from outside.
/// `us` and `vs` are texture coordinates per metre.
void addWall(CityMesh& mesh, Surface surface, const Vec3& a, const Vec3& b, double low, double high,
             double us, double vs) {
  const double length = std::sqrt(dot(b - a, b - a));
  const auto at = [](const Vec3& p, double z) { return Vec3{p.x, p.y, p.z + z}; };
  const std::array<Corner, 4> corners = {{{at(a, low), 0, -low * vs},
                                          {at(b, low), length * us, -low * vs},
                                          {at(b, high), length * us, -high * vs},
                                          {at(a, high), 0, -high * vs}}};
  mesh.addFace(surface, corners);
}

/// Adds a wall of a house, with a whole number of windows in each row and, if `rise` is not 0, a
/// gable above it.
void addFacade(CityMesh& mesh, const Vec3& a, const Vec3& b, double eaves, double rise) {
  const double length = std::sqrt(dot(b - a, b - a));
  const double u = std::max(1.0, std::floor(length / 3 + 0.5)) / kBays;
  const auto corner = [](const Vec3& p, double z, double at) {
    return Corner{{p.x, p.y, p.z + z}, at, -z / (kFloor * kBays)};
  };
  const std::array<Corner, 5> corners = {
      corner(a, kFoundation, 0), corner(b, kFoundation, u), corner(b, eaves, u),
      corner(rise > 0 ? (a + b) * 0.5 : a, eaves + rise, rise > 0 ? u / 2 : 0),
      corner(a, eaves, 0)};
  mesh.addFace(Surface::kWall, std::span<const Corner>(corners).first(rise > 0 ? 5 : 4));
}

/// Adds a triangle of stone below a roof.
void addGable(CityMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& top) {
  const double length = std::sqrt(dot(b - a, b - a));
  const std::array<Corner, 3> corners = {
      {{a, 0, 0},
       {b, length / kStonePicture, 0},
       {top, length / kStonePicture / 2, (a.z - top.z) / kStonePicture}}};
  mesh.addFace(Surface::kStone, corners);
}

/// Adds a face of a roof; corner 0 to 1 is its eaves.
void addRoofFace(CityMesh& mesh, std::span<const Vec3> points) {
  const Vec3 along = unit(points[1] - points[0]);
  std::array<Corner, 4> corners;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 d = points[i] - points[0];
    const double u = dot(d, along);
    const Vec3 up = d - along * u;
    corners[i] = {points[i], u / kRoofPicture, -std::sqrt(dot(up, up)) / kRoofPicture};
  }
  mesh.addFace(Surface::kRoof, std::span<const Corner>(corners).first(points.size()));
}

/// The block below a roof: x and y are half of its sides.
struct Box {
  Frame frame;
  double x = 0;
  double y = 0;

  Vec3 at(double sx, double sy, double z) const { return frame.toWorld({sx * x, sy * y, z}); }
  /// Corner 0..3, counter-clockwise as seen from above.
  Vec3 corner(uint32_t i, double z = 0) const {
    return at(i == 1 || i == 2 ? 1 : -1, i >= 2 ? 1 : -1, z);
  }
};

/// A roof with its ridge along x.
void addGabledRoof(CityMesh& mesh, const Box& box, double eaves, double rise, Rgb roof) {
  constexpr double kOverhang = 0.5;
  const Box wide = {box.frame, box.x + kOverhang / 2, box.y + kOverhang};
  const double low = eaves - rise * kOverhang / box.y;
  const Vec3 wide_left = wide.at(-1, 0, eaves + rise);
  const Vec3 wide_right = wide.at(1, 0, eaves + rise);
  mesh.setColor(roof);
  addRoofFace(mesh, std::array{wide.corner(0, low), wide.corner(1, low), wide_right, wide_left});
  addRoofFace(mesh, std::array{wide.corner(2, low), wide.corner(3, low), wide_left, wide_right});
}

/// Adds the gables of stone below such a roof.
void addStoneGables(CityMesh& mesh, const Box& box, double eaves, double rise) {
  addGable(mesh, box.corner(1, eaves), box.corner(2, eaves), box.at(1, 0, eaves + rise));
  addGable(mesh, box.corner(3, eaves), box.corner(0, eaves), box.at(-1, 0, eaves + rise));
}

/// A roof with four sides; a pyramid when the box is square.
void addHippedRoof(CityMesh& mesh, const Box& box, double eaves, double rise, Rgb roof) {
  constexpr double kOverhang = 0.4;
  const Box wide = {box.frame, box.x + kOverhang, box.y + kOverhang};
  const double ridge = std::max(0.0, box.x - box.y) / wide.x;
  const Vec3 left = wide.at(-ridge, 0, eaves + rise);
  const Vec3 right = wide.at(ridge, 0, eaves + rise);
  const auto corner = [&](uint32_t i) { return wide.corner(i, eaves); };
  mesh.setColor(roof);
  addRoofFace(mesh, std::array{corner(1), corner(2), right});
  addRoofFace(mesh, std::array{corner(3), corner(0), left});
  if (ridge > 0) {
    addRoofFace(mesh, std::array{corner(0), corner(1), right, left});
    addRoofFace(mesh, std::array{corner(2), corner(3), left, right});
  } else {
    addRoofFace(mesh, std::array{corner(0), corner(1), right});
    addRoofFace(mesh, std::array{corner(2), corner(3), left});
  }
}

void addTop(CityMesh& mesh, Surface surface, const Box& box, double z) {
  const std::array<Corner, 4> corners = {
      {{box.corner(0, z), 0, 0},
       {box.corner(1, z), 2 * box.x / kStonePicture, 0},
       {box.corner(2, z), 2 * box.x / kStonePicture, 2 * box.y / kStonePicture},
       {box.corner(3, z), 0, 2 * box.y / kStonePicture}}};
  mesh.addFace(surface, corners);
}

/// Four walls of stone and, if `has_top`, a lid.
void addStoneBox(CityMesh& mesh, const Box& box, double low, double high, bool has_top = true) {
  constexpr double kScale = 1 / kStonePicture;
  for (uint32_t i = 0; i < 4; ++i) {
    addWall(mesh, Surface::kStone, box.corner(i), box.corner((i + 1) % 4), low, high, kScale,
            kScale);
  }
  if (has_top) addTop(mesh, Surface::kStone, box, high);
}

/// A tower of `sides` flat sides with a pointed roof.
void addRoundTower(CityMesh& mesh, const Vec3& foot, double radius, double high, double spire,
                   uint32_t sides) {
  constexpr double kScale = 1 / kStonePicture;
  const auto at = [&](uint32_t i, double r, double z) {
    const test::CosSin d = turn(static_cast<double>(i % sides) / sides);
    return foot + Vec3{d.cos * r, d.sin * r, z};
  };
  mesh.setColor(kGranite);
  for (uint32_t i = 0; i < sides; ++i) {
    addWall(mesh, Surface::kStone, at(i, radius, 0), at(i + 1, radius, 0), -8, high, kScale,
            kScale);
  }
  mesh.setColor(kSlate);
  for (uint32_t i = 0; i < sides; ++i) {
    addRoofFace(mesh,
                std::array{at(i, radius + 0.7, high - 0.4), at(i + 1, radius + 0.7, high - 0.4),
                           foot + Vec3{0, 0, high + spire}});
  }
}

void addChimney(CityMesh& mesh, const House& house) {
  const Frame frame = {house.frame.toWorld({house.width_m / 4, house.depth_m / 5, 0}),
                       house.frame.direction};
  mesh.setColor(kRoofColors[0]);
  const double eaves = house.floor_count * kFloor;
  addStoneBox(mesh, {frame, 0.45, 0.45}, eaves, house.height() + 0.7);
}

/// Adds a closed ring of triangles between two circles, or up to a point if `high_radius` is 0. Its
/// normals are smooth.
void addCone(CityMesh& mesh, Surface surface, uint32_t sides, double low, double low_radius,
             double high, double high_radius) {
  const double slope = (low_radius - high_radius) / (high - low);
  const bool is_pointed = high_radius == 0;
  std::array<uint32_t, 2> previous{};
  std::array<uint32_t, 2> first{};
  for (uint32_t i = 0; i < sides; ++i) {
    const test::CosSin d = turn(static_cast<double>(i) / sides);
    const Vec3 normal = unit({d.cos, d.sin, slope});
    const double u = static_cast<double>(i) / sides;
    std::array<uint32_t, 2> now{};
    now[0] = mesh.addVertex(surface, {{d.cos * low_radius, d.sin * low_radius, low}, u, 1}, normal);
    now[1] =
        mesh.addVertex(surface, {{d.cos * high_radius, d.sin * high_radius, high}, u, 0}, normal);
    std::vector<uint32_t>& indices = mesh.part(surface).indices;
    if (i == 0) first = now;
    for (uint32_t last = 0; last < 2; ++last) {
      if (i == 0 || (last == 1 && i + 1 < sides)) continue;
      const auto& a = last == 0 ? previous : now;
      const auto& b = last == 0 ? now : first;
      indices.insert(indices.end(), {a[0], b[0], b[1]});
      if (!is_pointed) indices.insert(indices.end(), {a[0], b[1], a[1]});
    }
    previous = now;
  }
}

}  // namespace

void Bounds::add(const Vec3& p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

void Bounds::add(const Bounds& other) {
  add(other.low);
  add(other.high);
}

uint32_t CityMesh::addVertex(Surface surface, const Corner& corner, const Vec3& normal) {
  SurfacePart& p = part(surface);
  const uint32_t index = p.vertexCount();
  const Vec3 d = corner.position - origin_;
  push(p.positions, {d.x, d.z, -d.y});  // y is up in glTF
  push(p.normals, {normal.x, normal.z, -normal.y});
  p.texcoords.insert(p.texcoords.end(),
                     {static_cast<float>(corner.u), static_cast<float>(corner.v)});
  p.colors.insert(p.colors.end(),
                  {linearOf(color_.red), linearOf(color_.green), linearOf(color_.blue), 255});
  p.ids.push_back(static_cast<int32_t>(id_));
  bounds_.add(corner.position);
  return index;
}

void CityMesh::addFace(Surface surface, std::span<const Corner> corners) {
  const Vec3& a = corners[0].position;
  const Vec3 normal = unit(cross(corners[1].position - a, corners[2].position - a));
  const uint32_t first = part(surface).vertexCount();
  const auto count = static_cast<uint32_t>(corners.size());
  for (const Corner& corner : corners) addVertex(surface, corner, normal);
  SurfacePart& p = part(surface);
  for (uint32_t i = 0; i < count; ++i) {
    p.outline.insert(p.outline.end(), {first + i, first + (i + 1) % count});
    if (i + 2 < count) p.indices.insert(p.indices.end(), {first, first + i + 1, first + i + 2});
  }
}

void addHouse(CityMesh& mesh, const House& house, uint32_t id) {
  const Rgb roof = kRoofColors[house.roof_color];
  mesh.begin(kWallColors[house.wall_color], id);
  Box box = {house.frame, house.width_m / 2, house.depth_m / 2};
  if (house.is_turned) {
    const test::CosSin d = house.frame.direction;
    box = {{house.frame.origin, {-d.sin, d.cos}}, house.depth_m / 2, house.width_m / 2};
  }
  const double eaves = house.floor_count * kFloor;
  for (uint32_t i = 0; i < 4; ++i) {
    const double rise = i % 2 == 1 && !house.has_hips ? house.roof_m : 0;
    addFacade(mesh, box.corner(i), box.corner((i + 1) % 4), eaves, rise);
  }
  if (house.has_hips) {
    if (box.x < box.y) {
      const test::CosSin d = box.frame.direction;
      box = {{box.frame.origin, {-d.sin, d.cos}}, box.y, box.x};
    }
    addHippedRoof(mesh, box, eaves, house.roof_m, roof);
  } else {
    addGabledRoof(mesh, box, eaves, house.roof_m, roof);
  }
  if (house.has_chimney) addChimney(mesh, house);
}

std::vector<Feature> addMarket(CityMesh& mesh, const CityPlan& plan) {
  constexpr double kNave = 9;
  const auto at = [&](double x, double y) { return Frame{plan.onGround(x, y), {1, 0}}; };
  mesh.begin(kSandstone, 0);
  const Box nave = {at(-4, 9), 13, 5.5};
  addStoneBox(mesh, nave, kFoundation, kNave, false);
  addStoneGables(mesh, nave, kNave, 8);
  addGabledRoof(mesh, nave, kNave, 8, kSlate);
  mesh.setColor(kSandstone);
  const Box choir = {at(12, 9), 4, 4};
  addStoneBox(mesh, choir, kFoundation, 7, false);
  addHippedRoof(mesh, choir, 7, 5, kSlate);
  mesh.setColor(kSandstone);
  const Box tower = {at(-20, 9), 3.6, 3.6};
  addStoneBox(mesh, tower, kFoundation, 27, false);
  addHippedRoof(mesh, tower, 27, 17, kSlate);
  House hall;
  hall.frame = at(0, -16);
  hall.width_m = 22;
  hall.depth_m = 11;
  hall.floor_count = 3;
  hall.roof_m = 6;
  hall.has_hips = true;
  hall.wall_color = 6;
  addHouse(mesh, hall, 1);
  mesh.begin(kWallColors[6], 1);
  const Box clock = {hall.frame, 2, 2};
  addStoneBox(mesh, clock, 9, 20, false);
  addHippedRoof(mesh, clock, 20, 5, kRoofColors[1]);
  mesh.begin(kGranite, 2);
  const Box basin = {at(17, -3), 3, 3};
  addStoneBox(mesh, basin, -1, 0.9);
  mesh.setColor(kWaterBlue);
  addStoneBox(mesh, {basin.frame, 0.5, 0.5}, 0.5, 3.2);
  return {{"St. Mary's Church", 44, 1}, {"Town Hall", 25, 3}, {"Market Fountain", 3.2, 0}};
}

std::vector<Feature> addCastle(CityMesh& mesh, const CityPlan& plan) {
  constexpr double kHalf = 19;
  constexpr uint32_t kSides = 8;
  const Frame frame = {plan.castle(), turn(0.06)};
  const Box yard = {frame, kHalf, kHalf * 0.8};
  for (uint32_t i = 0; i < 4; ++i) {
    mesh.begin(kGranite, 0);
    const Vec3 a = yard.corner(i);
    const Vec3 b = yard.corner((i + 1) % 4);
    const Vec3 along = unit(b - a);
    const double length = std::sqrt(dot(b - a, b - a));
    addStoneBox(mesh, {{(a + b) * 0.5, {along.x, along.y}}, length / 2, 0.9}, -8, 7);
    mesh.begin(kGranite, i + 1);
    addRoundTower(mesh, a, 4.2, i == 2 ? 17 : 12, 7, kSides);
  }
  mesh.begin(kSandstone, 5);
  const Box keep = {{frame.toWorld({5, 3, 0}), frame.direction}, 6, 6};
  addStoneBox(mesh, keep, -4, 23, false);
  addHippedRoof(mesh, keep, 23, 8, kRoofColors[1]);
  mesh.begin(kWallColors[0], 6);
  const Box palace = {{frame.toWorld({-8, 6, 0}), frame.direction}, 7, 4.5};
  addStoneBox(mesh, palace, -4, 9, false);
  addStoneGables(mesh, palace, 9, 5);
  addGabledRoof(mesh, palace, 9, 5, kRoofColors[2]);
  return {{"Castle Wall", 7, 0},   {"South-west Tower", 19, 3}, {"South-east Tower", 19, 3},
          {"Powder Tower", 24, 5}, {"North-west Tower", 19, 3}, {"Keep", 31, 7},
          {"Knights' Hall", 14, 2}};
}

std::vector<Feature> addBridges(CityMesh& mesh, const CityPlan& plan) {
  constexpr double kLevel = 5.6;
  constexpr double kHalf = 52;
  constexpr double kWidth = 5;
  const double middle = plan.riverAt(0);
  mesh.begin(kSandstone, 0);
  const auto at = [&](double x, double y) { return Frame{{x, middle + y, 0}, {1, 0}}; };
  addStoneBox(mesh, {at(0, 0), kWidth, kHalf}, kLevel - 1.4, kLevel);
  for (const double side : {-1.0, 1.0}) {
    addStoneBox(mesh, {at(side * (kWidth + 0.3), 0), 0.3, kHalf}, kLevel - 1.4, kLevel + 1.1);
  }
  for (const double pier : {-22.0, -7.5, 7.5, 22.0}) {
    addStoneBox(mesh, {at(0, pier), kWidth + 0.8, 1.5}, -4, kLevel - 1.4, false);
  }
  return {{"Old Bridge", kLevel, 0}};
}

void addConifer(CityMesh& mesh) {
  mesh.begin(kBark, 0);
  addCone(mesh, Surface::kLeaves, 5, -1, 0.4, 2.2, 0.3);
  mesh.setColor(kConiferGreen);
  addCone(mesh, Surface::kLeaves, 8, 1.4, 2.5, 5.2, 0.8);
  addCone(mesh, Surface::kLeaves, 8, 4.2, 1.9, 9, 0);
}

void addBroadleaf(CityMesh& mesh) {
  mesh.begin(kBark, 0);
  addCone(mesh, Surface::kLeaves, 5, -1, 0.5, 3, 0.3);
  mesh.setColor(kLeafGreen);
  const TestMesh ball = test::jittered(test::icosphere(1), 5, 0.09f);
  const uint32_t first = mesh.part(Surface::kLeaves).vertexCount();
  for (uint32_t i = 0; i < ball.vertexCount(); ++i) {
    const Vec3 p = at(ball.positions, i);
    mesh.addVertex(Surface::kLeaves, {{p.x * 2.7, p.y * 2.7, 5 + p.z * 3}, 0, 0}, unit(p));
  }
  for (const uint32_t index : ball.indices) {
    mesh.part(Surface::kLeaves).indices.push_back(first + index);
  }
}

void addLamp(CityMesh& mesh) {
  mesh.begin(kIron, 0);
  addCone(mesh, Surface::kLeaves, 6, -0.5, 0.14, 4, 0.09);
  mesh.setColor(kLight);
  addCone(mesh, Surface::kLeaves, 6, 4, 0.2, 4.6, 0.42);
  mesh.setColor(kIron);
  addCone(mesh, Surface::kLeaves, 6, 4.6, 0.55, 5.1, 0);
}

}  // namespace mcc::samples
