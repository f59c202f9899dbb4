// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stages after connectivity, on random values: positions, seams, and triangles apart from the
// surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "format/predictors.h"
#include "positions/enc_isolated.h"
#include "positions/enc_recording.h"
#include "positions/growth.h"
#include "positions/predict.h"
#include "support/mesh_generators.h"
#include "unit/surface.h"
#include "writer/predictor_search.h"

namespace mcc::test {
namespace {

/// Meshes that lead the traversal everywhere: closed, open, of one triangle, with copies, of high
/// degree.
std::vector<TestMesh> surfaces() {
  return {tetrahedron(),
          looseTriangles(5),
          grid(9, 7),
          torus(8, 6),
          openFan(40),
          bipyramid(30),
          sheetWithHoles(3, 1),
          book(4, 4, 3),
          pinchedSpheres(3),
          moebius(8, 2),
          randomVoxels(1, 4, 50),
          fins(4),
          generated(2, 2, 3, 4),
          combOfStacks(5, 6)};
}

/// Runs both sides up to the positions. Made-up values go into `truth` between the stages.
template <bool kSingle>
class Pair {
 public:
  Pair(const TestMesh& mesh, const AttributeInfo& position, uint32_t isolated_count = 0,
       const std::vector<AttributeInfo>& further = {positionInfo(10)})
      : surface_(mesh),
        encoder_(kSingle),
        writer_(encoder_, headerOf(surface_, isolated_count), listOf(position, further)) {
    truth.connectivity = surface_.truth();
    EXPECT_TRUE(writer_.piece.codeConnectivity(truth).ok());
    classes_ = surface_.classOfVertex();
    truth.class_of_vertex = classes_.data();
    truth.class_count = mesh.vertexCount();
    EXPECT_TRUE(writer_.piece.codeStitch(truth).ok());
    writer_.header.wedge_count = groupCount() + isolated_count;
  }

  uint32_t groupCount() const { return writer_.piece.groups.count; }
  uint32_t faceCount() const { return writer_.piece.mesh.face_count; }
  uint32_t group(uint32_t f, uint32_t k) const {
    return writer_.piece.mesh.words[size_t{f} * kFaceWords + k];
  }
  FaceView faces() { return writer_.piece.mesh.view(); }
  /// Positions of the groups, in thousandths, and zeros for isolated vertices.
  std::vector<int32_t> latticePositions(const TestMesh& mesh, uint32_t isolated_count) const {
    std::vector<int32_t> positions(3 * (size_t{groupCount()} + isolated_count));
    for (uint32_t f = 0; f < faceCount(); ++f) {
      const uint32_t gate = surface_.sourceGate()[f];  // became half-edge 1
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t corner = gate / 3 * 3 + (gate + k + 2) % 3;
        const float* p = mesh.positions.data() + 3 * size_t{mesh.indices[corner]};
        for (size_t s = 0; s < 3; ++s) {
          positions[3 * size_t{group(f, k)} + s] = static_cast<int32_t>(std::lround(p[s] * 1000));
        }
      }
    }
    return positions;
  }
  Stages<EncoderIo>& writer() { return writer_; }
  EncoderIo& encoder() { return encoder_; }
  PieceHeader& header() { return writer_.header; }

  /// Ends the streams and opens the other side up to the same stage.
  Stages<DecoderIo<kSingle>>& reader() {
    streams_ = encoder_.finish();
    return readerOf(writer_.header);
  }
  /// The same with other claims.
  Stages<DecoderIo<kSingle>>& readerOf(const PieceHeader& header) {
    decoder_ = std::make_unique<DecoderIo<kSingle>>(streams_.codes, streams_.tokens, streams_.raw);
    reader_ = std::make_unique<Stages<DecoderIo<kSingle>>>(*decoder_, header, writer_.attributes);
    EXPECT_TRUE(reader_->piece.codeConnectivity(PieceTruth{}).ok());
    EXPECT_TRUE(reader_->piece.codeStitch(PieceTruth{}).ok());
    return *reader_;
  }
  DecoderIo<kSingle>& decoder() { return *decoder_; }

  PieceTruth truth;

 private:
  static std::vector<AttributeInfo> listOf(const AttributeInfo& position,
                                           std::vector<AttributeInfo> further) {
    further.insert(further.begin(), position);
    return further;
  }
  static PieceHeader headerOf(const Surface& surface, uint32_t isolated_count) {
    PieceHeader header = surface.header();
    header.isolated_count = isolated_count;
    if (isolated_count != 0) header.flags |= piece_flag::kIsolated;
    return header;
  }

