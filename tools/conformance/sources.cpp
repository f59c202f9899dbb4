// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "sources.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <span>

#include "support/mesh_generators.h"
#include "support/mirrored.h"
#include "support/repeated.h"

namespace mcc::conformance {
namespace {

using namespace test;  // the mesh generators

// ---- Surfaces -----------------------------------------------------------------------------------

TestMesh gyroid(uint32_t n) {
  return isosurface(n, [](double x, double y, double z) {
    return x * x + y * y * 0.7 + z * z * 1.3 + x * y * z - 0.5;
  });
}

/// Every kind of surface, at most a few hundred triangles.
std::vector<TestMesh> makeSurfaces() {
  std::vector<TestMesh> all = {
      tetrahedron(),
      looseTriangles(1),
      looseTriangles(9),
      icosphere(1),
      icosphere(2),
      uvSphere(8, 6),
      torus(9, 7),
      bipyramid(20),
      bipyramid(5),
      deepStack(20),
      randomStacked(3, 40),
      combOfStacks(6, 5),
      mengerSponge(1),
      plateWithTunnels(3, 2),
      plateWithTunnels(1, 3),
      grid(8, 8),
      grid(7, 9, QuadSplit::kAlternate),
      grid(9, 7, QuadSplit::kRows),
      jittered(grid(10, 10, QuadSplit::kRandom, 5), 4, 0.02f),
      sheetWithHoles(4, 1),
      sheetWithHoles(2, 7),
      openFan(12),
      generated(5, 4, 6, 7),
      generated(9, 2, 3, 2),
      generated(11, 1, 0, 1),
      moebius(12, 2),
      kleinBottle(6, 5),
      bowTies(3, 3, 2),
      bowTies(6, 4, 3),
      pinchedSpheres(3),
      book(4, 3, 2),
      book(3, 6, 3),
      fins(5),
      fins(8),
      randomVoxels(3, 4, 50),
      randomVoxels(8, 5, 35),
      tetrahedralSoup(2),
      randomSoup(11),
      doubled(icosphere(0)),
      doubled(grid(4, 4)),
      chartGrid(8, 8, 3),
      chartGrid(6, 6, 2),
      withRandomWedges(torus(7, 5), 4, 3),
      withRandomWedges(book(3, 3, 3), 4, 3),
      withRandomWedges(bowTies(3, 3, 3), 4, 2),
      withEqualTuples(torus(7, 5), 4),
      flatShaded(icosphere(1)),
      flatShaded(torus(7, 5)),
      withIndexDuplicates(icosphere(1), 5, 9),
      withIndexDuplicates(grid(6, 6), 5, 40),
      withPositionDuplicates(icosphere(1), 5, 9),
      withDegenerates(icosphere(1), 5, 9),
      withDegenerates(withIndexDuplicates(grid(6, 6), 1, 8), 2, 30),
      withUnused(icosphere(1), 5, 9),
      withUnused(tetrahedron(), 5, 20),
      withFlippedTriangles(icosphere(2), 3, 20),
      gyroid(5),
      gyroid(7),
      shuffled(icosphere(2), 1),
      unionOf(std::array{icosphere(1), translated(icosphere(1), 3, 0, 0),
                         translated(icosphere(1), 0, 3, 0)},
              "three spheres"),
      unionOf(std::array{torus(6, 5), translated(sheetWithHoles(2, 3), 4, 0, 0)}, "ring and sheet"),
      soup(7, 40, 20, {20, 20, 20, 20}),
      flipped(icosphere(2), 3, 300),
      flipped(torus(12, 9), 5, 400),
  };
  for (TestMesh& mesh : all) {
    if (mesh.normals.empty()) mesh = withNormals(std::move(mesh));
  }
  return all;
}

/// Isosurfaces large enough for their planes to be found.
std::vector<TestMesh> makePlanar() {
  const TestMesh surface = isosurface(16, [](double x, double y, double z) {
    return x * x + y * y * 0.9 + z * z * 0.8 + 0.3 * x * y * z - 0.8;
  });
  std::vector<TestMesh> all = {surface, withUnused(surface, 3, 20),
                               unionOf(std::array{surface, book(3, 2, 2)}, "isosurface and book")};
  for (TestMesh& mesh : all) mesh = withNormals(std::move(mesh));
  return all;
}

const std::vector<TestMesh>& planarSurfaces() {
  static const std::vector<TestMesh> kAll = makePlanar();
  return kAll;
}

const std::vector<TestMesh>& surfaces() {
  static const std::vector<TestMesh> kAll = makeSurfaces();
  return kAll;
}

// ---- Attributes ---------------------------------------------------------------------------------

constexpr uint32_t kBase = kNone;

/// Where on its surface a wedge is. Values are computed from it.
struct Place {
  const TestMesh& mesh;
  uint32_t wedge;

  float position(uint32_t c) const { return mesh.positions[3 * size_t{wedge} + c]; }
  float normal(uint32_t c) const { return mesh.normals[3 * size_t{wedge} + c]; }
  float texcoord(uint32_t c) const {
    if (!mesh.texcoords.empty()) return mesh.texcoords[2 * size_t{wedge} + c];
    return 0.5f + position(c) * 0.31f + position(2) * 0.17f;
  }
};

/// How exact the floats of an attribute are.
enum class Floats : uint8_t { kAny, kDecimal, kFraction, kBinary, kCoarse, kTiny, kSpecial, kHuge };

float shaped(float x, Floats floats, uint32_t digits, Random& random) {
  const auto roundedTo = [](double value, double scale) {
    return static_cast<float>(std::floor(value * scale + 0.5) / scale);
  };
  double power = 1;
  for (uint32_t i = 0; i < digits; ++i) power *= 10;
  switch (floats) {
    case Floats::kAny: return x;
    case Floats::kDecimal: return roundedTo(double{x}, power);
    case Floats::kFraction: return roundedTo(double{x}, std::ldexp(1.0, 2 + digits) - 1);
    case Floats::kBinary: return roundedTo(double{x}, std::ldexp(1.0, digits));
    case Floats::kCoarse: return static_cast<float>(std::floor(x * 3)) * 0.3731f;
    case Floats::kTiny: return x * 1e-41f;
    case Floats::kSpecial: {
      const uint32_t specials[] = {0x7fc00000, 0xffc12345, 0x7f800000, 0xff800000,
                                   0x80000000, 0x00000001, 0x807fffff, 0x7f7fffff};
      return random.chance(85) ? x : std::bit_cast<float>(specials[random.below(8)]);
    }
    case Floats::kHuge: break;
  }
  return random.chance(50) ? x * 3e35f : x * 1e-3f;
}

class SourceBuilder {
 public:
  SourceBuilder(const TestMesh& mesh, uint64_t seed) : mesh_(mesh), random_(seed) {
    piece_.wedge_count = mesh.vertexCount();
    piece_.parts = {mesh.indices};
  }

  Random& random() { return random_; }
  SourcePiece& piece() { return piece_; }
  Place at(uint32_t wedge) const { return {mesh_, wedge}; }
  SourcePiece take() { return std::move(piece_); }

  using Value = std::function<float(const Place&, uint32_t)>;

  /// A float attribute; `value` gives component c.
  void floats(const std::string& name, uint32_t target, const std::string& type, uint8_t bits,
              const Value& value) {
    NamedAttribute a = makeAttribute(name, target, type, ComponentType::kFloat32);
    a.bits = bits;
    for (uint32_t w = 0; w < piece_.wedge_count; ++w) {
      for (uint32_t c = 0; c < a.format.component_count; ++c) a.append(value({mesh_, w}, c));
    }
    piece_.attributes.push_back(std::move(a));
  }
  void integers(const std::string& name, uint32_t target, const std::string& type,
                ComponentType component_type, bool normalized, const Value& value) {
    NamedAttribute a = makeAttribute(name, target, type, component_type, normalized);
    for (uint32_t w = 0; w < piece_.wedge_count; ++w) {
      for (uint32_t c = 0; c < a.format.component_count; ++c) {
        a.appendInteger(static_cast<int64_t>(value({mesh_, w}, c)));
      }
    }
    piece_.attributes.push_back(std::move(a));
  }

  Floats anyFloats() { return static_cast<Floats>(random_.below(6)); }

  void positions(uint8_t bits, Floats floats_kind = Floats::kAny) {
    const uint32_t digits = random_.below(7);
    floats("POSITION", kBase, "VEC3", bits, [=, this](const Place& at, uint32_t c) {
      return shaped(at.position(c), floats_kind, digits, random_);
    });
  }
  void integerPositions(ComponentType type) {
    const float scale = componentBytes(type) == 1 ? 30.0f : 4000.0f;
    const bool is_unsigned = type == ComponentType::kUint8 || type == ComponentType::kUint16;
    integers("POSITION", kBase, "VEC3", type, random_.chance(30), [=](const Place& at, uint32_t c) {
      return std::floor(at.position(c) * scale) + (is_unsigned ? 2 * scale : 0);
    });
  }

