// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "koi.h"
#include "png.h"
#include "scene.h"

namespace mcc::samples {
namespace {

using test::cellWalls;
using test::jittered;
using test::shuffled;
using test::stackedCubes;
using test::tetrahedraAsQuads;
using test::tetrahedralSoup;
using test::turn;

// ---- Closed surfaces ----------------------------------------------------------------------------

GlbBuilder sphere() { return single("sphere", test::icosphere(4), 0.05f, 0.45f, 0.5f); }

GlbBuilder torus() { return single("torus", test::torus(64, 32), 0.9f, 0.35f, 0.05f); }

GlbBuilder genus3() {
  TestMesh mesh = test::plateWithTunnels(3, 1);
  for (int i = 0; i < 3; ++i) mesh = loopSubdivided(mesh);
  for (float& x : mesh.positions) x *= 0.3f;
  mesh = test::withNormals(test::translated(std::move(mesh), -1.05f, -0.45f, -0.15f));
  return single("genus3", mesh, 0.55f, 0.12f, 0.4f);
}

// ---- Boundaries ---------------------------------------------------------------------------------

/// Makes a waved square with seven round holes.
TestMesh wavedSheet() {
  constexpr uint32_t kCells = 44;
  constexpr std::array<double, 7> kRadii = {0.24, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15};
  TestMesh flat = test::grid(kCells, kCells, test::QuadSplit::kAlternate);
  std::vector<Vec3> places;
  for (uint32_t v = 0; v < flat.vertexCount(); ++v) {
    places.push_back(at(flat.positions, v) * (2.0 / kCells) - Vec3{1, 1, 0});
  }
  for (size_t hole = 0; hole < kRadii.size(); ++hole) {
    const test::CosSin direction = turn(static_cast<double>(hole) / 6);
    const Vec3 centre = hole == 0 ? Vec3{} : Vec3{0.62 * direction.cos, 0.62 * direction.sin, 0};
    const auto distance = [&](uint32_t v) {
      const double dx = places[v].x - centre.x;
      const double dy = places[v].y - centre.y;
      return std::sqrt(dx * dx + dy * dy);
    };
    std::vector<uint32_t> kept;
    std::vector<uint32_t> border;
    for (size_t t = 0; t < flat.indices.size(); t += 3) {
      const std::array<uint32_t, 3> corners = {flat.indices[t], flat.indices[t + 1],
                                               flat.indices[t + 2]};
      const bool inside = std::any_of(corners.begin(), corners.end(),
                                      [&](uint32_t v) { return distance(v) < kRadii[hole]; });
      std::vector<uint32_t>& list = inside ? border : kept;
      list.insert(list.end(), corners.begin(), corners.end());
    }
    for (const uint32_t v : border) {  // moves the vertices of a hole's border onto a circle
      const double d = distance(v);
      if (d < kRadii[hole]) continue;
      places[v].x = centre.x + (places[v].x - centre.x) * kRadii[hole] / d;
      places[v].y = centre.y + (places[v].y - centre.y) * kRadii[hole] / d;
    }
    flat.indices = std::move(kept);
  }
  TestMesh mesh;
  std::vector<uint32_t> renumbered(places.size(), kNone);
  for (const uint32_t v : flat.indices) {
    if (renumbered[v] == kNone) {
      renumbered[v] = mesh.vertexCount();
      constexpr double kTau = 6.283185307179586;
      const test::CosSin u = turn(0.6 * places[v].x);
      const test::CosSin w = turn(0.6 * places[v].y);
      push(mesh.positions, {places[v].x, 0.15 * u.sin * w.cos, -places[v].y});
      push(mesh.normals, unit({-0.09 * kTau * u.cos * w.cos, 1, -0.09 * kTau * u.sin * w.sin}));
    }
    mesh.indices.push_back(renumbered[v]);
  }
  return mesh;
}

GlbBuilder sheet() { return single("sheet_with_holes", wavedSheet(), 0.1f, 0.5f, 0.15f, true); }

GlbBuilder moebius() { return single("moebius", test::moebius(96, 8), 0.85f, 0.6f, 0.1f, true); }

// ---- Textured: a rounded cube of six charts -----------------------------------------------------

constexpr uint32_t kChartsAcross = 4;
constexpr uint32_t kChartsDown = 2;

std::vector<uint8_t> colourTexture() {
  constexpr uint32_t kChart = 32;
  constexpr uint8_t kColours[8][3] = {{222, 74, 62},  {240, 160, 40}, {236, 210, 70}, {70, 170, 90},
                                      {60, 120, 200}, {140, 80, 170}, {90, 90, 90},   {90, 90, 90}};
  std::vector<uint8_t> rgb;
  for (uint32_t y = 0; y < kChartsDown * kChart; ++y) {
    for (uint32_t x = 0; x < kChartsAcross * kChart; ++x) {
      const uint32_t chart = y / kChart * kChartsAcross + x / kChart;
      const int dx = static_cast<int>(x % kChart * 2) - 31;
      const int dy = static_cast<int>(y % kChart * 2) - 31;
      const bool ring = dx * dx + dy * dy < 23 * 23 && dx * dx + dy * dy > 14 * 14;
      const bool check = ((x / 4 ^ y / 4) & 1) != 0;
      for (const uint8_t c : kColours[chart]) {
        rgb.push_back(static_cast<uint8_t>(ring ? 250 : (check ? c : c * 4 / 5)));
      }
    }
  }
  return encodePng(kChartsAcross * kChart, kChartsDown * kChart, rgb);
}

/// Returns the tangent-space normals of a field of round bumps.
std::vector<uint8_t> normalTexture() {
  constexpr uint32_t kChart = 16;
  constexpr uint32_t kBump = 8;
  std::vector<uint8_t> rgb;
  for (uint32_t y = 0; y < kChartsDown * kChart; ++y) {
    for (uint32_t x = 0; x < kChartsAcross * kChart; ++x) {
      const double dx = (2.0 * (x % kBump) + 1) / kBump - 1;
      const double dy = (2.0 * (y % kBump) + 1) / kBump - 1;
      const bool bump = dx * dx + dy * dy < 0.8;
      const Vec3 n =
          unit({bump ? 0.5 * dx : 0, bump ? -0.5 * dy : 0, 1});  // rows go down, but green goes up
      for (const double c : {n.x, n.y, n.z}) {
        rgb.push_back(static_cast<uint8_t>(std::floor((c + 1) * 127.5 + 0.5)));
      }
    }
  }
  return encodePng(kChartsAcross * kChart, kChartsDown * kChart, rgb);
}

GlbBuilder textured() {
  constexpr uint32_t kCells = 16;
  constexpr double kFlat = 0.55;  // half the width of the flat middle of a side
  TestMesh mesh;
  std::vector<float> tangents;
  for (uint32_t side = 0; side < 6; ++side) {
    // The side's normal, u and v directions are the axes in turn, so that u x v = n.
    const uint32_t axis = side / 2;
    const double sign = side % 2 == 0 ? 1 : -1;
    const auto on_axis = [](uint32_t k, double length) {
      return Vec3{k == 0 ? length : 0, k == 1 ? length : 0, k == 2 ? length : 0};
    };
    const Vec3 n = on_axis(axis, sign);
    const Vec3 u = on_axis((axis + 1) % 3, sign);
    const Vec3 v = on_axis((axis + 2) % 3, 1);
    const uint32_t column = side % kChartsAcross;
    const uint32_t row = side / kChartsAcross;
    const uint32_t base = mesh.vertexCount();
    for (uint32_t j = 0; j <= kCells; ++j) {
      for (uint32_t i = 0; i <= kCells; ++i) {
        const double s = 2.0 * i / kCells - 1;
        const double t = 2.0 * j / kCells - 1;
        const Vec3 p =
            n + u * s + v * t;  // small binary fractions are exact, so sides meet bit for bit
        const auto middle = [=](double x) { return std::clamp(x, -kFlat, kFlat); };
        const Vec3 core = {middle(p.x), middle(p.y), middle(p.z)};
        const Vec3 normal = unit(p - core);
        push(mesh.positions, (core + normal * (1 - kFlat)) * 0.6);
        push(mesh.normals, normal);
        mesh.texcoords.push_back(
            static_cast<float>((column + 0.03 + 0.94 * i / kCells) / kChartsAcross));
        mesh.texcoords.push_back(
            static_cast<float>((row + 0.97 - 0.94 * j / kCells) / kChartsDown));
        push(tangents, unit(u - normal * dot(u, normal)));
        tangents.push_back(1.0f);
        if (i == kCells || j == kCells) continue;
        const uint32_t a = base + j * (kCells + 1) + i;
        pushQuad(mesh.indices, a, a + 1, a + kCells + 2, a + kCells + 1);
      }
    }
  }
  GlbBuilder glb("textured");
  Json attributes = addAttributes(glb, mesh);
  attributes["TANGENT"] = glb.addFloats(tangents, 4);
  const uint32_t indices = glb.addIndices(mesh.indices);
  const uint32_t material = glb.addMaterial("charts", 1, 1, 1, 0.0f, 0.5f);
  const uint32_t colour = glb.addTexture("colour", colourTexture());
  const uint32_t bumps = glb.addTexture("bumps", normalTexture());
  Json& json = glb.json()["materials"][material];
  json["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", colour}};
  json["normalTexture"] = {{"index", bumps}, {"scale", 0.6f}};
  const uint32_t index =
      glb.addMesh("rounded cube", Json::array({primitive(attributes, indices, material)}));
  glb.addNode({{"name", "rounded cube"}, {"mesh", index}});
  return glb;
}

// ---- Several primitives -------------------------------------------------------------------------

/// Makes the rows first..last of a surface of revolution about y; `profile` holds (radius, y). A
/// row of radius zero is one vertex. The same row has the same bits in every call.
TestMesh revolved(std::span<const std::array<double, 2>> profile, size_t first, size_t last,
                  uint32_t segments) {
  TestMesh mesh;
  std::vector<uint32_t> row_start;
  for (size_t row = first; row <= last; ++row) {
    const auto& before = profile[row == 0 ? 0 : row - 1];
    const auto& after = profile[std::min(row + 1, profile.size() - 1)];
    const bool is_pole = profile[row][0] == 0;
    row_start.push_back(mesh.vertexCount());
    for (uint32_t s = 0; s < (is_pole ? 1 : segments); ++s) {
      const test::CosSin a = turn(static_cast<double>(s) / segments);
      push(mesh.positions, {profile[row][0] * a.cos, profile[row][1], -profile[row][0] * a.sin});
      const double slope_out = after[1] - before[1];
      const double slope_up = before[0] - after[0];
      push(mesh.normals, is_pole ? Vec3{0, slope_up > 0 ? 1.0 : -1.0, 0}
                                 : unit({slope_out * a.cos, slope_up, -slope_out * a.sin}));
    }
  }
  for (size_t row = first; row < last; ++row) {
    const uint32_t low = row_start[row - first];
    const uint32_t high = row_start[row - first + 1];
    for (uint32_t s = 0; s < segments; ++s) {
      const uint32_t next = (s + 1) % segments;
      if (profile[row][0] == 0) {
        for (const uint32_t v : {low, high + next, high + s}) mesh.indices.push_back(v);
      } else if (profile[row + 1][0] == 0) {
        for (const uint32_t v : {low + s, low + next, high}) mesh.indices.push_back(v);
      } else {
        pushQuad(mesh.indices, low + s, low + next, high + next, high + s);
      }
    }
  }
  return mesh;
}

GlbBuilder twoMaterials() {
  // A vase: the foot's centre, up the outer wall, over the rim, down the inner wall to the centre.
  constexpr size_t kRows = 22;
  constexpr size_t kBorder = 14;  // the row that both primitives have
  const auto radius = [](double y) { return 0.42 + 0.2 * turn(0.1 + 0.45 * y).sin; };
  std::vector<std::array<double, 2>> profile = {{0, 0}, {0.3, 0}};
  for (size_t i = 0; i <= kRows; ++i) {
    const double y = 0.03 + 1.67 * static_cast<double>(i) / kRows;
    profile.push_back({radius(y), y});
  }
  for (size_t i = kRows + 1; i-- > 1;) {
    const double y = 0.05 + 1.67 * static_cast<double>(i) / kRows;
    profile.push_back({radius(y) - 0.05, y});
  }
  profile.push_back({0, 0.1});
  GlbBuilder glb("two_materials");
  const uint32_t blue = glb.addMaterial("glaze", 0.03f, 0.12f, 0.5f, 0.0f, 0.15f);
  const uint32_t white = glb.addMaterial("clay", 0.85f, 0.8f, 0.7f, 0.0f, 0.8f);
  Json primitives = Json::array();
  const TestMesh lower = revolved(profile, 0, kBorder, 40);
  const TestMesh upper = revolved(profile, kBorder, profile.size() - 1, 40);
  primitives.push_back(addPrimitive(glb, lower, white));
  primitives.push_back(addPrimitive(glb, upper, blue));
  const uint32_t index = glb.addMesh("vase", primitives);
  glb.addNode({{"name", "vase"}, {"mesh", index}});
  return glb;
}

GlbBuilder sharedVertices() {
  constexpr uint32_t kSegments = 36;
  const TestMesh ball = test::uvSphere(kSegments, 18);
  std::array<std::vector<uint32_t>, 3> panels;
  for (size_t t = 0; t < ball.indices.size(); t += 3) {
    double x = 0;
    double z = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = at(ball.positions, ball.indices[t + k]);
      x += p.x;
      z += p.z;
    }
    uint32_t sector = 0;  // one of six around the axis
    for (uint32_t i = 1; i < 6; ++i) {
      const test::CosSin best = turn((sector + 0.5) / 6);
      const test::CosSin candidate = turn((i + 0.5) / 6);
      if (x * candidate.cos - z * candidate.sin > x * best.cos - z * best.sin) sector = i;
    }
    std::vector<uint32_t>& panel = panels[sector % 3];
    for (size_t k = 0; k < 3; ++k) panel.push_back(ball.indices[t + k]);
  }
  GlbBuilder glb("shared_vertices");
  const std::array<uint32_t, 3> materials = {
      glb.addMaterial("red", 0.75f, 0.05f, 0.05f, 0.0f, 0.4f),
      glb.addMaterial("white", 0.9f, 0.9f, 0.85f, 0.0f, 0.4f),
      glb.addMaterial("blue", 0.05f, 0.2f, 0.7f, 0.0f, 0.4f)};
  const Json attributes = addAttributes(glb, ball);
  Json primitives = Json::array();
  for (size_t i = 0; i < panels.size(); ++i) {
    primitives.push_back(primitive(attributes, glb.addIndices(panels[i]), materials[i]));
  }
  const uint32_t index = glb.addMesh("beach ball", primitives);
  glb.addNode({{"name", "beach ball"}, {"mesh", index}});
  return glb;
}

