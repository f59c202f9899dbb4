// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The public interface of reader and writer: arguments, limits, memory, progress.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "mcc/reader.h"
#include "mcc/writer.h"
#include "mesh/face_mesh.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "unit/failing_allocator.h"

namespace mcc::test {
namespace {

std::vector<uint8_t> payloadOf(const PieceView& view) {
  EncodeResult result;
  const Status status = encode({&view, 1}, {}, result);
  EXPECT_TRUE(status.ok()) << status.what;
  return result.payload;
}
std::vector<uint8_t> payloadOf(const TestMesh& mesh) { return payloadOf(MeshPiece(mesh).view()); }

std::vector<uint8_t> manyPieces(uint32_t count) {
  const TestMesh mesh = withNormals(torus(6, 5));
  const MeshPiece piece(mesh);
  const std::vector<PieceView> views(count, piece.view());
  EncodeResult result;
  EXPECT_TRUE(encode(views, {}, result).ok());
  return result.payload;
}

/// Memory of the right shape for a payload.
class Targets {
 public:
  explicit Targets(const PayloadInfo& info)
      : attributes_(info.pieces.size()), parts_(info.pieces.size()) {
    for (size_t p = 0; p < info.pieces.size(); ++p) {
      for (const AttributeInfo& a : info.pieces[p].attributes) {
        const size_t stride = elementBytes(a.format);
        memory_.emplace_back(stride * info.pieces[p].wedge_count);
        attributes_[p].push_back({memory_.back().data(), stride});
      }
      for (const PartInfo& part : info.pieces[p].parts) {
        memory_.emplace_back(size_t{part.triangle_count} * 12);
        parts_[p].push_back({memory_.back().data(), IndexType::kUint32});
      }
    }
    refresh();
  }
  std::vector<AttributeTarget>& attributes(size_t piece) { return attributes_[piece]; }
  std::vector<PartTarget>& parts(size_t piece) { return parts_[piece]; }
  /// After a change of a vector's size.
  std::span<const PieceTarget> refresh() {
    pieces_.clear();
    for (size_t p = 0; p < attributes_.size(); ++p) pieces_.push_back({attributes_[p], parts_[p]});
    return pieces_;
  }
  std::vector<uint8_t> bytes() const {
    std::vector<uint8_t> all;
    for (const std::vector<uint8_t>& m : memory_) all.insert(all.end(), m.begin(), m.end());
    return all;
  }

