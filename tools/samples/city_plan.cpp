// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "city_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mcc::samples {
namespace {

using test::Random;
using test::turn;

constexpr uint64_t kSeed = 20260;
constexpr double kTownLevel = 5;     // metres above the water
constexpr double kDry = 1.6;         // metres above the water where grass begins
constexpr double kRiverWidth = 44;   // metres
constexpr double kDistrictGap = 42;  // metres between districts
constexpr double kAvenue = 9;        // half of its width
constexpr double kMarket = 27;       // half of its side

constexpr std::array<const char*, 16> kStreetNames = {
    "Mill", "Baker", "Tanner", "Bridge", "Castle", "Linden",  "Weaver",  "Smith",
    "Rose", "Abbey", "Cooper", "Ferry",  "Well",   "Orchard", "Harbour", "Market"};
constexpr std::array<const char*, 4> kStreetKinds = {"Street", "Lane", "Row", "Walk"};
constexpr std::array<const char*, 4> kDistrictNames = {"Old Town", "Tanners' Quarter", "Gardens",
                                                       "Upper Town"};

/// Rises smoothly from 0 at `low` to 1 at `high`.
double smoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double mix(double a, double b, double t) { return a + (b - a) * t; }

/// Returns the side of a district with `blocks` blocks.
double sideOf(uint32_t blocks) { return blocks * (kBlock + kStreet) - kStreet; }

/// Puts houses along one side of a block. `side` is its left end, and x runs along it; houses stand
/// at y > 0.
class HouseRow {
 public:
  HouseRow(const CityPlan& plan, District& district, Random& random)
      : plan_(plan), district_(district), random_(random) {}

  void build(const Frame& side, double length, const std::string& street, uint32_t first_number) {
    const size_t first = district_.houses.size();
    uint32_t number = first_number;
    for (double at = 0; at < length - 4;) {
      double width = random_.between(115, 180) / 10.0;
      if (length - at - width < 10) width = std::min(length - at, 19.0);
      const bool is_gap = random_.chance(district_.gap_percent) && at > 0;
      if (is_gap) {
        addTree(side, at + width / 2, 6);
      } else {
        addHouse(side, at, width, street + " " + std::to_string(number));
      }
      number += 2;
      at += width;
    }
    addRowOf(side, length, first, street);
  }

 private:
  void addTree(const Frame& side, double along, double inward) {
    const Vec3 place = side.toWorld({along, inward, 0});
    district_.trees.push_back(plan_.onGround(place.x, place.y));
  }

  void addHouse(const Frame& side, double at, double width, const std::string& name) {
    House house;
    house.depth_m = random_.between(90, 115) / 10.0;
    const double set_back = district_.has_rows ? 0 : random_.between(10, 40) / 10.0;
    house.width_m = district_.has_rows ? width : width - 1.5;
    const Vec3 middle = side.toWorld({at + width / 2, set_back + house.depth_m / 2, 0});
    house.frame = {plan_.onGround(middle.x, middle.y), side.direction};
    const uint32_t most = district_.has_rows ? 4 : 2;
    house.floor_count = random_.between(most == 4 ? 2 : 1, most);
    house.is_turned = random_.chance(30);
    house.has_hips = !house.is_turned && random_.chance(district_.has_rows ? 12 : 45);
    const double span = house.is_turned ? house.width_m : house.depth_m;
    house.roof_m = span * random_.between(38, 58) / 100.0;
    house.has_chimney = random_.below(1000) < plan_.size().chimney_share * 1000;
    house.wall_color = random_.below(8);
    house.roof_color = random_.below(5);
    house.name = name;
    district_.houses.push_back(house);
  }

  /// Adds the house that stands for all houses from number `first` on.
  void addRowOf(const Frame& side, double length, size_t first, const std::string& street) {
    const size_t count = district_.houses.size() - first;
    if (count == 0) return;
    House row = district_.houses[first];
    uint32_t floors = 0;
    for (size_t i = first; i < district_.houses.size(); ++i) {
      floors += district_.houses[i].floor_count;
    }
    const Vec3 middle = side.toWorld({length / 2, 5, 0});
    row.frame = {plan_.onGround(middle.x, middle.y), side.direction};
    row.width_m = length;
    row.depth_m = 10;
    row.floor_count = std::max<uint32_t>(1, static_cast<uint32_t>(floors / count));
    row.roof_m = 4.5;
    row.is_turned = row.has_hips = row.has_chimney = false;
    row.name = street;
    district_.rows.push_back(row);
  }

