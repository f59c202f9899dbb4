// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Mirrors by themselves; whole surfaces are in roundtrip/mirrors_test.cpp.
#include "positions/mirrors.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <map>
#include <vector>

#include "entropy/decoder_io.h"
#include "entropy/enc_coder.h"
#include "mesh/face_mesh.h"
#include "positions/enc_mirrors.h"
#include "positions/palette.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

using Point = std::array<int32_t, 3>;
using Face = std::array<uint32_t, 3>;

Mirrors mirrorsOf(std::initializer_list<Mirror> list) {
  Mirrors mirrors;
  for (const Mirror& m : list) mirrors.mirror[mirrors.count++] = m;
  return mirrors;
}

/// Vertices of a mesh whose mates are to be found. They are added in the order of the tests.
class Mates {
 public:
  Mates(const std::vector<Face>& faces, const std::vector<Point>& points, const Mirrors& mirrors,
        bool has_anchors = false)
      : points_(points),
        words_(kFaceWords * faces.size(), kNone),
        records_(points.size()),
        vertex_mates_(Allocator{}),
        mates_(FaceView{words_.data()}, records_.data(), mirrors, vertex_mates_, Allocator{}) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> half_edges;
    for (uint32_t f = 0; f < faces.size(); ++f) {
      for (uint32_t k = 0; k < 3; ++k) {
        words_[kFaceWords * f + k] = faces[f][k];
        half_edges[{faces[f][k], faces[f][(k + 1) % 3]}] = kFaceWords * f + k;
      }
    }
    for (const auto& [ends, h] : half_edges) {
      start_.try_emplace(ends.first, h);
      const auto twin = half_edges.find({ends.second, ends.first});
      if (twin != half_edges.end()) words_[h + 4] = twin->second;
    }
    EXPECT_TRUE(mates_.init(static_cast<uint32_t>(points.size()), has_anchors));
  }

  /// Looks for candidates of a vertex at `from`.
  void look(const std::vector<uint32_t>& neighbours, const Point& from) {
    std::vector<const VertexRecord*> around;
    for (const uint32_t n : neighbours) around.push_back(&records_[n]);
    mates_.findCandidates(around, lanesOf(from));
  }
  void name(uint32_t rank) { mates_.name(rank); }
  void add(uint32_t vertex) {
    std::copy_n(points_[vertex].data(), 3, records_[vertex].q);
    records_[vertex].q[3] = kKnown;
    mates_.add(vertex, start_.at(vertex));
  }
  void addAlone(uint32_t vertex) {
    look({}, {});
    add(vertex);
  }
  /// Adds the first vertex of a component that has an anchor.
  void begin(uint32_t vertex, uint32_t anchor) {
    look({}, {});
    std::copy_n(points_[vertex].data(), 3, records_[vertex].q);
    mates_.begin(vertex, {anchor, 0});
    add(vertex);
  }
  uint32_t mateOf(uint32_t mirror, uint32_t vertex) const {
    return vertex_mates_.mateOf(mirror, vertex);
  }
  std::vector<Point> images() const {
    std::vector<Point> all;
    for (uint32_t i = 0; i < mates_.count(); ++i) {
      const Lanes<uint32_t> q = mates_.imageOf(i);
      all.push_back(
          {static_cast<int32_t>(q[0]), static_cast<int32_t>(q[1]), static_cast<int32_t>(q[2])});
    }
    return all;
  }
  uint32_t context() const { return mates_.context(); }

 private:
  static Lanes<uint32_t> lanesOf(const Point& p) {
    return Lanes<uint32_t>{static_cast<uint32_t>(p[0]), static_cast<uint32_t>(p[1]),
                           static_cast<uint32_t>(p[2]), 0};
  }

  std::vector<Point> points_;
  std::vector<uint32_t> words_;
  std::vector<VertexRecord> records_;
  std::map<uint32_t, uint32_t> start_;
  VertexMates vertex_mates_;
  MirrorMates mates_;
};

