// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "scene.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace mcc::samples {

double noise(const Vec3& p, uint64_t seed) {
  const std::array<double, 3> floors = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const std::array<double, 3> rest = {p.x - floors[0], p.y - floors[1], p.z - floors[2]};
  double sum = 0;
  for (uint32_t corner = 0; corner < 8; ++corner) {
    uint64_t key = seed;
    double weight = 1;
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const bool far = (corner >> axis & 1) != 0;
      const double t = rest[axis];
      const double blend = t * t * (3 - 2 * t);
      weight *= far ? blend : 1 - blend;
      key =
          key * 0x9e3779b97f4a7c15u + static_cast<uint64_t>(int64_t(floors[axis]) + (far ? 1 : 0));
    }
    sum += weight * (2.0 * double{test::Random(key).unit()} - 1);
  }
  return sum;
}

double fractal(Vec3 p, uint32_t octaves, uint64_t seed) {
  double sum = 0;
  double height = 1;
  for (uint32_t octave = 0; octave < octaves; ++octave) {
    sum += height * noise(p, seed + octave);
    p = p * 2;
    height /= 2;
  }
  return sum;
}

TestMesh loopSubdivided(const TestMesh& mesh) {
  struct Edge {
    uint32_t middle = 0;
    Vec3 opposite;  // sum over both faces
  };
  std::map<std::pair<uint32_t, uint32_t>, Edge> edges;
  std::vector<Vec3> ring(mesh.vertexCount());
  std::vector<uint32_t> degree(mesh.vertexCount(), 0);
  for (size_t h = 0; h < mesh.indices.size(); ++h) {
    const uint32_t a = mesh.indices[h];
    const uint32_t b = mesh.indices[h / 3 * 3 + (h + 1) % 3];
    const uint32_t c = mesh.indices[h / 3 * 3 + (h + 2) % 3];
    Edge& edge = edges[std::minmax(a, b)];
    edge.opposite = edge.opposite + at(mesh.positions, c);
    ring[a] = ring[a] + at(mesh.positions, b);
    ++degree[a];
  }
  TestMesh fine;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const double n = degree[v];
    const double inner = 0.375 + 0.25 * test::turn(1 / n).cos;
    const double beta = (0.625 - inner * inner) / n;
    push(fine.positions, at(mesh.positions, v) * (1 - n * beta) + ring[v] * beta);
  }
  for (auto& [ends, edge] : edges) {
    edge.middle = fine.vertexCount();
    const Vec3 sum = at(mesh.positions, ends.first) + at(mesh.positions, ends.second);
    push(fine.positions, sum * 0.375 + edge.opposite * 0.125);
  }
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::array<uint32_t, 3> middle{};
    for (size_t k = 0; k < 3; ++k) {
      middle[k] = edges[std::minmax(mesh.indices[t + k], mesh.indices[t + (k + 1) % 3])].middle;
    }
    for (size_t k = 0; k < 3; ++k) {
      for (const uint32_t v : {mesh.indices[t + k], middle[k], middle[(k + 2) % 3]})
        fine.indices.push_back(v);
    }
    fine.indices.insert(fine.indices.end(), middle.begin(), middle.end());
  }
  return fine;
}

Json addAttributes(GlbBuilder& glb, const TestMesh& mesh) {
  Json attributes;
  attributes["POSITION"] = glb.addFloats(mesh.positions, 3);
  if (!mesh.normals.empty()) attributes["NORMAL"] = glb.addFloats(mesh.normals, 3);
  if (!mesh.texcoords.empty()) attributes["TEXCOORD_0"] = glb.addFloats(mesh.texcoords, 2);
  return attributes;
}

Json addPrimitive(GlbBuilder& glb, const TestMesh& mesh, uint32_t material) {
  const Json attributes = addAttributes(glb, mesh);
  return primitive(attributes, glb.addIndices(mesh.indices), material);
}

void addChannel(GlbBuilder& glb, uint32_t times, uint32_t values, uint32_t node, const char* path) {
  Json& json = glb.json;
  if (!json.contains("animations")) {
    json["animations"] = Json::array(
        {Json{{"name", "move"}, {"channels", Json::array()}, {"samplers", Json::array()}}});
  }
  Json& animation = json["animations"][0];
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back({{"input", times}, {"output", values}});
}

GlbBuilder single(const std::string& name, const TestMesh& mesh, float red, float green, float blue,
                  bool double_sided) {
  GlbBuilder glb(name);
  const uint32_t material = glb.addMaterial(name, red, green, blue, 0.0f, 0.45f, double_sided);
  const uint32_t index = glb.addMesh(name, Json::array({addPrimitive(glb, mesh, material)}));
  glb.addNode({{"name", name}, {"mesh", index}});
  return glb;
}

}  // namespace mcc::samples
