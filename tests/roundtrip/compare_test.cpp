// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks that the comparison of the round-trip tests finds differences.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "support/mesh_compare.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

using Indices = std::vector<uint32_t>;

TEST(Compare, Wedges) {
  EXPECT_EQ(compareWedges(3, Indices{2, 0, 1}), "");
  EXPECT_NE(compareWedges(3, Indices{2, 0}), "");
  EXPECT_NE(compareWedges(3, Indices{2, 0, 2}), "");
  EXPECT_NE(compareWedges(3, Indices{2, 0, 3}), "");
}

TEST(Compare, Triangles) {
  const Indices same = {0, 1, 2, 3};
  EXPECT_EQ(compareTriangles(Indices{0, 1, 2, 2, 1, 3}, Indices{1, 3, 2, 2, 0, 1}, same), "");
  EXPECT_EQ(compareTriangles(Indices{0, 1, 2}, Indices{1, 2, 3}, Indices{3, 0, 1, 2}), "");
  EXPECT_EQ(compareTriangles(Indices{1, 1, 2, 0, 0, 0}, Indices{0, 0, 0, 1, 2, 1}, same), "");
  // Turned round; one missing, one too much; a multiplicity; another wedge; out of range.
  EXPECT_NE(compareTriangles(Indices{0, 1, 2}, Indices{0, 2, 1}, same), "");
  EXPECT_NE(compareTriangles(Indices{0, 1, 2, 2, 1, 3}, Indices{0, 1, 2}, same), "");
  EXPECT_NE(compareTriangles(Indices{0, 1, 2}, Indices{0, 1, 2, 0, 1, 2}, same), "");
  EXPECT_NE(compareTriangles(Indices{0, 1, 2, 0, 1, 2, 0, 1, 3}, Indices{0, 1, 2, 0, 1, 3, 0, 1, 3},
                             same),
            "");
  EXPECT_NE(compareTriangles(Indices{0, 1, 2}, Indices{0, 1, 3}, same), "");
  EXPECT_NE(compareTriangles(Indices{0, 1, 2}, Indices{0, 1, 4}, same), "");
}

/// A piece and what an ideal codec makes of it, to be damaged by the tests.
struct Fixture {
  TestMesh mesh = uvSphere(8, 5);
  MeshPiece piece{mesh};
  std::vector<uint32_t> source_wedge;
  DecodedPiece decoded;

  Fixture() {
    const uint32_t count = mesh.vertexCount();
    source_wedge.resize(count);
    for (uint32_t i = 0; i < count; ++i) source_wedge[i] = count - 1 - i;
    decoded.wedge_count = count;
    decoded.parts.push_back(mesh.indices);
    for (uint32_t& v : decoded.parts[0]) v = count - 1 - v;
    AttributeInfo info;
    info.format = piece.view().attributes[0].format;
    info.coding = AttributeCoding::kLattice;
    info.bits = 14;
    info.lattice = {{-1, -1, -1, 0}, static_cast<float>(2.0 / 16383)};
    add(info, mesh.positions, [&](size_t k, float x) {
      const double q =
          std::floor((static_cast<double>(x) + 1) / static_cast<double>(info.lattice.step) + 0.5);
      const float scaled = static_cast<float>(q) * info.lattice.step;
      return scaled + info.lattice.origin[k % 3];
    });
    info.format = piece.view().attributes[1].format;
    info.coding = AttributeCoding::kOctahedral;
    info.bits = 10;
    add(info, mesh.normals, [](size_t, float x) { return x; });
  }

  template <typename Change>
  void add(const AttributeInfo& info, const std::vector<float>& values, Change change) {
    DecodedAttribute attribute{info, std::vector<uint8_t>(values.size() * 4)};
    for (size_t i = 0; i < values.size(); ++i) {
      const float value = change(i, values[source_wedge[i / 3] * 3 + i % 3]);
      std::memcpy(&attribute.bytes[i * 4], &value, 4);
    }
    decoded.attributes.push_back(attribute);
  }

  float& at(size_t attribute, size_t component) {
    return reinterpret_cast<float*>(decoded.attributes[attribute].bytes.data())[component];
  }
  std::string compare() const { return comparePiece(piece.view(), decoded, source_wedge); }
};

TEST(Compare, AcceptsWhatIsExact) { EXPECT_EQ(Fixture().compare(), ""); }

TEST(Compare, FindsAWrongLatticeValue) {
  Fixture f;
  f.at(0, 5) = std::nextafter(f.at(0, 5), 2.0f);
  EXPECT_NE(f.compare(), "");
  Fixture swapped;
  std::swap(swapped.source_wedge[3], swapped.source_wedge[4]);
  EXPECT_NE(swapped.compare(), "");
}

TEST(Compare, FindsACoarseLattice) {
  Fixture f;
  f.decoded.attributes[0].info.bits = 13;
  EXPECT_NE(f.compare(), "");
  Fixture g;
  g.decoded.attributes[0].info.lattice.step *= 1.001f;
  EXPECT_NE(g.compare(), "");
}

TEST(Compare, FindsAWrongNormal) {
  Fixture f;
  f.at(1, 0) += 0.01f;
  EXPECT_NE(f.compare(), "");
  Fixture g;
  for (size_t k = 0; k < 3; ++k) g.at(1, k) *= 0.9f;
  EXPECT_NE(g.compare(), "");
}

TEST(Compare, FindsWrongBits) {
  Fixture f;
  f.decoded.attributes[1].info.coding = AttributeCoding::kExactFloat;
  EXPECT_EQ(f.compare(), "");
  f.decoded.attributes[1].bytes[17] ^= 1;
  EXPECT_NE(f.compare(), "");
}

TEST(Compare, FindsAWrongFormatOrCount) {
  Fixture f;
  f.decoded.attributes[1].info.format.normalized = true;
  EXPECT_NE(f.compare(), "");
  Fixture g;
  g.decoded.attributes.pop_back();
  EXPECT_NE(g.compare(), "");
  Fixture h;
  h.decoded.parts.emplace_back();
  EXPECT_NE(h.compare(), "");
  Fixture i;
  --i.decoded.wedge_count;
  EXPECT_NE(i.compare(), "");
  Fixture j;
  std::swap(j.decoded.parts[0][0], j.decoded.parts[0][1]);
  EXPECT_NE(j.compare(), "");
}

TEST(Compare, FindsQuantisationNobodyAskedFor) {
  Fixture f;
  const MeshPiece exact(f.mesh, kExactBits);
  EXPECT_NE(comparePiece(exact.view(), f.decoded, f.source_wedge), "");
}

}  // namespace
}  // namespace mcc::test
