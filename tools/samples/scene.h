// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the generators of samples and of benchmark models share: vectors, and meshes in documents.
#ifndef MCC_TOOLS_SAMPLES_SCENE_H_
#define MCC_TOOLS_SAMPLES_SCENE_H_

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "glb_builder.h"
#include "support/mesh_generators.h"

namespace mcc::samples {

using test::TestMesh;

struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(const Vec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3 unit(const Vec3& a) { return a * (1 / std::sqrt(dot(a, a))); }

inline void push(std::vector<float>& values, const Vec3& v) {
  values.push_back(static_cast<float>(v.x));
  values.push_back(static_cast<float>(v.y));
  values.push_back(static_cast<float>(v.z));
}

inline Vec3 at(const std::vector<float>& values, uint32_t i) {
  return {double{values[size_t{i} * 3]}, double{values[size_t{i} * 3 + 1]},
          double{values[size_t{i} * 3 + 2]}};
}

/// Adds the two triangles of a quad, counter-clockwise a b c d.
inline void pushQuad(std::vector<uint32_t>& indices, uint32_t a, uint32_t b, uint32_t c,
                     uint32_t d) {
  for (const uint32_t v : {a, b, c, a, c, d}) indices.push_back(v);
}

/// Returns a smooth random number of -1 .. 1 for each place: values at the points of the integer
/// lattice, blended between them.
double noise(const Vec3& p, uint64_t seed);

/// Adds up noise of `octaves` sizes, each half as large and half as high as the one before.
double fractal(Vec3 p, uint32_t octaves, uint64_t seed);

/// Does one step of Loop's subdivision of a closed mesh.
TestMesh loopSubdivided(const TestMesh& mesh);

/// Adds the attributes of `mesh`; returns the attribute map of a primitive.
Json addAttributes(GlbBuilder& glb, const TestMesh& mesh);

inline Json primitive(const Json& attributes, uint32_t indices, uint32_t material) {
  return {{"attributes", attributes}, {"indices", indices}, {"material", material}};
}

/// Adds the attributes and then the indices of `mesh`.
Json addPrimitive(GlbBuilder& glb, const TestMesh& mesh, uint32_t material);

/// Adds a channel to the first animation, which is added when it is missing. `times` and `values`
/// are accessors.
void addChannel(GlbBuilder& glb, uint32_t times, uint32_t values, uint32_t node, const char* path);

/// Makes a document with one node, one mesh and one primitive.
GlbBuilder single(const std::string& name, const TestMesh& mesh, float red, float green, float blue,
                  bool double_sided = false);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_SCENE_H_
