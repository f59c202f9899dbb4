// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Derives what stages learn from one another.
#include "writer/truth.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace mcc {

McTruth connectivityTruth(const McRecord& r, const SurfaceLearned& learned) {
  McTruth truth;
  truth.operations = r.operations.data();
  truth.handles = r.handles.data();
  truth.components = r.components.data();
  truth.component_count = static_cast<uint32_t>(r.components.size());
  truth.gates = r.gates.data();
  truth.vertex_is_dummy = r.vertex_is_dummy.data();
  truth.node_of_collapse_node = learned.node_map.data();
  truth.source_of_vertex = learned.source_of_vertex.data();
  truth.source_gate_of_face = learned.source_gate.data();
  return truth;
}

void learnVertices(Plan& plan) {
  if (plan.knows_surface) return;
  if (!plan.header.hasPivots()) {
    plan.class_of_vertex.resize(plan.source_of_vertex.size());
    for (size_t v = 0; v < plan.class_of_vertex.size(); ++v) {
      plan.class_of_vertex[v] = plan.cut.class_of_vertex[plan.source_of_vertex[v]];
    }
  }
  plan.corner_source.resize(3 * plan.source_gate.size());
  for (size_t f = 0; f < plan.source_gate.size(); ++f) {
    const uint32_t gate = plan.source_gate[f];  // this corner becomes half-edge 1
    plan.corner_source[3 * f] = plan.triangles.wedges[prevCorner(gate)];
    plan.corner_source[3 * f + 1] = plan.triangles.wedges[gate];
    plan.corner_source[3 * f + 2] = plan.triangles.wedges[nextCorner(gate)];
  }
}

void learnPositions(Plan& plan, const FaceMesh& mesh, const Groups& groups) {
  if (plan.knows_surface) return;
  plan.knows_surface = true;
  if (plan.attributes.empty()) return;
  const std::vector<int32_t>& q = plan.attributes[0].values;
  plan.positions.resize(3 * (size_t{groups.count} + plan.triangles.isolated.size()));
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    for (uint32_t k = 0; k < 3; ++k) {
      const size_t group = mesh.words[size_t{f} * kFaceWords + k];
      const size_t source = plan.corner_source[3 * size_t{f} + k];
      for (size_t s = 0; s < 3; ++s) plan.positions[3 * group + s] = q[3 * source + s];
    }
  }
  for (size_t i = 0; i < plan.triangles.isolated.size(); ++i) {
    for (size_t s = 0; s < 3; ++s) {
      plan.positions[3 * (groups.count + i) + s] = q[3 * size_t{plan.triangles.isolated[i]} + s];
    }
  }
  const AttributeInfo& info = plan.attributes[0].info;
  if (info.coding != AttributeCoding::kGrid) return;
  plan.exact_positions = plan.positions;
  for (int32_t& value : plan.positions) value = codedPosition(info, value);
}

namespace {

/// Finds the triangles apart from the surface. Each refers to the first face that it may refer to.
void learnListed(Plan& plan, FaceMesh& mesh, const std::vector<uint32_t>& wedge_of_source) {
  plan.list.clear();
  std::vector<uint32_t> face_of_source(plan.source_gate.size());
  for (uint32_t f = 0; f < mesh.face_count; ++f) face_of_source[plan.source_gate[f] / 3] = f;
  const FaceView faces = mesh.view();
  for (const uint32_t source : plan.triangles.duplicates) {
    ListedTriangle t{
        {}, plan.triangles.part[source], listed_shape::kFaceAgain, face_of_source[source]};
    placeOnFace(faces, t);
    plan.list.push_back(t);
  }
  struct Degenerate {
    uint64_t edge;  ///< doubled wedge, single wedge
    uint32_t part;
    uint32_t shape;
    uint32_t face;
    bool operator<(const Degenerate& o) const {
      return edge != o.edge ? edge < o.edge : part < o.part;
    }
  };
  std::vector<Degenerate> degenerates;
  for (const SortedTriangles::Listed& t : plan.triangles.listed) {
    uint64_t w[3];
    for (int k = 0; k < 3; ++k) w[k] = wedge_of_source[t.wedge[k]];
    const int single = w[0] == w[1] ? 2 : (w[1] == w[2] ? 0 : 1);
    degenerates.push_back(
        {w[(single + 1) % 3] << 32 | w[single], t.part, listed_shape::kAny, kNone});
  }
  std::sort(degenerates.begin(), degenerates.end());
  std::vector<uint8_t> is_doubled(wedge_of_source.size(), 0);
  for (const Degenerate& d : degenerates) is_doubled[d.edge >> 32] = 1;
  for (uint32_t h = 0; h < 3 * mesh.face_count && !degenerates.empty(); ++h) {
    ListedTriangle t{{}, 0, 0, h / 3};
    for (const uint32_t side : {0u, 1u}) {
      t.shape = listed_shape::kOnEdge + 2 * (h % 3) + side;
      placeOnFace(faces, t);
      if (is_doubled[t.wedge[0]] == 0) continue;
      const uint64_t edge = uint64_t{t.wedge[0]} << 32 | t.wedge[2];
      auto it = std::lower_bound(degenerates.begin(), degenerates.end(), Degenerate{edge, 0, 0, 0});
      for (; it != degenerates.end() && it->edge == edge && it->face == kNone; ++it) {
        it->shape = t.shape;
        it->face = t.face;
      }
    }
  }
  for (const Degenerate& d : degenerates) {
    const uint32_t doubled = static_cast<uint32_t>(d.edge >> 32);
    plan.list.push_back(
        {{doubled, doubled, static_cast<uint32_t>(d.edge)}, d.part, d.shape, d.face});
  }
  std::sort(plan.list.begin(), plan.list.end(),
            [](const ListedTriangle& a, const ListedTriangle& b) {
              return std::tie(a.face, a.shape, a.part, a.wedge[0], a.wedge[2]) <
                     std::tie(b.face, b.shape, b.part, b.wedge[0], b.wedge[2]);
            });
}

}  // namespace

