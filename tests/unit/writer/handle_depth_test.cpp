// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// [A.4.4] Surfaces whose handles would lie too deep are cut until they do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/enc_jobs.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "writer/plan.h"

namespace mcc::test {
namespace {

uint32_t deepestOf(const Plan& plan) {
  uint32_t deepest = 0;
  for (const McHandle& handle : plan.record.handles)
    deepest = std::max(deepest, handle.stack_depth);
  return deepest;
}

/// Every corner has the class of its source, so that what was cut can be joined again.
bool keepsClasses(const Plan& plan) {
  const ClosedMesh& mesh = plan.cut.mesh;
  for (size_t c = 0; c < plan.triangles.wedges.size(); ++c) {
    if (plan.cut.class_of_vertex[mesh.corner_vertex[c]] !=
        plan.classes.class_of_wedge[plan.triangles.wedges[c]]) {
      return false;
    }
  }
  return true;
}

/// A mesh and its plan, where handles may be as deep as they are.
struct Uncut {
  explicit Uncut(const TestMesh& mesh) : piece(mesh), view(piece.view()) {
    const RunJobs in_order;
    std::vector<std::string> notes;
    EXPECT_TRUE(preparePiece(view, {}, Jobs(in_order), plan, notes).ok());
    prepareConnectivity(plan, kNone, kNone);
  }

  const MeshPiece piece;
  const PieceView view;
  Plan plan;
};

TEST(HandleDepth, SurfacesAreCutUntilItHolds) {
  for (const TestMesh& mesh : {mengerSponge(2), plateWithTunnels(40, 1)}) {
    Uncut uncut(mesh);
    Plan& plan = uncut.plan;
    const uint32_t deepest = deepestOf(plan);
    const size_t component_count = plan.cut.mesh.components.size();
    RecordProperty("deepest_of_" + mesh.name, std::to_string(deepest));
    ASSERT_GT(deepest, 3u) << mesh.name;
    for (const uint32_t limit : {0u, 1u, 3u, deepest}) {
      prepareConnectivity(plan, kNone, limit);
      EXPECT_LE(deepestOf(plan), limit) << mesh.name;
      EXPECT_TRUE(keepsClasses(plan)) << mesh.name;
      EXPECT_EQ(plan.cut.mesh.real_face_count, mesh.triangleCount()) << mesh.name;
      EXPECT_EQ(plan.cut.mesh.components.size() > component_count, limit < deepest) << mesh.name;
      EXPECT_EQ(plan.header.hasCopies(), limit < deepest) << mesh.name;
    }
  }
}

/// The plate's deepest handle is three digons less deep than it has tunnels.
TEST(HandleDepth, OnlyWhatIsTooDeepIsCut) {
  for (const uint32_t deepest : {kMaxHandleDepth, kMaxHandleDepth + 1}) {
    const TestMesh mesh = plateWithTunnels(deepest + 3, 1);
    Uncut uncut(mesh);
    Plan& plan = uncut.plan;
    ASSERT_EQ(deepestOf(plan), deepest);
    prepareConnectivity(plan, kNone);
    EXPECT_LE(deepestOf(plan), kMaxHandleDepth);
    EXPECT_EQ(plan.header.hasCopies(), deepest > kMaxHandleDepth);
  }
}

}  // namespace
}  // namespace mcc::test