  const CityPlan& plan_;
  District& district_;
  Random& random_;
};

/// Plants a block that has no houses.
void addPark(const CityPlan& plan, District& district, Random& random, const Vec3& corner) {
  for (uint32_t i = 0; i < 16; ++i) {
    const double x = 3 + random.below(400) / 10.0;
    const double y = 3 + random.below(400) / 10.0;
    const Vec3 tree = district.frame.toWorld(corner + Vec3{x, y, 0});
    district.trees.push_back(plan.onGround(tree.x, tree.y));
  }
}

/// Builds the four sides of a block and what stands in its courtyard.
void addBlock(const CityPlan& plan, District& district, Random& random, const Vec3& corner) {
  constexpr double kDepth = 12;  // what the houses of the other sides leave of a side
  HouseRow row(plan, district, random);
  const test::CosSin d = district.frame.direction;
  const auto place = [&](double x, double y) {
    const Vec3 world = district.frame.toWorld(corner + Vec3{x, y, 0});
    return Vec3{world.x, world.y, 0};
  };
  const auto street = [&random]() {
    const std::string name = kStreetNames[random.below(kStreetNames.size())];
    return name + " " + kStreetKinds[random.below(kStreetKinds.size())];
  };
  row.build({place(0, 0), d}, kBlock, street(), 1);
  row.build({place(kBlock, kBlock), {-d.cos, -d.sin}}, kBlock, street(), 2);
  row.build({place(kBlock, kDepth), {-d.sin, d.cos}}, kBlock - 2 * kDepth, street(), 1);
  row.build({place(0, kBlock - kDepth), {d.sin, -d.cos}}, kBlock - 2 * kDepth, street(), 2);
  const uint32_t tree_count = random.between(2, 5);
  for (uint32_t i = 0; i < tree_count; ++i) {
    const double x = 15 + random.below(160) / 10.0;
    const Vec3 tree = place(x, 15 + random.below(160) / 10.0);
    district.trees.push_back(plan.onGround(tree.x, tree.y));
  }
  for (const double x : {8.0, 23.0, 38.0}) {
    const Vec3 lamp = place(x, -2.0);
    district.lamps.push_back(plan.onGround(lamp.x, lamp.y));
  }
}

}  // namespace

CityPlan::CityPlan(const CitySize& size) : size_(size) {
  for (uint32_t row = 0; row < size.district_count; ++row) {
    for (uint32_t column = 0; column < size.district_count; ++column) addDistrict(column, row);
  }
  addAvenueTrees();
  addForest();
}

double CityPlan::riverAt(double x) const {
  const double bend = 46 * noise({x / 330, 0.5, 0.5}, kSeed + 1);
  return bend - size_.town_radius_m - 34;
}

Vec3 CityPlan::castle() const {
  const double r = size_.town_radius_m;
  return {0.95 * r + 60, 0.62 * r + 50, kTownLevel + 52};
}

double CityPlan::landAt(double x, double y) const {
  const double r = size_.town_radius_m;
  const double distance = std::sqrt(x * x + y * y);
  const double outside = smoothStep(r, r * 1.3 + 150, distance);
  const double hills = 40 + 46 * fractal({x / 260, y / 260, 0.5}, 4, kSeed + 2);
  double land = kTownLevel + 1.2 * noise({x / 90, y / 90, 0.5}, kSeed + 3);
  land += outside * std::max(hills, -2.0);
  const Vec3 top = castle();
  const double dx = x - top.x;
  const double dy = y - top.y;
  const double from_castle = std::sqrt(dx * dx + dy * dy);
  land = mix(top.z, land, smoothStep(34, 150, from_castle));
  const double from_river = std::abs(y - riverAt(x));
  return mix(-5, land, smoothStep(kRiverWidth / 2 - 8, kRiverWidth / 2 + 84, from_river));
}

double CityPlan::heightAt(double x, double y) const { return std::max(0.0, landAt(x, y)); }

Vec3 CityPlan::normalAt(double x, double y) const {
  constexpr double kStep = 4;
  const double east = heightAt(x + kStep, y) - heightAt(x - kStep, y);
  const double north = heightAt(x, y + kStep) - heightAt(x, y - kStep);
  return unit({-east, -north, 2 * kStep});
}

bool CityPlan::isOnRoad(double x, double y) const {
  constexpr double kHalf = 4.5;
  const double from_town = std::max(0.0, std::sqrt(x * x + y * y) - size_.town_radius_m);
  const double sway = std::min(from_town / 60, 1.0) * 30;
  const double cross_x = sway * noise({0.5, y / 170, 0.5}, kSeed + 4);
  const double cross_y = sway * noise({x / 170, 0.5, 0.5}, kSeed + 5);
  return std::abs(x - cross_x) < kHalf || std::abs(y - cross_y) < kHalf;
}