  void normals(uint8_t bits, Floats kind = Floats::kAny) {
    const uint32_t digits = random_.below(6);
    const bool exact = bits == 0;
    floats("NORMAL", kBase, "VEC3", bits, [=, this](const Place& at, uint32_t c) {
      return exact ? shaped(at.normal(c), kind, digits, random_) : at.normal(c);
    });
  }

  /// With `beside`, tangents are perpendicular to the normals.
  void tangents(uint8_t bits, bool beside, Floats kind = Floats::kAny) {
    const uint32_t digits = random_.below(6);
    NamedAttribute a = makeAttribute("TANGENT", kBase, "VEC4", ComponentType::kFloat32);
    a.bits = bits;
    for (uint32_t w = 0; w < piece_.wedge_count; ++w) {
      const Place at{mesh_, w};
      double t[3] = {1.0 + 0.3 * double{at.position(0)}, 0.2 * double{at.position(1)} - 0.4,
                     0.7 * double{at.position(2)} + 0.1};
      double dot = 0;
      for (uint32_t c = 0; c < 3; ++c) dot += t[c] * double{at.normal(c)};
      double square = 0;
      for (uint32_t c = 0; c < 3; ++c) {
        if (beside) t[c] -= dot * double{at.normal(c)};
        square += t[c] * t[c];
      }
      const double scale = square > 1e-9 ? 1 / std::sqrt(square) : 0;
      for (uint32_t c = 0; c < 3; ++c) {
        const auto x = static_cast<float>(square > 1e-9 ? t[c] * scale : (c == 0 ? 1.0 : 0.0));
        a.append(bits == 0 ? shaped(x, kind, digits, random_) : x);
      }
      const bool odd = kind == Floats::kSpecial && random_.chance(10);
      a.append(odd ? 0.25f : at.position(1) < 0.1f ? -1.0f : 1.0f);
    }
    piece_.attributes.push_back(std::move(a));
  }

  void texcoords(const std::string& name, uint8_t bits, Floats kind = Floats::kAny) {
    const uint32_t digits = random_.below(6);
    const uint32_t repeat = random_.below(3);
    floats(name, kBase, "VEC2", bits, [=, this](const Place& at, uint32_t c) {
      const float x = at.texcoord(c);
      const float folded = repeat == 0 ? std::fabs(x - 0.5f) : x;
      return shaped(folded, bits == 0 ? kind : Floats::kAny, digits, random_);
    });
  }

  void colors(const std::string& name, uint8_t bits, Floats kind = Floats::kAny) {
    const uint32_t digits = random_.below(6);
    const std::string type = random_.chance(50) ? "VEC3" : "VEC4";
    floats(name, kBase, type, bits, [=, this](const Place& at, uint32_t c) {
      if (c == 3) return 1.0f;
      return shaped(0.5f + at.position(c) * 0.2f + at.normal((c + 1) % 3) * 0.1f,
                    bits == 0 ? kind : Floats::kAny, digits, random_);
    });
  }

  /// Rigid, blended or wild; weights as floats or normalized integers.
  void skin(const std::string& set) {
    const uint32_t way = random_.below(4);
    const uint32_t weights_as = random_.below(4);
    const uint8_t bits = weights_as == 0 ? static_cast<uint8_t>(random_.between(2, 14)) : 0;
    const bool idle = random_.chance(30);
    const bool loose = random_.chance(30);
    NamedAttribute joints =
        makeAttribute("JOINTS_" + set, kBase, "VEC4",
                      random_.chance(50) ? ComponentType::kUint8 : ComponentType::kUint16);
    const ComponentType types[] = {ComponentType::kFloat32, ComponentType::kUint8,
                                   ComponentType::kUint16, ComponentType::kFloat32};
    NamedAttribute weights = makeAttribute("WEIGHTS_" + set, kBase, "VEC4", types[weights_as],
                                           types[weights_as] != ComponentType::kFloat32);
    weights.bits = bits;
    for (uint32_t w = 0; w < piece_.wedge_count; ++w) {
      const Place at{mesh_, w};
      const auto bone = static_cast<int32_t>(std::floor((at.position(0) + 4) * 2));
      uint32_t joint[4] = {};
      float weight[4] = {};
      for (uint32_t k = 0; k < 4; ++k) {
        joint[k] = static_cast<uint32_t>(std::abs(bone) + (way == 3 ? 3 - static_cast<int>(k)
                                                                    : static_cast<int>(k))) %
                   60;
        weight[k] = way == 0 ? (k == 0 ? 1.0f : 0.0f)
                             : std::fabs(at.position(k % 3)) * static_cast<float>(4 - k) + 0.01f;
        if (way == 2 && random_.chance(30)) {
          weight[k] = 0;
          joint[k] = idle ? random_.below(50) : 0;
        }
        if (way == 3 && random_.chance(10)) joint[k] = random_.below(60);
      }
      weight[0] += 0.05f;
      float sum = 0;
      for (const float x : weight) sum += x;
      int32_t rest = types[weights_as] == ComponentType::kUint8 ? 255 : 65535;
      const auto whole = static_cast<float>(rest);
      for (uint32_t k = 0; k < 4; ++k) {
        if (weight[k] == 0 && !idle) joint[k] = 0;
        joints.appendInteger(joint[k]);
        const float share = weight[k] / sum;
        if (types[weights_as] == ComponentType::kFloat32) {
          weights.append(loose && random_.chance(20) ? share * 0.5f : share);
          continue;
        }
        int32_t value = std::min(static_cast<int32_t>(std::floor(share * whole)), rest);
        rest -= value;
        if (k == 3 && !(loose && random_.chance(20)) && weight[3] != 0) value += rest;
        weights.appendInteger(value);
      }
    }
    piece_.attributes.push_back(std::move(joints));
    piece_.attributes.push_back(std::move(weights));
  }

  void custom(const std::string& name, uint32_t target = kBase) {
    static const char* const kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    const std::string type = kTypes[random_.below(7)];
    const auto component_type = static_cast<ComponentType>(random_.below(6));
    const uint32_t digits = random_.below(6);
    const Floats kind = random_.chance(20) ? Floats::kSpecial : anyFloats();
    if (component_type == ComponentType::kFloat32) {
      const uint8_t bits = random_.chance(50) ? 0 : static_cast<uint8_t>(random_.between(1, 24));
      const bool special = bits == 0;
      floats(name, target, type, bits, [=, this](const Place& at, uint32_t c) {
        return shaped(at.position(c % 3) * static_cast<float>(c + 1), special ? kind : Floats::kAny,
                      digits, random_);
      });
      return;
    }
    const bool normalized = component_type != ComponentType::kUint32 && random_.chance(30);
    integers(name, target, type, component_type, normalized, [](const Place& at, uint32_t c) {
      return std::floor(at.position(c % 3) * 37 + static_cast<float>(3 * c) + 120);
    });
  }

  /// Numbers of regions, in order of appearance or not.
  void ids(const std::string& name) {
    const float size = random_.chance(50) ? 1.7f : 5.0f;
    const ComponentType type = random_.chance(50) ? ComponentType::kUint16 : ComponentType::kUint32;
    integers(name, kBase, "SCALAR", type, false, [=, this](const Place& at, uint32_t) {
      const float cell = std::floor(at.position(0) * size) * 7 + std::floor(at.position(1) * size);
      return std::fabs(cell) * 3 + (random_.chance(5) ? 1000.0f : 0.0f);
    });
  }

  void morph(uint32_t target) {
    const uint8_t bits = random_.chance(50) ? 0 : static_cast<uint8_t>(random_.between(4, 14));
    const Floats kind = bits == 0 ? anyFloats() : Floats::kAny;
    const uint32_t digits = random_.below(5);
    const auto moves = [](const Place& at) { return at.position(0) > 0; };
    if (random_.chance(85)) {
      floats("POSITION", target, "VEC3", bits, [=, this](const Place& at, uint32_t c) {
        if (!moves(at)) return 0.0f;
        return shaped(at.position((c + 1) % 3) * 0.1f, kind, digits, random_);
      });
    }
    if (random_.chance(70)) {
      floats("NORMAL", target, "VEC3", bits, [=, this](const Place& at, uint32_t c) {
        if (!moves(at)) return 0.0f;
        return shaped(at.normal((c + 1) % 3) * 0.1f, kind, digits, random_);
      });
    }
    if (random_.chance(50)) {
      floats("TANGENT", target, "VEC3", bits, [=, this](const Place& at, uint32_t c) {
        return moves(at) ? shaped(at.normal((c + 2) % 3) * 0.07f, kind, digits, random_) : 0.0f;
      });
    }
    if (random_.chance(20)) {
      floats("TEXCOORD_0", target, "VEC2", bits, [=](const Place& at, uint32_t c) {
        return moves(at) ? at.position(c) * 0.01f : 0.0f;
      });
    }
    if (random_.chance(20)) {
      integers("POSITION_X", target, "VEC3", ComponentType::kInt8, true,
               [](const Place& at, uint32_t c) { return std::floor(at.position(c) * 9); });
    }
  }