 private:
  std::vector<std::vector<uint8_t>> memory_;
  std::vector<std::vector<AttributeTarget>> attributes_;
  std::vector<std::vector<PartTarget>> parts_;
  std::vector<PieceTarget> pieces_;
};

// ---- Reader -------------------------------------------------------------------------------------

TEST(Reader, NothingOpened) {
  Payload payload;
  EXPECT_EQ(payload.info().pieces.size(), 0u);
  EXPECT_EQ(payload.decode({}).error, Error::kBadArgument);
  EXPECT_EQ(payload.open({}).error, Error::kBadMagic);
  EXPECT_EQ(payload.decode({}).error, Error::kBadArgument);
}

TEST(Reader, InfoDescribesThePayload) {
  const TestMesh mesh = withNormals(sheetWithHoles(2, 1));
  const std::vector<uint8_t> bytes = payloadOf(mesh);
  Payload payload;
  ASSERT_TRUE(payload.open(bytes).ok());
  const PayloadInfo& info = payload.info();
  ASSERT_EQ(info.pieces.size(), 1u);
  EXPECT_EQ(info.pieces[0].wedge_count, mesh.vertexCount());
  EXPECT_EQ(info.pieces[0].vertex_count, mesh.vertexCount());
  ASSERT_EQ(info.pieces[0].attributes.size(), 2u);
  EXPECT_EQ(info.pieces[0].attributes[0].format.semantic, Semantic::kPosition);
  EXPECT_EQ(info.pieces[0].attributes[1].format.semantic, Semantic::kNormal);
  ASSERT_EQ(info.pieces[0].parts.size(), 1u);
  EXPECT_EQ(info.pieces[0].parts[0].triangle_count, mesh.triangleCount());
  EXPECT_EQ(info.header_bytes + info.codes_bytes + info.tokens_bytes + info.raw_bits_bytes,
            bytes.size());
}

TEST(Reader, MovesAndReopens) {
  const std::vector<uint8_t> first = payloadOf(torus(5, 4));
  const std::vector<uint8_t> second = manyPieces(3);
  FailingAllocator memory;
  {
    Payload a;
    ASSERT_TRUE(a.open(first, {}, memory.allocator()).ok());
    Payload b(std::move(a));
    EXPECT_EQ(b.info().pieces.size(), 1u);
    EXPECT_EQ(a.info().pieces.size(), 0u);  // NOLINT(bugprone-use-after-move): empty, as promised
    ASSERT_TRUE(a.open(second, {}, memory.allocator()).ok());
    a = std::move(b);
    EXPECT_EQ(a.info().pieces.size(), 1u);
    ASSERT_TRUE(a.open(second, {}, memory.allocator()).ok());  // over an open one
    EXPECT_EQ(a.info().pieces.size(), 3u);
    EXPECT_FALSE(a.open(std::span(second).first(9), {}, memory.allocator()).ok());
    EXPECT_EQ(a.info().pieces.size(), 0u);
  }
  EXPECT_EQ(memory.liveBlocks(), 0u);
  EXPECT_TRUE(memory.booksBalance());
}

TEST(Reader, TargetsOfAnotherShape) {
  const std::vector<uint8_t> bytes = manyPieces(2);
  Payload payload;
  ASSERT_TRUE(payload.open(bytes).ok());
  const auto decode = [&](auto change) {
    Targets targets(payload.info());
    change(targets);
    return payload.decode(targets.refresh()).error;
  };
  EXPECT_EQ(decode([](Targets&) {}), Error::kOk);
  EXPECT_EQ(decode([](Targets& t) { t.attributes(1).pop_back(); }), Error::kBadArgument);
  EXPECT_EQ(decode([](Targets& t) { t.attributes(0).push_back({}); }), Error::kBadArgument);
  EXPECT_EQ(decode([](Targets& t) { t.parts(1).clear(); }), Error::kBadArgument);
  EXPECT_EQ(decode([](Targets& t) { t.parts(0).push_back({}); }), Error::kBadArgument);
  EXPECT_EQ(decode([](Targets& t) { t.attributes(1)[1].stride_bytes = 11; }), Error::kBadArgument);
  EXPECT_EQ(decode([](Targets& t) { t.attributes(0)[0].stride_bytes = 0; }), Error::kBadArgument);
  Targets targets(payload.info());
  EXPECT_EQ(payload.decode(targets.refresh().first(1)).error, Error::kBadArgument);
  EXPECT_EQ(payload.decode({}).error, Error::kBadArgument);
}

/// Whichever target it is.
TEST(Reader, TargetsThatLeadOutOfMemory) {
  const std::vector<uint8_t> bytes = manyPieces(2);
  Payload payload;
  ASSERT_TRUE(payload.open(bytes).ok());
  auto* const last_bytes = reinterpret_cast<uint8_t*>(UINTPTR_MAX - 8);
  const auto expectRefused = [&](size_t piece, auto change) {
    Targets targets(payload.info());
    change(targets.attributes(piece), targets.parts(piece)[0]);
    EXPECT_EQ(payload.decode(targets.refresh()).error, Error::kBadArgument) << piece;
  };
  using Attributes = std::vector<AttributeTarget>;
  for (const size_t piece : {0, 1}) {
    for (const size_t a : {0, 1}) {
      expectRefused(piece, [&](Attributes& all, PartTarget&) { all[a].stride_bytes = SIZE_MAX; });
      expectRefused(piece, [&](Attributes& all, PartTarget&) { all[a].data = last_bytes; });
    }
    expectRefused(piece, [&](Attributes&, PartTarget& part) { part.indices = last_bytes; });
    for (const auto type : {0, 3, 8}) {
      expectRefused(piece, [&](Attributes&, PartTarget& part) {
        part.index_type = static_cast<IndexType>(type);
      });
    }
  }
}

TEST(Reader, NarrowIndices) {
  const auto decode = [](uint32_t vertices, IndexType type) {
    const TestMesh mesh = bipyramid(vertices - 2);
    const MeshPiece piece(mesh);
    TargetLayout layout;
    layout.index_type = type;
    return roundTrip(piece.view(), {}, layout).failure;
  };
  EXPECT_EQ(decode(256, IndexType::kUint8), "");
  EXPECT_NE(decode(257, IndexType::kUint8), "");
  EXPECT_EQ(decode(257, IndexType::kUint16), "");
  EXPECT_EQ(decode(65536, IndexType::kUint16), "");
  EXPECT_NE(decode(65537, IndexType::kUint16), "");
  EXPECT_EQ(decode(65537, IndexType::kUint32), "");
}

TEST(Reader, StridesLeaveTheGapsAlone) {
  const TestMesh mesh = chartGrid(6, 6, 2);
  const MeshPiece piece(mesh);
  for (const uint32_t padding : {0u, 1u, 3u, 20u}) {
    TargetLayout layout;
    layout.padding_bytes = padding;
    EXPECT_EQ(roundTrip(piece.view(), {}, layout).failure, "");
  }
}

TEST(Reader, DroppedAttributesAndTriangles) {
  const std::vector<uint8_t> bytes = payloadOf(chartGrid(6, 6, 2));
  Payload payload;
  ASSERT_TRUE(payload.open(bytes).ok());
  const size_t attribute_count = payload.info().pieces[0].attributes.size();
  ASSERT_EQ(attribute_count, 3u);
  Targets all(payload.info());
  ASSERT_TRUE(payload.decode(all.refresh()).ok());
  for (size_t dropped = 0; dropped <= attribute_count; ++dropped) {
    Targets targets(payload.info());
    if (dropped < attribute_count) {
      targets.attributes(0)[dropped] = {};
    } else {
      targets.parts(0)[0].indices = nullptr;
    }
    ASSERT_TRUE(payload.decode(targets.refresh()).ok());
    // The rest is as before.
    for (size_t a = 0; a < attribute_count; ++a) {
      if (a == dropped) continue;
      const size_t size =
          targets.attributes(0)[a].stride_bytes * payload.info().pieces[0].wedge_count;
      EXPECT_EQ(std::memcmp(targets.attributes(0)[a].data, all.attributes(0)[a].data, size), 0);
    }
  }
}

TEST(Reader, DecodesTwiceAlike) {
  const std::vector<uint8_t> bytes = manyPieces(2);
  Payload payload;
  ASSERT_TRUE(payload.open(bytes).ok());
  Targets first(payload.info());
  Targets second(payload.info());
  ASSERT_TRUE(payload.decode(first.refresh()).ok());
  ASSERT_TRUE(payload.decode(second.refresh()).ok());
  EXPECT_EQ(first.bytes(), second.bytes());
}

TEST(Reader, ProgressAndCancelling) {
  const std::vector<uint8_t> bytes = manyPieces(4);
  Payload payload;
  ASSERT_TRUE(payload.open(bytes).ok());
  struct Calls {
    std::vector<double> done;
    size_t allowed = 1000;
  };
  const auto decode = [&](Calls& calls, FailingAllocator& memory) {
    Targets targets(payload.info());
    DecodeOptions options;
    options.allocator = memory.allocator();
    options.progress_user = &calls;
    options.progress = [](void* user, double done) {
      auto* c = static_cast<Calls*>(user);
      c->done.push_back(done);
      return c->done.size() <= c->allowed;
    };
    return payload.decode(targets.refresh(), options).error;
  };
  Calls calls;
  FailingAllocator memory;
  EXPECT_EQ(decode(calls, memory), Error::kOk);
  ASSERT_FALSE(calls.done.empty());
  EXPECT_TRUE(std::is_sorted(calls.done.begin(), calls.done.end()));
  EXPECT_GE(calls.done.front(), 0);
  EXPECT_LE(calls.done.back(), 1);
  for (size_t allowed = 0; allowed < calls.done.size(); ++allowed) {
    Calls some;
    some.allowed = allowed;
    EXPECT_EQ(decode(some, memory), Error::kCancelled);
    EXPECT_EQ(some.done.size(), allowed + 1);  // it is not called again
    EXPECT_EQ(memory.liveBlocks(), 0u);
  }
}

/// Runs out of memory at the n-th allocation, for every n.
TEST(Reader, EveryAllocationMayFail) {
  const TestMesh meshes[] = {withUnused(withRandomWedges(book(3, 3, 2), 1, 3), 1, 3),
                             withDegenerates(withIndexDuplicates(chartGrid(5, 5, 2), 2, 5), 3, 5),
                             mengerSponge(1), looseTriangles(30)};
  for (const TestMesh& mesh : meshes) {
    SCOPED_TRACE(mesh.name);
    MeshPiece piece(mesh);
    AttributeFormat format;
    format.semantic = Semantic::kCustom;
    format.component_type = ComponentType::kUint8;
    format.component_count = 4;
    const std::vector<uint8_t> custom(4 * size_t{mesh.vertexCount()}, 9);
    piece.add(format, custom.data());
    std::vector<PartView> parts(2, PartView{mesh.indices});
    piece.setParts(std::move(parts));
    const std::vector<uint8_t> bytes = payloadOf(piece.view());
    uint64_t failures = 0;
    for (uint64_t allocations = 0;; ++allocations) {
      FailingAllocator memory(allocations);
      Error error = Error::kOk;
      {
        Payload payload;
        error = payload.open(bytes, {}, memory.allocator()).error;
        EXPECT_EQ(payload.info().pieces.empty(), error != Error::kOk);
        if (error == Error::kOk) {
          Targets targets(payload.info());
          DecodeOptions options;
          options.allocator = memory.allocator();
          error = payload.decode(targets.refresh(), options).error;
        }
      }
      ASSERT_EQ(memory.liveBlocks(), 0u) << allocations;
      ASSERT_TRUE(memory.booksBalance()) << allocations;
      if (error == Error::kOk) break;
      ASSERT_EQ(error, Error::kOutOfMemory) << allocations;
      ++failures;
      ASSERT_LT(failures, 10000u);
    }
    EXPECT_GT(failures, 10u);
  }
}

TEST(Reader, LimitsHoldBeforeMemoryIsTaken) {
  const TestMesh mesh = bipyramid(1000);
  const std::vector<uint8_t> bytes = payloadOf(mesh);
  const auto open = [&](const Limits& limits) {
    Payload payload;
    return payload.open(bytes, limits).error;
  };
  Limits limits;
  limits.max_vertices = mesh.vertexCount();
  limits.max_triangles = mesh.triangleCount();
  limits.max_attributes = 1;
  limits.max_pieces = 1;
  EXPECT_EQ(open(limits), Error::kOk);
  Limits fewer = limits;
  --fewer.max_vertices;
  EXPECT_EQ(open(fewer), Error::kLimit);
  fewer = limits;
  --fewer.max_triangles;
  EXPECT_EQ(open(fewer), Error::kLimit);
  fewer = limits;
  --fewer.max_attributes;
  EXPECT_EQ(open(fewer), Error::kLimit);
  fewer = limits;
  --fewer.max_pieces;
  EXPECT_EQ(open(fewer), Error::kLimit);
}

// ---- Writer -------------------------------------------------------------------------------------

struct Source {
  TestMesh mesh = tetrahedron();
  std::vector<AttributeView> attributes = std::vector<AttributeView>(1);
  std::vector<PartView> parts = {PartView{mesh.indices}};
  uint32_t wedge_count = 4;