/// A fan of triangles around vertex 0, whose other vertices are 1 .. n.
std::vector<Face> fanOf(uint32_t n, bool closed) {
  std::vector<Face> faces;
  for (uint32_t i = 1; i < n; ++i) faces.push_back({0, i, i + 1});
  if (closed) faces.push_back({0, n, 1});
  return faces;
}
/// Points of such a fan: the centre on the mirror x = 0, and the others at different x on its left.
std::vector<Point> fanPoints(uint32_t n) {
  std::vector<Point> points = {{0, 0, 0}};
  for (uint32_t i = 1; i <= n; ++i)
    points.push_back({-10 - static_cast<int32_t>(i), static_cast<int32_t>(5 * i), 0});
  return points;
}

TEST(Mirrors, CandidatesAreTheNearestImagesInOrder) {
  for (const bool closed : {false, true}) {
    Mates mates(fanOf(10, closed), fanPoints(10), mirrorsOf({{0, 0}}));
    for (uint32_t v = 0; v <= 10; ++v) mates.addAlone(v);
    mates.look({0}, {17, 35, 0});  // the image of 7
    const std::vector<Point> images = mates.images();
    ASSERT_EQ(images.size(), size_t{kMostCandidates});
    const std::vector<Point> expected = {{17, 35, 0}, {18, 40, 0}, {16, 30, 0}, {19, 45, 0},
                                         {15, 25, 0}, {20, 50, 0}, {14, 20, 0}};
    for (uint32_t i = 0; i < kMostCandidates; ++i) {
      // Those at the same distance are in the order of the ring, which differs with its start.
      const auto distance = [&](const Point& p) {
        return std::abs(p[0] - 17) + std::abs(p[1] - 35);
      };
      EXPECT_EQ(distance(images[i]), distance(expected[i])) << i;
    }
    EXPECT_EQ(mates.context(), 2 * 1 + 1u);
  }
}

TEST(Mirrors, ContextsSayHowClearTheChoiceIs) {
  Mates mates(fanOf(3, false), fanPoints(3), mirrorsOf({{0, 0}}));
  for (uint32_t v = 0; v <= 1; ++v) mates.addAlone(v);
  mates.look({0}, {50, 0, 0});
  EXPECT_EQ(mates.images().size(), 1u);
  EXPECT_EQ(mates.context(), 1u);
  mates.look({0, 1}, {50, 0, 0});  // vertex 1 has no mate
  EXPECT_EQ(mates.context(), 0u);
  for (uint32_t v = 2; v <= 3; ++v) mates.addAlone(v);
  mates.look({0}, {50, 0, 0});
  EXPECT_EQ(mates.context(), 2 * 2 + 1u);
  mates.look({0}, {13, 15, 0});
  EXPECT_EQ(mates.context(), 2 * 1 + 1u);
  mates.look({}, {13, 15, 0});
  EXPECT_EQ(mates.images().size(), 0u);
}

TEST(Mirrors, AVertexIsACandidateOnce) {
  // Both neighbours are on the mirror and have vertex 2 in their rings.
  const std::vector<Point> points = {{0, 0, 0}, {0, 9, 0}, {-7, 4, 0}, {7, 4, 0}};
  Mates mates({{0, 1, 2}, {1, 0, 3}}, points, mirrorsOf({{0, 0}}));
  for (uint32_t v = 0; v < 3; ++v) mates.addAlone(v);
  mates.look({0, 1}, {7, 4, 0});
  EXPECT_EQ(mates.images(), (std::vector<Point>{{7, 4, 0}}));
  // Once it has a mate, it is no candidate any more.
  mates.add(3);
  mates.look({0, 1}, {7, 4, 0});
  EXPECT_TRUE(mates.images().empty());
}

