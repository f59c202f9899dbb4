// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The meshes of the city: flat faces with texture coordinates, colours and feature ids, collected
// by material.
#ifndef MCC_TOOLS_SAMPLES_CITY_MESHES_H_
#define MCC_TOOLS_SAMPLES_CITY_MESHES_H_

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "city_plan.h"
#include "png.h"

namespace mcc::samples {

/// What a face is made of. Each is one material and, in a file, one primitive.
enum class Surface : uint8_t { kWall, kRoof, kStone, kLeaves };
inline constexpr size_t kSurfaceCount = 4;

/// The triangles of one surface.
struct SurfacePart {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> texcoords;
  std::vector<int32_t> colors;  ///< 4 per vertex, 0..255, linear
  std::vector<int32_t> ids;
  std::vector<uint32_t> indices;
  std::vector<uint32_t> outline;  ///< pairs of vertices

  uint32_t vertexCount() const { return static_cast<uint32_t>(positions.size() / 3); }
};

struct Corner {
  Vec3 position;
  double u = 0;
  double v = 0;
};

/// Lowest and highest coordinates.
struct Bounds {
  Vec3 low = {1e9, 1e9, 1e9};
  Vec3 high = {-1e9, -1e9, -1e9};

  void add(const Vec3& p);
  void add(const Bounds& other);
};

class CityMesh {
 public:
  /// Positions are stored relative to `origin`.
  explicit CityMesh(const Vec3& origin = {}) : origin_(origin) {}

  /// The color and the feature id of the faces that follow.
  void begin(Rgb color, uint32_t id) {
    color_ = color;
    id_ = id;
  }
  void setColor(Rgb color) { color_ = color; }
  /// Adds a flat convex face, counter-clockwise, with its edges in the outline.
  void addFace(Surface surface, std::span<const Corner> corners);
  /// Adds one vertex with its own normal, for triangles that the caller adds.
  uint32_t addVertex(Surface surface, const Corner& corner, const Vec3& normal);
  SurfacePart& part(Surface surface) { return parts_[static_cast<size_t>(surface)]; }
  const std::array<SurfacePart, kSurfaceCount>& parts() const { return parts_; }

  const Vec3& origin() const { return origin_; }
  /// In the coordinates of the city.
  const Bounds& bounds() const { return bounds_; }

 private:
  Vec3 origin_;
  Rgb color_ = {255, 255, 255};
  uint32_t id_ = 0;
  Bounds bounds_;
  std::array<SurfacePart, kSurfaceCount> parts_;
};

/// Something with a name that can be picked.
struct Feature {
  std::string name;
  double height_m = 0;
  uint32_t floor_count = 0;
};

void addHouse(CityMesh& mesh, const House& house, uint32_t id);
/// Adds the church, the fountain and the hall of the market with ids from 0 on; returns them.
std::vector<Feature> addMarket(CityMesh& mesh, const CityPlan& plan);
std::vector<Feature> addCastle(CityMesh& mesh, const CityPlan& plan);
std::vector<Feature> addBridges(CityMesh& mesh, const CityPlan& plan);
/// Trees stand at the origin and are about 8 m high.
void addConifer(CityMesh& mesh);
void addBroadleaf(CityMesh& mesh);
void addLamp(CityMesh& mesh);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_CITY_MESHES_H_