  Source() {
    attributes[0].data = mesh.positions.data();
    attributes[0].stride_bytes = 12;
    attributes[0].quantization_bits = 14;
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
};

template <class Change>
Error encodeError(Change change) {
  Source source;
  change(source);
  const PieceView view{source.wedge_count, source.attributes, source.parts};
  EncodeResult result;
  const Status status = encode({&view, 1}, {}, result);
  EXPECT_EQ(status.ok(), status.what[0] == '\0');
  return status.error;
}

TEST(Writer, BadArguments) {
  EXPECT_EQ(encodeError([](Source&) {}), Error::kOk);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes.clear(); }), Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.parts.clear(); }), Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes[0].data = nullptr; }), Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes[0].stride_bytes = 11; }), Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes[0].stride_bytes = 0; }), Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes[0].quantization_bits = 25; }),
            Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes[0].format.component_count = 2; }),
            Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes[0].format.semantic = Semantic::kNormal; }),
            Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.attributes[0].format.morph_target = 1; }),
            Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.mesh.indices[5] = 4; }), Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.wedge_count = 3; }), Error::kBadArgument);
  EXPECT_EQ(encodeError([](Source& s) { s.parts[0].indices = s.parts[0].indices.first(4); }),
            Error::kBadArgument);
  for (const uint8_t components :
       {uint8_t{0}, uint8_t{5}, uint8_t{8}, uint8_t{10}, uint8_t{15}, uint8_t{17}}) {
    EXPECT_EQ(encodeError([components](Source& s) {
                s.attributes.push_back(s.attributes[0]);
                s.attributes[1].format.semantic = Semantic::kCustom;
                s.attributes[1].format.component_count = components;
                s.attributes[1].stride_bytes = 100;
              }),
              Error::kBadArgument);
  }
  EncodeResult result;
  EXPECT_EQ(encode({}, {}, result).error, Error::kBadArgument);
}