  Surface surface_;
  EncoderIo encoder_;
  Stages<EncoderIo> writer_;
  std::vector<uint32_t> classes_;
  EncoderIo::Streams streams_;
  std::unique_ptr<DecoderIo<kSingle>> decoder_;
  std::unique_ptr<Stages<DecoderIo<kSingle>>> reader_;
};

// ---- Positions ----------------------------------------------------------------------------------

/// What a walk over a piece sees around a vertex, as numbers: vertices, kNone for those that are
/// not known, and counts.
using Sight = std::vector<uint32_t>;

uint32_t numberOf(const VertexRecord* records, const VertexRecord* r) {
  return r != nullptr ? static_cast<uint32_t>(r - records) : kNone;
}
Sight sightOf(const VertexRecord* records, const PlainFan& fan, const Beyond& b) {
  Sight sight;
  for (const VertexRecord* r :
       {fan.n0, fan.n1, fan.n2, fan.o0, fan.o1, b.has_ya ? b.ya : nullptr,
        b.has_yb ? b.yb : nullptr, b.has_x ? b.xa : nullptr, b.has_x ? b.xb : nullptr})
    sight.push_back(numberOf(records, r));
  return sight;
}
Sight sightOf(const VertexRecord* records, const AnyFan& fan) {
  Sight sight = {fan.closed ? 1u : 0u, fan.face_count, fan.neighbour_count};
  for (uint32_t i = 0; i <= fan.face_count; ++i) sight.push_back(numberOf(records, fan.n[i]));
  for (uint32_t i = 0; i < fan.face_count; ++i) sight.push_back(numberOf(records, fan.o[i]));
  return sight;
}

/// A visitor of RegionGrowth that keeps what it sees.
class Sights {
 public:
  class Plain {
   public:
    explicit Plain(Sights& sights) : sights_(sights) {}
    bool visit(uint32_t v, const PlainFan& fan) {
      sights_.plain(v, fan);
      return true;
    }
    void close(Sights&) {}
    void reopen(Sights&) {}

   private:
    Sights& sights_;
  };

  Sights(FaceMesh& mesh, const Groups& groups) : records_(groups.count) {
    RegionGrowth growth(mesh, groups, records_.data(), true, Allocator{});
    faces_ = growth.faces();
    EXPECT_TRUE(growth.run(*this, nullptr).ok());
  }
  void plain(uint32_t v, const PlainFan& fan) {
    add(v, sightOf(records_.data(), fan, lookBeyond(faces_, records_.data(), fan, true)));
  }
  void fan(uint32_t v, const AnyFan& fan) { add(v, sightOf(records_.data(), fan)); }
  void seed(uint32_t v, const VertexRecord* neighbour, uint32_t) {
    add(v, {numberOf(records_.data(), neighbour)});
  }
  Status check() const { return {}; }

  std::vector<std::pair<uint32_t, Sight>> list;

 private:
  void add(uint32_t v, Sight sight) {
    records_[v].q[3] = kKnown;
    list.emplace_back(v, std::move(sight));
  }

