// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Stores what the stages of a piece decode in the caller's memory. [A.10.18, A.9.4]
#ifndef MCC_READER_OUTPUTS_H_
#define MCC_READER_OUTPUTS_H_

#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>

#include "base/memory.h"
#include "format/decodes.h"
#include "mesh/dequantize.h"
#include "reader/piece.h"
#include "vectors/octahedral.h"

namespace mcc {

/// Which wedges go to the elements of the caller's memory, one after another.
struct WedgeAt {
  const uint32_t* order;  ///< null: all, as decoded
  uint32_t count;

  size_t operator()(uint32_t place) const {
    return !decodes::kOrders || order == nullptr ? place : order[place];
  }
};
inline WedgeAt wedgeAt(const CodedPiece& piece, uint32_t wedge_count) {
  return {piece.wedge_order.empty() ? nullptr : piece.wedge_order.data(), wedge_count};
}

/// Where the integers of an element are, for all attributes alike. Compact code stores every
/// attribute through this.
struct ElementAt {
  const int32_t* values;
  size_t stride;
  WedgeAt wedge_at;
  const uint32_t* group = nullptr;  ///< by wedge; null: all but isolated wedges equal their group
  uint32_t isolated_first = ~uint32_t{0};  ///< wedges from here on come after the groups
  uint32_t group_count = 0;

