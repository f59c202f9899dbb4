// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Truth: what each stage needs to know of the source, derived from what the stage before has coded.
#ifndef MCC_SRC_WRITER_TRUTH_H_
#define MCC_SRC_WRITER_TRUTH_H_

#include "writer_plan.h"

namespace mcc {

/// Where a run of the connectivity puts what it learns.
struct SurfaceLearned {
  std::vector<uint32_t>& node_map;
  std::vector<uint32_t>& source_of_vertex;
  std::vector<uint32_t>& source_gate;
};

McTruth connectivityTruth(const McRecord& r, const SurfaceLearned& learned);

/// Classes of the vertices and source wedges of the corners, once the connectivity is coded.
void learnVertices(Plan& plan);

/// Positions in the order of the groups, once the vertices are stitched.
void learnPositions(Plan& plan, const FaceMesh& mesh, const Groups& groups);

/// Source wedges, parts of faces, duplicates and listed triangles, once the seams are coded.
void learnWedges(Plan& plan, FaceMesh& mesh);

/// The source's order of triangles as TriangleOrderCoder names them. Equal triangles are paired in their order.
void learnTriangleOrder(Plan& plan, const TriangleTable& table);

/// The values of `index` behind those of the attributes coded with it, in `stride` words per wedge.
void learnValues(const Plan& plan, uint32_t index, uint32_t offset, uint32_t stride,
                 Array<int32_t>& values);

}  // namespace mcc

#endif  // MCC_SRC_WRITER_TRUTH_H_
