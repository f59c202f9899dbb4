// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Prepares a piece: quantises, welds, sorts, cuts and collapses it.
#include "writer/plan.h"

#include <algorithm>
#include <utility>

#include "base/caller_memory.h"
#include "positions/enc_isolated.h"

namespace mcc {
namespace {

bool isBasePosition(const AttributeFormat& f) {
  return f.semantic == Semantic::kPosition && f.morph_target == 0;
}

/// Whether bits are 0, or what a lattice or the grid of unit vectors can have.
bool areBits(const AttributeView& attribute) {
  const AttributeFormat& format = attribute.format;
  const uint32_t bits = attribute.quantization_bits;
  const bool is_unit_vector =
      format.semantic == Semantic::kNormal || format.semantic == Semantic::kTangent;
  // Vectors of other lengths, and deltas of morph targets, are on a lattice that the caller gives.
  const bool has_grid = is_unit_vector && format.morph_target == 0 &&
                        attribute.lattice == nullptr &&
                        format.component_type == ComponentType::kFloat32;
  if (bits == 0 || !has_grid) return bits <= kMaxLatticeBits;
  return bits >= kMinUnitBits && bits <= kMaxUnitBits;
}

Status checkAttribute(const AttributeView& attribute, uint32_t wedge_count) {
  const AttributeFormat& format = attribute.format;
  if (format.semantic > Semantic::kCustom || format.component_type > ComponentType::kFloat32 ||
      !isComponentCount(format.component_count)) {
    return fail(Error::kBadArgument, "the format of an attribute is not one of glTF");
  }
  if (!areBits(attribute)) {
    return fail(
        Error::kBadArgument,
        "the bits of an attribute are not 0 to 24, or for normals and tangents 0 or 2 to 16");
  }
  if (attribute.data == nullptr && wedge_count != 0)
    return fail(Error::kBadArgument, "the data of an attribute is null");
  if (attribute.stride_bytes < elementBytes(format)) {
    return fail(Error::kBadArgument, "the stride of an attribute is smaller than its elements");
  }
  if (!canBeInMemory(attribute.data, wedge_count, attribute.stride_bytes, elementBytes(format))) {
    return fail(Error::kBadArgument, "the stride of an attribute leads out of memory");
  }
  const uint32_t origins = format.morph_target == 0 ? format.component_count : 0;
  if (attribute.lattice != nullptr && !isValidLattice(*attribute.lattice, origins)) {
    return fail(Error::kBadArgument,
                "the step of a lattice is not positive and finite, or its origin not finite");
  }
  return {};
}

/// Checks the counts of all parts before any index is read, since a count may be wrong.
Status checkParts(const PieceView& piece) {
  uint64_t triangles = 0;
  for (const PartView& part : piece.parts) {
    if (part.indices.size() % 3 != 0)
      return fail(Error::kBadArgument, "a part's number of indices is not a multiple of three");
    triangles += part.indices.size() / 3;  // cannot overflow: each part before fits
    if (triangles >= kMaxVertices) return fail(Error::kLimit, "a piece has 2^28 or more triangles");
  }
  for (const PartView& part : piece.parts) {
    for (const uint32_t index : part.indices) {
      if (index >= piece.wedge_count)
        return fail(Error::kBadArgument, "an index is not below wedge_count");
    }
  }
  return {};
}

Status checkPiece(const PieceView& piece) {
  if (piece.attributes.empty() || !isBasePosition(piece.attributes[0].format) ||
      piece.attributes[0].format.component_count != 3) {
    return fail(Error::kBadArgument,
                "the first attribute of a piece must be POSITION with 3 components");
  }
  if (piece.wedge_count >= kMaxVertices)
    return fail(Error::kLimit, "a piece has 2^28 or more vertices");
  if (piece.parts.empty()) return fail(Error::kBadArgument, "a piece has no parts");
  for (const AttributeView& attribute : piece.attributes)
    MCC_TRY(checkAttribute(attribute, piece.wedge_count));
  return checkParts(piece);
}

/// Joints are coded by golomb(), whose largest value is 2^32 - 2. [A.3.5]
Status checkJoints(const Plan& plan) {
  const std::vector<AttributeInfo> infos = infosOf(plan);
  for (uint32_t i = 0; i < infos.size(); ++i) {
    if (methodOf(infos, i) != AttributeMethod::kSkin) continue;
    const std::vector<int32_t>& joints = plan.attributes[i].values;
    if (std::find(joints.begin(), joints.end(), -1) != joints.end()) {
      return fail(Error::kBadArgument, "JOINTS with WEIGHTS cannot be -1 or 2^32 - 1");
    }
  }
  return {};
}

/// Halves the components whose handles are too deep. Returns false when there are none.
bool halveDeepComponents(const Plan& plan, uint32_t max_handle_depth,
                         std::vector<uint32_t>& region_of_face, uint32_t& region_count) {
  const ClosedMesh& mesh = plan.cut.mesh;
  uint32_t last = kNone;  // handles are in the order of their components
  for (const McHandle& handle : plan.record.handles) {
    if (handle.stack_depth <= max_handle_depth || handle.component == last) continue;
    last = handle.component;
    region_of_face.resize(mesh.real_face_count, 0);
    halveComponent(mesh, mesh.components[mesh.components.size() - 1 - last], region_count++,
                   region_of_face);
  }
  return last != kNone;
}

SurfaceCoding surfaceOf(const ClosedMesh& mesh, std::span<const uint32_t> class_of_vertex,
                        uint32_t class_count) {
  std::vector<uint8_t> umbrellas(class_count, 0);
  for (const uint32_t c : class_of_vertex)
    umbrellas[c] = static_cast<uint8_t>(std::min(2, umbrellas[c] + 1));
  std::vector<uint8_t> on_boundary(mesh.real_vertex_count, 0);
  for (uint32_t h = 0; h < 3 * mesh.real_face_count; ++h) {
    if (mesh.twin[h] / 3 >= mesh.real_face_count) on_boundary[mesh.corner_vertex[h]] = 1;
  }
  SurfaceCoding surface = SurfaceCoding::kManifold;
  for (uint32_t v = 0; v < mesh.real_vertex_count; ++v) {
    if (umbrellas[class_of_vertex[v]] < 2) continue;
    if (on_boundary[v] == 0) return SurfaceCoding::kCopies;
    surface = SurfaceCoding::kBoundaryCopies;
  }
  return surface;
}

/// Cuts and collapses the surface, and halves components until no handle is too deep. The loop
/// always terminates, because a single triangle has no handle, and components of two are halved
/// into single ones.
void cutAndCollapse(Plan& plan, uint32_t start_half_edge, uint32_t max_handle_depth) {
  const std::vector<uint32_t> corner_class = classesOfCorners(plan);
  std::vector<uint32_t> region_of_face;
  uint32_t region_count = 1;
  do {
    plan.cut =
        cutToManifold(corner_class, plan.classes.class_count, start_half_edge, region_of_face);
    plan.record = collapse(plan.cut.mesh);
  } while (halveDeepComponents(plan, max_handle_depth, region_of_face, region_count));
}

/// Sorts isolated wedges into the order in which their positions are coded.
void sortIsolated(Plan& plan) {
  std::vector<uint32_t>& isolated = plan.triangles.isolated;
  if (isolated.empty() || plan.attributes.empty()) return;
  const QuantizedAttribute& position = plan.attributes[0];
  std::vector<int32_t> positions;
  for (const uint32_t wedge : isolated) {
    for (size_t s = 0; s < 3; ++s)
      positions.push_back(codedPosition(position.info, position.values[3 * size_t{wedge} + s]));
  }
  std::vector<uint32_t> sorted;
  for (const uint32_t i : isolatedOrder(positions)) sorted.push_back(isolated[i]);
  isolated = std::move(sorted);
}

}  // namespace

std::vector<uint32_t> classesOfCorners(const Plan& plan) {
  std::vector<uint32_t> corner_class(plan.triangles.wedges.size());
  for (size_t i = 0; i < corner_class.size(); ++i)
    corner_class[i] = plan.classes.class_of_wedge[plan.triangles.wedges[i]];
  return corner_class;
}

void prepareConnectivity(Plan& plan, uint32_t start_half_edge, uint32_t max_handle_depth) {
  cutAndCollapse(plan, start_half_edge, max_handle_depth);
  plan.knows_surface = plan.knows_wedges = false;
  const ClosedMesh& mesh = plan.cut.mesh;
  plan.node_map.resize(plan.record.node_count);
  plan.source_of_vertex.resize(mesh.real_vertex_count);
  plan.source_gate.resize(mesh.real_face_count);

  PieceHeader& h = plan.header;
  h.vertex_count = mesh.real_vertex_count;
  h.face_count = mesh.real_face_count;
  h.operation_count = static_cast<uint32_t>(plan.record.operations.size());
  h.dummy_count = mesh.dummy_count;
  if (mesh.dummy_count != 0) h.flags |= piece_flag::kHoles;
  if (!plan.record.handles.empty()) h.flags |= piece_flag::kHandles;
  h.setSurface(surfaceOf(mesh, plan.cut.class_of_vertex, plan.classes.class_count));
}

void preparePivots(Plan& plan) {
  plan.knows_surface = plan.knows_wedges = false;
  plan.pivots = listByPivots(classesOfCorners(plan), plan.classes.class_count);
  plan.class_of_vertex = plan.pivots.class_of_vertex;
  plan.source_gate = plan.pivots.source_gate;
  PieceHeader& h = plan.header;
  h.vertex_count = static_cast<uint32_t>(plan.class_of_vertex.size());
  h.operation_count = h.dummy_count = 0;
  h.flags &= ~(piece_flag::kHoles | piece_flag::kHandles);
  h.setSurface(SurfaceCoding::kPivots);
}

bool allowsPivots(const Plan& plan) {
  const std::vector<uint32_t> c = classesOfCorners(plan);
  for (size_t i = 0; i < c.size(); i += 3) {
    if (c[i] == c[i + 1] || c[i + 1] == c[i + 2] || c[i + 2] == c[i]) return false;
  }
  return true;
}

Status preparePiece(const PieceView& view, const EncodeSettings& options, const Jobs& jobs,
                    Plan& plan, std::vector<std::string>& notes) {
  MCC_TRY(checkPiece(view));
  if (options.indices_only && view.attributes.size() != 1)
    return fail(Error::kBadArgument,
                "with indices_only, a piece can have no attribute except POSITION");
  plan.view = &view;
  // Some floats turn out to be coded exactly although bits were asked for; that is rare.
  const bool expects_exact = view.attributes[0].quantization_bits == 0 &&
                             view.attributes[0].format.component_type == ComponentType::kFloat32;
  jobs.run(3, [&](size_t i) {
    if (i == 0) plan.attributes = quantizeAttributes(view, options.without, notes);
    if (i == 1) plan.classes = weldPositions(view.attributes[0], view.wedge_count, expects_exact);
    if (i == 2) plan.triangles = sortTriangles(view.parts, view.wedge_count);
  });
  const bool is_exact = isExact(plan.attributes[0].info.coding);
  if (is_exact != expects_exact)
    plan.classes = weldPositions(view.attributes[0], view.wedge_count, is_exact);
  MCC_TRY(checkJoints(plan));
  if (options.indices_only) plan.attributes.clear();
  plan.header.wedge_count = view.wedge_count;
  for (const PartView& part : view.parts)
    plan.parts.push_back({static_cast<uint32_t>(part.indices.size() / 3)});
  describePiece(plan, options);
  return {};
}

void findPlanesOf(Plan& plan, std::span<const int32_t> positions) {
  if (plan.has_planes.has_value()) return;
  const AttributeInfo& info = plan.attributes[0].info;
  plan.has_planes = info.coding == AttributeCoding::kLattice &&
                    info.bits <= position_mode::kMaxBitsOfPlanes &&
                    findPlanes(positions, plan.planes);
}

std::vector<AttributeInfo> infosOf(const Plan& plan) {
  std::vector<AttributeInfo> infos;
  for (const QuantizedAttribute& a : plan.attributes) infos.push_back(a.info);
  return infos;
}

void describePiece(Plan& plan, const EncodeOptions& options) {
  PieceHeader& h = plan.header;
  h.isolated_count = static_cast<uint32_t>(plan.triangles.isolated.size());
  h.listed_count =
      static_cast<uint32_t>(plan.triangles.listed.size() + plan.triangles.duplicates.size());
  h.part_count = static_cast<uint32_t>(plan.parts.size());
  h.attribute_count = static_cast<uint32_t>(plan.attributes.size());
  if (h.isolated_count != 0) h.flags |= piece_flag::kIsolated;
  if (h.listed_count != 0) h.flags |= piece_flag::kListed;
  if (h.part_count > 1) h.flags |= piece_flag::kManyParts;
  if (options.keep_triangle_order) h.flags |= piece_flag::kTriangleOrder;
  if (options.keep_vertex_order) h.flags |= piece_flag::kVertexOrder;
  sortIsolated(plan);
  std::vector<uint32_t> wedge_of_class(plan.classes.class_count, kNone);
  for (const uint32_t w : plan.triangles.wedges) {
    uint32_t& first = wedge_of_class[plan.classes.class_of_wedge[w]];
    if (first == kNone) first = w;
    if (first != w) h.flags |= piece_flag::kSeams;
  }
}

std::vector<uint32_t> codingOrder(const Plan& plan) {
  std::vector<uint32_t> order;
  for (uint32_t phase = 0; phase < kCodingPhases; ++phase) {
    for (uint32_t a = 1; a < plan.attributes.size(); ++a) {
      if (codingPhase(plan.attributes[a].info) == phase) order.push_back(a);
    }
  }
  return order;
}

}  // namespace mcc
