// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// mcTree() for a payload and for plain triangles, and what inspect derives from a payload.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "gltf-mcc/tree_of_edges.h"
#include "gltf/document/references.h"
#include "gltf/files/file_io.h"
#include "gltf/round_trip.h"
#include "mcc/files.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;
using tool::McTree;
using tool::mcTree;

std::vector<uint8_t> sample(const std::string& name) {
  std::vector<uint8_t> bytes;
  EXPECT_TRUE(readFile(fs::path(MCC_SAMPLES_DIR) / name, bytes).ok());
  return bytes;
}

McTree treeOf(std::span<const uint8_t> bytes, uint32_t primitive = 0) {
  McTree tree;
  const Result result = mcTree({{}, bytes}, 0, primitive, {}, tree);
  EXPECT_TRUE(result.ok()) << result.message();
  return tree;
}

std::vector<uint8_t> compressed(std::span<const uint8_t> bytes, const ConvertOptions& options) {
  std::vector<uint8_t> output;
  ConvertReport report;
  EXPECT_TRUE(convertGlb(bytes, options, output, report).ok());
  EXPECT_FALSE(report.payloads.empty());
  return output;
}

using Point = std::array<float, 3>;

Point pointOf(const McTree& tree, uint32_t vertex) {
  return {tree.positions[3 * vertex], tree.positions[3 * vertex + 1],
          tree.positions[3 * vertex + 2]};
}

/// Returns the ends of the edges in their order, independently of the numbers of vertices.
std::vector<std::pair<Point, Point>> edgesOf(const McTree& tree) {
  std::vector<std::pair<Point, Point>> edges;
  for (const McTree::Edge& edge : tree.edges) {
    edges.emplace_back(pointOf(tree, edge.parent), pointOf(tree, edge.child));
  }
  return edges;
}

TEST(McTree, BeginsAtTheRootAndMeetsEveryVertexOnce) {
  const McTree tree = treeOf(sample("sphere.glb"));
  EXPECT_FALSE(tree.is_of_payload);
  std::set<Point> met;
  for (const auto& [parent, child] : edgesOf(tree)) {
    if (met.empty()) met.insert(parent);
    EXPECT_EQ(met.count(parent), 1u) << "a child before its parent";
    EXPECT_TRUE(met.insert(child).second) << "a vertex with two parents";
  }
  std::set<Point> all;
  for (const uint32_t index : tree.indices) all.insert(pointOf(tree, index));
  EXPECT_EQ(met, all);
}

TEST(McTree, EdgesAreThoseOfTriangles) {
  for (const char* name : {"sphere.glb", "genus3.glb", "sheet_with_holes.glb", "moebius.glb"}) {
    const McTree tree = treeOf(sample(name));
    std::set<std::pair<Point, Point>> sides;
    for (size_t c = 0; c < tree.indices.size(); ++c) {
      const uint32_t next = tree.indices[c % 3 == 2 ? c - 2 : c + 1];
      sides.insert({pointOf(tree, tree.indices[c]), pointOf(tree, next)});
      sides.insert({pointOf(tree, next), pointOf(tree, tree.indices[c])});
    }
    EXPECT_GT(tree.edges.size(), 50u) << name;
    for (const auto& edge : edgesOf(tree)) EXPECT_EQ(sides.count(edge), 1u) << name;
  }
}

TEST(McTree, OfAPayloadIsThatOfItsSource) {
  ConvertOptions options;
  options.lossless = true;
  for (const char* name : {"sphere.glb", "genus3.glb", "torus.glb"}) {
    const std::vector<uint8_t> source = sample(name);
    const McTree plain = treeOf(source);
    options.indices_only = options.keep_vertex_order = false;
    const McTree coded = treeOf(compressed(source, options));
    EXPECT_TRUE(coded.is_of_payload);
    EXPECT_EQ(edgesOf(coded), edgesOf(plain)) << name;
    options.indices_only = true;
    EXPECT_EQ(edgesOf(treeOf(compressed(source, options))), edgesOf(plain)) << name;
    options.keep_vertex_order = true;
    EXPECT_EQ(edgesOf(treeOf(compressed(source, options))), edgesOf(plain)) << name;
  }
}

