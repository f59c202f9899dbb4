// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quantize.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "format/codings.h"
#include "values/enc_extent.h"

namespace mcc::gltf {
namespace {

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

/// Finds the lattice with the largest step that keeps every point within `distance` of its source.
/// Rounding to the lattice and the two float32 roundings of decoding move a component by at most
/// step / 2 + 2^-24 (|scaled| + |decoded|). Returns false when float32 or 24 bits allow no such
/// lattice.
bool fitDistance(const Extent& extent, double distance, Lattice& lattice, uint8_t& bits) {
  lattice = {};
  std::copy_n(extent.min, extent.component_count, lattice.origin);
  const double rounding = std::ldexp(1.02 * (extent.size() + 2 * extent.farthest()), -24);
  const double per_component =
      distance / std::sqrt(static_cast<double>(extent.component_count)) - rounding;
  if (!(per_component > 0)) return false;
  lattice.step = static_cast<float>(2 * per_component * (1 - 0x1p-20));
  if (!std::isnormal(lattice.step)) return false;
  const double last_point = std::floor(extent.size() / double{lattice.step} + 0.5);
  bits = static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(std::max(last_point, 1.0))));
  return last_point < std::ldexp(1.0, kMaxLatticeBits);
}

/// Fits a lattice of a given step through 0, so that unmoved vertices of a morph target stay
/// unmoved. `bits` becomes what its larger side needs. Returns false when that is too much.
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

class QuantizationPlanner {
 public:
  QuantizationPlanner(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                      std::vector<std::string>& notes)
      : options_(options), payloads_(payloads), notes_(notes) {}

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
  struct Member {
    PiecePlan* piece;
    AttributePlan* attribute;
  };

  static std::string where(const PiecePlan& piece, const AttributePlan& attribute) {
    return piece.parts[0].users[0].path() + ": " + attribute.label();
  }

  void planPositions() {
    const uint8_t bits = options_.position_bits;
    if (bits == 0 && options_.max_position_error == 0 && !options_.position_lattice) return;
    std::vector<std::vector<Member>> groups;
    for (PayloadPlan& payload : payloads_) {
      if (options_.grid != Grid::kScene || groups.empty()) groups.emplace_back();
      for (PiecePlan& piece : payload.pieces) {
        if (options_.grid == Grid::kPrimitive) groups.emplace_back();
        for (AttributePlan& attribute : piece.attributes) {
          if (isBasePosition(attribute) && isFloat(attribute)) {
            groups.back().push_back({&piece, &attribute});
          }
        }
      }
    }
    for (const auto& group : groups) planPositionGroup(group, bits);
  }

