// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Where things are in the city that samples/city shows: hills, a river, fields, districts and their
// houses. Coordinates are metres to the east (x), to the north (y) and up (z) from the market.
#ifndef MCC_TOOLS_SAMPLES_CITY_PLAN_H_
#define MCC_TOOLS_SAMPLES_CITY_PLAN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "scene.h"

namespace mcc::samples {

/// How large the city is, and how finely it is modelled.
struct CitySize {
  double extent_m = 1024;        ///< side of the square of land
  double town_radius_m = 215;    ///< where the hills begin
  uint32_t terrain_levels = 3;   ///< of the implicit quadtree
  uint32_t subtree_levels = 2;   ///< of each of its subtrees
  uint32_t terrain_cells = 12;   ///< on a side of each tile
  bool has_ground_ids = false;   ///< feature ids on the terrain
  uint32_t district_count = 2;   ///< on a side of the town
  uint32_t block_count = 2;      ///< on a side of each district
  double chimney_share = 0.2;    ///< of the houses
  uint32_t map_pixels = 256;     ///< on a side of the picture on the terrain
  uint32_t forest_attempts = 0;  ///< places where a tree of the forest may stand
};

enum class Ground : uint8_t {
  kWater,
  kSand,
  kMeadow,
  kGrainField,
  kPloughedField,
  kForest,
  kRock,
  kStreet,
  kYard,
  kGarden,
};

/// A place and a direction on the map.
struct Frame {
  Vec3 origin;
  test::CosSin direction = {1, 0};

  Vec3 toWorld(const Vec3& local) const {
    return origin + Vec3{local.x * direction.cos - local.y * direction.sin,
                         local.x * direction.sin + local.y * direction.cos, local.z};
  }
  Vec3 toLocal(const Vec3& world) const {
    const Vec3 d = world - origin;
    return {d.x * direction.cos + d.y * direction.sin, d.y * direction.cos - d.x * direction.sin,
            d.z};
  }
};

struct House {
  Frame frame;  ///< the middle of its floor; x runs along the street
  double width_m = 0;
  double depth_m = 0;
  uint32_t floor_count = 0;
  double roof_m = 0;       ///< height of the roof alone
  bool is_turned = false;  ///< its gable faces the street
  bool has_hips = false;   ///< a roof with four sides
  bool has_chimney = false;
  uint32_t wall_color = 0;
  uint32_t roof_color = 0;
  std::string name;  ///< its address

  double height() const { return floor_count * 3.0 + roof_m; }
};

/// What the file of a district is.
enum class DistrictKind : uint8_t { kGlb, kB3dm, kInstanced, kComposite };

struct District {
  std::string name;
  DistrictKind kind = DistrictKind::kGlb;
  Frame frame;
  uint32_t block_count = 0;  ///< on a side
  uint32_t park = kNone;     ///< the block without houses; kNone: each has some
  uint32_t gap_percent = 0;  ///< of the plots are gardens
  bool has_rows = true;      ///< houses stand wall to wall
  std::vector<House> houses;
  std::vector<House> rows;  ///< the same seen from afar: one house for a side of a block
  std::vector<Vec3> trees;  ///< in courtyards and gardens
  std::vector<Vec3> lamps;  ///< along the streets
};

/// The sides of blocks and streets, in metres.
inline constexpr double kBlock = 46;
inline constexpr double kStreet = 8;

class CityPlan {
 public:
  explicit CityPlan(const CitySize& size);

  const CitySize& size() const { return size_; }
  const std::vector<District>& districts() const { return districts_; }
  const std::vector<Vec3>& avenueTrees() const { return avenue_trees_; }
  const std::vector<Vec3>& forest() const { return forest_; }

  /// The height of the land, or of the water on it.
  double heightAt(double x, double y) const;
  /// A unit vector.
  Vec3 normalAt(double x, double y) const;
  Ground groundAt(double x, double y) const;
  Vec3 onGround(double x, double y) const { return {x, y, heightAt(x, y)}; }

  /// The y of the river's middle.
  double riverAt(double x) const;
  /// The hill with the castle.
  Vec3 castle() const;

 private:
  double landAt(double x, double y) const;
  bool isOnRoad(double x, double y) const;
  bool inTown(double x, double y, Ground& ground) const;
  void addDistrict(uint32_t column, uint32_t row);
  void addAvenueTrees();
  void addForest();

  CitySize size_;
  std::vector<District> districts_;
  std::vector<Vec3> avenue_trees_;
  std::vector<Vec3> forest_;
};

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_CITY_PLAN_H_