// ---- Moving -------------------------------------------------------------------------------------

GlbBuilder skinned() {
  constexpr uint32_t kJoints = 4;
  constexpr uint32_t kRowsPerJoint = 9;
  constexpr uint32_t kSegments = 24;
  constexpr double kJointLength = 0.5;
  std::vector<std::array<double, 2>> profile = {{0, 0}};
  for (uint32_t row = 0; row <= kJoints * kRowsPerJoint; ++row) {
    const double part = static_cast<double>(row) / (kJoints * kRowsPerJoint);
    profile.push_back({0.3 * std::sqrt(1 - 0.96 * part), part * kJoints * kJointLength});
  }
  profile.push_back({0, kJoints * kJointLength + 0.04});
  const TestMesh mesh = revolved(profile, 0, profile.size() - 1, kSegments);

  std::vector<int32_t> joints;
  std::vector<float> weights;
  std::vector<float> swelling;
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const Vec3 p = at(mesh.positions, v);
    const double along = std::clamp(p.y / kJointLength - 0.5, 0.0, kJoints - 1.0);
    const int32_t joint = std::min(static_cast<int32_t>(along), static_cast<int32_t>(kJoints) - 2);
    const float second = static_cast<float>(along - joint);
    for (const int32_t j : {joint, second > 0 ? joint + 1 : 0, 0, 0}) joints.push_back(j);
    for (const float w : {1 - second, second, 0.0f, 0.0f}) weights.push_back(w);
    // glTF requires joint 0 where the weight is zero.
    if (second == 1) joints[joints.size() - 4] = 0;
    const double from_middle = std::clamp((p.y - 1) / 0.45, -1.0, 1.0);
    const double swell = 0.8 * (1 - from_middle * from_middle) * (1 - from_middle * from_middle);
    push(swelling, {p.x * swell, 0, p.z * swell});
  }

  GlbBuilder glb("skinned");
  const uint32_t material = glb.addMaterial("tentacle", 0.35f, 0.1f, 0.45f, 0.0f, 0.35f);
  Json attributes = addAttributes(glb, mesh);
  attributes["JOINTS_0"] = glb.addIntegers(joints, 4, ComponentType::kUint8, false);
  attributes["WEIGHTS_0"] = glb.addFloats(weights, 4);
  Json tentacle = primitive(attributes, glb.addIndices(mesh.indices), material);
  tentacle["targets"] = Json::array({Json{{"POSITION", glb.addFloats(swelling, 3)}}});
  const uint32_t index = glb.addMesh("tentacle", Json::array({tentacle}));
  glb.json()["meshes"][index]["weights"] = {0.0f};
  glb.json()["meshes"][index]["extras"] = {{"targetNames", {"swelling"}}};

  const uint32_t body = glb.addNode({{"name", "tentacle"}, {"mesh", index}, {"skin", 0}});
  std::vector<float> inverse_bind;
  Json skeleton = Json::array();
  for (uint32_t j = 0; j < kJoints; ++j) {
    Json node = {{"name", "joint " + std::to_string(j)}};
    if (j > 0) node["translation"] = {0.0, kJointLength, 0.0};
    const uint32_t next = static_cast<uint32_t>(glb.json()["nodes"].size()) + 1;
    if (j + 1 < kJoints) node["children"] = {next};
    skeleton.push_back(glb.addNode(node, j == 0));
    const float down = static_cast<float>(-kJointLength * j);
    for (const float x :
         {1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, down, 0.f, 1.f}) {
      inverse_bind.push_back(x);
    }
  }
  glb.json()["skins"] = Json::array(
      {Json{{"inverseBindMatrices", glb.addPlainFloats(inverse_bind, 16)}, {"joints", skeleton}}});

  constexpr uint32_t kKeys = 17;
  std::vector<float> times;
  std::vector<float> swell_keys;
  for (uint32_t key = 0; key < kKeys; ++key) {
    times.push_back(static_cast<float>(key) * 0.25f);
    swell_keys.push_back(
        static_cast<float>(0.5 - 0.5 * turn(static_cast<double>(key) / (kKeys - 1)).cos));
  }
  const uint32_t time_accessor = glb.addPlainFloats(times, 1);
  for (uint32_t j = 1; j < kJoints; ++j) {
    std::vector<float> rotations;
    for (uint32_t key = 0; key < kKeys; ++key) {
      const double swing = turn(static_cast<double>(key) / (kKeys - 1) - 0.12 * j).sin;
      const test::CosSin half = turn(0.06 * swing);
      for (const double x : {0.0, 0.0, half.sin, half.cos})
        rotations.push_back(static_cast<float>(x));
    }
    addChannel(glb, time_accessor, glb.addPlainFloats(rotations, 4), skeleton[j].get<uint32_t>(),
               "rotation");
  }
  addChannel(glb, time_accessor, glb.addPlainFloats(swell_keys, 1), body, "weights");
  return glb;
}