  /// Deals triangles out to parts in turn, and adds an empty part after them.
  void split(uint32_t count) {
    std::vector<std::vector<uint32_t>> parts(count + 1);
    for (uint32_t t = 0; t < mesh_.triangleCount(); ++t) {
      std::vector<uint32_t>& part =
          parts[random_.chance(10) ? random_.below(count) : t / 5 % count];
      part.insert(part.end(), mesh_.indices.begin() + 3 * t, mesh_.indices.begin() + 3 * t + 3);
    }
    piece_.parts = std::move(parts);
  }

 private:
  const TestMesh& mesh_;
  Random random_;
  SourcePiece piece_;
};

uint8_t latticeBits(Random& random, uint8_t low, uint8_t high) {
  if (random.chance(8)) return low;
  if (random.chance(8)) return high;
  return static_cast<uint8_t>(random.between(low, high));
}

void addRandomAttributes(SourceBuilder& b) {
  Random& random = b.random();
  switch (random.below(8)) {
    case 0: b.integerPositions(static_cast<ComponentType>(random.below(4))); break;
    case 1: b.positions(0, b.anyFloats()); break;
    case 2: b.positions(0, random.chance(60) ? Floats::kHuge : Floats::kTiny); break;
    default: b.positions(latticeBits(random, 1, 24)); break;
  }
  if (random.chance(20)) return;
  if (random.chance(55)) {
    if (random.chance(60)) {
      b.normals(latticeBits(random, 2, 16));
    } else {
      b.normals(0, random.chance(50) ? Floats::kAny : static_cast<Floats>(random.below(7)));
    }
  }
  if (random.chance(50)) {
    b.texcoords("TEXCOORD_0", random.chance(65) ? latticeBits(random, 1, 24) : uint8_t{0},
                random.chance(30) ? Floats::kSpecial : b.anyFloats());
  }
  if (random.chance(15)) b.texcoords("TEXCOORD_1", latticeBits(random, 1, 24));
  if (random.chance(35)) {
    if (random.chance(60)) {
      b.tangents(latticeBits(random, 2, 16), random.chance(60));
    } else {
      b.tangents(0, random.chance(80), random.chance(60) ? Floats::kAny : Floats::kSpecial);
    }
  }
  if (random.chance(25)) {
    b.colors("COLOR_0", random.chance(50) ? uint8_t{0} : latticeBits(random, 1, 12),
             random.chance(30) ? Floats::kSpecial : b.anyFloats());
  }
  if (random.chance(25)) b.skin(random.chance(70) ? "0" : "3");
  if (random.chance(25)) b.custom("_A");
  if (random.chance(12)) b.custom("_B");
  if (random.chance(15)) b.ids("_ID");
  if (random.chance(25)) {
    b.morph(0);
    if (random.chance(50)) b.morph(1);
  }
}

}  // namespace

Source randomSource(uint64_t seed) {
  Random random(seed);
  Source source;
  const std::vector<TestMesh>& all = surfaces();
  const uint32_t piece_count = random.chance(12) ? random.between(2, 4) : 1;
  const bool indices_only = random.chance(6);
  const uint64_t attributes_seed = random.next();
  for (uint32_t i = 0; i < piece_count; ++i) {
    const TestMesh& mesh = all[random.below(static_cast<uint32_t>(all.size()))];
    source.name += (i == 0 ? "" : "_and_") + mesh.name;
    source.shows += (i == 0 ? "" : ", ") + mesh.name;
    SourceBuilder b(mesh, attributes_seed);
    if (indices_only) {
      b.positions(0);
    } else {
      addRandomAttributes(b);
    }
    if (random.chance(15)) b.split(random.between(1, 5));
    source.pieces.push_back(b.take());
  }
  source.options.variation = seed | 1;
  source.options.indices_only = indices_only;
  source.options.keep_vertex_order = random.chance(15);
  source.options.keep_triangle_order = random.chance(15);
  return source;
}

Source planarSource(uint64_t seed) {
  Random random(seed);
  const std::vector<TestMesh>& all = planarSurfaces();
  const TestMesh& mesh = all[random.below(static_cast<uint32_t>(all.size()))];
  SourceBuilder b(mesh, random.next());
  b.positions(static_cast<uint8_t>(random.between(6, 17)));
  Source source;
  source.name = mesh.name;
  source.shows = mesh.name;
  source.pieces.push_back(b.take());
  source.options.variation = seed | 1;
  return source;
}

namespace {

/// A source whose only piece is made by `fill`.
Source single(const std::string& name, const std::string& shows, const TestMesh& mesh,
              const std::function<void(SourceBuilder&)>& fill) {
  SourceBuilder b(mesh, 1);
  fill(b);
  Source source;
  source.name = name;
  source.shows = shows;
  source.pieces.push_back(b.take());
  return source;
}

void smallSources(std::vector<Source>& all) {
  const auto positionsAt = [](uint8_t bits) {
    return [=](SourceBuilder& b) { b.positions(bits); };
  };
  all.push_back(single("one_triangle", "One triangle, its positions exact", looseTriangles(1),
                       positionsAt(0)));
  all.push_back(single("one_triangle_lattice", "One triangle on a lattice of one bit",
                       looseTriangles(1), positionsAt(1)));
  all.push_back(
      single("tetrahedron", "The smallest closed surface", tetrahedron(), positionsAt(14)));
  Source alone = single("triangles_alone", "Triangles without attributes, which stay accessors",
                        icosphere(0), positionsAt(0));
  alone.options.indices_only = true;
  all.push_back(alone);
  TestMesh unused;
  unused.name = "isolated wedges beside one triangle";
  unused = withUnused(looseTriangles(1), 3, 300);
  unused = withNormals(unused);
  all.push_back(single("mostly_isolated",
                       "One triangle and 300 vertices that no triangle uses: indices of 16 bits",
                       unused, [](SourceBuilder& b) {
                         b.positions(11);
                         b.normals(5);
                       }));
  Source empty = single("empty_piece", "A piece without triangles and wedges before one with some",
                        tetrahedron(), positionsAt(10));
  SourcePiece nothing;
  nothing.parts = {{}};
  nothing.attributes = {makeAttribute("POSITION", kNone, "VEC3", ComponentType::kFloat32)};
  nothing.attributes[0].bits = 10;
  empty.pieces.insert(empty.pieces.begin(), nothing);
  all.push_back(empty);
  Source pieces;
  pieces.name = "nine_pieces";
  pieces.shows = "Nine pieces that share models; those with equal headers say so";
  for (uint32_t i = 0; i < 9; ++i) {
    const TestMesh mesh = i % 2 == 0 ? icosphere(1) : uvSphere(6 + i, 5);
    SourceBuilder b(mesh, 3);
    b.positions(12);
    const Lattice lattice{{-2, -2, -2, 0}, 0.001f};
    b.piece().attributes[0].lattice = lattice;
    pieces.pieces.push_back(b.take());
  }
  all.push_back(pieces);
  all.push_back(
      single("large_numbers", "Set 255, morph target 65535, integers at their limits",
             withNormals(grid(5, 5)), [](SourceBuilder& b) {
               b.positions(14);
               b.texcoords("TEXCOORD_255", 9);
               b.colors("COLOR_255", 6);
               const auto extreme = [](const Place& at, uint32_t c) {
                 const float all_values[] = {
                     0, 1, 4294967040.0f, 2147483648.0f, 4294966784.0f, 2147483520.0f, 65535, 127};
                 return all_values[(at.wedge * 3 + c) % 8];
               };
               for (uint32_t i = 0; i < 5; ++i) {
                 b.integers("_LIMITS_" + std::to_string(i), kBase, i == 3 ? "VEC2" : "VEC3",
                            static_cast<ComponentType>(i), false, extreme);
               }
               b.floats("POSITION", 65534, "VEC3", 8,
                        [](const Place& at, uint32_t c) { return at.position(c) * 0.1f; });
               b.floats("POSITION", 15, "VEC3", 8,
                        [](const Place& at, uint32_t c) { return at.position(2 - c) * 0.1f; });
             }));
  all.push_back(single("aliases", "Attributes that are equal to earlier ones",
                       withNormals(chartGrid(6, 6, 3)), [](SourceBuilder& b) {
                         b.positions(12);
                         b.texcoords("TEXCOORD_0", 10);
                         b.piece().attributes.push_back(b.piece().attributes[1]);
                         b.piece().attributes.back().name = "TEXCOORD_1";
                         b.piece().attributes.back().format.set_index = 1;
                         for (uint32_t target : {0u, 1u}) {
                           b.floats(
                               "POSITION", target, "VEC3", 10,
                               [](const Place& at, uint32_t c) { return at.position(c) * 0.2f; });
                         }
                       }));
}

/// Exact grids: every decimal one, binary ones from end to end.
void gridSources(std::vector<Source>& all) {
  for (uint32_t first = 0; first < 10; first += 5) {
    all.push_back(single("grids_" + std::to_string(first), "Decimal grids",
                         withNormals(torus(7, 6)), [first](SourceBuilder& b) {
                           b.positions(10);
                           for (uint32_t i = first; i < first + 5; ++i) {
                             const double scale = std::pow(10.0, i);
                             b.floats(
                                 "_GRID_" + std::to_string(i), kBase, "SCALAR", 0,
                                 [scale](const Place& at, uint32_t) {
                                   const double x = double{at.position(0)} * 0.03 +
                                                    static_cast<double>(at.wedge) * 0.001;
                                   return static_cast<float>(std::floor(x * scale + 0.5) / scale);
                                 });
                           }
                         }));
  }
  all.push_back(single("grids_binary", "Binary grids with steps of 2^-149 to 2^96",
                       withNormals(torus(7, 6)), [](SourceBuilder& b) {
                         b.positions(10);
                         for (const int exponent : {-149, -148, -130, -60, -7, 3, 70, 96}) {
                           b.floats("_STEP_" + std::to_string(exponent + 149), kBase, "VEC2", 0,
                                    [=](const Place& at, uint32_t c) {
                                      const double x = std::floor(double{at.position(c)} * 90);
                                      return static_cast<float>(std::ldexp(x, exponent));
                                    });
                         }
                       }));
  for (const bool cached : {false, true}) {
    all.push_back(single(cached ? "tails_cached" : "tails_plain",
                         "Binary grids with bits below the step, zeros of both signs among them",
                         withNormals(torus(9, 8)), [cached](SourceBuilder& b) {
                           b.positions(0);
                           b.floats("_TAILS", kBase, "VEC4", 0, [=](const Place& at, uint32_t c) {
                             const auto wedge =
                                 static_cast<float>(cached ? at.wedge % 5 : at.wedge);
                             if ((at.wedge + c) % 7 == 0)
                               return (at.wedge + c) % 2 == 0 ? -0.0f : 0.0f;
                             if ((at.wedge + c) % 11 == 0) return 1e-30f * wedge;
                             return 0.3713f * wedge - 0.0101f * static_cast<float>(c);
                           });
                         }));
  }
}

/// Values at which formulas change: guards that no real model reaches.
void extremeSources(std::vector<Source>& all) {
  const auto spread = [](const Place& at, uint32_t c) {
    return static_cast<float>((at.wedge * 37 + c * 11) % 101);
  };
  all.push_back(single(
      "values_near_1e38", "Exact values around 1e38, where predictions are cut off",
      withNormals(torus(9, 8)), [=](SourceBuilder& b) {
        b.positions(10);
        b.floats("_LARGE", kBase, "VEC3", 0,
                 [=](const Place& at, uint32_t c) { return 1.0e38f + spread(at, c) * 1e34f; });
        b.floats("_LARGEST", kBase, "SCALAR", 0,
                 [=](const Place& at, uint32_t c) { return spread(at, c) * 3.3e36f; });
      }));
  all.push_back(single("charts_near_limits", "Exact chart coordinates around 1e-9 and 1e9",
                       withNormals(torus(9, 8)), [=](SourceBuilder& b) {
                         b.positions(0);
                         b.normals(0);
                         b.texcoords("TEXCOORD_0", 0);
                         for (size_t i = 0; i < b.piece().attributes.back().bytes.size(); i += 4) {
                           const uint32_t n = static_cast<uint32_t>(i / 4);
                           const float x =
                               n % 3 == 0   ? 1e-9f * static_cast<float>(95 + n % 11) / 100
                               : n % 3 == 1 ? 1e9f * static_cast<float>(95 + n % 11) / 100
                                            : static_cast<float>(n % 17) * 1e20f;
                           std::memcpy(&b.piece().attributes.back().bytes[i], &x, 4);
                         }
                         b.tangents(0, true);
                       }));
  for (const uint8_t bits : {uint8_t{0}, uint8_t{9}}) {
    all.push_back(single(bits == 0 ? "huge_positions" : "huge_positions_octahedral",
                         "Positions of up to 1e38, whose faces overflow", withNormals(torus(9, 8)),
                         [=](SourceBuilder& b) {
                           b.floats("POSITION", kBase, "VEC3", 0, [](const Place& at, uint32_t c) {
                             return at.position(c) * 8e37f;
                           });
                           b.normals(bits);
                           b.texcoords("TEXCOORD_0", 0);
                           b.tangents(bits, true);
                           b.floats("POSITION", 0, "VEC3", 0, [](const Place& at, uint32_t c) {
                             return at.normal(c) * 2e38f;
                           });
                           b.floats("NORMAL", 0, "VEC3", 8, [](const Place& at, uint32_t c) {
                             return at.normal((c + 1) % 3) * 0.1f;
                           });
                         }));
  }
  TestMesh instances = chartGrid(12, 12, 2);
  for (size_t i = 0; i < instances.texcoords.size(); ++i) {
    // Every chart is the same, with large steps.
    const auto place = static_cast<uint32_t>(i % 18);
    instances.texcoords[i] = static_cast<float>(place * place * 7 % 19) / 19.0f;
  }
  all.push_back(single("repeated_charts", "Charts whose large residuals repeat", instances,
                       [](SourceBuilder& b) {
                         b.positions(9);
                         b.texcoords("TEXCOORD_0", 16);
                       }));
  all.push_back(single(
      "lattice_differences", "A chart and values whose differences exceed 1e9 steps",
      withNormals(torus(9, 8)), [=](SourceBuilder& b) {
        b.positions(24);
        b.integers("_WIDE", kBase, "VEC2", ComponentType::kUint32, false,
                   [=](const Place& at, uint32_t c) { return spread(at, c) * 42000000.0f; });
        b.integers("TEXCOORD_0", kBase, "VEC2", ComponentType::kUint32, false,
                   [=](const Place& at, uint32_t c) { return spread(at, c + 1) * 42000000.0f; });
        b.colors("COLOR_0", 24);
      }));
  all.push_back(single("flat_faces",
                       "Faces without an area, normals of length 0, positions of no extent",
                       withNormals(grid(5, 5)), [=](SourceBuilder& b) {
                         b.floats("POSITION", kBase, "VEC3", 12, [](const Place& at, uint32_t c) {
                           return c == 0 ? std::floor(at.position(0) * 3) : 0.0f;
                         });
                         b.normals(8);
                         b.texcoords("TEXCOORD_0", 8);
                         b.tangents(8, false);
                       }));
}

/// Vertices, groups and loops beyond the numbers at which searches end.
void crowdedSources(std::vector<Source>& all) {
  const TestMesh meshes[] = {
      bipyramid(90),
      shuffled(bipyramid(90), 3),
      bowTies(2, 40, 2),
      bowTies(3, 5, 70),
      doubled(bipyramid(90)),
      withRandomWedges(bipyramid(90), 4, 5),
      flatShaded(bipyramid(90)),
      book(30, 3, 1),
      unionOf(std::array{grid(24, 2), book(3, 30, 2), moebius(40, 1)}, "long loops"),
      pinchedSpheres(9),
      doubled(sheetWithHoles(5, 3)),
  };
  uint32_t number = 0;
  for (const TestMesh& mesh : meshes) {
    const TestMesh with_normals = mesh.normals.empty() ? withNormals(mesh) : mesh;
    Source source =
        single("crowded_" + std::to_string(++number), "Numbers at which searches end: " + mesh.name,
               with_normals, [](SourceBuilder& b) {
                 b.positions(12);
                 b.normals(8);
                 b.texcoords("TEXCOORD_0", 9);
                 b.colors("COLOR_0", 7);
                 b.floats("_EXACT", kBase, "VEC2", 0, [](const Place& at, uint32_t c) {
                   return at.position(c) * (c == 0 ? 1e36f : 1e-5f);
                 });
               });
    source.options.variation = number;
    source.options.keep_vertex_order = number % 3 != 0;
    source.options.keep_triangle_order = number % 2 == 0;
    all.push_back(source);
  }
}

/// A chain of bipyramids, each sharing a pole with the next: vertices of many triangles, inside two
/// surfaces.
TestMesh poles() {
  std::vector<TestMesh> all;
  for (uint32_t i = 0; i < 8; ++i) {
    all.push_back(translated(bipyramid(13 + i), 0, 0, 2 * static_cast<float>(i)));
  }
  return unionOf(all, "poles");
}

/// Larger surfaces: contexts and tables that small ones do not reach.
void largerSources(std::vector<Source>& all) {
  struct Larger {
    const char* name;
    TestMesh mesh;
  };
  const Larger surfaces[] = {
      {"irregular", flipped(icosphere(3), 3, 12000)},
      {"wavy", jittered(grid(24, 24, QuadSplit::kRandom, 3), 9, 0.004f)},
      {"handles", generated(21, 9, 14, 12)},
      {"copies", unionOf(std::array{randomVoxels(5, 6, 40), book(5, 6, 6),
                                    flipped(icosphere(2), 3, 99), bowTies(9, 4, 3)},
                         "copies")},
      {"isosurface", gyroid(12)},
      {"stacks", combOfStacks(14, 12)},
      // Most ways to find a vertex again need a surface with many copies that is cut, not listed by
      // vertices.
      {"voxels", randomVoxels(6, 10, 45)},
      {"turned", withFlippedTriangles(icosphere(3), 5, 30)},
      {"turned_sheet", withFlippedTriangles(grid(20, 20), 5, 8)},
      {"poles", poles()},
  };
  for (const Larger& larger : surfaces) {
    for (const uint32_t number : {1u, 2u}) {
      Source source =
          single(std::string(larger.name) + "_large_" + std::to_string(number),
                 "A few hundred triangles or more, choice " + std::to_string(number), larger.mesh,
                 [number](SourceBuilder& b) { b.positions(static_cast<uint8_t>(8 + 2 * number)); });
      source.options.variation = number;
      all.push_back(source);
    }
  }
}

/// A surface whose scales come from the specification's coefficients. The seeds give neither
/// weights nor shear, both, shear and weights; 600 vertices on a coarse lattice notice if a
/// coefficient changes by 1/64.
void scaleSources(std::vector<Source>& all) {
  for (const uint32_t seed : {4u, 15u, 23u, 28u}) {
    Source source =
        single("scales_" + std::to_string(seed), "Coefficients of the scale",
               flipped(icosphere(3), 5, 12000), [](SourceBuilder& b) { b.positions(7); });
    source.options.variation = seed;
    all.push_back(source);
  }
}

/// In one part of the grid most vertices have only a weight of 1. Whole weights among the others
/// lead to an expected sum of 1.
Source skinOfTinyWeights() {
  return single(
      "tiny_weights", "Weights whose expected sum is 1", withNormals(grid(14, 14)),
      [](SourceBuilder& b) {
        b.positions(10);
        NamedAttribute joints = makeAttribute("JOINTS_0", kBase, "VEC4", ComponentType::kUint8);
        NamedAttribute weights =
            makeAttribute("WEIGHTS_0", kBase, "VEC4", ComponentType::kUint8, true);
        for (uint32_t w = 0; w < b.piece().wedge_count; ++w) {
          const bool is_whole = w / 15 < 9 || (w % 15 % 3 == 1 && w / 15 % 3 == 1);
          const uint32_t first = b.random().between(40, 120);
          const uint32_t second = b.random().between(60, 120);
          const std::array<uint32_t, 4> joint = {is_whole ? 1u : 9u, is_whole ? 9u : 0u,
                                                 is_whole ? 17u : 0u, 0u};
          const std::array<uint32_t, 4> weight = {is_whole ? first : 1u, is_whole ? second : 0u,
                                                  is_whole ? 255 - first - second : 0u, 0u};
          for (const uint32_t x : joint) joints.append(static_cast<uint8_t>(x));
          for (const uint32_t x : weight) weights.append(static_cast<uint8_t>(x));
        }
        b.piece().attributes.push_back(joints);
        b.piece().attributes.push_back(weights);
      });
}

/// An isosurface whose vertices were moved within the cells of its grid: each is on or between any
/// planes, or on any diagonal.
TestMesh strewnOnCells() {
  constexpr uint32_t kCells = 12;
  constexpr float kCell = 2.0f / kCells;
  TestMesh mesh = gyroid(kCells);
  Random random(5);
  const auto anyPart = [&] { return static_cast<float>(random.between(1, 99)) * 0.01f; };
  for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const uint32_t axes = random.between(0, 7);
    const uint32_t downwards = random.below(8);
    const bool is_on_diagonal = random.chance(60);
    const float t = anyPart();
    for (uint32_t s = 0; s < 3; ++s) {
      float& x = mesh.positions[3 * size_t{v} + s];
      float offset = 0;
      if ((axes >> s & 1) != 0) {
        offset = anyPart();
        if (is_on_diagonal) offset = (downwards >> s & 1) != 0 ? 1 - t : t;
      }
      x = (std::floor((x + 1) / kCell) + offset) * kCell - 1;
    }
  }
  return mesh;
}

/// Coordinates a little above the largest that directions of faces are computed with.
Source positionsAbove3e38(uint8_t normal_bits) {
  const std::string kind = normal_bits == 0 ? "exact" : "octahedral";
  return single("positions_above_3e38_" + kind,
                "Coordinates of 3.01e38, which count as 0 where normals are predicted",
                withNormals(torus(9, 8)), [=](SourceBuilder& b) {
                  b.floats("POSITION", kBase, "VEC3", 0, [](const Place& at, uint32_t c) {
                    return c == 0 && at.wedge % 5 == 0 ? 3.01e38f : at.position(c) * 1e38f;
                  });
                  b.normals(normal_bits);
                  b.tangents(normal_bits, true);
                });
}

}  // namespace

