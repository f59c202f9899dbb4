// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "koi.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "koi_picture.h"
#include "koi_shape.h"
#include "scene.h"

namespace mcc::samples {
namespace {

// ---- Skeleton -----------------------------------------------------------------------------------

/// z of the joints of the spine, from the head to the tail.
constexpr std::array<double, 7> kSpine = {0.42, 0.17, -0.08, -0.30, -0.50, -0.68, -0.84};
constexpr uint32_t kLeftFin = kSpine.size();
constexpr uint32_t kRightFin = kLeftFin + 1;
constexpr uint32_t kJointCount = kRightFin + 1;

Vec3 placeOfJoint(uint32_t joint) {
  if (joint < kSpine.size()) return {0, 0, kSpine[joint]};
  return pectoralRoot(joint == kLeftFin ? 1 : -1);
}

/// Up to two joints of a vertex.
struct Influence {
  uint32_t joint = 0;
  double second = 0;  ///< weight of joint + 1
};

/// At a joint, a vertex moves half with it and half with the one before.
Influence influenceOfSpine(double z) {
  if (z >= kSpine[0]) return {};
  for (uint32_t j = 0; j + 1 < kSpine.size(); ++j) {
    if (z < kSpine[j + 1]) continue;
    const double along = (kSpine[j] - z) / (kSpine[j] - kSpine[j + 1]) + 0.5;
    if (j == 0 && along < 1) return {0, 0};
    return along < 1 ? Influence{j - 1, along} : Influence{j, along - 1};
  }
  return {kSpine.size() - 1, 0};
}

// ---- Meshes -------------------------------------------------------------------------------------

/// A mesh with everything that a vertex of the koi has.
struct SkinnedMesh {
  TestMesh surface;
  std::vector<int32_t> joints;
  std::vector<int32_t> weights;             ///< their sum is 255
  std::array<std::vector<float>, 2> moves;  ///< of positions, by morph target
  std::array<std::vector<float>, 2> turns;  ///< of normals

  uint32_t add(const Vec3& p, const Vec3& normal, const TexturePlace& place,
               const Influence& influence) {
    push(surface.positions, p);
    push(surface.normals, normal);
    surface.texcoords.insert(surface.texcoords.end(), {place.u, place.v});
    const auto second = static_cast<int32_t>(255 * influence.second + 0.5);
    const auto joint = static_cast<int32_t>(influence.joint);
    // glTF requires joint 0 where the weight is zero.
    for (const int32_t j : {second < 255 ? joint : 0, second > 0 ? joint + 1 : 0, 0, 0}) {
      joints.push_back(j);
    }
    for (const int32_t w : {255 - second, second, 0, 0}) weights.push_back(w);
    return surface.vertexCount() - 1;
  }

  void addMove(size_t target, const Vec3& move, const Vec3& turn) {
    push(moves[target], move);
    push(turns[target], turn);
  }