GlbBuilder morphed() {
  const TestMesh ball = test::icosphere(3);
  TestMesh flat = ball;
  TestMesh star = ball;
  for (uint32_t v = 0; v < ball.vertexCount(); ++v) {
    const Vec3 p = at(ball.positions, v);
    flat.positions[size_t{v} * 3 + 1] *= 0.35f;
    const double grow = 1 + 2.2 * p.x * p.y * p.z + 0.5 * p.y * p.y * p.y * p.y;
    for (size_t k = 0; k < 3; ++k) star.positions[size_t{v} * 3 + k] *= static_cast<float>(grow);
  }
  GlbBuilder glb("morphed");
  const uint32_t material = glb.addMaterial("jelly", 0.8f, 0.15f, 0.3f, 0.0f, 0.3f);
  Json jelly = addPrimitive(glb, ball, material);
  jelly["targets"] = Json::array();
  for (TestMesh target : {flat, star}) {
    target = test::withNormals(std::move(target));
    for (size_t i = 0; i < target.positions.size(); ++i) {
      target.positions[i] -= ball.positions[i];
      target.normals[i] -= ball.normals[i];
    }
    jelly["targets"].push_back(addAttributes(glb, target));
  }
  const uint32_t index = glb.addMesh("jelly", Json::array({jelly}));
  glb.json()["meshes"][index]["weights"] = {0.0f, 0.0f};
  glb.json()["meshes"][index]["extras"] = {{"targetNames", {"flat", "star"}}};
  const uint32_t node = glb.addNode({{"name", "jelly"}, {"mesh", index}});
  const std::vector<float> times = {0, 1, 2, 3, 4};
  const std::vector<float> weights = {0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  const uint32_t time_accessor = glb.addPlainFloats(times, 1);
  addChannel(glb, time_accessor, glb.addPlainFloats(weights, 1), node, "weights");
  return glb;
}

// ---- Odd topology and odd encodings -------------------------------------------------------------

GlbBuilder nonManifold() {
  GlbBuilder glb("non_manifold");
  const std::array<uint32_t, 3> materials = {
      glb.addMaterial("wheel", 0.1f, 0.4f, 0.65f, 0.0f, 0.6f, true),
      glb.addMaterial("knots", 0.8f, 0.45f, 0.1f, 0.0f, 0.6f, true),
      glb.addMaterial("beads", 0.5f, 0.6f, 0.15f, 0.0f, 0.6f, true)};
  const std::array<TestMesh, 3> meshes = {test::book(7, 8, 4), test::bowTies(4, 3, 6),
                                          test::pinchedSpheres(4)};
  const std::array<const char*, 3> names = {"edges of seven faces", "vertices of three fans",
                                            "spheres sharing poles"};
  const std::array<Json, 3> places = {
      Json{{"translation", {0.0, -1.0, 0.0}}, {"scale", {0.25, 0.25, 0.25}}},
      Json{{"translation", {-1.35, -1.75, 0.0}}, {"scale", {0.3, 0.3, 0.3}}},
      Json{{"translation", {1.8, 0.75, 0.0}}, {"scale", {0.25, 0.25, 0.25}}}};
  for (size_t i = 0; i < meshes.size(); ++i) {
    TestMesh mesh = meshes[i];
    mesh.normals.clear();
    const Json made = addPrimitive(glb, mesh, materials[i]);
    Json node = {{"name", names[i]}, {"mesh", glb.addMesh(names[i], Json::array({made}))}};
    node.update(places[i]);
    glb.addNode(node);
  }
  return glb;
}

/// Makes a trefoil knot with 16-bit positions, 8-bit normals and colours, and 16-bit texture
/// coordinates.
GlbBuilder quantized() {
  constexpr uint32_t kAlong = 160;
  constexpr uint32_t kAround = 14;
  constexpr double kExtent = 3.5;
  constexpr double kWave = 0.75;
  std::vector<int32_t> positions;
  std::vector<int32_t> normals;
  std::vector<int32_t> texcoords;
  std::vector<int32_t> colours;
  std::vector<uint32_t> indices;
  const auto put = [](std::vector<int32_t>& values, double x, double scale) {
    values.push_back(static_cast<int32_t>(std::floor(x * scale + 0.5)));
  };
  for (uint32_t i = 0; i <= kAlong; ++i) {
    const double t = i == kAlong ? 0 : static_cast<double>(i) / kAlong;  // the ends meet
    const test::CosSin a = turn(2 * t);
    const test::CosSin b = turn(3 * t);
    const double radius = 2 + kWave * b.cos;
    const Vec3 centre = {radius * a.cos, kWave * b.sin, radius * a.sin};
    const Vec3 along = {-3 * kWave * b.sin * a.cos - 2 * radius * a.sin, 3 * kWave * b.cos,
                        -3 * kWave * b.sin * a.sin + 2 * radius * a.cos};
    const Vec3 side = unit(cross(along, {0, 1, 0}));
    const Vec3 up = unit(cross(side, along));
    for (uint32_t j = 0; j <= kAround; ++j) {
      const test::CosSin c = turn(j == kAround ? 0 : static_cast<double>(j) / kAround);
      const Vec3 normal = side * c.cos + up * c.sin;
      const Vec3 p = centre + normal * 0.42;
      for (const double x : {p.x, p.y, p.z}) put(positions, x / kExtent, 32767);
      for (const double x : {normal.x, normal.y, normal.z}) put(normals, x, 127);
      put(texcoords, static_cast<double>(i) / kAlong, 65535);
      put(texcoords, static_cast<double>(j) / kAround, 65535);
      const double stripes = 0.75 + 0.25 * turn(4.0 * j / kAround * 0.5 + 12 * t).sin;
      for (const double phase : {0.0, 1.0 / 3, 2.0 / 3}) {
        put(colours, stripes * (0.5 + 0.5 * turn(t + phase).cos), 255);
      }
      colours.push_back(255);
      if (i == kAlong || j == kAround) continue;
      const uint32_t v = i * (kAround + 1) + j;
      pushQuad(indices, v, v + 1, v + kAround + 2, v + kAround + 1);
    }
  }
  GlbBuilder glb("quantized");
  glb.json()["extensionsUsed"] = {"KHR_mesh_quantization"};
  glb.json()["extensionsRequired"] = {"KHR_mesh_quantization"};
  Json attributes;
  attributes["POSITION"] = glb.addIntegers(positions, 3, ComponentType::kInt16, true);
  attributes["NORMAL"] = glb.addIntegers(normals, 3, ComponentType::kInt8, true);
  attributes["TEXCOORD_0"] = glb.addIntegers(texcoords, 2, ComponentType::kUint16, true);
  attributes["COLOR_0"] = glb.addIntegers(colours, 4, ComponentType::kUint8, true);
  const uint32_t index_accessor = glb.addIndices(indices);
  const uint32_t material = glb.addMaterial("knot", 1, 1, 1, 0.1f, 0.35f);
  std::vector<uint8_t> grain;
  for (uint32_t i = 0; i < 16 * 16; ++i) {
    for (int channel = 0; channel < 3; ++channel)
      grain.push_back((i / 16 / 2 + i / 2) % 2 != 0 ? 255 : 225);
  }
  const uint32_t texture = glb.addTexture("grain", encodePng(16, 16, grain));
  glb.json()["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", texture}};
  const uint32_t index =
      glb.addMesh("knot", Json::array({primitive(attributes, index_accessor, material)}));
  glb.addNode({{"name", "knot"}, {"mesh", index}, {"scale", {kExtent, kExtent, kExtent}}});
  return glb;
}

