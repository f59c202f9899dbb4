// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Models of the kinds that people measure, on which no constant or choice of the codec was fitted.
// All are made from seeds.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <unordered_map>
#include <utility>

#include "models.h"
#include "scene.h"

namespace mcc::samples {
namespace {

using test::cellWalls;
using test::CosSin;
using test::jittered;
using test::Random;
using test::shuffled;
using test::stackedCubes;
using test::tetrahedraAsQuads;
using test::tetrahedralSoup;
using test::turn;

constexpr float kGrey = 0.6f;

GlbBuilder grey(const TestMesh& mesh) { return single(mesh.name, mesh, kGrey, kGrey, kGrey); }

TestMesh named(const char* name, TestMesh mesh) {
  mesh.name = name;
  return mesh;
}

/// Makes a sheet of columns x rows quads with texture coordinates; `place` takes 0..1 twice.
TestMesh sheetOf(uint32_t columns, uint32_t rows,
                 const std::function<Vec3(double, double)>& place) {
  TestMesh mesh;
  for (uint32_t r = 0; r <= rows; ++r) {
    for (uint32_t c = 0; c <= columns; ++c) {
      const double u = static_cast<double>(c) / columns;
      const double v = static_cast<double>(r) / rows;
      push(mesh.positions, place(u, v));
      mesh.texcoords.insert(mesh.texcoords.end(), {static_cast<float>(u), static_cast<float>(v)});
      if (r == rows || c == columns) continue;
      const uint32_t i = r * (columns + 1) + c;
      pushQuad(mesh.indices, i, i + 1, i + columns + 2, i + columns + 1);
    }
  }
  return mesh;
}

/// Adds a mesh of one primitive, and a node for it.
void addObject(GlbBuilder& glb, const TestMesh& mesh, uint32_t material) {
  const uint32_t index = glb.addMesh(mesh.name, Json::array({addPrimitive(glb, mesh, material)}));
  glb.addNode({{"name", mesh.name}, {"mesh", index}});
}

/// Adds an object at its place in rows of `columns` objects, which are `spacing` apart.
void addInRows(GlbBuilder& glb, const char* kind, uint32_t number, TestMesh mesh, uint32_t columns,
               uint32_t spacing, uint32_t material) {
  mesh = test::translated(std::move(mesh), static_cast<float>(number % columns * spacing), 0,
                          static_cast<float>(number / columns * spacing));
  mesh.name = std::string(kind) + " " + std::to_string(number);
  addObject(glb, mesh, material);
}

// ---- Surfaces -----------------------------------------------------------------------------------

GlbBuilder subdivision() {
  TestMesh mesh = test::randomStacked(7, 60);
  for (int i = 0; i < 5; ++i) mesh = loopSubdivided(mesh);
  return grey(named("bench_subdivision", test::withNormals(std::move(mesh))));
}

GlbBuilder terrain() {
  constexpr uint32_t kTiles = 8;
  constexpr uint32_t kCells = 32;
  GlbBuilder glb("bench_terrain");
  const uint32_t material = glb.addMaterial("ground", 0.3f, 0.4f, 0.2f, 0.0f, 0.9f);
  Json primitives = Json::array();
  for (uint32_t tile = 0; tile < kTiles * kTiles; ++tile) {
    const auto place = [tile](double u, double v) {
      const double x = u + tile % kTiles;
      const double z = v + tile / kTiles;
      return Vec3{x, 0.5 * fractal({x, 0, z}, 7, 11), -z};
    };
    const TestMesh mesh = test::withNormals(sheetOf(kCells, kCells, place));
    primitives.push_back(addPrimitive(glb, mesh, material));
  }
  const uint32_t index = glb.addMesh("terrain", primitives);
  glb.addNode({{"name", "terrain"}, {"mesh", index}});
  return glb;
}

/// A terrain in one primitive that has positions alone, as scans of landscapes do.
GlbBuilder largeTerrain() {
  constexpr uint32_t kCells = 3163;
  TestMesh mesh = sheetOf(kCells, kCells, [](double u, double v) {
    return Vec3{8 * u, 0.5 * fractal({8 * u, 0, 8 * v}, 9, 11), -8 * v};
  });
  mesh.texcoords.clear();
  return grey(named("large_terrain", std::move(mesh)));
}

double gyroidField(double x, double y, double z) {
  const CosSin a = turn(1.5 * x);
  const CosSin b = turn(1.5 * y);
  const CosSin c = turn(1.5 * z);
  return a.sin * b.cos + b.sin * c.cos + c.sin * a.cos + 0.4 * noise({3 * x, 3 * y, 3 * z}, 5);
}

/// Does what a marching-cubes program does on n^3 cells over [-1, 1]^3. On a side of a cell with
/// two opposite corners inside, these are kept apart, so that neighbouring cells fit together.
class MarchingCubes {
 public:
  MarchingCubes(uint32_t n, const std::function<double(double, double, double)>& field) : n_(n) {
    for (uint32_t z = 0; z <= n; ++z) {
      for (uint32_t y = 0; y <= n; ++y) {
        for (uint32_t x = 0; x <= n; ++x) {
          const Vec3 p = placeOf({x, y, z});
          values_.push_back(field(p.x, p.y, p.z));
        }
      }
    }
    for (uint32_t z = 0; z < n; ++z) {
      for (uint32_t y = 0; y < n; ++y) {
        for (uint32_t x = 0; x < n; ++x) addCell({x, y, z});
      }
    }
  }