std::vector<Source> addedSources() {
  const auto positions = [](SourceBuilder& b) { b.positions(10); };
  return {single("many_digons", "Hundreds of digons wait, and handles put others below 255 of them",
                 plateWithTunnels(258, 1), positions),
          skinOfTinyWeights(),
          positionsAbove3e38(0),
          positionsAbove3e38(9),
          single("strewn_on_cells", "Vertices on every kind of diagonal and between any planes",
                 strewnOnCells(), [](SourceBuilder& b) { b.positions(14); }),
          single("cut_handles", "A handle would put a digon below 256 others: the surface is cut",
                 plateWithTunnels(kTooManyTunnels, 1), positions)};
}

namespace {

/// A mesh in blocks of about `block_triangles`. With a variation, choices are made at random.
Source inBlocks(const std::string& name, const std::string& shows, const TestMesh& mesh,
                uint32_t block_triangles, uint64_t variation,
                const std::function<void(SourceBuilder&)>& fill) {
  Source source = single("blocks_" + name, "Blocks: " + shows, mesh, fill);
  source.options.block_triangles = block_triangles;
  source.options.variation = variation;
  return source;
}

void addAlias(SourceBuilder& b) {
  b.piece().attributes.push_back(b.piece().attributes.back());
  NamedAttribute& alias = b.piece().attributes.back();
  alias.name = "TEXCOORD_1";
  alias.format.set_index = 1;
}

/// What blocks are cut out of, and the wedges that they share.
void blockSurfaces(std::vector<Source>& all) {
  const auto positions = [](SourceBuilder& b) { b.positions(12); };
  const auto rich = [](SourceBuilder& b) {
    b.positions(12);
    b.normals(8);
    b.texcoords("TEXCOORD_0", 10);
  };
  all.push_back(inBlocks("torus", "a closed surface", torus(9, 7), 40, 0, positions));
  all.push_back(inBlocks("random_edges", "a surface with edges flipped at random",
                         flipped(icosphere(3), 3, 9000), 300, 0, positions));
  all.push_back(inBlocks("charts", "seams along and across the cuts",
                         withNormals(chartGrid(12, 12, 4)), 60, 0, rich));
  all.push_back(inBlocks("random_wedges", "wedges all around their vertices",
                         withNormals(withRandomWedges(torus(12, 9), 4, 3)), 50, 2, rich));
  all.push_back(inBlocks("equal_tuples", "wedges with equal elements on the cuts: exceptions",
                         withEqualTuples(torus(10, 8), 4), 30, 0, positions));
  all.push_back(inBlocks("touching", "cuts that end in vertices inside of other blocks: exceptions",
                         pinchedSpheres(6), 21, 0, positions));
  all.push_back(inBlocks("copies", "edges of many faces, cut by blocks and by the codec",
                         book(5, 14, 4), 60, 3, positions));
  all.push_back(inBlocks("voxels", "cubes that meet in edges and vertices", randomVoxels(6, 6, 45),
                         120, 0, positions));
  all.push_back(inBlocks("holes_and_handles", "many holes, handles and components",
                         generated(21, 6, 9, 5), 70, 5, positions));
  all.push_back(inBlocks("parts", "parts that begin in any block, one of them empty",
                         chartGrid(12, 12, 4), 50, 0, [](SourceBuilder& b) {
                           b.positions(12);
                           b.texcoords("TEXCOORD_0", 10);
                           b.split(3);
                         }));
  all.push_back(inBlocks("isolated", "isolated wedges in the first block",
                         withUnused(torus(9, 7), 5, 30), 40, 0, positions));
  all.push_back(inBlocks(
      "beside", "duplicates, and degenerate triangles on edges and vertices",
      [] {
        TestMesh mesh = withIndexDuplicates(grid(12, 12), 5, 30);
        for (uint32_t t = 0; t < 60; t += 3) {
          const uint32_t a = mesh.indices[3 * t];
          const uint32_t b = t % 2 == 0 ? mesh.indices[3 * t + 1] : a;
          mesh.indices.insert(mesh.indices.end(), {a, b, a});
        }
        return mesh;
      }(),
      50, 0, positions));
  all.push_back(inBlocks("tiny", "one triangle in each block", icosphere(1), 1, 0, positions));
  all.push_back(inBlocks("planes", "positions on planes that all blocks share", gyroid(14), 500, 0,
                         [](SourceBuilder& b) { b.positions(14); }));
}

/// Attributes of every method.
void blockAttributes(std::vector<Source>& all) {
  const TestMesh ring = withNormals(withRandomWedges(torus(14, 10), 4, 2));
  const auto add = [&](const std::string& name, const std::string& shows, uint64_t variation,
                       const std::function<void(SourceBuilder&)>& fill) {
    all.push_back(inBlocks(name, shows, ring, 70, variation, fill));
  };
  add("octahedral", "octahedral normals and tangents in their planes, charts, an alias", 0,
      [](SourceBuilder& b) {
        b.positions(13);
        b.normals(9);
        b.tangents(9, true);
        b.texcoords("TEXCOORD_0", 11);
        addAlias(b);
      });
  add("tangent_points", "octahedral tangents", 7, [](SourceBuilder& b) {
    b.positions(13);
    b.normals(9);
    b.tangents(7, false);
    b.texcoords("TEXCOORD_0", 11);
  });
  add("exact", "every float exact", 0, [](SourceBuilder& b) {
    b.positions(0);
    b.normals(0);
    b.tangents(0, true);
    b.texcoords("TEXCOORD_0", 0);
    b.colors("COLOR_0", 0, Floats::kSpecial);
  });
  add("exact_varied", "exact floats, other choices", 12, [](SourceBuilder& b) {
    b.positions(0, Floats::kHuge);
    b.normals(0);
    b.tangents(0, false);
    b.texcoords("TEXCOORD_0", 0, Floats::kBinary);
  });
  add("integers", "integers, their positions too", 0, [](SourceBuilder& b) {
    b.integerPositions(ComponentType::kInt16);
    b.ids("_ID");
    b.integers("_WIDE", kBase, "MAT4", ComponentType::kUint32, false,
               [](const Place& at, uint32_t c) { return at.position(c % 3) * 1e8f + 2e9f; });
  });
  for (uint64_t variation = 0; variation < 3; ++variation) {
    add("skin_and_morph_" + std::to_string(variation), "joints, weights and morph targets",
        variation, [](SourceBuilder& b) {
          b.positions(11);
          b.normals(7);
          b.skin("0");
          b.morph(0);
          b.morph(1);
        });
  }
  for (const uint64_t variation : {21, 34, 55, 89}) {
    add("varied_" + std::to_string(variation), "choices at random", variation,
        [variation](SourceBuilder& b) {
          b.positions(static_cast<uint8_t>(6 + variation % 9));
          b.normals(static_cast<uint8_t>(variation % 2 == 0 ? 0 : 8));
          b.tangents(8, true);
          b.texcoords("TEXCOORD_0", 9);
          b.colors("COLOR_0", 5);
          b.custom("_A");
        });
  }
}

}  // namespace