GlbBuilder modes() {
  constexpr uint32_t kStrip = 5;
  constexpr uint32_t kFan = 6;
  GlbBuilder glb("modes");
  const auto add_node = [&glb](const char* name, const Json& made, double x) {
    const uint32_t index = glb.addMesh(name, Json::array({made}));
    glb.addNode({{"name", name}, {"mesh", index}, {"translation", {x, 0.0, 0.0}}});
  };

  // A strip over four rows of a waved flag; degenerate triangles lead from row to row.
  constexpr uint32_t kColumns = 16;
  constexpr uint32_t kRows = 4;
  TestMesh flag;
  for (uint32_t row = 0; row <= kRows; ++row) {
    for (uint32_t column = 0; column <= kColumns; ++column) {
      const double wave = turn(1.5 * column / kColumns + 0.1 * row).sin;
      push(flag.positions, {-0.8 + 1.6 * column / kColumns, -0.5 + 1.0 * row / kRows, 0.12 * wave});
    }
  }
  for (uint32_t row = 0; row < kRows; ++row) {
    const uint32_t low = row * (kColumns + 1);
    const uint32_t high = low + kColumns + 1;
    if (row > 0) flag.indices.push_back(high);
    for (uint32_t column = 0; column <= kColumns; ++column) {
      flag.indices.push_back(high + column);
      flag.indices.push_back(low + column);
    }
    if (row + 1 < kRows) flag.indices.push_back(low + kColumns);
  }
  Json strip =
      addPrimitive(glb, flag, glb.addMaterial("strip", 0.8f, 0.2f, 0.1f, 0.0f, 0.6f, true));
  strip["mode"] = kStrip;
  add_node("triangle strip", strip, -3.0);

  TestMesh disc;
  push(disc.positions, {0, 0, 0.3});
  for (uint32_t i = 0; i <= 24; ++i) {
    const test::CosSin a = turn(i == 24 ? 0 : i / 24.0);
    push(disc.positions, {0.6 * a.cos, 0.6 * a.sin, 0});
  }
  Json fan = {{"attributes", addAttributes(glb, disc)},
              {"material", glb.addMaterial("fan", 0.9f, 0.7f, 0.1f, 0.0f, 0.6f, true)},
              {"mode", kFan}};
  add_node("triangle fan without indices", fan, -1.0);

  TestMesh crystal = test::flatShaded(test::bipyramid(6));
  for (float& x : crystal.positions) x *= 0.6f;
  Json loose = {{"attributes", addAttributes(glb, crystal)},
                {"material", glb.addMaterial("loose", 0.1f, 0.6f, 0.4f, 0.0f, 0.3f)}};
  add_node("triangles without indices", loose, 1.0);

  TestMesh plane;
  std::vector<uint32_t> raised;
  std::vector<float> raised_places;
  for (uint32_t row = 0; row <= 12; ++row) {
    for (uint32_t column = 0; column <= 12; ++column) {
      const Vec3 p = {-0.6 + 0.1 * column, -0.6 + 0.1 * row, 0};
      const double height = 0.5 - 4 * dot(p, p);
      if (height > 0.001) {
        raised.push_back(plane.vertexCount());
        push(raised_places, p + Vec3{0, 0, height});
      }
      const uint32_t v = plane.vertexCount();
      push(plane.positions, p);
      if (row < 12 && column < 12) pushQuad(plane.indices, v, v + 1, v + 14, v + 13);
    }
  }
  const uint32_t base = glb.addFloats(plane.positions, 3);
  const uint32_t sparse = glb.addSparseFloats(base, plane.positions, raised, raised_places);
  const uint32_t indices = glb.addIndices(plane.indices);
  const uint32_t blue = glb.addMaterial("sparse", 0.25f, 0.35f, 0.8f, 0.0f, 0.6f, true);
  add_node("sparse accessor over a plane", primitive({{"POSITION", sparse}}, indices, blue), 2.6);
  const uint32_t grey = glb.addMaterial("plane", 0.5f, 0.5f, 0.5f, 0.0f, 0.9f, true);
  add_node("the plane itself", primitive({{"POSITION", base}}, indices, grey), 4.0);
  return glb;
}