bool CityPlan::inTown(double x, double y, Ground& ground) const {
  for (const District& district : districts_) {
    const double half = sideOf(district.block_count) / 2;
    const Vec3 local = district.frame.toLocal({x, y, 0});
    const double edge = half + kStreet * 0.75;
    if (std::abs(local.x) > edge || std::abs(local.y) > edge) continue;
    const double in_x = std::fmod(local.x + half + kBlock + kStreet, kBlock + kStreet);
    const double in_y = std::fmod(local.y + half + kBlock + kStreet, kBlock + kStreet);
    if (in_x > kBlock || in_y > kBlock) {
      ground = Ground::kStreet;
      return true;
    }
    const auto column = static_cast<uint32_t>((local.x + half + kStreet) / (kBlock + kStreet));
    const auto row = static_cast<uint32_t>((local.y + half + kStreet) / (kBlock + kStreet));
    const bool is_park = row * district.block_count + column == district.park;
    const double from_side = std::min({in_x, in_y, kBlock - in_x, kBlock - in_y});
    ground = is_park || from_side > 13 || !district.has_rows ? Ground::kGarden : Ground::kYard;
    return true;
  }
  const bool is_market = std::abs(x) < kMarket && std::abs(y) < kMarket;
  const double r = size_.town_radius_m;
  const bool is_avenue = (std::abs(x) < kAvenue || std::abs(y) < kAvenue) && x * x + y * y < r * r;
  if (is_market || is_avenue) ground = Ground::kStreet;
  return is_market || is_avenue;
}

Ground CityPlan::groundAt(double x, double y) const {
  const double land = landAt(x, y);
  if (land < 0) return Ground::kWater;
  if (land < kDry) return Ground::kSand;
  Ground ground = Ground::kMeadow;
  if (inTown(x, y, ground)) return ground;
  if (isOnRoad(x, y)) return Ground::kStreet;
  if (normalAt(x, y).z < 0.8) return Ground::kRock;
  const double woods = fractal({x / 120, y / 120, 0.5}, 3, kSeed + 6);
  const double r = size_.town_radius_m * 1.2;
  const bool is_far = x * x + y * y > r * r;
  if (is_far && woods + land / 90 > 0.55) return Ground::kForest;
  const double row = std::floor((y + 0.3 * x) / 64);
  const double column = std::floor((x - 0.3 * y) / 88 + row * 0.37);
  const auto key = static_cast<uint64_t>(int64_t(row) * 7919 + int64_t(column));
  const uint32_t field = Random(key).below(5);
  if (!is_far || land > 45 || field < 2) return Ground::kMeadow;
  return field == 2 ? Ground::kPloughedField : field == 3 ? Ground::kGrainField : Ground::kGarden;
}

void CityPlan::addDistrict(uint32_t column, uint32_t row) {
  const uint32_t number = row * size_.district_count + column;
  Random random(kSeed + 100 + number);
  District district;
  const double pitch = sideOf(size_.block_count) + kDistrictGap;
  const double first = -pitch * (size_.district_count - 1) / 2;
  const double angle = (random.below(100) / 100.0 - 0.5) * 0.028;
  const Vec3 middle = onGround(first + column * pitch, first + row * pitch);
  district.frame = {middle, turn(angle)};
  district.kind = static_cast<DistrictKind>(number % 4);
  district.name = kDistrictNames[number % 4];
  if (number >= 4) district.name += " " + std::to_string(number / 4 + 1);
  district.block_count = size_.block_count;
  district.has_rows = district.kind != DistrictKind::kInstanced;
  district.gap_percent = district.has_rows ? 5 : 30;
  if (number % 4 == 2 || number % 4 == 3) {
    district.park = random.below(size_.block_count * size_.block_count);
  }
  const double half = sideOf(size_.block_count) / 2;
  for (uint32_t block = 0; block < size_.block_count * size_.block_count; ++block) {
    const uint32_t x = block % size_.block_count;
    const uint32_t y = block / size_.block_count;
    const Vec3 corner = {x * (kBlock + kStreet) - half, y * (kBlock + kStreet) - half, 0};
    (block == district.park ? addPark : addBlock)(*this, district, random, corner);
  }
  districts_.push_back(std::move(district));
}

void CityPlan::addAvenueTrees() {
  Ground ground = Ground::kMeadow;
  for (double at = kMarket + 8; at < size_.town_radius_m; at += 11) {
    for (const double side : {-kAvenue - 3, kAvenue + 3}) {
      for (const double sign : {-1.0, 1.0}) {
        for (const Vec3& place : {Vec3{side, sign * at, 0}, Vec3{sign * at, side, 0}}) {
          if (inTown(place.x, place.y, ground) || landAt(place.x, place.y) < kDry) continue;
          avenue_trees_.push_back(onGround(place.x, place.y));
        }
      }
    }
  }
}

void CityPlan::addForest() {
  Random random(kSeed + 7);
  const auto meters = static_cast<uint32_t>(size_.extent_m) - 8;
  for (uint32_t i = 0; i < size_.forest_attempts; ++i) {
    const double x = random.below(10 * meters) / 10.0 - meters / 2.0;
    const double y = random.below(10 * meters) / 10.0 - meters / 2.0;
    if (groundAt(x, y) == Ground::kForest) forest_.push_back(onGround(x, y));
  }
}

}  // namespace mcc::samples