  FaceView faces_{nullptr};
  std::vector<VertexRecord> records_;
};

TEST(PositionRecording, RestoresWhatTheWalkSaw) {
  using Kind = PositionRecording::Kind;
  std::map<Kind, size_t> counts;
  for (const TestMesh& mesh : surfaces()) {
    Pair<false> pair(mesh, positionInfo(10));
    auto& piece = pair.writer().piece;
    const std::vector<std::pair<uint32_t, Sight>> seen = Sights(piece.mesh, piece.groups).list;
    const std::vector<int32_t> positions = pair.latticePositions(mesh, 0);
    std::vector<VertexRecord> records(piece.groups.count);
    PositionRecording recording;
    ASSERT_TRUE(recording.record(piece.mesh, piece.groups, records.data(), positions.data()).ok());
    ASSERT_EQ(recording.visits().size(), seen.size());
    for (size_t i = 0; i < seen.size(); ++i) {
      const PositionRecording::Visit& visit = recording.visits()[i];
      EXPECT_EQ(visit.vertex, seen[i].first);
      ++counts[static_cast<Kind>(visit.kind)];
      PlainFan plain;
      Beyond beyond;
      AnyFan any;
      switch (static_cast<Kind>(visit.kind)) {
        case Kind::kPlain:
          recording.plain(records.data(), visit, plain, beyond);
          EXPECT_EQ(sightOf(records.data(), plain, beyond), seen[i].second);
          break;
        case Kind::kAny:
          recording.any(records.data(), visit, any);
          EXPECT_EQ(sightOf(records.data(), any), seen[i].second);
          break;
        case Kind::kSeed:
          const VertexRecord* neighbour = recording.seedNeighbour(records.data(), visit);
          EXPECT_EQ(numberOf(records.data(), neighbour), seen[i].second[0]);
          EXPECT_EQ(recording.beginsComponent(visit), neighbour == nullptr);
          break;
      }
    }
  }
  for (const Kind kind : {Kind::kPlain, Kind::kAny, Kind::kSeed}) EXPECT_GT(counts[kind], 10u);
}

enum class Values : uint8_t { kRandom, kSmooth, kAnyInteger, kJumps, kPlanes };

/// Choices of the encoder that need nothing else.
std::vector<uint8_t> positionPredictors() {
  using namespace position_mode;
  return {0,
          kWeights,
          kWeights | kSelect,
          kFold,
          kWeights | kShear,
          kWeights | kFold | kSplit,
          kWeights | kSelect | kFold | kSplit | kShear};
}

const AxisPlanes kSomePlanes[3] = {{0, 5 * AxisPlanes::kOne},
                                   {7 * AxisPlanes::kOne / 3, 31 * AxisPlanes::kOne / 4},
                                   {AxisPlanes::kMinStep - 1, AxisPlanes::kMinStep}};

/// On planes, on diagonals or anywhere, unlike any real isosurface.
void setNearPlanes(Random& random, uint8_t bits, int32_t* q) {
  const int32_t end = 1 << bits;
  const int32_t t = static_cast<int32_t>(random.below(8));
  const bool on_diagonal = random.chance(30);
  for (uint32_t s = 0; s < 3; ++s) {
    const int32_t plane = static_cast<int32_t>(random.below(1u << bits) / 8);
    q[s] = kSomePlanes[s].at(plane);
    if (on_diagonal) q[s] += random.chance(50) ? t : -t;
    if (!on_diagonal && random.chance(40)) q[s] += static_cast<int32_t>(random.below(4));
    q[s] = std::clamp(q[s], 0, end - 1);
  }
}

template <bool kSingle>
void expectPositions(const TestMesh& mesh, uint8_t bits, uint8_t predictor, Values kind,
                     uint32_t isolated_count) {
  SCOPED_TRACE(mesh.name + ", bits " + std::to_string(bits) + ", predictor " +
               std::to_string(predictor));
  AttributeInfo info = positionInfo(bits);
  info.predictor = predictor;
  Pair<kSingle> pair(mesh, info, isolated_count);
  Random random(bits);
  std::vector<int32_t> positions(3 * (size_t{pair.groupCount()} + isolated_count));
  for (size_t i = 0; i < positions.size(); ++i) {
    switch (kind) {
      case Values::kRandom: positions[i] = static_cast<int32_t>(random.below(1u << bits)); break;
      case Values::kSmooth:
        positions[i] = static_cast<int32_t>((i / 3 * (1 + i % 3)) & ((1u << bits) - 1));
        break;
      case Values::kAnyInteger:
        positions[i] = static_cast<int32_t>(random.next() >> 32);
        if (random.chance(10)) positions[i] = std::numeric_limits<int32_t>::min();
        if (random.chance(10)) positions[i] = std::numeric_limits<int32_t>::max();
        break;
      case Values::kJumps:  // as far as possible, where nobody expects it
        positions[i] = random.chance(97) ? 0 : std::numeric_limits<int32_t>::min();
        break;
      case Values::kPlanes:
        if (i % 3 == 0) setNearPlanes(random, bits, &positions[i]);
    }
  }
  const std::vector<int32_t> isolated(positions.end() - 3 * int64_t{isolated_count},
                                      positions.end());
  auto next = positions.end() - 3 * int64_t{isolated_count};
  for (const uint32_t i : isolatedOrder(isolated))
    next = std::copy_n(&isolated[3 * size_t{i}], 3, next);
  pair.truth.positions = positions.data();
  pair.truth.planes = kSomePlanes;
  ASSERT_TRUE(pair.writer().piece.codePositions(pair.truth).ok());
  auto& reader = pair.reader();
  const Status status = reader.piece.codePositions(PieceTruth{});
  ASSERT_TRUE(status.ok()) << status.what;
  ASSERT_TRUE(pair.decoder().finish().ok());
  ASSERT_GE(reader.piece.records.size(), positions.size() / 3);
  for (size_t g = 0; g < positions.size() / 3; ++g) {
    for (size_t s = 0; s < 3; ++s)
      ASSERT_EQ(reader.piece.records[g].q[s], positions[3 * g + s]) << "group " << g;
  }
  // The traversal enters each group once, by a half-edge of its own, in the same way on both sides.
  const auto& sequence = reader.piece.sequence;
  ASSERT_EQ(sequence.size(), pair.groupCount());
  std::set<uint32_t> entered;
  for (size_t i = 0; i < sequence.size(); ++i) {
    ASSERT_EQ(sequence[i], pair.writer().piece.sequence[i]);
    ASSERT_TRUE(entered.insert(reader.piece.mesh.words[sequence[i]]).second);
  }
}

TEST(Positions, PlanesHoldAnyValuesOfTheLattice) {
  for (const TestMesh& mesh : surfaces()) {
    for (const uint8_t bits : {uint8_t{1}, uint8_t{4}, uint8_t{9}, uint8_t{17}}) {
      using namespace position_mode;
      for (const uint8_t with_planes :
           {kPlanes, uint8_t{kPlanes | kWeights}, uint8_t{kPlanes | kWeights | kSelect}}) {
        for (const Values kind : {Values::kPlanes, Values::kRandom, Values::kSmooth}) {
          expectPositions<true>(mesh, bits, with_planes, kind, 2);
          expectPositions<false>(mesh, bits, with_planes, kind, 3);
        }
      }
    }
  }
}

TEST(Positions, AnyValuesAtAllBits) {
  const std::vector<TestMesh> meshes = surfaces();
  for (uint8_t bits = 1; bits <= 24; ++bits) {
    for (const uint8_t predictor : positionPredictors()) {
      const TestMesh& mesh = meshes[(bits + 5u * predictor) % meshes.size()];
      for (const Values kind :
           {Values::kRandom, Values::kSmooth, Values::kAnyInteger, Values::kJumps}) {
        expectPositions<true>(mesh, bits, predictor, kind, bits % 4u);
        expectPositions<false>(mesh, bits, predictor, kind, bits % 3u);
      }
    }
  }
}

TEST(Positions, OnAllKindsOfSurfaces) {
  for (const TestMesh& mesh : surfaces()) {
    for (const uint8_t bits : {uint8_t{6}, uint8_t{14}, uint8_t{17}, uint8_t{18}, uint8_t{24}}) {
      for (const uint8_t predictor : positionPredictors()) {
        expectPositions<true>(mesh, bits, predictor, Values::kRandom, 0);
        expectPositions<false>(mesh, bits, predictor, Values::kSmooth, 7);
      }
    }
  }
}

TEST(Positions, AFlatRegularGridIsCheap) {
  const TestMesh mesh = grid(40, 40);
  AttributeInfo info = positionInfo(14);
  Pair<false> pair(mesh, info);
  std::vector<int32_t> positions(3 * size_t{pair.groupCount()});
  // Group g is some vertex of the grid: its place comes from the source mesh.
  Surface surface(mesh);
  EncoderIo io(true);
  Stages<EncoderIo> stages(io, surface.header(), {info});
  PieceTruth truth;
  truth.connectivity = surface.truth();
  ASSERT_TRUE(stages.piece.codeConnectivity(truth).ok());
  const std::vector<uint32_t> source = surface.classOfVertex();
  for (size_t g = 0; g < source.size(); ++g) {
    positions[3 * g] = static_cast<int32_t>(source[g] % 41 * 100);
    positions[3 * g + 1] = static_cast<int32_t>(source[g] / 41 * 100);
  }
  pair.truth.positions = positions.data();
  const uint64_t before = pair.encoder().cost();
  ASSERT_TRUE(pair.writer().piece.codePositions(pair.truth).ok());
  const double bits = static_cast<double>(pair.encoder().cost() - before) / kCostOne;
  EXPECT_LT(bits, 4.0 * pair.groupCount());  // 14-bit values, 42 bits as they are
}

TEST(Positions, AStreamThatEndsIsAnError) {
  const TestMesh mesh = torus(30, 20);
  Pair<true> pair(mesh, positionInfo(14));
  Random random(1);
  std::vector<int32_t> positions(3 * size_t{pair.groupCount()});
  for (int32_t& q : positions) q = static_cast<int32_t>(random.below(1u << 14));
  const size_t connectivity_bytes = static_cast<size_t>(pair.encoder().cost() / kCostOne / 8 + 8);
  pair.truth.positions = positions.data();
  ASSERT_TRUE(pair.writer().piece.codePositions(pair.truth).ok());
  const std::vector<uint8_t> codes = pair.encoder().finish().codes;
  for (size_t size = connectivity_bytes; size + 100 < codes.size(); size += 97) {
    const std::vector<uint8_t> cut(codes.begin(),
                                   codes.begin() + static_cast<std::ptrdiff_t>(size));
    DecoderIo<true> decoder(cut, {}, {});
    Stages<DecoderIo<true>> reader(decoder, pair.header(), pair.writer().attributes);
    ASSERT_TRUE(reader.piece.codeConnectivity(PieceTruth{}).ok());
    ASSERT_TRUE(reader.piece.codeStitch(PieceTruth{}).ok());
    const bool decoded = reader.piece.codePositions(PieceTruth{}).ok();
    EXPECT_FALSE(decoded && decoder.finish().ok()) << size;
  }
}

// ---- Values -------------------------------------------------------------------------------------

AttributeInfo valuesInfo(uint8_t components, uint8_t predictor) {
  AttributeInfo info;
  info.format.semantic = Semantic::kColor;
  info.format.component_type = ComponentType::kUint32;
  info.format.component_count = components;
  info.coding = AttributeCoding::kInteger;
  info.predictor = predictor;
  return info;
}

/// Integer `i` of an attribute; q: the position of its wedge.
using MakeValue = std::function<int32_t(uint32_t attribute, uint32_t i, const int32_t* q)>;

/// Attributes through both sides, in this order; returns the bits of the last one.
template <bool kSingle>
double codeAttributes(const TestMesh& mesh, const std::vector<AttributeInfo>& infos,
                      uint32_t isolated_count, const MakeValue& value) {
  Pair<kSingle> pair(mesh, positionInfo(16), isolated_count, infos);
  const std::vector<int32_t> positions = pair.latticePositions(mesh, isolated_count);
  pair.truth.positions = positions.data();
  PieceCoder<EncoderIo>& writer = pair.writer().piece;
  EXPECT_TRUE(writer.codePositions(pair.truth).ok());
  EXPECT_TRUE(writer.codeSeams(pair.truth).ok());
  EXPECT_TRUE(writer.prepareAttributes().ok());
  std::vector<Array<int32_t>> values(infos.size() + 1);
  uint64_t before = 0;
  for (uint32_t a = 1; a <= infos.size(); ++a) {
    const uint32_t words = writer.codedComponentsOf(a);
    for (uint32_t i = 0; i < positions.size() / 3 * words; ++i)
      EXPECT_TRUE(values[a].push_back(value(a, i, &positions[i / words * 3])));
    before = pair.encoder().cost();
    EXPECT_TRUE(writer.codeAttribute(a, values[a]).ok());
  }
  const double bits = static_cast<double>(pair.encoder().cost() - before) / kCostOne;
  PieceCoder<DecoderIo<kSingle>>& reader = pair.reader().piece;
  EXPECT_TRUE(reader.codePositions(PieceTruth{}).ok());
  EXPECT_TRUE(reader.codeSeams(PieceTruth{}).ok());
  EXPECT_TRUE(reader.prepareAttributes().ok());
  for (uint32_t a = 1; a <= infos.size(); ++a) {
    Array<int32_t> decoded;
    EXPECT_TRUE(reader.codeAttribute(a, decoded).ok());
    EXPECT_TRUE(std::equal(values[a].data(), values[a].data() + values[a].size(), decoded.data(),
                           decoded.data() + decoded.size()))
        << "attribute " << a;
  }
  EXPECT_TRUE(pair.decoder().finish().ok());
  return bits;
}

TEST(Values, EveryMethodOnAllKindsOfSurfaces) {
  for (const TestMesh& mesh : surfaces()) {
    for (uint8_t components : {uint8_t{1}, uint8_t{2}, uint8_t{3}, uint8_t{4}, uint8_t{7}}) {
      for (uint32_t predictor = 0; predictor < 4; ++predictor) {
        const bool is_smooth = predictor >= 2;
        const AttributeInfo info = valuesInfo(components, static_cast<uint8_t>(predictor % 2));
        SCOPED_TRACE(mesh.name + ", predictor " + std::to_string(predictor));
        Random random(predictor);
        codeAttributes<false>(mesh, {info}, 3, [&](uint32_t, uint32_t, const int32_t* q) {
          if (is_smooth) return q[0] + q[1] / 8;
          const int32_t any = static_cast<int32_t>(random.next() >> 32);
          return random.chance(20) ? any : random.chance(50) ? 0 : any >> 24;
        });
      }
    }
  }
}

// ---- Memory of values ---------------------------------------------------------------------------

/// Two copies of a grid, the second one farther along x.
TestMesh twoGrids(float apart) {
  TestMesh mesh = grid(9, 7);
  const TestMesh other = mesh;
  const uint32_t count = static_cast<uint32_t>(mesh.positions.size() / 3);
  for (size_t i = 0; i < other.positions.size(); ++i)
    mesh.positions.push_back(other.positions[i] + (i % 3 == 0 ? apart : 0.0f));
  for (const uint32_t index : other.indices) mesh.indices.push_back(index + count);
  return mesh;
}

/// A number below 2^bits that both copies have at the same place.
uint32_t atPlace(const int32_t* q, uint32_t i, uint32_t bits) {
  const uint32_t place = static_cast<uint32_t>(q[0] % 30000) * 65599u + static_cast<uint32_t>(q[1]);
  return ((place * 0x9e3779b1u ^ i * 0x85ebca6bu) * 0xc2b2ae35u) >> (32 - bits);
}

TEST(Memory, ChartsThatAreUsedTwiceCostAFlag) {
  AttributeInfo info = valuesInfo(2, 0);
  info.format.semantic = Semantic::kTexcoord;
  const auto value = [](uint32_t, uint32_t i, const int32_t* q) {
    return static_cast<int32_t>(atPlace(q, i % 2, 16));
  };
  for (const uint8_t predictor : {uint8_t{0}, texcoord_method::kHinge}) {
    info.predictor = predictor;
    const double without = codeAttributes<true>(twoGrids(30), {info}, 2, value);
    info.predictor = static_cast<uint8_t>(predictor | texcoord_method::kRemembers);
    EXPECT_LT(codeAttributes<true>(twoGrids(30), {info}, 2, value), 0.7 * without);
    codeAttributes<false>(twoGrids(30), {info}, 0, value);
  }
}

TEST(Memory, NormalsOfPartsThatRepeatCostAFlag) {
  AttributeInfo info;
  info.format.semantic = Semantic::kNormal;
  info.format.component_count = 3;
  info.coding = AttributeCoding::kExactFloat;
  // Steep, so that no component of a normal is negative, like the values.
  TestMesh mesh = twoGrids(30);
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    mesh.positions[i + 2] -= 2 * (mesh.positions[i] + mesh.positions[i + 1]);
  }
  const auto value = [](uint32_t, uint32_t i, const int32_t* q) {
    return orderedFromFloat(static_cast<float>(atPlace(q, i % 3, 20)) * 0x1p-21f);
  };
  const double without = codeAttributes<true>(mesh, {info}, 2, value);
  info.predictor = exact_normal_method::kRemembers;
  EXPECT_LT(codeAttributes<true>(mesh, {info}, 2, value), 0.65 * without);
}