  TestMesh mesh;

 private:
  using Point = std::array<uint32_t, 3>;

  Vec3 placeOf(const Point& p) const {
    const double step = 2.0 / n_;
    return {p[0] * step - 1, p[1] * step - 1, p[2] * step - 1};
  }
  static Point cornerOf(Point cell, uint32_t corner) {
    for (uint32_t axis = 0; axis < 3; ++axis) cell[axis] += corner >> axis & 1;
    return cell;
  }
  size_t numberOf(const Point& p) const {
    return p[0] + (n_ + size_t{1}) * (p[1] + (n_ + size_t{1}) * p[2]);
  }
  bool isInside(const Point& cell, uint32_t corner) const {
    return values_[numberOf(cornerOf(cell, corner))] < 0;
  }

  /// Returns the vertex on the edge between two corners of a cell.
  uint32_t vertexOn(const Point& cell, uint32_t a, uint32_t b) {
    if (a > b) std::swap(a, b);
    const Point from = cornerOf(cell, a);
    const Point to = cornerOf(cell, b);
    const auto [found, is_new] =
        vertices_.try_emplace(numberOf(from) * 8 + (b - a), mesh.vertexCount());
    if (is_new) {
      const double low = values_[numberOf(from)];
      const double t = low / (low - values_[numberOf(to)]);
      push(mesh.positions, placeOf(from) * (1 - t) + placeOf(to) * t);
    }
    return found->second;
  }

  void addCell(const Point& cell) {
    // The corners of each side, counter-clockwise as seen from outside.
    constexpr uint32_t kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    std::unordered_map<uint32_t, uint32_t> next;  // vertex after vertex around the cell's polygons
    std::vector<uint32_t> order;
    for (const auto& side : kSides) {
      for (uint32_t k = 0; k < 4; ++k) {
        if (!isInside(cell, side[k]) || isInside(cell, side[(k + 3) % 4])) continue;
        uint32_t last = k;
        while (isInside(cell, side[(last + 1) % 4])) ++last;
        const uint32_t entry = vertexOn(cell, side[(k + 3) % 4], side[k]);
        next[entry] = vertexOn(cell, side[last % 4], side[(last + 1) % 4]);
        order.push_back(entry);
      }
    }
    for (const uint32_t first : order) {
      std::vector<uint32_t> polygon;
      for (uint32_t v = first; next.count(v) != 0;) {
        polygon.push_back(v);
        const uint32_t after = next[v];
        next.erase(v);
        v = after;
      }
      for (size_t i = 2; i < polygon.size(); ++i) {
        for (const uint32_t v : {polygon[0], polygon[i - 1], polygon[i]}) mesh.indices.push_back(v);
      }
    }
  }