TEST(Mirrors, OneCandidateSettlesTheSearch) {
  // The first neighbour has one candidate around its mate, so that those of the second do not
  // count.
  std::vector<Point> points = fanPoints(5);
  points.push_back({0, -9, 0});
  Mates mates({{0, 1, 2}, {1, 6, 3}, {6, 4, 3}, {6, 5, 4}}, points, mirrorsOf({{0, 0}}));
  for (const uint32_t v : {0u, 1u, 3u, 4u, 5u, 6u}) mates.addAlone(v);
  mates.look({0, 6}, {0, 0, 0});
  EXPECT_EQ(mates.images().size(), 1u);
  mates.look({6, 0}, {0, 0, 0});
  EXPECT_EQ(mates.images().size(), 4u);
}

TEST(Mirrors, MatesAreExactImagesOrNamed) {
  for (const bool is_named : {false, true}) {
    for (int32_t off = -2; off <= 2; ++off) {
      const std::vector<Point> points = {{0, 0, 0}, {0, 9, 0}, {-7, 4, 0}, {7, 4 + off, 0}};
      Mates mates({{0, 1, 2}, {1, 0, 3}}, points, mirrorsOf({{0, 0}}));
      for (uint32_t v = 0; v < 3; ++v) mates.addAlone(v);
      mates.look({0, 1}, {7, 4, 0});
      if (is_named) mates.name(0);
      mates.add(3);
      mates.look({0, 1}, {7, 4, 0});
      EXPECT_EQ(mates.images().empty(), is_named || off == 0) << off;
    }
  }
}

TEST(Mirrors, VerticesAtMostAStepFromTheirImageAreTheirOwnMates) {
  for (int32_t x = -3; x <= 3; ++x) {
    const std::vector<Point> points = {{x, 0, 0}, {-20, 9, 0}, {-30, 4, 0}};
    Mates mates({{0, 1, 2}}, points, mirrorsOf({{0, 1}}));  // the image of x is 1 - x
    for (uint32_t v = 0; v < 2; ++v) mates.addAlone(v);
    mates.look({0}, {0, 0, 0});
    EXPECT_EQ(mates.images().empty(), x != 0 && x != 1) << x;
  }
}

TEST(Mirrors, ImagesWrap) {
  constexpr int32_t kMost = INT32_MAX;
  constexpr int32_t kLeast = INT32_MIN;
  // x -> 1 - x, of a vertex at the least coordinate there is.
  const std::vector<Point> points = {{0, 0, 0}, {1, kMost, 0}, {kLeast, 4, kLeast}, {0, 0, 0}};
  Mates mates({{0, 1, 2}, {1, 0, 3}}, points, mirrorsOf({{0, 1}, {2, kMost}}));
  for (uint32_t v = 0; v < 3; ++v) mates.addAlone(v);
  mates.look({0}, {kMost, kLeast, 0});
  for (const Point& image : mates.images()) EXPECT_EQ(image, (Point{kLeast + 1, 4, kLeast}));
}

TEST(Mirrors, OnlyTheRingsFirstCornersAreLookedAt) {
  constexpr uint32_t kMany = 60;
  for (const bool closed : {false, true}) {
    for (const uint32_t far : {2u, 16u, 17u, 18u, 30u, 44u, 59u}) {
      std::vector<Point> points = fanPoints(kMany);
      Mates mates(fanOf(kMany, closed), points, mirrorsOf({{0, 0}}));
      mates.addAlone(0);  // it starts with the half-edge to vertex 1
      mates.addAlone(far);
      mates.look({0}, {0, 0, 0});
      const bool seen = far <= kMateCorners || (closed && kMany - far < kMateCorners);
      EXPECT_EQ(mates.images().size(), seen ? 1u : 0u) << closed << " " << far;
    }
  }
}