/// The same numbers as of the reader, with 2^28 itself among those that are too many; nothing that
/// many elements would need is read.
TEST(Writer, LimitsOfThePieces) {
  for (const uint32_t count : {kMaxVertices, kMaxVertices + 1, ~0u})
    EXPECT_EQ(encodeError([=](Source& s) { s.wedge_count = count; }), Error::kLimit) << count;
  for (const size_t triangles : {size_t{kMaxVertices}, size_t{kMaxVertices} + 1, size_t{1} << 40}) {
    EXPECT_EQ(encodeError([=](Source& s) {
                s.parts[0].indices = {s.mesh.indices.data(), 3 * triangles};
              }),
              Error::kLimit)
        << triangles;
  }
  EXPECT_EQ(encodeError([](Source& s) {  // together
              const size_t half = size_t{3} << 27;
              s.parts = {PartView{{s.mesh.indices.data(), half}},
                         PartView{{s.mesh.indices.data(), half}}};
            }),
            Error::kLimit);
}

TEST(Writer, StridesThatLeadOutOfMemory) {
  constexpr size_t kMost = size_t{PTRDIFF_MAX} / 3;  // from the first of four wedges to the last
  for (const size_t stride : {SIZE_MAX, SIZE_MAX / 2 + 1, SIZE_MAX / 3, kMost, kMost - 1}) {
    EXPECT_EQ(encodeError([=](Source& s) { s.attributes[0].stride_bytes = stride; }),
              Error::kBadArgument)
        << stride;
  }
  Source source;
  source.attributes[0].stride_bytes = SIZE_MAX;  // from a single wedge it leads nowhere
  const PartView nothing;
  EXPECT_EQ(roundTrip({1, source.attributes, {&nothing, 1}}).failure, "");
}