std::vector<Source> blockSources() {
  std::vector<Source> all;
  blockSurfaces(all);
  blockAttributes(all);
  return all;
}

namespace {

/// A vertex in the middle of many others, and triangles from it to random pairs of these, so that
/// its edges have many faces in no order.
TestMesh coneOverRandomGraph() {
  constexpr uint32_t kAround = 90;
  TestMesh mesh;
  mesh.name = "cone over a random graph";
  Random random(11);
  for (uint32_t v = 0; v <= kAround; ++v) {
    const float angle = static_cast<float>(v) * 0.41f;
    const float radius = v == 0 ? 0.0f : 1.0f + static_cast<float>(v % 7) * 0.1f;
    mesh.positions.insert(mesh.positions.end(), {radius * (1 - angle * angle / 700),
                                                 radius * angle / 40, static_cast<float>(v % 11)});
  }
  for (uint32_t t = 0; t < 420; ++t) {
    const uint32_t a = random.between(1, kAround);
    const uint32_t b = random.between(1, kAround);
    if (a != b) mesh.indices.insert(mesh.indices.end(), {0, a, b});
  }
  return mesh;
}

/// Wedges of a single point, in triangles that are none.
TestMesh onePoint() {
  TestMesh mesh;
  mesh.name = "one point";
  mesh.positions = {0.3f, 0.1f, 0.7f, 0.3f, 0.1f, 0.7f, 0.3f, 0.1f, 0.7f};
  mesh.normals = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  mesh.indices = {0, 1, 2, 0, 0, 1};
  return mesh;
}

}  // namespace

