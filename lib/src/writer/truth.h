// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Truth: what each stage needs to know about the source, derived from what the stages before it
// have coded.
#ifndef MCC_WRITER_TRUTH_H_
#define MCC_WRITER_TRUTH_H_

#include "mesh/groups.h"
#include "surface/order.h"
#include "writer/plan.h"

namespace mcc {

/// Where the connectivity stores what it learns.
struct SurfaceLearned {
  std::vector<uint32_t>& node_map;
  std::vector<uint32_t>& source_of_vertex;
  std::vector<uint32_t>& source_gate;
};

McTruth connectivityTruth(const McRecord& r, const SurfaceLearned& learned);

/// Finds the classes of the vertices and the source wedges of the corners, after the connectivity
/// is coded. This and the next two do nothing when they have run before.
void learnVertices(Plan& plan);

/// Puts the positions into the order of the groups, after the vertices are stitched.
void learnPositions(Plan& plan, const FaceMesh& mesh, const Groups& groups);

/// Finds source wedges, parts of faces, duplicates and listed triangles, after the seams are coded.
void learnWedges(Plan& plan, FaceMesh& mesh);

/// Describes the source's order of triangles as TriangleOrderCoder does. Equal triangles are paired
/// in their order.
void learnTriangleOrder(Plan& plan, const TriangleTable& table);

/// Copies the values of attribute `index` to `offset`, after those of the attributes coded with it,
/// in `stride` words per wedge.
void learnValues(const Plan& plan, uint32_t index, uint32_t offset, uint32_t stride,
                 Array<int32_t>& values);

}  // namespace mcc

#endif  // MCC_WRITER_TRUTH_H_