void learnWedges(Plan& plan, FaceMesh& mesh) {
  if (plan.knows_wedges) return;
  plan.knows_wedges = true;
  plan.wedge_source.assign(plan.header.wedge_count, kNone);
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    for (uint32_t k = 0; k < 3; ++k) {
      plan.wedge_source[mesh.words[size_t{f} * kFaceWords + k]] =
          plan.corner_source[3 * size_t{f} + k];
    }
  }
  const uint32_t first_isolated = plan.header.wedge_count - plan.header.isolated_count;
  for (size_t i = 0; i < plan.triangles.isolated.size(); ++i) {
    plan.wedge_source[first_isolated + i] = plan.triangles.isolated[i];
  }
  std::vector<uint32_t> wedge_of_source(plan.header.wedge_count);
  for (uint32_t w = 0; w < plan.header.wedge_count; ++w) wedge_of_source[plan.wedge_source[w]] = w;
  plan.part_of_face.resize(mesh.face_count);
  for (uint32_t f = 0; f < mesh.face_count; ++f) {
    plan.part_of_face[f] = plan.triangles.part[plan.source_gate[f] / 3];
  }
  learnListed(plan, mesh, wedge_of_source);
}

void learnTriangleOrder(Plan& plan, const TriangleTable& table) {
  using Wedges = std::array<uint32_t, 3>;
  struct Named {
    Wedges wedges;  ///< the smallest of the triangle's rotations
    uint32_t part;
    uint32_t place;
    bool operator<(const Named& o) const {
      return std::tie(wedges, part, place) < std::tie(o.wedges, o.part, o.place);
    }
  };
  const auto turned = [](const Wedges& w, uint32_t by) {
    return Wedges{w[by % 3], w[(by + 1) % 3], w[(by + 2) % 3]};
  };
  const auto nameOf = [&](const Wedges& w, uint32_t part, uint32_t place) {
    return Named{std::min({w, turned(w, 1), turned(w, 2)}), part, place};
  };
  std::vector<uint32_t> wedge_of_source(plan.header.wedge_count);
  for (uint32_t w = 0; w < plan.header.wedge_count; ++w) wedge_of_source[plan.wedge_source[w]] = w;
  std::vector<Wedges> source;
  std::vector<Named> wanted;
  for (uint32_t part = 0; part < plan.view->parts.size(); ++part) {
    const std::span<const uint32_t> indices = plan.view->parts[part].indices;
    for (size_t i = 0; i < indices.size(); i += 3) {
      const Wedges w = {wedge_of_source[indices[i]], wedge_of_source[indices[i + 1]],
                        wedge_of_source[indices[i + 2]]};
      wanted.push_back(nameOf(w, part, static_cast<uint32_t>(source.size())));
      source.push_back(w);
    }
  }
  const auto wedgesOf = [&](uint32_t t) {
    return Wedges{table.wedges[3 * size_t{t}], table.wedges[3 * size_t{t} + 1],
                  table.wedges[3 * size_t{t} + 2]};
  };
  std::vector<Named> coded;
  for (uint32_t t = 0; t < table.count(); ++t)
    coded.push_back(nameOf(wedgesOf(t), table.partOf(t), t));
  std::sort(wanted.begin(), wanted.end());
  std::sort(coded.begin(), coded.end());
  plan.triangle_order.resize(table.count());
  for (size_t i = 0; i < coded.size(); ++i) {
    uint32_t corner = 0;
    while (turned(wedgesOf(coded[i].place), corner) != source[wanted[i].place]) ++corner;
    plan.triangle_order[wanted[i].place] = orderedTriangle(coded[i].place, corner);
  }
}

void learnValues(const Plan& plan, uint32_t index, uint32_t offset, uint32_t stride,
                 Array<int32_t>& values) {
  const QuantizedAttribute& a = plan.attributes[index];
  for (uint32_t w = 0; w < plan.header.wedge_count; ++w) {
    for (uint32_t c = 0; c < a.components; ++c) {
      values[size_t{w} * stride + offset + c] =
          a.values[size_t{plan.wedge_source[w]} * a.components + c];
    }
  }
}

}  // namespace mcc