TEST(Memory, OnAllKindsOfSurfaces) {
  for (const TestMesh& mesh : surfaces()) {
    SCOPED_TRACE(mesh.name);
    AttributeInfo chart = valuesInfo(2, texcoord_method::kHinge | texcoord_method::kRemembers);
    chart.format.semantic = Semantic::kTexcoord;
    AttributeInfo normal;
    normal.format.semantic = Semantic::kNormal;
    normal.format.component_count = 3;
    normal.coding = AttributeCoding::kExactFloat;
    normal.predictor = exact_normal_method::kRemembers;
    Random random(1);
    codeAttributes<false>(mesh, {chart, normal}, 2, [&](uint32_t a, uint32_t, const int32_t*) {
      const int32_t few = static_cast<int32_t>(random.below(3));
      return a == 1 ? few : orderedFromFloat(static_cast<float>(few - 1));
    });
  }
}

// ---- The table of predictor bytes ---------------------------------------------------------------

/// Field by field, the search finds the best byte if fields do not depend on each other, and it
/// tries only valid bytes.
TEST(Predictors, TheSearchFindsTheBest) {
  Random random(5);
  for (const MethodInfo& info : kMethods) {
    const AttributeMethod method = info.method;
    if (isWithAnother(method) || method == AttributeMethod::kPosition) continue;
    for (uint32_t round = 0; round < 50; ++round) {
      uint64_t costs[256];
      for (uint64_t& cost : costs) cost = random.below(1000);
      const auto costOf = [&](uint8_t predictor) {
        uint64_t sum = 0;
        for (const PredictorField& field : info)
          sum += costs[(field.mask * 16u + field.valueOf(predictor)) & 255];
        return sum;
      };
      PredictorSearch search(method, true, {});
      while (!search.done()) {
        ASSERT_TRUE(isValidPredictor(method, search.candidate()));
        search.report(costOf(search.candidate()));
      }
      uint64_t best = ~uint64_t{0};
      for (uint32_t p = 0; p < 256; ++p) {
        const uint8_t predictor = static_cast<uint8_t>(p);
        if (isValidPredictor(method, predictor)) best = std::min(best, costOf(predictor));
      }
      EXPECT_EQ(costOf(search.best()), best) << info.name;
    }
  }
}