std::vector<Source> rareSources() {
  std::vector<Source> all;
  all.push_back(single("one_point", "Exact positions that are all the same", onePoint(),
                       [](SourceBuilder& b) {
                         b.floats("POSITION", kBase, "VEC3", 0,
                                  [](const Place& at, uint32_t c) { return at.position(c); });
                         b.normals(8);
                       }));
  for (uint64_t variation = 1; variation <= 6; ++variation) {
    all.push_back(single("flat_faces_exact_" + std::to_string(variation),
                         "Exact normals and tangents at faces without an area",
                         withNormals(grid(5, 5)), [](SourceBuilder& b) {
                           b.floats("POSITION", kBase, "VEC3", 0, [](const Place& at, uint32_t c) {
                             return c == 0 ? std::floor(at.position(0) * 3) : 0.0f;
                           });
                           b.normals(0);
                           b.texcoords("TEXCOORD_0", 0);
                           b.tangents(0, true);
                         }));
    all.back().options.variation = variation;
  }
  all.push_back(
      single("joints_without_partners", "A second JOINTS of set 0, and one without WEIGHTS",
             withNormals(torus(9, 7)), [](SourceBuilder& b) {
               b.positions(10);
               b.skin("0");
               const auto joint = [](const Place& at, uint32_t c) {
                 return static_cast<float>((at.wedge / 9 + c) % 5);
               };
               b.integers("JOINTS_0", kBase, "VEC4", ComponentType::kUint8, false, joint);
               b.piece().attributes.back().name.clear();
               b.integers("JOINTS_1", kBase, "VEC4", ComponentType::kUint8, false,
                          [joint](const Place& at, uint32_t c) { return joint(at, c + 1); });
             }));
  for (uint64_t variation = 0; variation < 3; ++variation) {
    all.push_back(single("many_spokes_" + std::to_string(variation),
                         "A face whose spokes are more than 32 places apart", coneOverRandomGraph(),
                         [](SourceBuilder& b) { b.positions(9); }));
    all.back().options.variation = variation;
  }
  all.push_back(single(
      "partners_come_later", "JOINTS and WEIGHTS that cannot have partners before ones that do",
      withNormals(torus(9, 7)), [](SourceBuilder& b) {
        b.positions(10);
        const auto unfit = [&b](const char* name, Semantic semantic, uint32_t target) {
          b.integers(name, target, target == kBase ? "VEC3" : "VEC4", ComponentType::kUint8, false,
                     [](const Place& at, uint32_t c) {
                       return static_cast<float>((at.wedge / 9 + c) % 5);
                     });
          NamedAttribute& attribute = b.piece().attributes.back();
          attribute.name.clear();
          attribute.format.semantic = semantic;
          attribute.format.set_index = 0;
        };
        unfit("JOINTS_0", Semantic::kJoints, kBase);
        unfit("WEIGHTS_0", Semantic::kWeights, kBase);
        unfit("JOINTS_0", Semantic::kJoints, 0);
        unfit("WEIGHTS_0", Semantic::kWeights, 0);
        b.skin("0");
      }));
  all.push_back(single("origin_of_negative_zero", "A lattice whose origins are -0",
                       withNormals(torus(9, 7)), [](SourceBuilder& b) {
                         b.positions(10);
                         const Lattice lattice{{-0.0f, -0.0f, -0.0f, 0}, 0.001f};
                         b.piece().attributes[0].lattice = lattice;
                       }));
  all.push_back(single(
      "listed_in_two_parts", "Degenerate triangles at every vertex, on no edges, in two parts",
      [] {
        TestMesh mesh = grid(5, 5);
        const auto count = static_cast<uint32_t>(mesh.positions.size() / 3);
        for (uint32_t v = 0; v < count; ++v)
          mesh.indices.insert(mesh.indices.end(),
                              {v, (v * 7 + 11) % count, v, v, (v * 11 + 20) % count, v});
        return mesh;
      }(),
      [](SourceBuilder& b) {
        b.positions(9);
        b.split(1);
      }));
  for (uint64_t variation = 1; variation <= 2; ++variation) {
    all.push_back(single("long_normals_" + std::to_string(variation),
                         "Exact normals with components of 4 and more", withNormals(torus(9, 7)),
                         [](SourceBuilder& b) {
                           b.positions(12);
                           b.floats("NORMAL", kBase, "VEC3", 0, [](const Place& at, uint32_t c) {
                             return at.normal(c) * (at.wedge % 5 == 0 ? 40.0f : 1.0f);
                           });
                         }));
    all.back().options.variation = variation;
  }
  return all;
}

