// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quantize.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "format/codings.h"

namespace mcc::gltf {
namespace {

/// Returns the largest distance of a value from the lattice's origin along an axis, in steps.
double farthestPoint(const Extent& extent, const Lattice& lattice) {
  double farthest = 0;
  for (uint32_t c = 0; c < extent.component_count; ++c) {
    for (const float value : {extent.min[c], extent.max[c]}) {
      farthest = std::max(farthest, std::abs(latticePoint(value, lattice.origin[c], lattice.step)));
    }
  }
  return farthest;
}

/// Counts the bits of the last point of a lattice. Returns false when they are too many.
bool countBits(double last_point, uint8_t& bits) {
  if (last_point >= std::ldexp(1.0, kMaxLatticeBits)) return false;
  bits = static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(std::max(last_point, 1.0))));
  return true;
}

}  // namespace

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
  return countBits(std::floor(extent.size() / double{lattice.step} + 0.5), bits);
}

bool fitAroundZero(const Extent& extent, float step, Lattice& lattice, uint8_t& bits) {
  if (!std::isnormal(step)) return false;
  lattice = {};
  lattice.step = step;
  return countBits(farthestPoint(extent, lattice), bits);
}

bool fitTangents(const Extent& extent, uint8_t bits, Lattice& lattice) {
  std::fill_n(lattice.origin, extent.component_count, -1.0f);
  lattice.step = std::ldexp(1.0f, 1 - int{bits});
  return extent.isInside(-1.01f, 1.01f);
}

bool isFloat(const AttributePlan& attribute) {
  return attribute.format.component_type == ComponentType::kFloat32;
}

std::string whereIs(const PiecePlan& piece, const AttributePlan& attribute) {
  return piece.parts[0].users[0].path() + ": " + attribute.label();
}

void useLattice(const PiecePlan& piece, AttributePlan& attribute, const Lattice& lattice,
                uint8_t bits, const std::string& why_exact, std::vector<std::string>& notes) {
  if (!why_exact.empty()) return notes.push_back(whereIs(piece, attribute) + why_exact);
  attribute.bits = bits;
  attribute.has_lattice = true;
  attribute.lattice = lattice;
}

void PositionGroup::use(const Lattice& lattice, uint8_t bits, double max_distance) {
  for (const PlannedAttribute& member : finite) {
    member.attribute->bits = bits;
    member.attribute->has_lattice = true;
    member.attribute->lattice = lattice;
    member.attribute->max_distance = max_distance;
  }
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
        if (attribute.isBase(Semantic::kPosition) && isFloat(attribute))
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
        notes.push_back(whereIs(*member.piece, *member.attribute) + kNotFinite);
      }
    }
    if (!group.finite.empty()) visit(group);
  }
}

void noteRoundedWeights(PiecePlan& piece) {
  std::vector<AttributePlan*> sets;
  for (AttributePlan& attribute : piece.attributes) {
    if (!attribute.isBase(Semantic::kWeights)) continue;
    if (!attribute.has_lattice || attribute.lattice != unitLattice(attribute.bits)) return;
    sets.push_back(&attribute);
  }
  for (AttributePlan* set : sets) set->is_rounded_with_others = true;
}

namespace {

class QuantizationPlanner {
 public:
  QuantizationPlanner(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                      std::vector<std::string>& notes)
      : options_(options), payloads_(payloads), notes_(notes), given_(options.position_lattice) {
    if (options.step != 0) given_ = Lattice{{0, 0, 0, 0}, static_cast<float>(options.step)};
  }

  void run() {
    if (options_.lossless) return;
    planPositions();
    for (PayloadPlan& payload : payloads_) {
      for (PiecePlan& piece : payload.pieces) {
        for (AttributePlan& attribute : piece.attributes) planAttribute(piece, attribute);
        noteRoundedWeights(piece);
      }
    }
  }

 private:
  void planPositions() {
    const uint8_t bits = options_.position_bits;
    if (bits == 0 && options_.max_position_error == 0 && !given_) return;
    visitPositionGroups(options_.grid, payloads_, notes_,
                        [&](PositionGroup& group) { planPositionGroup(group, bits); });
  }