// ---- Seams --------------------------------------------------------------------------------------

uint32_t findRoot(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Wedge of each corner (3f+k), by cutting edges at random: every wedge is one run of corners.
std::vector<uint32_t> cutWedges(const FaceView& faces, uint32_t face_count, uint32_t cut_percent,
                                Random& random) {
  std::vector<uint32_t> parent(3 * size_t{face_count});
  std::iota(parent.begin(), parent.end(), 0u);
  const auto corner = [](uint32_t h) { return 3 * faceOf(h) + (h & 3); };
  for (uint32_t f = 0; f < face_count; ++f) {
    for (uint32_t h = f * kFaceWords; h < f * kFaceWords + 3; ++h) {
      const uint32_t clockwise = faces.rotateCw(h);
      if (clockwise == kNone || random.chance(cut_percent)) continue;
      parent[findRoot(parent, corner(h))] = findRoot(parent, corner(clockwise));
    }
  }
  std::vector<uint32_t> wedges(parent.size());
  for (uint32_t c = 0; c < wedges.size(); ++c) wedges[c] = findRoot(parent, c);
  return wedges;
}

/// The same with one of up to `most` wedges per group, chosen per corner: runs come again, also in
/// other umbrellas.
std::vector<uint32_t> scatteredWedges(const FaceView& faces, uint32_t face_count, uint32_t most,
                                      Random& random) {
  std::vector<uint32_t> wedges;
  for (uint32_t f = 0; f < face_count; ++f) {
    for (uint32_t k = 0; k < 3; ++k)
      wedges.push_back(faces.vertex(f * kFaceWords + k) * most + random.below(most));
  }
  return wedges;
}

template <bool kSingle>
void expectSeams(const TestMesh& mesh, uint32_t percent, uint32_t most, uint32_t isolated_count) {
  SCOPED_TRACE(mesh.name + ", " + std::to_string(percent) + " % cut, " + std::to_string(most));
  Pair<kSingle> pair(mesh, positionInfo(10), isolated_count);
  Random random(percent + most);
  const std::vector<uint32_t> source =
      most == 0 ? cutWedges(pair.faces(), pair.faceCount(), percent, random)
                : scatteredWedges(pair.faces(), pair.faceCount(), most, random);
  std::vector<uint32_t> group_of_corner;
  for (uint32_t f = 0; f < pair.faceCount(); ++f) {
    for (uint32_t k = 0; k < 3; ++k) group_of_corner.push_back(pair.group(f, k));
  }
  const uint32_t surface_wedges =
      static_cast<uint32_t>(std::set<uint32_t>(source.begin(), source.end()).size());
  pair.header().flags |= piece_flag::kSeams;
  pair.header().wedge_count = surface_wedges + isolated_count;
  const std::vector<int32_t> positions(3 * (size_t{pair.groupCount()} + isolated_count), 0);
  pair.truth.positions = positions.data();
  ASSERT_TRUE(pair.writer().piece.codePositions(pair.truth).ok());
  pair.truth.corner_source = source.data();
  const Status written = pair.writer().piece.codeSeams(pair.truth);
  ASSERT_TRUE(written.ok()) << written.what;

  auto& reader = pair.reader();
  ASSERT_TRUE(reader.piece.codePositions(PieceTruth{}).ok());
  const Status status = reader.piece.codeSeams(PieceTruth{});
  ASSERT_TRUE(status.ok()) << status.what;
  ASSERT_TRUE(pair.decoder().finish().ok());
  std::map<uint32_t, uint32_t> wedge_of_source;
  std::set<uint32_t> wedges;
  for (uint32_t c = 0; c < source.size(); ++c) {
    const uint32_t wedge = reader.piece.mesh.words[size_t{c / 3} * kFaceWords + c % 3];
    ASSERT_EQ(pair.writer().piece.mesh.words[size_t{c / 3} * kFaceWords + c % 3], wedge);
    ASSERT_LT(wedge, surface_wedges);
    ASSERT_EQ(reader.piece.groupOf(wedge), group_of_corner[c]);
    const auto [entry, is_new] = wedge_of_source.emplace(source[c], wedge);
    ASSERT_EQ(entry->second, wedge) << "a wedge fell apart";
    ASSERT_TRUE(!is_new || wedges.insert(wedge).second) << "two wedges became one";
  }
  // The sequence for the attributes: each wedge once.
  ASSERT_EQ(reader.piece.wedges.count, surface_wedges);
  ASSERT_EQ(reader.piece.wedges.isolated_count, isolated_count);
  ASSERT_EQ(reader.piece.wedges.isolated_first, surface_wedges);
  std::set<uint32_t> entered;
  for (uint32_t i = 0; i < surface_wedges; ++i) {
    ASSERT_TRUE(entered.insert(reader.piece.mesh.words[reader.piece.wedges.half_edges[i]]).second);
  }
  for (uint32_t i = 0; i < isolated_count; ++i)
    ASSERT_EQ(reader.piece.groupOf(surface_wedges + i), pair.groupCount() + i);
}

TEST(Seams, AnyPartitionIntoRuns) {
  for (const TestMesh& mesh : surfaces()) {
    for (const uint32_t percent : {0u, 3u, 30u, 70u, 100u}) {
      expectSeams<true>(mesh, percent, 0, 0);
      expectSeams<false>(mesh, percent, 0, percent % 4);
    }
  }
}

TEST(Seams, WedgesThatComeAgain) {
  for (const TestMesh& mesh : surfaces()) {
    for (const uint32_t most : {1u, 2u, 3u, 9u}) {
      expectSeams<true>(mesh, 0, most, 0);
      expectSeams<false>(mesh, 0, most, most);
    }
  }
}

TEST(Seams, OtherCountsAreErrors) {
  Pair<true> pair(grid(9, 7), positionInfo(10));
  Random random(1);
  const std::vector<uint32_t> source = cutWedges(pair.faces(), pair.faceCount(), 30, random);
  const uint32_t count =
      static_cast<uint32_t>(std::set<uint32_t>(source.begin(), source.end()).size());
  pair.header().flags |= piece_flag::kSeams;
  pair.header().wedge_count = count;
  const std::vector<int32_t> positions(3 * size_t{pair.groupCount()}, 0);
  pair.truth.positions = positions.data();
  ASSERT_TRUE(pair.writer().piece.codePositions(pair.truth).ok());
  pair.truth.corner_source = source.data();
  ASSERT_TRUE(pair.writer().piece.codeSeams(pair.truth).ok());
  (void)pair.reader();
  for (const uint32_t claimed : {0u, 1u, count - 1, count, count + 1, 10 * count}) {
    PieceHeader header = pair.header();
    header.wedge_count = claimed;
    auto& reader = pair.readerOf(header);
    ASSERT_TRUE(reader.piece.codePositions(PieceTruth{}).ok());
    const Error error = reader.piece.codeSeams(PieceTruth{}).error;
    EXPECT_EQ(error, claimed == count ? Error::kOk : Error::kBadAttribute) << claimed;
  }
}

// ---- Parts and listed triangles -----------------------------------------------------------------

struct Leftovers {
  std::vector<uint32_t> parts;
  std::vector<ListedTriangle> list;

  LeftoverTruth truth() const { return {parts.data(), list.data()}; }
};

/// Listed triangles of every shape; those that refer to faces ascend.
Leftovers randomLeftovers(const FaceView& faces, uint32_t face_count, uint32_t wedge_count,
                          uint32_t part_count, uint32_t listed_count, Random& random) {
  Leftovers leftovers;
  uint32_t part = 0;
  for (uint32_t f = 0; f < face_count; ++f) {
    if (random.chance(20)) part = random.below(part_count);
    leftovers.parts.push_back(part);
  }
  uint32_t face = 0;
  for (uint32_t i = 0; i < listed_count; ++i) {
    ListedTriangle t{{}, random.below(part_count), random.below(8), face};
    if (t.shape == listed_shape::kAny) {
      for (uint32_t& wedge : t.wedge) wedge = random.below(wedge_count);
    } else {
      face += random.chance(50) ? 0 : random.below((face_count - face) / 2 + 1);
      t.face = face;
      placeOnFace(faces, t);
    }
    leftovers.list.push_back(t);
  }
  if (listed_count > 1) {
    leftovers.list[0] = {
        {wedge_count - 1, 0, wedge_count - 1}, part_count - 1, listed_shape::kAny, 0};
    leftovers.list[1] = {{0, wedge_count - 1, 0}, 0, listed_shape::kAny, 0};
  }
  return leftovers;
}

/// Writes the leftovers and sets the header's claims.
template <bool kSingle>
void writeLeftovers(Pair<kSingle>& pair, const Leftovers& leftovers, uint32_t part_count) {
  PieceHeader& header = pair.header();
  header.part_count = part_count;
  header.listed_count = static_cast<uint32_t>(leftovers.list.size());
  if (part_count > 1) header.flags |= piece_flag::kManyParts;
  if (header.listed_count != 0) header.flags |= piece_flag::kListed;
  pair.truth.leftovers = leftovers.truth();
  ASSERT_TRUE(pair.writer().piece.codeLeftovers(pair.truth).ok());
}

template <bool kSingle>
void expectLeftovers(const TestMesh& mesh, uint32_t part_count, uint32_t listed_count) {
  SCOPED_TRACE(mesh.name + ", " + std::to_string(part_count) + " parts");
  Pair<kSingle> pair(mesh, positionInfo(10), 2);
  Random random(part_count + listed_count);
  const Leftovers leftovers = randomLeftovers(
      pair.faces(), pair.faceCount(), pair.header().wedge_count, part_count, listed_count, random);
  writeLeftovers(pair, leftovers, part_count);
  auto& reader = pair.reader();
  const Status status = reader.piece.codeLeftovers(PieceTruth{});
  ASSERT_TRUE(status.ok()) << status.what;
  ASSERT_TRUE(pair.decoder().finish().ok());
  for (uint32_t f = 0; f < pair.faceCount() && part_count > 1; ++f)
    ASSERT_EQ(reader.piece.mesh.words[size_t{f} * kFaceWords + kFaceWord], leftovers.parts[f]);
  ASSERT_EQ(reader.piece.list.size(), leftovers.list.size());
  for (size_t i = 0; i < leftovers.list.size(); ++i) {
    ASSERT_EQ(reader.piece.list[i].part, leftovers.list[i].part);
    for (int k = 0; k < 3; ++k)
      ASSERT_EQ(reader.piece.list[i].wedge[k], leftovers.list[i].wedge[k]);
  }
}

TEST(Leftovers, PartsAndListedTriangles) {
  for (const TestMesh& mesh : {grid(9, 7), torus(6, 5), looseTriangles(20), book(4, 4, 3)}) {
    for (const uint32_t part_count : {1u, 2u, 3u, 50u}) {
      for (const uint32_t listed_count : {0u, 1u, 40u, 400u}) {
        expectLeftovers<true>(mesh, part_count, listed_count);
        expectLeftovers<false>(mesh, part_count, listed_count);
      }
    }
  }
}

/// Repeating every face costs almost nothing.
TEST(Leftovers, FacesAgainAreNearlyFree) {
  Pair<true> pair(torus(30, 20), positionInfo(10));
  Leftovers leftovers;
  leftovers.parts.assign(pair.faceCount(), 0);
  for (uint32_t f = 0; f < pair.faceCount(); ++f) {
    leftovers.list.push_back({{}, 0, listed_shape::kFaceAgain, f});
    placeOnFace(pair.faces(), leftovers.list.back());
  }
  const uint64_t before = pair.encoder().cost();
  writeLeftovers(pair, leftovers, 1);
  EXPECT_LT(pair.encoder().cost() - before, pair.faceCount() * uint64_t{kCostOne} / 8);
}

TEST(Leftovers, OtherClaimsAreErrors) {
  Pair<true> pair(grid(5, 5), positionInfo(10));
  Random random(3);
  const Leftovers leftovers =
      randomLeftovers(pair.faces(), pair.faceCount(), pair.header().wedge_count, 3, 60, random);
  writeLeftovers(pair, leftovers, 3);
  (void)pair.reader();
  const auto decode = [&](const PieceHeader& header) {
    return pair.readerOf(header).piece.codeLeftovers(PieceTruth{}).error;
  };
  EXPECT_EQ(decode(pair.header()), Error::kOk);
  PieceHeader header = pair.header();
  header.listed_count += 100000;
  EXPECT_NE(decode(header), Error::kOk);
  header = pair.header();
  header.wedge_count -= 1;  // the first listed triangle has the last wedge
  EXPECT_EQ(decode(header), Error::kBadAttribute);
  header = pair.header();
  header.part_count = 2;
  EXPECT_NE(decode(header), Error::kOk);
}

}  // namespace
}  // namespace mcc::test