TEST(McTree, SaysWhatIsWrong) {
  const auto failure = [](const Builder& builder, uint32_t mesh, uint32_t primitive) {
    McTree tree;
    return mcTree({{}, builder.toGlb()}, mesh, primitive, {}, tree).message();
  };
  Builder builder;
  Json points = Sheet(4).addTo(builder);
  points["mode"] = 0;
  Json nowhere = points;
  nowhere.erase("mode");
  nowhere["attributes"].erase("POSITION");
  Sheet wild(4);
  wild.indices[2] = 1000;
  Json outside = wild.addTo(builder);
  builder.addMesh({points, nowhere, outside});
  EXPECT_EQ(failure(builder, 0, 0), "/meshes/0/primitives/0: has points or lines, not triangles");
  EXPECT_EQ(failure(builder, 0, 1), "/meshes/0/primitives/1: has no POSITION");
  EXPECT_EQ(failure(builder, 0, 2),
            "/meshes/0/primitives/2/indices: an index is not below the count");
  EXPECT_EQ(failure(builder, 0, 3), "/meshes/0: there is no primitive 3; there are 3");
  EXPECT_EQ(failure(builder, 1, 0), "there is no mesh 1; the last is 0");
}

/// Damaged payloads give errors, or trees of what they hold.
TEST(McTree, OfDamagedFiles) {
  const std::vector<uint8_t> good = compressed(sample("torus.glb"), {});
  for (size_t at = 20; at < good.size(); at += 97) {
    std::vector<uint8_t> bad = good;
    bad[at] ^= 0x10;
    McTree tree;
    if (!mcTree({{}, bad}, 0, 0, {}, tree).ok()) continue;
    for (const McTree::Edge& edge : tree.edges) {
      ASSERT_LT(std::max(edge.parent, edge.child), tree.positions.size() / 3);
    }
  }
}

TEST(InspectStreams, SumUpToThePayload) {
  for (const char* name : {"textured.glb", "skinned.glb", "morphed.glb", "genus3.glb"}) {
    for (const bool lossless : {false, true}) {
      ConvertOptions options;
      options.lossless = lossless;
      std::vector<uint8_t> output;
      ConvertReport converted;
      ASSERT_TRUE(convertGlb(sample(name), options, output, converted).ok());
      InspectReport report;
      ASSERT_TRUE(inspectGlb(output, true, report).ok());
      ASSERT_EQ(report.payloads.size(), converted.payloads.size());
      for (size_t i = 0; i < report.payloads.size(); ++i) {
        SCOPED_TRACE(std::string(name) + (lossless ? " lossless" : ""));
        const InspectPayload& payload = report.payloads[i];
        double sum = 0;
        for (const StreamReport& stream : payload.streams) {
          sum += stream.bits;
          for (const StreamReport& spent : converted.payloads[i].streams) {
            if (spent.name != stream.name || spent.name == "header") continue;
            EXPECT_NEAR(stream.bits, spent.bits, 16 + 0.01 * spent.bits) << stream.name;
          }
        }
        for (const InspectPiece& piece : payload.pieces) {
          ASSERT_EQ(piece.details.size(), piece.attributes.size());
          for (const InspectAttribute& details : piece.details) sum += details.coded_bits;
        }
        EXPECT_NEAR(sum, 8 * static_cast<double>(payload.payload_bytes), 1e-6);
      }
    }
  }
}