  uint32_t n_;
  std::vector<double> values_;
  std::unordered_map<uint64_t, uint32_t> vertices_;
};

GlbBuilder cubes() { return grey(named("bench_cubes", MarchingCubes(64, gyroidField).mesh)); }

GlbBuilder tetrahedra() {
  return grey(named("bench_tetrahedra", test::isosurface(40, gyroidField)));
}

GlbBuilder scan() {
  TestMesh mesh = test::icosphere(6);
  mesh = test::flipped(std::move(mesh), 3, mesh.indices.size() / 10);
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const Vec3 p = at(mesh.positions, v);
    const double height = 1 + 0.15 * fractal(p * 2, 5, 21);
    const Vec3 moved = p * (height + 0.001 * noise(p * 400, 22));
    mesh.positions[3 * size_t{v}] = static_cast<float>(moved.x);
    mesh.positions[3 * size_t{v} + 1] = static_cast<float>(moved.y);
    mesh.positions[3 * size_t{v} + 2] = static_cast<float>(moved.z);
  }
  mesh.normals.clear();
  mesh.texcoords.clear();
  return grey(named("bench_scan", test::jittered(std::move(mesh), 4, 0.003f)));
}

GlbBuilder cloth() {
  const auto place = [](double u, double v) {
    const double fold = turn(5 * u + 0.3 * noise({2 * u, 3 * v, 0}, 31)).sin;
    const double sag = 0.15 * noise({3 * u, 3 * v, 1}, 32);
    return Vec3{2 * u + 0.02 * fold, 2 * v, 0.06 * (1 - 0.6 * v) * fold + sag};
  };
  return grey(named("bench_cloth", test::withNormals(sheetOf(240, 240, place))));
}

/// Cards of six quads each, all cut from one of eight strips of a texture.
GlbBuilder hair() {
  constexpr uint32_t kCards = 3000;
  constexpr uint32_t kQuads = 6;
  Random random(41);
  std::vector<TestMesh> cards;
  for (uint32_t card = 0; card < kCards; ++card) {
    const Vec3 root = unit(
        {2.0 * double{random.unit()} - 1, double{random.unit()}, 2.0 * double{random.unit()} - 1});
    const Vec3 side = unit(cross(root, {0.01, 1, 0.02})) * 0.03;
    const double bend = 0.3 + 0.5 * double{random.unit()};
    const auto place = [&](double u, double v) {
      return root * (1 + 0.4 * v) + side * (2 * u - 1) + Vec3{0, -bend * v * v, 0};
    };
    TestMesh mesh = sheetOf(1, kQuads, place);
    const float strip = static_cast<float>(random.below(8));
    for (size_t i = 0; i < mesh.texcoords.size(); i += 2) {
      mesh.texcoords[i] = (mesh.texcoords[i] + strip) / 8;
    }
    cards.push_back(test::withNormals(std::move(mesh)));
  }
  TestMesh all;
  for (const TestMesh& card : cards) {
    const uint32_t first = all.vertexCount();
    all.positions.insert(all.positions.end(), card.positions.begin(), card.positions.end());
    all.normals.insert(all.normals.end(), card.normals.begin(), card.normals.end());
    all.texcoords.insert(all.texcoords.end(), card.texcoords.begin(), card.texcoords.end());
    for (const uint32_t v : card.indices) all.indices.push_back(first + v);
  }
  return grey(named("bench_hair", std::move(all)));
}

// ---- Solids -------------------------------------------------------------------------------------

/// A point of the outline of a solid of revolution. At a crease there are two with different
/// normals.
struct OutlinePoint {
  double radius;
  double height;
  double normal_out;
  double normal_up;
};

/// Adds a quarter of a circle from the normal of angle `from` (in turns) to the next.
void addFillet(std::vector<OutlinePoint>& outline, double radius, double height, double fillet,
               double from) {
  constexpr uint32_t kSteps = 6;
  for (uint32_t i = 0; i <= kSteps; ++i) {
    const CosSin a = turn(from + 0.25 * i / kSteps);
    outline.push_back({radius + fillet * a.cos, height + fillet * a.sin, a.cos, a.sin});
  }
}

/// Makes a solid of revolution with normals and texture coordinates.
TestMesh revolved(const std::vector<OutlinePoint>& outline, uint32_t segments) {
  TestMesh mesh;
  const uint32_t points = static_cast<uint32_t>(outline.size());
  for (uint32_t s = 0; s <= segments; ++s) {
    const CosSin a = turn(s == segments ? 0 : static_cast<double>(s) / segments);
    for (uint32_t i = 0; i < points; ++i) {
      const OutlinePoint& o = outline[i];
      push(mesh.positions, {o.radius * a.cos, o.height, o.radius * a.sin});
      push(mesh.normals, {o.normal_out * a.cos, o.normal_up, o.normal_out * a.sin});
      mesh.texcoords.push_back(static_cast<float>(s) / static_cast<float>(segments));
      mesh.texcoords.push_back(static_cast<float>(i) / static_cast<float>(points - 1));
      if (s == segments || i + 1 == points) continue;
      const OutlinePoint& up = outline[i + 1];
      if (o.radius == up.radius && o.height == up.height) continue;  // the crease
      const uint32_t v = s * points + i;
      if (o.radius == 0) {
        mesh.indices.insert(mesh.indices.end(), {v, v + 1, v + points + 1});
      } else if (up.radius == 0) {
        mesh.indices.insert(mesh.indices.end(), {v, v + 1, v + points});
      } else {
        pushQuad(mesh.indices, v, v + 1, v + points + 1, v + points);
      }
    }
  }
  return mesh;
}

/// Turned parts with flanges, holes and fillets.
GlbBuilder cad() {
  GlbBuilder glb("bench_cad");
  const uint32_t material = glb.addMaterial("steel", kGrey, kGrey, kGrey, 1.0f, 0.4f);
  Random random(51);
  for (uint32_t part = 0; part < 60; ++part) {
    const auto between = [&](double low, double high) {
      return low + (high - low) * double{random.unit()};
    };
    const double hole = between(0.2, 0.4);
    const double wide = between(0.8, 1.2);
    const double narrow = between(0.45, 0.7);
    const double thick = between(0.15, 0.3);
    const double tall = between(0.6, 2);
    const double fillet = between(0.02, 0.1);
    std::vector<OutlinePoint> outline = {
        {hole, tall, -1, 0}, {hole, 0, -1, 0}, {hole, 0, 0, -1}, {wide - fillet, 0, 0, -1}};
    addFillet(outline, wide - fillet, fillet, fillet, -0.25);
    addFillet(outline, wide - fillet, thick - fillet, fillet, 0);
    outline.push_back({narrow, thick, 0, 1});
    outline.push_back({narrow, thick, 1, 0});
    addFillet(outline, narrow - fillet, tall - fillet, fillet, 0);
    outline.push_back({hole, tall, 0, 1});
    TestMesh mesh = revolved(outline, 16 + 4 * random.below(12));
    mesh.texcoords.clear();
    addInRows(glb, "part", part, std::move(mesh), 10, 3, material);
  }
  return glb;
}

GlbBuilder props() {
  GlbBuilder glb("bench_props");
  const uint32_t material = glb.addMaterial("clay", 0.6f, 0.3f, 0.2f, 0.0f, 0.8f);
  Random random(61);
  for (uint32_t prop = 0; prop < 400; ++prop) {
    std::vector<OutlinePoint> outline = {{0, 0, 0, -1}};
    const uint32_t rings = random.between(4, 9);
    for (uint32_t i = 0; i < rings; ++i) {
      const Vec3 normal = unit({1, double{random.unit()} - 0.5, 0});
      outline.push_back({0.15 + 0.4 * double{random.unit()}, 0.2 * i, normal.x, normal.y});
    }
    outline.push_back({0, 0.2 * rings, 0, 1});
    addInRows(glb, "prop", prop, revolved(outline, random.between(8, 24)), 20, 1, material);
  }
  return glb;
}

GlbBuilder boxes() {
  GlbBuilder glb("bench_boxes");
  const uint32_t material = glb.addMaterial("box", 0.7f, 0.6f, 0.4f, 0.0f, 0.8f);
  Random random(71);
  for (uint32_t box = 0; box < 1000; ++box) {
    const std::array<double, 3> size = {
        0.2 + double{random.unit()}, 0.2 + 3 * double{random.unit()}, 0.2 + double{random.unit()}};
    const std::array<double, 3> corner = {2.0 * (box % 40), 0, 2.0 * (box / 40)};
    TestMesh mesh;
    mesh.name = "box " + std::to_string(box);
    for (uint32_t side = 0; side < 6; ++side) {
      const uint32_t axis = side / 2;
      const bool far = side % 2 != 0;
      const uint32_t first = mesh.vertexCount();
      for (uint32_t k = 0; k < 4; ++k) {
        const bool u = k == 1 || k == 2;
        const bool v = k >= 2;
        std::array<double, 3> p = corner;
        std::array<double, 3> n = {0, 0, 0};
        p[axis] += far ? size[axis] : 0;
        p[(axis + 1) % 3] += (far ? u : v) ? size[(axis + 1) % 3] : 0;
        p[(axis + 2) % 3] += (far ? v : u) ? size[(axis + 2) % 3] : 0;
        n[axis] = far ? 1 : -1;
        push(mesh.positions, {p[0], p[1], p[2]});
        push(mesh.normals, {n[0], n[1], n[2]});
      }
      pushQuad(mesh.indices, first, first + 1, first + 2, first + 3);
    }
    addObject(glb, mesh, material);
  }
  return glb;
}

constexpr Model kBenchModels[] = {
    {"bench_subdivision.glb", "Loop's subdivision of an irregular cage", subdivision},
    {"bench_terrain.glb", "64 tiles of a terrain, a primitive each", terrain},
    {"bench_cubes.glb", "isosurface by marching cubes", cubes},
    {"bench_tetrahedra.glb", "isosurface by marching tetrahedra", tetrahedra},
    {"bench_scan.glb", "noisy surface with irregular triangles", scan},
    {"bench_cloth.glb", "folded cloth with normals and texture coordinates", cloth},
    {"bench_hair.glb", "3,000 hair cards in one primitive", hair},
    {"bench_cad.glb", "60 turned parts with creases and fillets", cad},
    {"bench_props.glb", "400 small objects with normals and texture coordinates", props},
    {"bench_boxes.glb", "1,000 boxes, a mesh each", boxes},
};

constexpr Model kLargeModels[] = {
    {"large_terrain.glb", "a terrain of 20 million triangles", largeTerrain},
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

std::span<const Model> benchModels() { return kBenchModels; }
std::span<const Model> soupModels() { return kSoups; }

std::span<const Model> largeModels() { return kLargeModels; }

}  // namespace mcc::samples