/// Numbers that are no bits and no enumerators are refused, and not cut off or taken for others.
TEST(Writer, OptionsOutOfRange) {
  for (uint32_t bits = 0; bits < 256; ++bits) {
    const auto b = static_cast<uint8_t>(bits);
    const bool is_lattice = bits <= 24;
    EXPECT_EQ(encodeError([=](Source& s) { s.attributes[0].quantization_bits = b; }),
              is_lattice ? Error::kOk : Error::kBadArgument)
        << bits;
    const bool is_grid = bits == 0 || (bits >= 2 && bits <= 16);
    for (const Semantic semantic : {Semantic::kNormal, Semantic::kTangent}) {
      const auto change = [=](Source& s) {
        s.attributes.push_back(s.attributes[0]);
        s.attributes[1].format.semantic = semantic;
        s.attributes[1].quantization_bits = b;
      };
      EXPECT_EQ(encodeError(change), is_grid ? Error::kOk : Error::kBadArgument) << bits;
    }
    const auto integers = [=](Source& s) {  // ignore what it is
      s.attributes.push_back(s.attributes[0]);
      s.attributes[1].format.semantic = Semantic::kColor;
      s.attributes[1].format.component_type = ComponentType::kUint8;
      s.attributes[1].quantization_bits = b;
    };
    EXPECT_EQ(encodeError(integers), is_lattice ? Error::kOk : Error::kBadArgument) << bits;
    if (bits <= static_cast<uint32_t>(Semantic::kCustom)) continue;
    EXPECT_EQ(encodeError([=](Source& s) {
                s.attributes.push_back(s.attributes[0]);
                s.attributes[1].format.semantic = static_cast<Semantic>(b);
              }),
              Error::kBadArgument);
    EXPECT_EQ(encodeError([=](Source& s) {
                s.attributes[0].format.component_type = static_cast<ComponentType>(b);
              }),
              Error::kBadArgument);
    const Source source;
    const PieceView view{source.wedge_count, source.attributes, source.parts};
    EncodeOptions options;
    options.prefer = static_cast<Preference>(b);
    EncodeResult result;
    EXPECT_EQ(encode({&view, 1}, options, result).error, Error::kBadArgument);
  }
}