  void planPositionGroup(PositionGroup& group, uint8_t bits) {
    const Extent& extent = group.extent;
    const auto stayExact = [&](const std::string& why) {
      notes_.push_back(group.where() + why + "; it stays exact");
    };
    Lattice lattice;
    if (given_) {
      if (!countBits(farthestPoint(extent, *given_), bits))
        return stayExact(" is more than 2^24 steps from the origin of the given lattice");
      return group.use(*given_, bits);
    }
    if (options_.max_position_error > 0) {
      const double distance =
          options_.max_position_error * (options_.is_error_relative ? extent.size() : 1);
      if (!fitError(extent, distance / std::sqrt(3.0), lattice, bits))
        return stayExact(" needs more than a lattice of 24 bits for the promised error");
      return group.use(lattice, bits, distance);
    }
    if (!fitWithin(group.extent, bits, lattice)) return stayExact(outliersText(bits));
    group.use(lattice, bits);
  }

  /// Fits a lattice of these bits, unless it would be too coarse for most of the values.
  static bool fitWithin(Extent& extent, uint8_t bits, Lattice& lattice) {
    return !isRuinedByOutliers(extent, bits) && fitLattice(extent, bits, lattice);
  }
  static std::string outliersText(uint8_t bits) {
    return sentence(" has outliers for which a lattice of ", bits,
                    " bits would be too coarse for all other values");
  }

  uint8_t bitsOf(Semantic semantic) const {
    switch (semantic) {
      case Semantic::kPosition: return options_.position_bits;
      case Semantic::kNormal: return options_.normal_bits;
      case Semantic::kTangent: return options_.tangent_bits;
      case Semantic::kTexcoord: return options_.texcoord_bits;
      case Semantic::kColor: return options_.color_bits;
      case Semantic::kWeights: return options_.weight_bits;
      case Semantic::kJoints:
      case Semantic::kCustom: break;
    }
    return 0;
  }

  void planAttribute(const PiecePlan& piece, AttributePlan& attribute) {
    uint8_t bits = bitsOf(attribute.format.semantic);
    const bool follows_position =
        attribute.format.semantic == Semantic::kPosition && piece.attributes[0].has_lattice;
    if (follows_position && bits == 0) bits = piece.attributes[0].bits;
    if (!isFloat(attribute) || bits == 0 || attribute.isBase(Semantic::kPosition)) return;
    Extent extent(attribute.format.component_count);
    Lattice lattice;
    std::string why;  // it stays exact
    const Semantic semantic = attribute.format.semantic;
    if (!addTo(extent, attribute)) {
      why = kNotFinite;
    } else if (attribute.target != kNone) {
      if (!fitAroundZero(extent, stepOfDelta(piece, attribute, extent, bits), lattice, bits))
        why = kTooManySteps;
    } else if (semantic == Semantic::kNormal) {
      // The codec has its own grid for unit vectors; the lattice is used for those of other
      // lengths.
      if (!fitLattice(extent, bits, lattice))
        why = " has values no lattice can hold; it stays exact";
    } else if (semantic == Semantic::kTangent) {
      if (!fitTangents(extent, bits, lattice)) why = kNotUnit;
    } else if (semantic != Semantic::kTexcoord && extent.isInside(0, 1)) {
      lattice = unitLattice(bits);  // black stays black, and no weight of 0 grows
    } else if (!fitWithin(extent, bits, lattice)) {
      why = outliersText(bits) + "; it stays exact";
    }
    useLattice(piece, attribute, lattice, bits, why, notes_);
  }

  /// Deltas of positions use the step of the positions, and those of unit vectors a step for the
  /// interval -1..1. All others use their own range.
  static float stepOfDelta(const PiecePlan& piece, const AttributePlan& attribute,
                           const Extent& extent, uint8_t bits) {
    const double points = static_cast<double>((uint64_t{1} << bits) - 1);
    const Semantic semantic = attribute.format.semantic;
    if (semantic == Semantic::kPosition && piece.attributes[0].has_lattice)
      return piece.attributes[0].lattice.step;
    if (semantic == Semantic::kNormal || semantic == Semantic::kTangent)
      return static_cast<float>(2.0 / points);
    const double range = extent.size() == 0 ? extent.farthest() : extent.size();
    return static_cast<float>(range == 0 ? 1.0 : range / points);
  }

  const ConvertOptions& options_;
  std::vector<PayloadPlan>& payloads_;
  std::vector<std::string>& notes_;
  std::optional<Lattice> given_;  ///< of all positions
};

}  // namespace

void planQuantization(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                      std::vector<std::string>& notes) {
  QuantizationPlanner(options, payloads, notes).run();
}

}  // namespace mcc::gltf
