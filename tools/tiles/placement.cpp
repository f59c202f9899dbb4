// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/placement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gltf/document/package.h"
#include "host/result.h"
#include "json/json.h"

namespace mcc::tiles {
namespace {

using gltf::arrayOf;
using gltf::findMember;
using gltf::Json;
using gltf::Result;

/// Reads an optional member of a node.
bool readOptional(const Json& node, const char* key, double* numbers, size_t count) {
  const Json* given = findMember(node, key);
  return given == nullptr || readNumbers(*given, numbers, count);
}

Result localMatrix(const Json& node, const std::string& path, Matrix& matrix) {
  matrix = kIdentity;
  double t[3] = {0, 0, 0};
  double r[4] = {0, 0, 0, 1};
  double s[3] = {1, 1, 1};
  if (!readOptional(node, "matrix", matrix.data(), 16) ||
      !readOptional(node, "translation", t, 3) || !readOptional(node, "rotation", r, 4) ||
      !readOptional(node, "scale", s, 3)) {
    return gltf::error(path, "the transform of the node is not made of numbers");
  }
  if (findMember(node, "matrix") != nullptr) return {};
  const double x = r[0], y = r[1], z = r[2], w = r[3];
  matrix = {s[0] * (1 - 2 * (y * y + z * z)),
            s[0] * 2 * (x * y + z * w),
            s[0] * 2 * (x * z - y * w),
            0,
            s[1] * 2 * (x * y - z * w),
            s[1] * (1 - 2 * (x * x + z * z)),
            s[1] * 2 * (y * z + x * w),
            0,
            s[2] * 2 * (x * z + y * w),
            s[2] * 2 * (y * z - x * w),
            s[2] * (1 - 2 * (x * x + y * y)),
            0,
            t[0],
            t[1],
            t[2],
            1};
  return {};
}

/// Walks the nodes from those without a parent, and collects the matrices of those with a mesh.
Result meshMatrices(const Json& json, std::vector<Matrix>& matrices) {
  const Json& nodes = arrayOf(json, "nodes");
  struct Visit {
    uint64_t node;
    Matrix parent;
  };
  std::vector<uint8_t> has_parent(nodes.size(), 0);
  std::vector<uint64_t> children;
  for (const Json& node : nodes) {
    for (const Json& child : arrayOf(node, "children")) {
      uint64_t number = 0;
      const bool is_node = gltf::asUnsigned(child, number) && number < nodes.size();
      if (!is_node || has_parent[number] != 0) {
        return gltf::error("/nodes", "the nodes do not form trees");
      }
      has_parent[number] = 1;
    }
  }
  std::vector<Visit> stack;
  for (uint64_t i = 0; i < nodes.size(); ++i) {
    if (has_parent[i] == 0) stack.push_back({i, kIdentity});
  }
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const Json& node = nodes[visit.node];
    Matrix local;
    MCC_GLTF_TRY(localMatrix(node, gltf::at("/nodes", visit.node), local));
    const Matrix matrix = product(visit.parent, local);
    if (findMember(node, "mesh") != nullptr) matrices.push_back(matrix);
    for (const Json& child : arrayOf(node, "children")) {
      uint64_t number = 0;
      if (gltf::asUnsigned(child, number)) stack.push_back({number, matrix});
    }
  }
  return {};
}

double farthestBound(const Json& json) {
  const Json& accessors = arrayOf(json, "accessors");
  double farthest = 0;
  for (const Json& mesh : arrayOf(json, "meshes")) {
    for (const Json& primitive : arrayOf(mesh, "primitives")) {
      const Json* attributes = findMember(primitive, "attributes");
      const Json* position = attributes == nullptr ? nullptr : findMember(*attributes, "POSITION");
      uint64_t number = 0;
      const bool is_accessor =
          position != nullptr && gltf::asUnsigned(*position, number) && number < accessors.size();
      if (!is_accessor) continue;
      for (const char* bound : {"min", "max"}) {
        for (const Json& value : arrayOf(accessors[number], bound)) {
          double coordinate = 0;
          if (gltf::asNumber(value, coordinate) && std::isfinite(coordinate)) {
            farthest = std::max(farthest, std::abs(coordinate));
          }
        }
      }
    }
  }
  return farthest;
}

bool usesExtension(const Json& json, const char* name) {
  for (const Json& used : arrayOf(json, "extensionsUsed")) {
    if (used.is_string() && used.text() == name) return true;
  }
  return false;
}

}  // namespace

Result placementOf(std::span<const uint8_t> file, const TileModel& model, Placement& placement) {
  placement = {};
  Json json;
  MCC_GLTF_TRY(gltf::readJson(file, json));
  std::vector<Matrix> matrices;
  MCC_GLTF_TRY(meshMatrices(json, matrices));
  if (matrices.empty()) matrices.push_back(kIdentity);
  placement.scale = 0;
  bool is_one_frame = !model.is_instanced;
  for (const Matrix& matrix : matrices) {
    placement.scale = std::max(placement.scale, largestScale(matrix));
    is_one_frame = is_one_frame && matrix == matrices[0];
  }
  placement.scale *= model.instance_scale;
  if (!std::isfinite(placement.scale)) {
    return gltf::error("/nodes", "the transforms of the nodes are not finite");
  }
  placement.farthest = farthestBound(json);
  if (usesExtension(json, "EXT_mesh_gpu_instancing")) {
    placement.caveat = "the scales of its instances do not count in the promised error";
  } else if (!arrayOf(json, "skins").empty() || !arrayOf(json, "animations").empty()) {
    placement.caveat = "its nodes move, and the promised error is that of their rest";
  }
  if (!is_one_frame || !placement.caveat.empty()) return {};
  placement.matrix = matrices[0];
  return {};
}

}  // namespace mcc::tiles