TEST(Writer, NothingInAPieceIsFine) {
  for (const uint32_t wedge_count : {0u, 1u, 4u}) {
    Source source;
    const PartView nothing;
    const PieceView view{wedge_count, source.attributes, {&nothing, 1}};
    EXPECT_EQ(roundTrip(view).failure, "") << wedge_count;
  }
}

TEST(Writer, SameInputSameBytes) {
  const TestMesh mesh = withRandomWedges(generated(3, 2, 3, 3), 4, 2);
  EXPECT_EQ(payloadOf(mesh), payloadOf(mesh));
}

TEST(Writer, SizesAddUp) {
  const TestMesh mesh = withNormals(withDegenerates(sheetWithHoles(3, 2), 1, 6));
  const MeshPiece piece(mesh);
  const RoundTrip result = roundTrip(piece.view());
  ASSERT_EQ(result.failure, "");
  const StreamSizes& s = result.encoded.sizes;
  double sum = s.header_bits + s.connectivity_bits + s.stitch_bits + s.leftover_bits + s.seam_bits +
               s.position_bits + s.order_bits;
  for (const double bits : s.attribute_bits) sum += bits;
  EXPECT_NEAR(sum, 8.0 * static_cast<double>(result.encoded.payload.size()), 1);
  EXPECT_EQ(s.attribute_bits.size(), 2u);
  EXPECT_GE(s.header_bits, 0);
}

TEST(Writer, EveryPreferenceDecodes) {
  const TestMesh mesh = withNormals(chartGrid(9, 9, 4));
  const MeshPiece piece(mesh);
  for (const Preference prefer : {Preference::kBalanced, Preference::kSize, Preference::kSpeed}) {
    EncodeOptions options;
    options.prefer = prefer;
    EXPECT_EQ(roundTrip(piece.view(), options).failure, "");
  }
}

}  // namespace
}  // namespace mcc::test