constexpr Model kModels[] = {
    {"koi.glb", "a picture, a skin of nine joints and two morph targets: a fish that swims", koi},
    {"sphere.glb", "closed surface of genus 0", sphere},
    {"torus.glb", "closed surface of genus 1", torus},
    {"genus3.glb", "closed surface of genus 3", genus3},
    {"sheet_with_holes.glb", "open sheet with seven holes: eight boundary loops", sheet},
    {"textured.glb", "six charts: UV seams, normals, tangents, colour and normal textures",
     textured},
    {"two_materials.glb", "two primitives of one mesh with their own vertices, meeting in a border",
     twoMaterials},
    {"shared_vertices.glb", "three primitives of one mesh on the same vertices", sharedVertices},
    {"skinned.glb", "skin of four joints, one morph target, both animated", skinned},
    {"morphed.glb", "two morph targets with normals, animated", morphed},
    {"non_manifold.glb", "edges of seven faces, vertices of several fans", nonManifold},
    {"moebius.glb", "Möbius strip: not orientable", moebius},
    {"quantized.glb", "KHR_mesh_quantization: 16 and 8 bit integer attributes, vertex colours",
     quantized},
    {"modes.glb", "triangle strip, fan, no indices, sparse accessor, an accessor shared by two meshes",
     modes},
};

