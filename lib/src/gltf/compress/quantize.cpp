// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quantize.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "format/codings.h"
#include "gltf/compress/fit_lattice.h"
#include "values/enc_extent.h"

namespace mcc::gltf {
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

  /// Adds a note about the first attribute of a group.
  void noteAbout(const PositionGroup& group, const std::string& what) {
    notes_.push_back(whereIs(*group.finite[0].piece, *group.finite[0].attribute) + what);
  }

  void planPositionGroup(PositionGroup& group, uint8_t bits) {
    Extent& extent = group.extent;
    Lattice lattice;
    if (given_) {
      const double far = farthestPoint(extent, *given_);
      if (far >= std::ldexp(1.0, kMaxLatticeBits)) {
        noteAbout(group,
                  " is more than 2^24 steps from the origin of the given lattice; it stays exact");
        return;
      }
      const auto needed =
          static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(std::max(far, 1.0))));
      for (const PlannedAttribute& member : group.finite)
        useLattice(*member.attribute, *given_, needed);
      return;
    }
    if (options_.max_position_error > 0) {
      const double distance =
          options_.max_position_error * (options_.is_error_relative ? extent.size() : 1);
      uint8_t needed = 0;
      if (!fitError(extent, distance / std::sqrt(3.0), lattice, needed)) {
        noteAbout(group,
                  " needs more than a lattice of 24 bits for the promised error; it stays exact");
        return;
      }
      for (const PlannedAttribute& member : group.finite) {
        useLattice(*member.attribute, lattice, needed);
        member.attribute->max_distance = distance;
      }
      return;
    }
    if (isRuinedByOutliers(extent, bits) || !fitLattice(extent, bits, lattice)) {
      noteAbout(group, " has outliers for which a lattice of " + std::to_string(bits) +
                           " bits would be too coarse for all other values; it stays exact");
      return;
    }
    for (const PlannedAttribute& member : group.finite)
      useLattice(*member.attribute, lattice, bits);
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
      notes_.push_back(whereIs(piece, attribute) + " has NaN or infinite values and stays exact");
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
      notes_.push_back(whereIs(piece, attribute) + " has outliers for which a lattice of " +
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
      notes_.push_back(whereIs(piece, attribute) +
                       " has values no lattice can hold; it stays exact");
    }
  }

  /// Uses a step that is a power of two, starting at -1, so that 0 and the signs in w do not
  /// change.
  void planTangent(const PiecePlan& piece, AttributePlan& attribute, const Extent& extent,
                   uint8_t bits) {
    if (!extent.isInside(-1.01f, 1.01f)) {
      notes_.push_back(whereIs(piece, attribute) + " is not of unit length and stays exact");
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
      notes_.push_back(whereIs(piece, attribute) + " spans too many steps and stays exact");
    }
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