namespace {

/// Vertices on mirrors, near images, seeds that are images, and halves that are apart.
void mirroredSurfaces(std::vector<Source>& all) {
  const auto positions = [](SourceBuilder& b) { b.positions(12, Floats::kAny); };
  const TestMesh half = halfSheet(6, 5, 1);
  const TestMesh one = mirrored(half, 0);
  const TestMesh two = mirrored(one, 1);
  const TestMesh three = mirrored(two, 2);
  const TestMesh apart = translated(jittered(torus(7, 5), 1, 0.05f), 4, 0, 0);
  all.push_back(single("one", "A surface with two equal halves", one, positions));
  all.push_back(single("two", "Four equal quarters", two, positions));
  all.push_back(
      single("three", "Eight equal parts, two of which meet in no edge", three, positions));
  all.push_back(single("near", "Images that are a step away", withNoise(two, 12), positions));
  all.push_back(single("apart", "The halves are two components: a seed has no candidates",
                       mirrored(apart, 0), positions));
  all.push_back(single("other_triangles", "The triangles of the halves differ", flipped(two, 3, 20),
                       positions));
  all.push_back(
      single("bowties", "Seeds that are images", mirrored(bowTies(4, 3, 2), 0), positions));
  all.push_back(single("not_manifold", "Halves of a surface that is cut or has pivots",
                       mirrored(book(4, 3, 3), 0), positions));
  all.push_back(single("crowded", "Vertices with more corners than are looked at",
                       mirrored(openFan(40), 0), positions));
  all.push_back(
      single("isolated", "Isolated wedges have no images", withUnused(one, 3, 9), positions));
}

/// Normals and texture coordinates that a vertex and its images under x -> -x share. Wedge n of a
/// vertex has those of kind kinds[n], or of n modulo their number.
TestMesh withSharedValues(TestMesh mesh, std::span<const uint32_t> kinds) {
  mesh.normals.clear();
  mesh.texcoords.clear();
  std::map<std::array<float, 3>, uint32_t> wedges_at;
  for (uint32_t w = 0; w < mesh.vertexCount(); ++w) {
    const float* p = &mesh.positions[3 * size_t{w}];
    const uint32_t kind = kinds[wedges_at[{p[0], p[1], p[2]}]++ % kinds.size()];
    Random random(kind);
    float n[3];
    for (int s = 0; s < 3; ++s) {
      random = Random(random.next() + static_cast<uint64_t>(1000 * std::fabs(p[s])));
      n[s] = std::copysign(static_cast<float>(random.below(4)), p[s]);
    }
    if (n[0] == 0 && n[1] == 0) n[2] = std::copysign(1.0f, p[2]);
    const float scale = 1 / std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (const float x : n) mesh.normals.push_back(x * scale);
    for (int c = 0; c < 2; ++c) mesh.texcoords.push_back(random.unit());
  }
  return mesh;
}

TestMesh withSharedValues(TestMesh mesh, uint32_t kinds) {
  std::vector<uint32_t> all(kinds);
  std::iota(all.begin(), all.end(), 0u);
  return withSharedValues(std::move(mesh), all);
}

void matesOfSurfaces(std::vector<Source>& all) {
  const auto fill = [](SourceBuilder& b) {
    b.positions(10);
    b.normals(4);
    b.texcoords("TEXCOORD_0", 7);
  };
  const TestMesh one = mirrored(halfSheet(5, 4, 1), 0);
  const TestMesh three = mirrored(mirrored(mirrored(halfSheet(3, 3, 2), 0), 1), 2);
  all.push_back(single("one", "halves without seams", withSharedValues(one, 1), fill));
  all.push_back(single("three", "eight parts, with seams",
                       withSharedValues(withRandomWedges(three, 3, 3), 3), fill));
  all.push_back(single("crowded", "vertices with more wedges than are looked at",
                       withSharedValues(withRandomWedges(mirrored(openFan(12), 1), 4, 7), 7),
                       fill));
  all.push_back(single("two_charts", "two sets of texture coordinates, isolated wedges",
                       withSharedValues(withUnused(one, 3, 9), 2), [&](SourceBuilder& b) {
                         fill(b);
                         b.texcoords("TEXCOORD_1", 3);
                       }));
}

/// Triangles with wedges of their own, whose normals are smooth nevertheless.
TestMesh sphereOfFaces() {
  TestMesh mesh = flatShaded(icosphere(0));
  mesh.normals = mesh.positions;
  return mesh;
}

/// Two normals whose points on the grid of 4 bits, (5, 11) and (8, 4), have one key.
TestMesh withTwoNormals(TestMesh mesh) {
  mesh.normals.clear();
  for (uint32_t w = 0; w < mesh.vertexCount(); ++w) {
    const float scale = 1 / std::sqrt(w % 3 == 0 ? 21.0f : 19.0f);
    for (const float x : w % 3 == 0 ? std::array{-2.0f, 4.0f, 1.0f} : std::array{1.0f, -3.0f, 3.0f})
      mesh.normals.push_back(x * scale);
  }
  return mesh;
}

/// A waved sheet, one half of which is squeezed to a line, so that its faces have no area.
TestMesh squeezedSheet() {
  TestMesh mesh = withNormals(grid(6, 5));
  float middle = 0;
  for (size_t i = 1; i < mesh.positions.size(); i += 3) middle += mesh.positions[i];
  middle /= static_cast<float>(mesh.vertexCount());
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    float* p = &mesh.positions[i];
    p[0] += 0.1f * p[1];
    if (p[1] > middle) continue;
    p[1] = middle;
    p[2] = 0;
  }
  return mesh;
}

/// Texture coordinates that have no direction in one half.
void halfChart(SourceBuilder& b) {
  b.floats("TEXCOORD_0", kBase, "VEC2", 7,
           [](const Place& at, uint32_t c) { return at.position(0) < 0 ? 0.5f : at.texcoord(c); });
}

/// A tangent in the plane of each face of a mesh without shared wedges.
void tangentsOfFaces(SourceBuilder& b, uint8_t bits) {
  b.floats("TANGENT", kBase, "VEC4", bits, [&](const Place& at, uint32_t c) {
    const uint32_t first = at.wedge / 3 * 3;
    if (c == 3) return first % 5 == 0 ? -1.0f : 1.0f;
    const auto along = [&](uint32_t s) {
      return 0.7 * double{b.at(first + 1).position(s)} + 0.3 * double{b.at(first + 2).position(s)} -
             double{b.at(first).position(s)};
    };
    const double square = along(0) * along(0) + along(1) * along(1) + along(2) * along(2);
    return static_cast<float>(along(c) / std::sqrt(square));
  });
}

void anglesInHalfAChart(SourceBuilder& b) {
  b.positions(8);
  b.normals(4);
  halfChart(b);
  b.tangents(3, true);
}

template <class Fill>
Source inTwoPieces(const char* name, const char* shows, const TestMesh& mesh, Fill fill) {
  Source source = single(name, shows, mesh, fill);
  source.pieces.push_back(source.pieces[0]);
  return source;
}

Source repeatsInPieces() {
  const auto fill = [](SourceBuilder& b) {
    b.positions(8);
    b.tangents(3, false);
  };
  Source source = inTwoPieces("tangents_repeats_in_pieces", "points without normals, in two pieces",
                              torus(5, 4), fill);
  source.options.variation = 3;  // which do not lie in faces
  return source;
}

/// All these sources as version 1.1 has them, and with choices at random, once for each variation.
std::vector<Source> variedOfVersion11(std::vector<Source> all, uint64_t variations,
                                      const std::string& name, const std::string& shows) {
  for (size_t i = 0, plain = all.size(); i < plain; ++i) {
    for (uint64_t variation = 1; variation <= variations; ++variation) {
      Source source = all[i];
      source.name += "_" + std::to_string(variation);
      source.options.variation = 10 * i + variation;
      all.push_back(std::move(source));
    }
  }
  for (Source& source : all) {
    source.name = name + source.name;
    source.shows = shows + source.shows;
    source.options.without = {};
    source.options.without.add(Feature::kAnchors);
    source.options.without.add(Feature::kStarts);
  }
  return all;
}

}  // namespace

std::vector<Source> mirroredSources() {
  std::vector<Source> all;
  mirroredSurfaces(all);
  all.push_back(single("integers", "Integer positions with mirrors",
                       mirrored(halfSheet(6, 5, 2), 1),
                       [](SourceBuilder& b) { b.integerPositions(ComponentType::kInt16); }));
  all.push_back(single("floats", "Exact floats with mirrors", mirrored(halfSheet(6, 5, 3), 0),
                       [](SourceBuilder& b) { b.positions(0, Floats::kAny); }));
  // Any mirrors, with any way to code positions: palettes with images, shear, weights.
  return variedOfVersion11(std::move(all), 2, "mirrors_", "Mirrors: ");
}

std::vector<Source> matesSources() {
  std::vector<Source> all;
  matesOfSurfaces(all);
  return variedOfVersion11(std::move(all), 3, "mates_", "Values of mates: ");
}

std::vector<Source> anchorSources() {
  std::vector<Source> all;
  const auto fill = [](SourceBuilder& b) {
    b.positions(10);
    b.normals(4);
    b.texcoords("TEXCOORD_0", 5);
  };
  const TestMesh part = withSharedValues(jittered(torus(5, 4), 1, 0.05f), 1);
  all.push_back(single("moved", "components that are moved alone", repeated(part, 3, 0), fill));
  all.push_back(single("turned", "components of many turns, with seams",
                       repeated(withRandomWedges(part, 3, 3), 7, 7), fill));
  all.push_back(single("near", "images that are a step away, and other triangles",
                       withNoise(flipped(repeated(part, 2, 10), 3, 20), 10),
                       [](SourceBuilder& b) { b.positions(10); }));
  all.push_back(single("mirrored", "anchors with mirrors",
                       mirrored(translated(repeated(part, 2, 0), 4, 1, 0), 0),
                       [](SourceBuilder& b) { b.positions(12, Floats::kAny); }));
  all.push_back(single("not_manifold", "components that are cut or have pivots",
                       repeated(book(4, 3, 3), 2, 9), [](SourceBuilder& b) { b.positions(9); }));
  all = variedOfVersion11(std::move(all), 2, "anchors_", "Anchors: ");
  for (Source& source : all) {
    source.options.without = {};
    source.options.without.add(Feature::kStarts);
  }
  return all;
}