  const int32_t* operator()(uint32_t place) const {
    size_t at = wedge_at(place);
    if (decodes::kIsolated && at >= isolated_first) {
      at = at - isolated_first + group_count;
    } else if (group != nullptr) {
      at = group[at];
    }
    return values + at * stride;
  }
};

/// Computes unit vectors from grid points, four at a time. If `has_sign`, a fourth component is -1
/// or 1.
template <class Load>
void storeNormals(int32_t centre, bool has_sign, uint32_t wedge_count,
                  const AttributeTarget& target, Load load) {
  uint8_t* to = static_cast<uint8_t*>(target.data);
  for (uint32_t w = 0; w < wedge_count; w += 4) {
    const uint32_t count = std::min(wedge_count - w, 4u);
    const int32_t* points[4];
    for (uint32_t i = 0; i < 4; ++i) points[i] = load(w + (i < count ? i : 0));
    Float4 rows[4];
    octahedralToUnit(points, centre, rows);
    rows[3] = rows[0];  // to spare
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (uint32_t i = 0; i < count; ++i, to += target.stride_bytes) {
      std::memcpy(to, &rows[i], 3 * sizeof(float));  // of a constant size, which takes no call
      if (has_sign) storeFloat(to + 12, points[i][2] != 0 ? -1.0f : 1.0f);
    }
  }
}

/// Stores lattice values. They have kComponents, which 0 leaves open.
template <uint32_t kComponents, class Load>
void storeLattice(const AttributeInfo& info, uint32_t wedge_count, const AttributeTarget& target,
                  Load load) {
  const uint32_t components = kComponents != 0 ? kComponents : info.format.component_count;
  const Lattice lattice = info.lattice;
  uint8_t* to = static_cast<uint8_t*>(target.data);
  for (uint32_t w = 0; w < wedge_count; ++w, to += target.stride_bytes) {
    const int32_t* q = load(w);
    for (uint32_t c = 0; c < components; ++c) {
      storeFloat(to + 4 * c, latticeValue(q[c], lattice.step, lattice.origin[c]));
    }
  }
}

/// Stores integers modulo the width of Component, whose sign does not matter.
template <class Component, class Load>
void storeIntegers(uint32_t components, uint32_t wedge_count, const AttributeTarget& target,
                   Load load) {
  uint8_t* to = static_cast<uint8_t*>(target.data);
  for (uint32_t w = 0; w < wedge_count; ++w, to += target.stride_bytes) {
    const int32_t* q = load(w);
    for (uint32_t c = 0; c < components; ++c) {
      const Component value = static_cast<Component>(q[c]);
      std::memcpy(to + sizeof value * c, &value, sizeof value);
    }
  }
}

/// Copies coded integers to the caller's elements; `load(i)` points to the integers of
/// element i. [A.10.18]
template <class Load>
void storeElements(const AttributeInfo& info, uint32_t wedge_count, const AttributeTarget& target,
                   Load load) {
  if (target.data == nullptr) return;
  const AttributeFormat& format = info.format;
  const uint32_t components = format.component_count;
  uint8_t* to = static_cast<uint8_t*>(target.data);
  const size_t stride = target.stride_bytes;
  switch (info.coding) {
    case AttributeCoding::kLattice:
      if (!kCompact && components == 3) return storeLattice<3>(info, wedge_count, target, load);
      if (!kCompact && components == 2) return storeLattice<2>(info, wedge_count, target, load);
      return storeLattice<0>(info, wedge_count, target, load);
    case AttributeCoding::kOctahedral:
      storeNormals(octahedralCentre(info.bits), components == 4, wedge_count, target, load);
      return;
    case AttributeCoding::kExactFloat:
    case AttributeCoding::kGrid:  // its values are ordered floats at this point
      if (!decodes::kExactFloats) return;
      for (uint32_t w = 0; w < wedge_count; ++w, to += stride) {
        const int32_t* q = load(w);
        for (uint32_t c = 0; c < components; ++c) {
          const uint32_t bits = bitsFromOrdered(q[c]);
          std::memcpy(to + 4 * c, &bits, 4);
        }
      }
      return;
    default: {
      const uint32_t bytes = componentBytes(format.component_type);
      if (!kCompact && bytes == 1)
        return storeIntegers<uint8_t>(components, wedge_count, target, load);
      if (!kCompact && bytes == 2)
        return storeIntegers<uint16_t>(components, wedge_count, target, load);
      for (uint32_t w = 0; w < wedge_count; ++w, to += stride) {
        const int32_t* q = load(w);
        for (uint32_t c = 0; c < components; ++c) {
          storeInteger(to + size_t{bytes} * c, format.component_type, q[c]);
        }
      }
    }
  }
}

/// Computes tangents from angles in the planes of their normals. [A.10.13]
inline void storeTangents(const AttributeInfo& info, const int32_t* values,
                          const AttributeInfo& normal_info, const int32_t* normals,
                          WedgeAt wedge_at, const AttributeTarget& target) {
  const int32_t centre = octahedralCentre(normal_info.bits);
  uint8_t* to = static_cast<uint8_t*>(target.data);
  for (uint32_t w = 0; w < wedge_at.count; w += 4) {
    const uint32_t count = std::min(wedge_at.count - w, 4u);
    const int32_t* points[4];
    AngleSteps steps[4] = {{0, 2}, {0, 2}, {0, 2}, {0, 2}};
    int32_t signs[4];
    for (uint32_t i = 0; i < 4; ++i) {
      const size_t from = wedge_at(w + (i < count ? i : 0));
      points[i] = normals + 2 * from;
      steps[i] = AngleSteps(values[2 * from], info.bits);
      signs[i] = values[2 * from + 1] != 0 ? -1 : 1;
    }
    Float4 normal[3];
    Float4 rows[4];
    octahedralToUnit(points, centre, normal);
    tangentFromSteps(
        normal, fourFloats(steps[0].quarter, steps[1].quarter, steps[2].quarter, steps[3].quarter),
        fourFloats(steps[0].rest, steps[1].rest, steps[2].rest, steps[3].rest), info.bits, rows);
    rows[3] = fourFloats(signs[0], signs[1], signs[2], signs[3]);
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (uint32_t i = 0; i < count; ++i, to += target.stride_bytes) {
      std::memcpy(to, &rows[i], 4 * sizeof(float));
    }
  }
}

/// Stores `values`, value_stride per wedge, in the target of attribute `index` and of all its
/// aliases.
inline void storeAttribute(const TangentNormals& normals, AttributeInfos infos, uint32_t index,
                           const int32_t* values, uint32_t value_stride, WedgeAt wedge_at,
                           std::span<const AttributeTarget> targets) {
  const AttributeInfo& a = infos[index];
  for (size_t i = index; i < targets.size(); ++i) {
    const bool is_alias = infos[i].coding == AttributeCoding::kAlias && infos[i].alias_of == index;
    if (targets[i].data == nullptr || (i != index && !is_alias)) continue;
    if (decodes::kTangents && a.coding == AttributeCoding::kTangentAngle) {
      storeTangents(a, values, *normals.info, normals.points, wedge_at, targets[i]);
    } else {
      if constexpr (kCompact) {
        storeElements(a, wedge_at.count, targets[i], ElementAt{values, value_stride, wedge_at});
      } else {
        storeElements(a, wedge_at.count, targets[i],
                      [=](uint32_t place) { return values + wedge_at(place) * value_stride; });
      }
    }
  }
}

/// Stores the values that codeAttribute() left for an attribute, and for one that is coded with it.
inline void storeDecoded(const TangentNormals& normals, AttributeInfos infos, uint32_t index,
                         const int32_t* values, WedgeAt wedge_at,
                         std::span<const AttributeTarget> targets) {
  const uint32_t stride = codedComponents(infos, index);
  storeAttribute(normals, infos, index, values, stride, wedge_at, targets);
  if (methodOf(infos, index) != AttributeMethod::kSkin || wedge_at.count == 0) return;
  storeAttribute(normals, infos, skinPartner(infos, index), values + kSkinSlots, stride, wedge_at,
                 targets);
}

inline void storePositions(const CodedPiece& piece, const AttributeInfo& info, uint32_t wedge_count,
                           const AttributeTarget& target) {
  const VertexRecord* records = piece.records.data();
  const WedgeAt wedge_at = wedgeAt(piece, wedge_count);
  if constexpr (kCompact) {
    storeElements(info, wedge_count, target,
                  ElementAt{records->q, sizeof(VertexRecord) / sizeof(int32_t), wedge_at,
                            piece.wedge_group.empty() ? nullptr : piece.wedge_group.data(),
                            piece.wedges.isolated_first, piece.groups.count});
  } else if (piece.wedge_group.empty() && piece.wedge_order.empty()) {
    storeElements(info, wedge_count, target, [=](uint32_t w) { return records[w].q; });
  } else {
    storeElements(info, wedge_count, target, [&piece, records, wedge_at](uint32_t i) {
      return records[piece.groupOf(static_cast<uint32_t>(wedge_at(i)))].q;
    });
  }
}

inline void storeIndex(const PartTarget& target, size_t at, uint32_t index) {
  switch (target.index_type) {
    case IndexType::kUint8:
      static_cast<uint8_t*>(target.indices)[at] = static_cast<uint8_t>(index);
      return;
    case IndexType::kUint16:
      static_cast<uint16_t*>(target.indices)[at] = static_cast<uint16_t>(index);
      return;
    case IndexType::kUint32: static_cast<uint32_t*>(target.indices)[at] = index; return;
  }
}

/// Stores the triangles in the usual case of one part and no triangles apart from the surface.
/// `number(w)` is what the caller calls wedge w.
template <class Number>
void storeFaces(const FaceMesh& mesh, const PartTarget& target, const Number& number) {
  const auto store = [&](auto* to) {
    const uint32_t* face = mesh.words.data();
    for (uint32_t f = 0; f < mesh.face_count; ++f, face += kFaceWords, to += 3) {
      for (int k = 0; k < 3; ++k)
        to[k] = static_cast<std::remove_reference_t<decltype(*to)>>(number(face[k]));
    }
  };
  if (target.indices == nullptr) return;
  switch (target.index_type) {
    case IndexType::kUint8: store(static_cast<uint8_t*>(target.indices)); break;
    case IndexType::kUint16: store(static_cast<uint16_t*>(target.indices)); break;
    case IndexType::kUint32: store(static_cast<uint32_t*>(target.indices)); break;
  }
}

/// Tells the caller the mc-edges of a piece. `number(w)` is what the caller calls wedge w.
template <class Number>
void tellMcEdges(const CodedPiece& piece, uint32_t piece_index, const Number& number,
                 const DecodeOptions& options) {
  if (options.mc_edge == nullptr) return;
  for (size_t i = 0; i < piece.mc_edges.size(); ++i) {
    const McEdgeCorners corners = piece.mc_edges[i];
    options.mc_edge(options.mc_edge_user, piece_index, number(piece.mesh.words[corners.of_vertex]),
                    number(piece.mesh.words[corners.of_from]));
  }
}

/// Fills `place_of` with the place of each wedge in the order that is kept; empty if none is.
inline Status findPlaces(const CodedPiece& piece, Array<uint32_t>& place_of) {
  if (!place_of.resize(piece.wedge_order.size()))
    return fail(Error::kOutOfMemory, "no memory for the order");
  for (uint32_t i = 0; i < piece.wedge_order.size(); ++i) place_of[piece.wedge_order[i]] = i;
  return {};
}

inline Status checkPartCounts(std::span<const PartInfo> infos, const Array<uint32_t>& counts) {
  for (size_t p = 0; p < infos.size(); ++p) {
    if (counts[p] != infos[p].triangle_count) {
      return fail(Error::kBadAttribute,
                  "a part has another number of triangles than the header claims");
    }
  }
  return {};
}

/// Stores triangles and wedges in the orders that are kept.
inline Status storeOrderedTriangles(const CodedPiece& piece, std::span<const PartInfo> infos,
                                    std::span<const PartTarget> targets,
                                    const Allocator& allocator) {
  Array<uint32_t> fill(allocator);
  Array<uint32_t> place_of(allocator);
  if (!fill.assign(targets.size(), 0)) return fail(Error::kOutOfMemory, "no memory for the order");
  MCC_TRY(findPlaces(piece, place_of));
  const TriangleTable& table = piece.triangles;
  for (uint32_t i = 0; i < table.count(); ++i) {
    const uint32_t ordered =
        piece.triangle_order.empty() ? orderedTriangle(i, 0) : piece.triangle_order[i];
    const uint32_t triangle = ordered >> 2;
    const uint32_t part = table.partOf(triangle);
    const uint32_t at = fill[part]++;
    if (at >= infos[part].triangle_count || targets[part].indices == nullptr) continue;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t wedge = table.wedges[3 * size_t{triangle} + ((ordered & 3) + k) % 3];
      storeIndex(targets[part], 3 * size_t{at} + k, place_of.empty() ? wedge : place_of[wedge]);
    }
  }
  return checkPartCounts(infos, fill);
}