/// All faces of n^3 boxes; a wall between two boxes occurs twice.
Sheet stackedBoxes(uint16_t n) {
  Sheet boxes(0);
  boxes.positions.clear();
  const auto side = static_cast<uint16_t>(n + 1);
  for (uint16_t v = 0; v < side * side * side; ++v) {
    const uint16_t at[] = {static_cast<uint16_t>(v % side), static_cast<uint16_t>(v / side % side),
                           static_cast<uint16_t>(v / side / side)};
    boxes.positions.insert(boxes.positions.end(), std::begin(at), std::end(at));
    if (*std::max_element(at, at + 3) == n) continue;
    const uint16_t step[] = {1, side, static_cast<uint16_t>(side * side)};
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const uint16_t a = step[(axis + 1) % 3];
      const uint16_t b = step[(axis + 2) % 3];
      for (const uint16_t up : {uint16_t{0}, step[axis]}) {
        const auto p = [&](int corner) { return static_cast<uint16_t>(v + up + corner); };
        boxes.indices.insert(boxes.indices.end(), {p(0), p(a), p(a + b), p(0), p(a + b), p(b)});
      }
    }
  }
  boxes.normals.assign(boxes.positions.size(), 0.57735f);
  boxes.texcoords.assign(boxes.positions.size() / 3 * 2, 0);
  return boxes;
}

TEST(InspectDetails, TheSurfaceSaysHowItIsCoded) {
  const auto surfaceOf = [](const std::vector<uint8_t>& source) {
    InspectReport report;
    EXPECT_TRUE(inspectGlb(compressed(source, {}), false, report).ok());
    return report.payloads.at(0).pieces.at(0).surface;
  };
  Builder builder;
  builder.addMesh({stackedBoxes(8).addTo(builder)});
  EXPECT_EQ(surfaceOf(builder.toGlb()), SurfaceCoding::kPivots);
  EXPECT_EQ(surfaceOf(sample("torus.glb")), SurfaceCoding::kManifold);
  EXPECT_EQ(surfaceOf(sample("moebius.glb")), SurfaceCoding::kBoundaryCopies);
}

/// Returns the paths of the primitives that use a piece.
std::set<std::string> usersOf(const Json& json, uint64_t view, uint64_t piece) {
  std::set<std::string> users;
  visitPrimitives(json, [&](const PrimitiveRef& ref, const Json& primitive) {
    const Json* extension = extensionOf(primitive, kExtensionName);
    if (extension == nullptr || (*extension)["bufferView"] != view) return;
    const Json* number = findMember(*extension, "piece");
    if (piece == (number == nullptr ? 0 : number->get<uint64_t>())) users.insert(ref.path());
  });
  return users;
}

TEST(InspectDetails, BoundsHoldAndPredictorsHaveNames) {
  for (const char* name : {"textured.glb", "skinned.glb", "morphed.glb", "modes.glb"}) {
    std::vector<uint8_t> output;
    ConvertReport converted;
    ASSERT_TRUE(convertGlb(sample(name), {}, output, converted).ok());
    InspectReport report;
    ASSERT_TRUE(inspectGlb(output, true, report).ok());
    const Json json = jsonOf(output);
    size_t checked = 0;
    for (size_t i = 0; i < report.payloads.size(); ++i) {
      for (size_t number = 0; number < report.payloads[i].pieces.size(); ++number) {
        const InspectPiece& piece = report.payloads[i].pieces[number];
        const std::set<std::string> users = usersOf(json, report.payloads[i].buffer_view, number);
        ASSERT_FALSE(users.empty());
        for (size_t k = 0; k < piece.details.size(); ++k) {
          const InspectAttribute& details = piece.details[k];
          SCOPED_TRACE(std::string(name) + " " + details.name);
          EXPECT_EQ(details.predictor.empty(),
                    piece.attributes[k].coding == AttributeCoding::kAlias);
          for (const AttributeReport& attribute : converted.payloads[i].attributes) {
            const auto& paths = attribute.primitives;
            const bool is_of_piece =
                std::find(paths.begin(), paths.end(), *users.begin()) != paths.end();
            if (!is_of_piece || attribute.name != details.name ||
                piece.attributes[k].bits != attribute.bits)
              continue;
            ++checked;
            EXPECT_EQ(details.is_angle, attribute.is_angle);
            EXPECT_LE(attribute.max_error, details.error_bound * 1.01 + 1e-6);
          }
        }
      }
    }
    EXPECT_GT(checked, 0u);
  }
}

}  // namespace
}  // namespace mcc::gltf::test