std::vector<Source> trainedSources() {
  const auto fill = [](SourceBuilder& b) {
    b.positions(8);
    b.normals(5);
    b.texcoords("TEXCOORD_0", 6);
    b.texcoords("TEXCOORD_1", 6);
  };
  std::vector<Source> all;
  all.push_back(single("values", "normals and two sets of texture coordinates, with seams",
                       withRandomWedges(withSharedValues(jittered(torus(7, 5), 1, 0.05f), 1), 3, 3),
                       fill));
  all.push_back(single("palettes", "palettes", withSharedValues(grid(6, 5), 1), fill));
  // The variations whose models start trained, without and with palettes.
  all[0].options.variation = 8;
  all[1].options.variation = 1;
  for (Source& source : all) {
    source.name = "trained_" + source.name;
    source.shows = "Models that start trained: " + source.shows;
    source.options.without = {};
    source.options.without.add(Feature::kMirrors);
    source.options.without.add(Feature::kAnchors);
  }
  return all;
}

std::vector<Source> tangentSources() {
  std::vector<Source> all;
  const TestMesh cut = withTwoNormals(withRandomWedges(torus(6, 4), 4, 3));
  all.push_back(
      single("tangents_angles", "angles, one half without a chart", cut, anglesInHalfAChart));
  all.push_back(single("tangents_one_per_face", "a tangent for each face, one half without a chart",
                       sphereOfFaces(), [](SourceBuilder& b) {
                         b.positions(8);
                         b.normals(5);
                         halfChart(b);
                         tangentsOfFaces(b, 8);
                       }));
  all.push_back(single("tangents_flat_faces",
                       "points at faces without an area, beside exact normals", squeezedSheet(),
                       [](SourceBuilder& b) {
                         b.positions(8);
                         b.normals(0, Floats::kBinary);
                         b.texcoords("TEXCOORD_0", 7);
                         b.tangents(6, false);
                       }));
  all.back().options.variation = 3;  // which lie in faces
  all.push_back(repeatsInPieces());
  all.push_back(inBlocks("of_tangents", "angles", cut, 20, 3, anglesInHalfAChart));
  for (Source& source : all) {
    source.shows = "Version 1.1: " + source.shows;
    source.options.without = {};
    source.options.without.add(Feature::kMirrors);
    source.options.without.add(Feature::kAnchors);
    source.options.without.add(Feature::kStarts);
  }
  return all;
}

namespace {

/// A vertex in the middle of `count` others.
TestMesh wheel(uint32_t count) {
  TestMesh mesh = openFan(count - 1);
  mesh.indices.insert(mesh.indices.end(), {0, count, 1});
  return jittered(mesh, count, 0.05f);
}

/// A flat sheet with texture coordinates along its sides. Every other normal is the direction of
/// the first of them, so that nothing of a tangent is beside it.
TestMesh alongNormals() {
  TestMesh mesh = grid(6, 5);
  mesh.normals.clear();
  mesh.texcoords.clear();
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    mesh.positions[i + 2] = 0;
    const bool is_along = i % 2 == 0;
    mesh.normals.insert(mesh.normals.end(), {is_along ? 1.0f : 0.0f, 0, is_along ? 0.0f : 1.0f});
    mesh.texcoords.insert(mesh.texcoords.end(), {mesh.positions[i], mesh.positions[i + 1]});
  }
  return mesh;
}

}  // namespace

std::vector<Source> boundarySources() {
  std::vector<Source> all;
  all.push_back(single("wheels", "mates with a corner more than are looked at",
                       mirrored(translated(wheel(37), 3, 1, 0), 0),
                       [](SourceBuilder& b) { b.positions(12, Floats::kAny); }));
  const uint32_t kinds[] = {0, 1, 0, 1, 2, 0, 2, 3};
  all.push_back(
      single("equal_wedges", "mates that have a value at two of their first four wedges",
             withSharedValues(withRandomWedges(mirrored(halfSheet(3, 8, 3), 0), 3, 9), kinds),
             [](SourceBuilder& b) {
               b.positions(10);
               b.normals(4);
               b.texcoords("TEXCOORD_0", 7);
             }));
  all.push_back(inTwoPieces("tangents_along_normals",
                            "tangents that vanish beside their normals, in two pieces",
                            alongNormals(), [](SourceBuilder& b) {
                              b.positions(8);
                              b.normals(5);
                              b.texcoords("TEXCOORD_0", 7);
                              b.tangents(3, false);
                            }));
  // On a lattice so coarse that vertices and images meet, which may be mates already.
  all.push_back(single("meeting", "images at places of other vertices",
                       withNoise(repeated(jittered(torus(6, 5), 4, 0.05f), 2, 4), 5),
                       [](SourceBuilder& b) { b.positions(5); }));
  all.back().options.variation = 3;
  all.push_back(inTwoPieces(
      "pieces", "anchors, mates and values of mates in two pieces",
      repeated(withSharedValues(mirrored(translated(halfSheet(4, 3, 2), 1, 0, 0), 0), 1), 2, 0),
      [](SourceBuilder& b) {
        b.positions(10);
        b.normals(4);
        b.texcoords("TEXCOORD_0", 7);
      }));
  all.push_back(all.back());
  all.back().name += "_2";
  all.back().options.variation = 2;
  all.push_back(single("small_faces", "tangents in faces whose normals are a unit long",
                       sphereOfFaces(), [](SourceBuilder& b) {
                         b.positions(1);
                         b.normals(5);
                         b.floats("TEXCOORD_0", kBase, "VEC2", 7,
                                  [](const Place& at, uint32_t c) { return at.position(c); });
                         tangentsOfFaces(b, 8);
                       }));
  all.back().options.variation = 2;  // which lie in faces
  for (Source& source : all) {
    source.name = "boundaries_" + source.name;
    source.shows = "Boundaries of rules: " + source.shows;
    source.options.without = {};
    source.options.without.add(Feature::kStarts);
  }
  return all;
}

std::vector<Source> readingSources() {
  std::vector<Source> all;
  all.push_back(anchorSources()[0]);
  all.back().name = "mates_of_many";
  all.back().shows = "vertices that are mates of several, and are mates of others";
  all.back().options.variation = 23;
  TestMesh two = jittered(grid(3, 3), 15, 0.2f);  // sheets, one above the other, that share vertex 7
  const TestMesh above = translated(jittered(grid(3, 3), 42, 0.2f), 0, 0, 3);
  const uint32_t count = two.vertexCount();
  two.positions.insert(two.positions.end(), above.positions.begin(), above.positions.end());
  for (const uint32_t v : above.indices) two.indices.push_back(v == 7 ? 7 : v + count);
  all.push_back(single("touching", "components that touch earlier ones, with other anchors",
                       repeated(two, 2, 5), [](SourceBuilder& b) { b.positions(9); }));
  all.push_back(single(
      "sums", "tangents of bundles whose first wedge has no chart, and of isolated wedges",
      withTwoNormals(withUnused(withRandomWedges(torus(6, 4), 3, 3), 3, 12)), [](SourceBuilder& b) {
        b.positions(8);
        b.normals(4);
        b.floats("TEXCOORD_0", kBase, "VEC2", 7,
                 [](const Place& at, uint32_t c) { return at.wedge == 0 ? 0.5f : at.texcoord(c); });
        b.tangents(4, false);
      }));
  all.push_back(single(
      "colours", "models that start trained, but those of colours",
      withRandomWedges(withSharedValues(jittered(torus(7, 5), 1, 0.05f), 1), 1, 3),
      [](SourceBuilder& b) {
        b.positions(8);
        b.normals(5);
        b.floats("COLOR_0", kBase, "VEC3", 4, [](const Place& at, uint32_t c) {
          return std::floor(0.5f + at.position(c)) * 0.3f;
        });
      }));
  for (Source& source : all) {
    source.options.without = {};
    if (&source != &all.back()) source.options.without.add(Feature::kStarts);
    source.name = "readings_" + source.name;
    source.shows = "Rules that are easily misread: " + source.shows;
  }
  return all;
}

std::vector<Source> chosenSources() {
  std::vector<Source> all;
  smallSources(all);
  gridSources(all);
  std::vector<Source> extremes;
  extremeSources(extremes);
  for (const Source& source : extremes) {
    for (uint64_t variation = 1; variation <= 3; ++variation) {
      all.push_back(source);
      all.back().name += "_" + std::to_string(variation);
      all.back().options.variation = variation;
    }
  }
  crowdedSources(all);
  largerSources(all);
  scaleSources(all);
  all.push_back(single("ordered_duplicates", "Triangles that occur twice, in an order that is kept",
                       withIndexDuplicates(grid(24, 20), 5, 40),
                       [](SourceBuilder& b) { b.positions(10); }));
  all.back().options.keep_triangle_order = true;
  return all;
}

}  // namespace mcc::conformance
