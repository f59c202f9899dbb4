// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A piece on its way through the writer: what preparation finds, what stages learn from one
// another, and what is chosen for them.
#ifndef MCC_WRITER_PLAN_H_
#define MCC_WRITER_PLAN_H_

#include <optional>
#include <string>
#include <vector>

#include "base/enc_jobs.h"
#include "connectivity/enc_collapse.h"
#include "connectivity/enc_pivots.h"
#include "container/payload_header.h"
#include "exact/grid.h"
#include "positions/enc_anchors.h"
#include "positions/enc_fit.h"
#include "positions/enc_planes.h"
#include "positions/mirrors.h"
#include "prepare/enc_cut.h"
#include "prepare/enc_quantize.h"
#include "prepare/enc_triangles.h"
#include "prepare/enc_weld.h"
#include "surface/leftovers.h"
#include "writer/settings.h"

namespace mcc {

/// A piece on its way through the writer.
struct Plan {
  const PieceView* view = nullptr;
  PieceHeader header;
  std::vector<PartInfo> parts;
  std::vector<QuantizedAttribute> attributes;  ///< POSITION first
  std::vector<uint32_t> source_attribute;      ///< index of each in view->attributes
  PositionClasses classes;
  SortedTriangles triangles;
  CutResult cut;
  McRecord record;
  PivotRecord pivots;  ///< instead of `cut` and `record`, if the header has pivots

  // These are filled when the stages run for the first time, and are the same in every run.
  bool knows_surface = false;  ///< what learnVertices() and learnPositions() find
  bool knows_wedges = false;   ///< what learnWedges() finds
  std::vector<uint32_t> node_map;
  std::vector<uint32_t> source_of_vertex;
  std::vector<uint32_t> source_gate;
  std::vector<uint32_t> class_of_vertex;
  std::vector<uint32_t> corner_source;
  std::vector<int32_t> positions;
  std::vector<int32_t> exact_positions;  ///< ordered floats, if the positions are on an exact grid
  DistinctCoordinates coordinates;
  bool finds_coordinates = false;  ///< `coordinates` are still to be found
  std::optional<bool> has_planes;  ///< whether there are `planes`; nothing: not known yet
  AxisPlanes planes[3];
  Mirrors mirrors;                  ///< if the header has them
  Anchors anchors;                  ///< likewise
  bool starts_trained = false;      ///< the same for all pieces of a payload
  PositionParameters positions_as;  ///< the chosen parameters with fitted tables
  std::vector<uint32_t> wedge_source;
  std::vector<uint32_t> part_of_face;
  std::vector<ListedTriangle> list;
  std::vector<uint32_t> triangle_order;
  std::vector<uint32_t> wedge_order;
};

/// Returns what a position is coded by: the integer of its grid, if it is on one.
inline int32_t codedPosition(const AttributeInfo& info, int32_t value) {
  return info.coding == AttributeCoding::kGrid ? gridInteger(info, value) : value;
}

/// Returns the headers of all attributes.
std::vector<AttributeInfo> infosOf(const Plan& plan);

/// Sets the fields of the header that follow from attributes, classes and triangles.
void describePiece(Plan& plan, const EncodeOptions& options);

/// Returns the position classes of the corners of all proper triangles.
std::vector<uint32_t> classesOfCorners(const Plan& plan);

/// Finds planes in positions of the piece, unless that has been tried before.
void findPlanesOf(Plan& plan, std::span<const int32_t> positions);

/// Checks the piece, quantises and welds it, and sorts its triangles.
Status preparePiece(const PieceView& view, const EncodeSettings& options, const Jobs& jobs,
                    Plan& plan, std::vector<std::string>& notes);

/// Cuts the surface to a manifold and collapses it, and sets the fields of the header that follow.
/// May be called again. A component with a handle deeper than `max_handle_depth` is cut in two
/// until there is none.
void prepareConnectivity(Plan& plan, uint32_t start_half_edge,
                         uint32_t max_handle_depth = kMaxHandleDepth);

/// Lists the faces vertex by vertex, instead of prepareConnectivity(). The surface must not have a
/// face with two corners in one place.
void preparePivots(Plan& plan);

/// Returns whether no face has two corners in one place.
bool allowsPivots(const Plan& plan);

/// Returns the attributes except the first, in the order in which their phases code them.
std::vector<uint32_t> codingOrder(const Plan& plan);

}  // namespace mcc

#endif  // MCC_WRITER_PLAN_H_