  void planPositionGroup(const std::vector<Member>& group, uint8_t bits) {
    Extent extent(3);
    std::vector<AttributePlan*> finite;
    for (const Member& member : group) {
      if (addTo(extent, *member.attribute)) {
        finite.push_back(member.attribute);
      } else {
        notes_.push_back(where(*member.piece, *member.attribute) +
                         " has NaN or infinite values and stays exact");
      }
    }
    if (finite.empty()) return;
    Lattice lattice;
    if (options_.position_lattice) {
      const double far = farthestPoint(extent, *options_.position_lattice);
      if (far >= std::ldexp(1.0, kMaxLatticeBits)) {
        notes_.push_back(
            where(*group[0].piece, *group[0].attribute) +
            " is more than 2^24 steps from the origin of the given lattice; it stays exact");
        return;
      }
      const auto needed =
          static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(std::max(far, 1.0))));
      for (AttributePlan* attribute : finite)
        useLattice(*attribute, *options_.position_lattice, needed);
      return;
    }
    if (options_.max_position_error > 0) {
      const double distance =
          options_.max_position_error * (options_.is_error_relative ? extent.size() : 1);
      uint8_t needed = 0;
      if (!fitDistance(extent, distance, lattice, needed)) {
        notes_.push_back(
            where(*group[0].piece, *group[0].attribute) +
            " needs more than a lattice of 24 bits for the promised error; it stays exact");
        return;
      }
      for (AttributePlan* attribute : finite) {
        useLattice(*attribute, lattice, needed);
        attribute->max_distance = distance;
      }
      return;
    }
    if (isRuinedByOutliers(extent, bits) || !fitLattice(extent, bits, lattice)) {
      notes_.push_back(where(*group[0].piece, *group[0].attribute) +
                       " has outliers for which a lattice of " + std::to_string(bits) +
                       " bits would be too coarse for all other values; it stays exact");
      return;
    }
    for (AttributePlan* attribute : finite) useLattice(*attribute, lattice, bits);
  }

  /// Returns the largest distance of a value from the lattice's origin along an axis, in steps.
  static double farthestPoint(const Extent& extent, const Lattice& lattice) {
    double farthest = 0;
    for (uint32_t c = 0; c < extent.component_count; ++c) {
      for (const float value : {extent.min[c], extent.max[c]}) {
        farthest =
            std::max(farthest, std::abs(latticePoint(value, lattice.origin[c], lattice.step)));
      }
    }
    return farthest;
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
    if (!isFloat(attribute) || bits == 0 || isBasePosition(attribute)) return;
    Extent extent(attribute.format.component_count);
    if (!addTo(extent, attribute)) {
      notes_.push_back(where(piece, attribute) + " has NaN or infinite values and stays exact");
    } else if (attribute.target != kNone) {
      planMorphDelta(piece, attribute, extent, bits);
    } else if (attribute.format.semantic == Semantic::kNormal) {
      planNormal(piece, attribute, extent, bits);
    } else if (attribute.format.semantic == Semantic::kTangent) {
      planTangent(piece, attribute, extent, bits);
    } else {
      planValues(piece, attribute, extent, bits);
    }
  }

  void planValues(const PiecePlan& piece, AttributePlan& attribute, Extent& extent, uint8_t bits) {
    const bool is_unit_range =
        attribute.format.semantic != Semantic::kTexcoord && extent.isInside(0, 1);
    Lattice lattice;
    if (is_unit_range) {  // 0 and 1 are lattice points: black stays black, and no weight of 0 grows
      useLattice(attribute, unitLattice(bits), bits);
    } else if (isRuinedByOutliers(extent, bits) || !fitLattice(extent, bits, lattice)) {
      notes_.push_back(where(piece, attribute) + " has outliers for which a lattice of " +
                       std::to_string(bits) +
                       " bits would be too coarse for all other values; it stays exact");
    } else {
      useLattice(attribute, lattice, bits);
    }
  }

  /// The codec has its own grid for unit vectors; the lattice is used for vectors of other lengths.
  void planNormal(const PiecePlan& piece, AttributePlan& attribute, const Extent& extent,
                  uint8_t bits) {
    Lattice lattice;
    if (fitLattice(extent, bits, lattice)) {
      useLattice(attribute, lattice, bits);
    } else {
      notes_.push_back(where(piece, attribute) + " has values no lattice can hold; it stays exact");
    }
  }

  /// Uses a step that is a power of two, starting at -1, so that 0 and the signs in w do not
  /// change.
  void planTangent(const PiecePlan& piece, AttributePlan& attribute, const Extent& extent,
                   uint8_t bits) {
    if (!extent.isInside(-1.01f, 1.01f)) {
      notes_.push_back(where(piece, attribute) + " is not of unit length and stays exact");
      return;
    }
    Lattice lattice;
    std::fill_n(lattice.origin, attribute.format.component_count, -1.0f);
    lattice.step = std::ldexp(1.0f, 1 - int{bits});
    useLattice(attribute, lattice, bits);
  }

  /// Deltas of positions use the step of the positions, and those of unit vectors a step for the
  /// interval -1..1. All others use their own range.
  void planMorphDelta(const PiecePlan& piece, AttributePlan& attribute, const Extent& extent,
                      uint8_t bits) {
    const double points = static_cast<double>((uint64_t{1} << bits) - 1);
    float step = 0;
    if (attribute.format.semantic == Semantic::kPosition) {
      step = piece.attributes[0].has_lattice ? piece.attributes[0].lattice.step : 0;
    } else if (attribute.format.semantic == Semantic::kNormal ||
               attribute.format.semantic == Semantic::kTangent) {
      step = static_cast<float>(2.0 / points);
    }
    if (step == 0) {
      const double range = extent.size() == 0 ? extent.farthest() : extent.size();
      step = static_cast<float>(range == 0 ? 1.0 : range / points);
    }
    Lattice lattice;
    uint8_t needed_bits = 0;
    if (fitAroundZero(extent, step, lattice, needed_bits)) {
      useLattice(attribute, lattice, needed_bits);
    } else {
      notes_.push_back(where(piece, attribute) + " spans too many steps and stays exact");
    }
  }

  /// The writer rounds the weights of a vertex together if all of them are on one lattice from 0 to
  /// 1.
  static void noteRoundedWeights(PiecePlan& piece) {
    std::vector<AttributePlan*> sets;
    for (AttributePlan& attribute : piece.attributes) {
      if (attribute.format.semantic != Semantic::kWeights || attribute.target != kNone) continue;
      if (!attribute.has_lattice || attribute.lattice != unitLattice(attribute.bits)) return;
      sets.push_back(&attribute);
    }
    for (AttributePlan* set : sets) set->is_rounded_with_others = true;
  }

  const ConvertOptions& options_;
  std::vector<PayloadPlan>& payloads_;
  std::vector<std::string>& notes_;
};

}  // namespace

void planQuantization(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                      std::vector<std::string>& notes) {
  QuantizationPlanner(options, payloads, notes).run();
}

}  // namespace mcc::gltf