/// Stores faces in decoding order, then the listed triangles, split into parts. `number(w)` is what
/// the caller calls wedge w, and `part_of(f)` the part of face f. [A.9.4]
template <class Number, class PartOf>
Status storeSurface(const CodedPiece& piece, std::span<const PartInfo> infos,
                    std::span<const PartTarget> targets, const Number& number,
                    const PartOf& part_of, const Allocator& allocator) {
  if (targets.size() == 1 && piece.list.empty()) {
    storeFaces(piece.mesh, targets[0], number);
    return {};
  }
  Array<uint32_t> fill(allocator);
  if (!fill.assign(targets.size(), 0)) return fail(Error::kOutOfMemory, "no memory for the parts");
  const auto store = [&](uint32_t part, const uint32_t* wedges) {
    const size_t at = fill[part]++;
    if (at >= infos[part].triangle_count || targets[part].indices == nullptr) return;
    for (size_t k = 0; k < 3; ++k) storeIndex(targets[part], 3 * at + k, number(wedges[k]));
  };
  for (uint32_t f = 0; f < piece.mesh.face_count; ++f) {
    store(targets.size() > 1 ? part_of(f) : 0, piece.mesh.words.data() + size_t{f} * kFaceWords);
  }
  for (size_t i = 0; i < piece.list.size(); ++i) store(piece.list[i].part, piece.list[i].wedge);
  return checkPartCounts(infos, fill);
}

inline Status storeTriangles(const CodedPiece& piece, std::span<const PartInfo> infos,
                             std::span<const PartTarget> targets, const Allocator& allocator) {
  if (decodes::kOrders && piece.triangles.count() != 0)
    return storeOrderedTriangles(piece, infos, targets, allocator);
  const uint32_t* words = piece.mesh.words.data();
  return storeSurface(
      piece, infos, targets, [](uint32_t wedge) { return wedge; },
      [words](uint32_t f) { return words[size_t{f} * kFaceWords + kFaceWord]; }, allocator);
}

}  // namespace mcc

#endif  // MCC_READER_OUTPUTS_H_
