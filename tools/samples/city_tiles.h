// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Files of the city's tiles: GLB with and without property tables, b3dm, i3dm, subtrees.
#ifndef MCC_TOOLS_SAMPLES_CITY_TILES_H_
#define MCC_TOOLS_SAMPLES_CITY_TILES_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "city_meshes.h"

namespace mcc::samples {

using Bytes = std::vector<uint8_t>;

/// Who the feature ids of a model are for.
enum class Ids : uint8_t {
  kNone,
  kPropertyTable,  ///< EXT_mesh_features and EXT_structural_metadata
  kBatchTable,     ///< _BATCHID, for a b3dm
};

struct ModelOptions {
  std::string title;
  std::string picture_folder;  ///< URI with '/' at its end; empty: the pictures are embedded
  Ids ids = Ids::kNone;
  std::vector<Feature> features;
  bool has_outline = false;     ///< CESIUM_primitive_outline
  std::vector<Vec3> instances;  ///< places for EXT_mesh_gpu_instancing; empty: the model itself
};

Bytes makeModel(const CityMesh& mesh, const ModelOptions& options);

/// A tile of the terrain; see CityPlan for what it shows. Adds it to `bounds`.
struct TerrainTile {
  uint32_t level = 0;
  uint32_t x = 0;
  uint32_t y = 0;
};
Bytes makeTerrain(const CityPlan& plan, const TerrainTile& tile, const std::string& picture_folder,
                  Bounds& bounds);
/// Whether there is a tile at a place of the quadtree.
bool hasTerrain(const CityPlan& plan, const TerrainTile& tile);

/// A b3dm around a model of Ids::kBatchTable whose origin is `center`.
Bytes makeB3dm(const Bytes& glb, std::span<const Feature> features, const Vec3& center);
/// An i3dm with an instance at each place, of random sizes.
Bytes makeI3dm(const Bytes& glb, std::span<const Vec3> places, uint64_t seed);

/// The subtree whose root is a tile of the terrain.
Bytes makeSubtree(const CityPlan& plan, const TerrainTile& root);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_CITY_TILES_H_