  /// Adds the triangles of a grid of vertices, row after row.
  void addGrid(uint32_t first, uint32_t rows, uint32_t columns, bool is_first_row_a_point,
               bool is_last_row_a_point) {
    for (uint32_t i = 0; i + 1 < rows; ++i) {
      for (uint32_t j = 0; j + 1 < columns; ++j) {
        const uint32_t a = first + i * columns + j;
        const uint32_t b = a + columns;
        if (!(i == 0 && is_first_row_a_point)) {
          surface.indices.insert(surface.indices.end(), {a, b + 1, a + 1});
        }
        if (!(i + 2 == rows && is_last_row_a_point)) {
          surface.indices.insert(surface.indices.end(), {a, b, b + 1});
        }
      }
    }
  }
};

constexpr std::array<KoiPose, 2> kTargets = {KoiPose{1, 0}, KoiPose{0, 1}};

void addBody(SkinnedMesh& mesh) {
  constexpr uint32_t kRings = 40;
  constexpr uint32_t kSegments = 24;
  for (uint32_t i = 0; i <= kRings; ++i) {
    const double t = static_cast<double>(i) / kRings;
    const double along = t * (0.2 + t * (1.4 - 0.6 * t));  // rings are close at the head
    for (uint32_t j = 0; j <= kSegments; ++j) {
      const double around = static_cast<double>(j) / kSegments;
      const Vec3 p = koiPoint(along, around);
      const Vec3 normal = koiNormal(along, around);
      mesh.add(p, normal, placeOnBody(along, around), influenceOfSpine(p.z));
      for (size_t k = 0; k < kTargets.size(); ++k) {
        mesh.addMove(k, koiPoint(along, around, kTargets[k]) - p,
                     koiNormal(along, around, kTargets[k]) - normal);
      }
    }
  }
  mesh.addGrid(0, kRings + 1, kSegments + 1, true, true);
}

/// Two unit vectors that are at right angles to a unit vector and to each other.
std::array<Vec3, 2> frameOf(const Vec3& axis) {
  const Vec3 side = unit(cross(axis, std::abs(axis.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
  return {side, cross(axis, side)};
}

/// An eye moves with the body where it is.
void addEye(SkinnedMesh& mesh, double side) {
  constexpr uint32_t kRings = 5;
  constexpr uint32_t kSegments = 12;
  constexpr double kRadius = 0.036;
  constexpr double kAlong = 0.105;
  const double around = 0.5 - side * 0.21;
  const Vec3 axis = koiNormal(kAlong, around);
  const Vec3 centre = koiPoint(kAlong, around) - axis * (0.4 * kRadius);
  const std::array<Vec3, 2> frame = frameOf(axis);
  const uint32_t first = mesh.surface.vertexCount();
  for (uint32_t i = 0; i <= kRings; ++i) {
    const double from_axis = static_cast<double>(i) / kRings;
    const test::CosSin polar = test::turn(from_axis * 0.3);
    for (uint32_t j = 0; j <= kSegments; ++j) {
      const double part = static_cast<double>(j) / kSegments;
      const test::CosSin angle = test::turn(j == kSegments ? 0 : part);
      const Vec3 normal =
          axis * polar.cos + (frame[0] * angle.cos + frame[1] * angle.sin) * polar.sin;
      mesh.add(centre + normal * kRadius, normal, placeOnEye(from_axis, part), {});
      for (size_t k = 0; k < kTargets.size(); ++k) mesh.addMove(k, {}, {});
    }
  }
  mesh.addGrid(first, kRings + 1, kSegments + 1, true, false);
}

/// A thin tube at a corner of the mouth, which moves with it.
void addBarbel(SkinnedMesh& mesh, double side, double length) {
  constexpr uint32_t kRings = 5;
  constexpr uint32_t kSegments = 5;
  constexpr double kAlong = 0.035;
  const double around = 0.5 - side * (length > 0.1 ? 0.30 : 0.36);
  const Vec3 root = koiPoint(kAlong, around) - koiNormal(kAlong, around) * 0.01;
  const uint32_t first = mesh.surface.vertexCount();
  for (uint32_t i = 0; i <= kRings; ++i) {
    const double t = static_cast<double>(i) / kRings;
    const Vec3 axis = unit({side * (1 - 0.6 * t), -0.5 - t, 0.5 - 1.2 * t});
    const Vec3 centre =
        root +
        Vec3{side * (t - 0.3 * t * t), -0.5 * t - 0.5 * t * t, 0.5 * t - 0.6 * t * t} * length;
    const std::array<Vec3, 2> frame = frameOf(axis);
    const double radius = 0.011 * std::sqrt(1 - 0.98 * t);
    for (uint32_t j = 0; j <= kSegments; ++j) {
      const double part = static_cast<double>(j) / kSegments;
      const test::CosSin angle = test::turn(j == kSegments ? 0 : part);
      const Vec3 normal = frame[0] * angle.cos + frame[1] * angle.sin;
      mesh.add(centre + normal * radius, normal, placeOnBarbel(t, part), {});
      for (size_t k = 0; k < kTargets.size(); ++k) {
        mesh.addMove(k, koiPoint(kAlong, around, kTargets[k]) - koiPoint(kAlong, around), {});
      }
    }
  }
  mesh.addGrid(first, kRings + 1, kSegments + 1, false, false);
}

void addFin(SkinnedMesh& mesh, const KoiFin& fin) {
  constexpr uint32_t kAcross = 12;
  constexpr uint32_t kOutward = 5;
  const uint32_t first = mesh.surface.vertexCount();
  for (uint32_t i = 0; i <= kAcross; ++i) {
    const double across = static_cast<double>(i) / kAcross;
    for (uint32_t j = 0; j <= kOutward; ++j) {
      const double outward = static_cast<double>(j) / kOutward;
      const Vec3 p = fin.point(across, outward);
      Influence influence = influenceOfSpine(p.z);
      if (fin.joint == KoiFin::Joint::kLeft) influence = {kLeftFin, 0};
      if (fin.joint == KoiFin::Joint::kRight) influence = {kRightFin, 0};
      mesh.add(p, fin.normal(across, outward), placeOnFin(across, outward), influence);
    }
  }
  mesh.addGrid(first, kAcross + 1, kOutward + 1, false, false);
}

// ---- Document -----------------------------------------------------------------------------------

Json addSkinned(GlbBuilder& glb, const SkinnedMesh& mesh, uint32_t material) {
  Json attributes = addAttributes(glb, mesh.surface);
  attributes["JOINTS_0"] = glb.addIntegers(mesh.joints, 4, ComponentType::kUint8, false);
  attributes["WEIGHTS_0"] = glb.addIntegers(mesh.weights, 4, ComponentType::kUint8, true);
  return primitive(attributes, glb.addIndices(mesh.surface.indices), material);
}

/// Only the head moves in a morph target.
uint32_t addMoves(GlbBuilder& glb, const std::vector<float>& moves) {
  std::vector<uint32_t> where;
  std::vector<float> values;
  for (uint32_t v = 0; v < moves.size() / 3; ++v) {
    const Vec3 move = at(moves, v);
    if (dot(move, move) < 1e-12) continue;
    where.push_back(v);
    push(values, move);
  }
  return glb.addSparseZeros(moves.size() / 3, where, values);
}

uint32_t addMaterial(GlbBuilder& glb, const char* name, float roughness, bool double_sided,
                     uint32_t texture) {
  const uint32_t material = glb.addMaterial(name, 1, 1, 1, 0, roughness, double_sided);
  glb.json()["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", texture}};
  return material;
}

uint32_t addMesh(GlbBuilder& glb) {
  SkinnedMesh body;
  addBody(body);
  for (const double side : {1.0, -1.0}) {
    addEye(body, side);
    addBarbel(body, side, 0.13);
    addBarbel(body, side, 0.06);
  }
  SkinnedMesh fins;
  for (const KoiFin& fin : koiFins()) addFin(fins, fin);

  const uint32_t texture = glb.addTexture("koi", koiPicture());
  Json first = addSkinned(glb, body, addMaterial(glb, "skin", 0.28f, false, texture));
  Json targets = Json::array();
  for (size_t k = 0; k < kTargets.size(); ++k) {
    Json target;
    target["POSITION"] = addMoves(glb, body.moves[k]);
    target["NORMAL"] = addMoves(glb, body.turns[k]);
    targets.push_back(target);
  }
  first["targets"] = targets;
  // All primitives of a mesh have its targets; those of the fins move nothing.
  Json second = addSkinned(glb, fins, addMaterial(glb, "fins", 0.5f, true, texture));
  const uint32_t nothing = glb.addSparseZeros(fins.surface.vertexCount());
  second["targets"] = Json::array({Json{{"POSITION", nothing}, {"NORMAL", nothing}},
                                   Json{{"POSITION", nothing}, {"NORMAL", nothing}}});
  const uint32_t mesh = glb.addMesh("koi", Json::array({first, second}));
  glb.json()["meshes"][mesh]["weights"] = {0.0f, 0.0f};
  glb.json()["meshes"][mesh]["extras"] = {{"targetNames", {"mouth", "gills"}}};
  return mesh;
}

/// Adds the joints, each after its parent, and the skin. Returns the node of the first one.
uint32_t addSkeleton(GlbBuilder& glb) {
  const auto first = static_cast<uint32_t>(glb.json()["nodes"].size());
  std::vector<float> inverse_bind;
  Json joints = Json::array();
  for (uint32_t j = 0; j < kJointCount; ++j) {
    const bool is_spine = j < kSpine.size();
    const Vec3 place = placeOfJoint(j);
    const Vec3 parent = j == 0 ? Vec3{} : placeOfJoint(is_spine ? j - 1 : 0);
    const Vec3 offset = place - parent;
    Json node = {{"name", is_spine ? "spine " + std::to_string(j)
                                   : std::string(j == kLeftFin ? "left fin" : "right fin")}};
    node["translation"] = {static_cast<float>(offset.x), static_cast<float>(offset.y),
                           static_cast<float>(offset.z)};
    if (j + 1 < kSpine.size()) node["children"] = {first + j + 1};
    if (j == 0) node["children"] = {first + 1, first + kLeftFin, first + kRightFin};
    joints.push_back(glb.addNode(node, j == 0));
    std::array<float, 16> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    matrix[12] = static_cast<float>(-place.x);
    matrix[13] = static_cast<float>(-place.y);
    matrix[14] = static_cast<float>(-place.z);
    inverse_bind.insert(inverse_bind.end(), matrix.begin(), matrix.end());
  }
  glb.json()["skins"] = Json::array(
      {Json{{"inverseBindMatrices", glb.addPlainFloats(inverse_bind, 16)}, {"joints", joints}}});
  return first;
}

constexpr uint32_t kKeys = 25;  // of one stroke; the last one is the first
constexpr float kSeconds = 2;

/// Adds a rotation by `half_turns(part)` half turns, where part runs from 0 to 1.
template <typename HalfTurns>
void addRotation(GlbBuilder& glb, uint32_t times, uint32_t node, const Vec3& axis,
                 const HalfTurns& half_turns) {
  std::vector<float> rotations;
  for (uint32_t key = 0; key < kKeys; ++key) {
    const double part = static_cast<double>(key % (kKeys - 1)) / (kKeys - 1);
    const test::CosSin half = test::turn(half_turns(part) / 2);
    for (const double x : {axis.x * half.sin, axis.y * half.sin, axis.z * half.sin, half.cos}) {
      rotations.push_back(static_cast<float>(x));
    }
  }
  addChannel(glb, times, glb.addPlainFloats(rotations, 4), node, "rotation");
}

void addSwimming(GlbBuilder& glb, uint32_t fish, uint32_t first_joint) {
  std::vector<float> keys;
  std::vector<float> weights;
  for (uint32_t key = 0; key < kKeys; ++key) {
    const double part = static_cast<double>(key % (kKeys - 1)) / (kKeys - 1);
    keys.push_back(kSeconds * static_cast<float>(key) / (kKeys - 1));
    weights.push_back(static_cast<float>(0.5 - 0.5 * test::turn(part).cos));
    weights.push_back(static_cast<float>(0.5 - 0.5 * test::turn(part - 0.3).cos));
  }
  const uint32_t times = glb.addPlainFloats(keys, 1);
  for (uint32_t j = 0; j < kSpine.size(); ++j) {
    // The wave runs towards the tail and grows; the head swings against it.
    const double height = j == 0 ? -0.022 : 0.012 + 0.008 * j;
    addRotation(glb, times, first_joint + j, {0, 1, 0},
                [&](double part) { return height * test::turn(part - 0.10 * j).sin; });
  }
  for (const uint32_t fin : {kLeftFin, kRightFin}) {
    const double side = fin == kLeftFin ? 1 : -1;
    addRotation(glb, times, first_joint + fin, {0, 0, 1},
                [&](double part) { return side * (0.02 + 0.07 * test::turn(part).sin); });
  }
  addChannel(glb, times, glb.addPlainFloats(weights, 1), fish, "weights");
}

}  // namespace

GlbBuilder koi() {
  GlbBuilder glb("koi");
  const uint32_t mesh = addMesh(glb);
  const uint32_t fish = glb.addNode({{"name", "koi"}, {"mesh", mesh}, {"skin", 0}});
  const uint32_t first_joint = addSkeleton(glb);
  addSwimming(glb, fish, first_joint);
  glb.json()["animations"][0]["name"] = "swim";
  return glb;
}

}  // namespace mcc::samples
