// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/fit_lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "format/codings.h"

namespace mcc::gltf {

float floatAt(const AttributePlan& attribute, uint64_t element, uint32_t component) {
  float value = 0;
  std::memcpy(&value,
              attribute.source.data + element * attribute.source.stride_bytes + 4 * component, 4);
  return value;
}

bool addTo(Extent& extent, const AttributePlan& attribute) {
  return extent.add(attribute.source.count,
                    [&](uint64_t i, uint32_t c) { return floatAt(attribute, i, c); });
}

bool fitError(const Extent& extent, double error, Lattice& lattice, uint8_t& bits) {
  lattice = {};
  std::copy_n(extent.min, extent.component_count, lattice.origin);
  const double rounding = std::ldexp(1.02 * (extent.size() + 2 * extent.farthest()), -24);
  const double per_component = error - rounding;
  if (!(per_component > 0)) return false;
  lattice.step = static_cast<float>(2 * per_component * (1 - 0x1p-20));
  if (!std::isnormal(lattice.step)) return false;
  const double last_point = std::floor(extent.size() / double{lattice.step} + 0.5);
  bits = static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(std::max(last_point, 1.0))));
  return last_point < std::ldexp(1.0, kMaxLatticeBits);
}

bool fitAroundZero(const Extent& extent, float step, Lattice& lattice, uint8_t& bits) {
  if (!std::isnormal(step)) return false;
  constexpr double kLastPoint = (1 << kMaxLatticeBits) - 1;
  lattice = {};
  lattice.step = step;
  double last_point = 1;
  for (uint32_t c = 0; c < extent.component_count; ++c) {
    for (const float end : {extent.min[c], extent.max[c]})
      last_point = std::max(last_point, std::abs(latticePoint(end, 0, step)));
  }
  if (last_point > kLastPoint) return false;
  bits = static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(last_point)));
  return true;
}

void useLattice(AttributePlan& attribute, const Lattice& lattice, uint8_t bits) {
  attribute.bits = bits;
  attribute.has_lattice = true;
  attribute.lattice = lattice;
}

bool isFloat(const AttributePlan& attribute) {
  return attribute.format.component_type == ComponentType::kFloat32;
}

bool isBasePosition(const AttributePlan& attribute) {
  return attribute.format.semantic == Semantic::kPosition && attribute.target == kNone;
}

std::string whereIs(const PiecePlan& piece, const AttributePlan& attribute) {
  return piece.parts[0].users[0].path() + ": " + attribute.label();
}

void visitPositionGroups(Grid grid, std::vector<PayloadPlan>& payloads,
                         std::vector<std::string>& notes,
                         const std::function<void(PositionGroup&)>& visit) {
  std::vector<std::vector<PlannedAttribute>> all;
  for (PayloadPlan& payload : payloads) {
    if (grid != Grid::kScene || all.empty()) all.emplace_back();
    for (PiecePlan& piece : payload.pieces) {
      if (grid == Grid::kPrimitive) all.emplace_back();
      for (AttributePlan& attribute : piece.attributes) {
        if (isBasePosition(attribute) && isFloat(attribute))
          all.back().push_back({&piece, &attribute});
      }
    }
  }
  for (const std::vector<PlannedAttribute>& members : all) {
    PositionGroup group;
    for (const PlannedAttribute& member : members) {
      if (addTo(group.extent, *member.attribute)) {
        group.finite.push_back(member);
      } else {
        notes.push_back(whereIs(*member.piece, *member.attribute) +
                        " has NaN or infinite values and stays exact");
      }
    }
    if (!group.finite.empty()) visit(group);
  }
}

void noteRoundedWeights(PiecePlan& piece) {
  std::vector<AttributePlan*> sets;
  for (AttributePlan& attribute : piece.attributes) {
    if (attribute.format.semantic != Semantic::kWeights || attribute.target != kNone) continue;
    if (!attribute.has_lattice || attribute.lattice != unitLattice(attribute.bits)) return;
    sets.push_back(&attribute);
  }
  for (AttributePlan* set : sets) set->is_rounded_with_others = true;
}

}  // namespace mcc::gltf
