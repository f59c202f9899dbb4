// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The writer's trials on the caller's threads: the bytes depend neither on their number nor on who
// finishes first.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <new>
#include <stdexcept>
#include <thread>

#include "base/enc_jobs.h"
#include "support/mesh_compare.h"
#include "support/mesh_generators.h"
#include "support/run_jobs.h"

namespace mcc::test {
namespace {

void expectSame(std::span<const PieceView> pieces, EncodeOptions options, const std::string& name) {
  EncodeResult alone;
  ASSERT_TRUE(encode(pieces, options, alone).ok()) << name;
  for (const RunJobs& hook : {RunJobs(runBackwards), RunJobs(runOnThreads)}) {
    options.run_jobs = hook;
    EncodeResult result;
    ASSERT_TRUE(encode(pieces, options, result).ok()) << name;
    EXPECT_EQ(result.payload, alone.payload) << name;
    EXPECT_EQ(result.notes, alone.notes) << name;
    ASSERT_EQ(result.pieces.size(), alone.pieces.size()) << name;
    for (size_t i = 0; i < alone.pieces.size(); ++i) {
      EXPECT_EQ(result.pieces[i].source_wedge, alone.pieces[i].source_wedge) << name;
    }
  }
}

TEST(JobsOfTheWriter, MakeTheSameBytesInAnyOrder) {
  for (const TestMesh& mesh : smallZoo()) {
    const MeshPiece piece(mesh);
    const PieceView view = piece.view();
    expectSame({&view, 1}, {}, mesh.name);
  }
}

TEST(JobsOfTheWriter, MakeTheSameBytesOfSampledMeshes) {
  // Above 12,000 vertices the trials use only a part of them.
  const TestMesh meshes[] = {
      jittered(icosphere(6), 1, 0.002f), withNormals(torus(200, 100)), book(40, 30, 20),
      voxelSurface(40, 40, 40, [](auto x, auto y, auto z) { return (x * y + z) % 3 != 0; })};
  for (const TestMesh& mesh : meshes) {
    const MeshPiece piece(mesh);
    const PieceView view = piece.view();
    expectSame({&view, 1}, {}, mesh.name);
  }
}

TEST(JobsOfTheWriter, MakeTheSameBytesOfSeveralPieces) {
  const TestMesh meshes[] = {withNormals(torus(30, 20)), chartGrid(20, 20, 5),
                             withIndexDuplicates(icosphere(3), 1, 20), pinchedSpheres(5),
                             tetrahedron()};
  std::vector<std::unique_ptr<MeshPiece>> pieces;
  std::vector<PieceView> views;
  for (const TestMesh& mesh : meshes) {
    pieces.push_back(std::make_unique<MeshPiece>(mesh));
    views.push_back(pieces.back()->view());
  }
  EncodeOptions options;
  options.keep_triangle_order = true;
  expectSame(views, options, "several");
}

TEST(JobsOfTheWriter, PassOnTheLowestFailure) {
  for (const RunJobs& hook : {RunJobs(), RunJobs(runBackwards), RunJobs(runOnThreads)}) {
    const Jobs jobs(hook);
    const Status status = jobs.tryAll(5, [](size_t i) -> Status {
      return i < 2 ? Status{} : fail(i == 2 ? Error::kLimit : Error::kBadArgument, "");
    });
    EXPECT_EQ(status.error, Error::kLimit);
    EXPECT_THROW(jobs.run(3,
                          [](size_t i) {
                            if (i == 1) throw std::bad_alloc();
                            if (i == 2) throw std::runtime_error("after the first");
                          }),
                 std::bad_alloc);
  }
}

TEST(JobsOfTheWriter, AreOffered) {
  const TestMesh mesh = withNormals(torus(30, 20));
  const MeshPiece piece(mesh);
  const PieceView view = piece.view();
  EncodeOptions options;
  std::atomic<size_t> offered{0};
  options.run_jobs = [&](size_t count, const std::function<void(size_t)>& job) {
    offered += count;
    runBackwards(count, job);
  };
  EncodeResult result;
  ASSERT_TRUE(encode({&view, 1}, options, result).ok());
  EXPECT_GT(offered, 12u);
}

}  // namespace
}  // namespace mcc::test