GlbBuilder soupModel(const TestMesh& mesh) { return single(mesh.name, mesh, 0.6f, 0.6f, 0.6f); }

constexpr Model kSoups[] = {
    {"soup_tetrahedra.glb", "tetrahedra, four faces each",
     [] { return soupModel(tetrahedralSoup(12)); }},
    {"soup_tetrahedra_jittered.glb", "the same, moved and shuffled",
     [] { return soupModel(shuffled(jittered(tetrahedralSoup(12), 1, 0.25f), 2)); }},
    {"soup_quads.glb", "tetrahedra as quads: 96,000 triangles on 9,261 vertices",
     [] { return soupModel(tetrahedraAsQuads(1, 20)); }},
    {"soup_quads_jittered.glb", "the same, moved",
     [] { return soupModel(jittered(tetrahedraAsQuads(1, 20), 2, 0.25f)); }},
    {"soup_cubes.glb", "stacked cubes", [] { return soupModel(stackedCubes(1, 20, 100)); }},
    {"soup_cubes_half.glb", "every other cube", [] { return soupModel(stackedCubes(1, 20, 50)); }},
    {"soup_cubes_jittered.glb", "every other cube, moved and shuffled",
     [] { return soupModel(shuffled(jittered(stackedCubes(3, 20, 50), 4, 0.2f), 5)); }},
    {"soup_cells.glb", "walls of cells, moved",
     [] { return soupModel(jittered(cellWalls(20), 1, 0.2f)); }},
};

}  // namespace

std::span<const Model> allModels() { return kModels; }

std::span<const Model> soupModels() { return kSoups; }

}  // namespace mcc::samples