TEST(Mirrors, VerticesMeetByTheirPositions) {
  // Two triangles that share nothing: the second finds its mates by where they are.
  const std::vector<Point> points = {{-5, 0, 0}, {-5, 9, 0}, {-9, 4, 0},
                                     {5, 0, 0},  {9, 4, 0},  {5, 9, 0}};
  Mates mates({{0, 1, 2}, {3, 4, 5}}, points, mirrorsOf({{0, 0}}));
  for (uint32_t v = 0; v < 4; ++v) mates.addAlone(v);
  mates.look({3}, {9, 4, 0});
  EXPECT_EQ(mates.images()[0], points[4]);
  EXPECT_EQ(mates.images().size(), 2u);
}

TEST(Mirrors, TheLastVertexOfAPositionIsFound) {
  // 0 and 3 are at the same place; the table holds the latter, around which 4 and 5 are.
  const std::vector<Point> points = {{-5, 0, 0}, {-5, 9, 0}, {-9, 4, 0}, {-5, 0, 0}, {-5, 2, 7},
                                     {-6, 2, 7}, {5, 0, 0},  {9, 4, 0},  {5, 9, 0}};
  Mates mates({{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}, points, mirrorsOf({{0, 0}}));
  for (uint32_t v = 0; v < 7; ++v) mates.addAlone(v);
  mates.look({6}, {5, 2, 7});
  EXPECT_EQ(mates.images(), (std::vector<Point>{{5, 2, 7}, {6, 2, 7}}));
}

TEST(Mirrors, AVertexIsRepeatedOnceInEachComponent) {
  // Two copies of a triangle, each with its vertex 1 doubled, as where a surface was cut: 5 and 9.
  const std::vector<Point> triangle = {{0, 0, 0}, {0, 9, 0}, {-7, 4, 0}};
  std::vector<Point> points = triangle;
  for (const int32_t z : {50, 90}) {
    for (const Point& p : {triangle[0], triangle[1], triangle[1], triangle[2]})
      points.push_back({p[0], p[1], z});
  }
  Mates mates({{0, 1, 2}, {3, 4, 5}, {4, 6, 5}, {7, 8, 9}, {8, 10, 9}}, points, {}, true);
  for (uint32_t v = 0; v < 3; ++v) mates.addAlone(v);
  for (const uint32_t first : {3u, 7u}) {
    mates.begin(first, 0);
    mates.look({first}, points[first + 1]);
    EXPECT_EQ(mates.images(), (std::vector<Point>{points[first + 1], points[first + 3]}));
    mates.addAlone(first + 1);
    mates.look({first}, points[first + 2]);
    EXPECT_EQ(mates.images(), (std::vector<Point>{points[first + 3]})) << "1 is taken";
    for (uint32_t v = first + 2; v < first + 4; ++v) mates.addAlone(v);
    EXPECT_EQ(mates.mateOf(0, first), 0u);
    EXPECT_EQ(mates.mateOf(0, first + 1), 1u);
    EXPECT_EQ(mates.mateOf(0, first + 2), kNone) << "1 is taken";
    EXPECT_EQ(mates.mateOf(0, first + 3), 2u);
  }
}

// ---- The list of mirrors ------------------------------------------------------------------------

/// Writes raw fields, and returns what reading the list of mirrors from them says.
Status readList(const std::vector<std::pair<uint32_t, uint32_t>>& fields, uint32_t bits,
                Mirrors& mirrors) {
  EncoderIo encoder(false);
  for (const auto& [width, value] : fields) encoder.raw(width, value);
  const EncoderIo::Streams streams = encoder.finish();
  DecoderIo<false> decoder(streams.codes, streams.tokens, streams.raw);
  return codeMirrors(decoder, bits, Mirrors{}, mirrors);
}

TEST(Mirrors, ListsComeBack) {
  Random random(5);
  for (const uint32_t bits : {1u, 8u, 14u, 30u, 32u}) {
    const uint32_t sum_bits = sumBits(bits);
    for (uint32_t count = 1; count <= kMaxMirrors; ++count) {
      Mirrors written;
      written.count = count;
      for (Mirror& m : written.mirror)
        m = {random.below(3), static_cast<int32_t>(random.next() >> 32) >> (32 - sum_bits)};
      EncoderIo encoder(false);
      Mirrors same;
      ASSERT_TRUE(codeMirrors(encoder, bits, written, same).ok());
      const EncoderIo::Streams streams = encoder.finish();
      DecoderIo<false> decoder(streams.codes, streams.tokens, streams.raw);
      Mirrors read;
      ASSERT_TRUE(codeMirrors(decoder, bits, Mirrors{}, read).ok());
      ASSERT_EQ(read.count, count);
      for (uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(read.mirror[i].axis, written.mirror[i].axis);
        EXPECT_EQ(read.mirror[i].sum, written.mirror[i].sum);
        EXPECT_EQ(same.mirror[i].sum, written.mirror[i].sum);
      }
    }
  }
}

TEST(Mirrors, ListsWithoutMeaningAreErrors) {
  Mirrors mirrors;
  EXPECT_TRUE(readList({{2, 0}, {2, 2}, {16, 77}}, 14, mirrors).ok());
  EXPECT_EQ(readList({{2, 0}, {2, 3}, {16, 77}}, 14, mirrors).error, Error::kBadAttribute);
  EXPECT_EQ(
      readList({{2, 3}, {2, 0}, {16, 1}, {2, 1}, {16, 2}, {2, 2}, {16, 3}}, 14, mirrors).error,
      Error::kBadAttribute);
}

// ---- The search ---------------------------------------------------------------------------------

/// Random points and their images under these mirrors.
std::vector<int32_t> symmetric(uint32_t seed, uint32_t count, int32_t size,
                               const std::vector<Mirror>& mirrors) {
  Random random(seed);
  std::vector<Point> points(count);
  for (Point& p : points) {
    for (int32_t& x : p) x = static_cast<int32_t>(random.below(static_cast<uint32_t>(size)));
  }
  for (const Mirror& m : mirrors) {
    for (size_t i = 0, n = points.size(); i < n; ++i) {
      Point image = points[i];
      image[m.axis] = m.sum - image[m.axis];
      points.push_back(image);
    }
  }
  std::vector<int32_t> all;
  for (const Point& p : points) all.insert(all.end(), p.begin(), p.end());
  return all;
}

TEST(FindMirrors, EveryPlaneOfASymmetricBoxIsFound) {
  const std::vector<Mirror> planes = {{0, 4001}, {1, 5000}, {2, 3777}};
  for (uint32_t count = 1; count <= 3; ++count) {
    const std::vector<Mirror> some(planes.begin(), planes.begin() + count);
    const Mirrors found = findMirrors(symmetric(count, 50, 5000, some), 16);
    ASSERT_EQ(found.count, count);
    for (const Mirror& m : some) {
      const Mirror* const across = found.across(m.axis);
      ASSERT_NE(across, nullptr);
      EXPECT_EQ(across->sum, m.sum);
    }
  }
}

TEST(FindMirrors, ImagesAStepAwayCount) {
  // Pairs with each of three sums are 3 % of the points; those of all are nearly a fifth.
  Random random(7);
  std::vector<int32_t> points = symmetric(2, 820, 1 << 14, {});
  for (int32_t i = 0; i < 90; ++i) {
    const int32_t x = static_cast<int32_t>(random.below(4000));
    const int32_t y = static_cast<int32_t>(random.below(1 << 14));
    points.insert(points.end(), {x, y, i, 9000 + i % 3 - x, y, i});
  }
  const Mirrors found = findMirrors(points, 16);
  ASSERT_EQ(found.count, 1u);
  EXPECT_EQ(found.mirror[0].sum, 9001);
}

TEST(FindMirrors, ImagesOnCrowdedLinesCount) {
  // Lines of 20 points do not vote, but nearly all images are on them.
  Random random(8);
  std::vector<int32_t> points;
  for (int32_t line = 0; line < 40; ++line) {
    const int32_t pairs = line < 30 ? 10 : 1;
    const int32_t y = static_cast<int32_t>(random.below(1 << 14));
    for (int32_t i = 0; i < pairs; ++i) {
      const int32_t x = 100 * i + static_cast<int32_t>(random.below(90));
      points.insert(points.end(), {x, y, line, 9000 - x, y, line});
    }
  }
  const Mirrors found = findMirrors(points, 16);
  ASSERT_EQ(found.count, 1u);
  EXPECT_EQ(found.mirror[0].sum, 9000);
}

TEST(FindMirrors, RandomPointsHaveNone) {
  EXPECT_EQ(findMirrors(symmetric(1, 2000, 1 << 14, {}), 16).count, 0u);
  EXPECT_EQ(findMirrors({}, 16).count, 0u);
}

TEST(FindMirrors, SumsThatNeedMoreBitsAreNone) {
  const std::vector<int32_t> points = symmetric(1, 50, 4096, {{1, 8000}});
  EXPECT_EQ(findMirrors(points, 14).count, 1u);
  EXPECT_EQ(findMirrors(points, 13).count, 0u);
  // Those of the largest coordinates are beyond 32 bits.
  std::vector<int32_t> far = symmetric(1, 50, 4096, {{1, 8000}});
  for (int32_t& x : far) x += INT32_MAX - 8000;
  EXPECT_EQ(findMirrors(far, 32).count, 0u);
}

// ---- Palettes -----------------------------------------------------------------------------------

/// What a palette of these ascending values costs, after it has come back.
double codePalette(std::vector<int32_t> values, const Mirrors& mirrors) {
  const AxisPalette none;
  AxisPalette truth[3] = {none, none, none};
  truth[1].values = values.data();
  truth[1].count = static_cast<uint32_t>(values.size());
  EncoderIo encoder(false);
  PaletteModels models;
  EXPECT_TRUE(PositionPalettes(Allocator{}).code(encoder, models, truth, ~0u, mirrors).ok());
  const double cost = static_cast<double>(encoder.cost()) / kCostOne;
  const EncoderIo::Streams streams = encoder.finish();
  DecoderIo<false> decoder(streams.codes, streams.tokens, streams.raw);
  PaletteModels fresh;
  PositionPalettes read{Allocator{}};
  EXPECT_TRUE(read.code(decoder, fresh, nullptr, ~0u, mirrors).ok());
  EXPECT_EQ(read.axis(0).count, 0u);
  EXPECT_TRUE(std::equal(values.begin(), values.end(), read.axis(1).values,
                         read.axis(1).values + read.axis(1).count));
  return cost;
}

TEST(Mirrors, PalettesHaveImages) {
  Random random(3);
  std::vector<int32_t> values;
  for (int32_t x = 0, i = 0; i < 100; ++i) {
    x += 1 + static_cast<int32_t>(random.below(500));
    values.push_back(x);
  }
  const int32_t sum = 2 * values.back() + 7;
  for (uint32_t i = 100; i-- != 0;) values.push_back(sum - values[i]);
  const double plain = codePalette(values, Mirrors{});
  EXPECT_LT(codePalette(values, mirrorsOf({{0, 1}, {1, sum}, {1, 5}})), 0.65 * plain);
  // Only the first across an axis matters, and one that has no images costs nearly nothing.
  EXPECT_LT(codePalette(values, mirrorsOf({{1, sum + 1}, {1, sum}})), 1.1 * plain);
}

TEST(Mirrors, PalettesNearTheEndsOfIntegers) {
  const std::vector<int32_t> low = {INT32_MIN + 1, INT32_MIN + 5, INT32_MIN + 400};
  const std::vector<int32_t> high = {INT32_MAX - 400, INT32_MAX - 5, INT32_MAX};
  for (const int32_t sum : {0, -1, 1, INT32_MAX, INT32_MIN, INT32_MAX - 4}) {
    codePalette(low, mirrorsOf({{1, sum}}));
    codePalette(high, mirrorsOf({{1, sum}}));
  }
}

}  // namespace
}  // namespace mcc::test
