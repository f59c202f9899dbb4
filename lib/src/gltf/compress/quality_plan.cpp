// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quality_plan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>

#include "format/codings.h"
#include "gltf/compress/fit_lattice.h"
#include "gltf/compress/quality.h"
#include "gltf/compress/texture_uses.h"
#include "json/json.h"
#include "values/enc_extent.h"

namespace mcc::gltf {
namespace {

constexpr const char* kTooFine =
    " would need a lattice of more than 24 bits, or one finer than float32, for the quality; it "
    "stays exact";

/// Returns a number with at most six digits.
std::string numberText(double value) {
  const double power = std::pow(10, 5 - std::floor(std::log10(value)));
  const std::string text = Json(std::round(value * power) / power).dump();
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

/// Lengths of the vectors of an attribute, without its fourth component and without those that are
/// zero.
struct Lengths {
  double shortest = 0;  ///< 0: all are zero
  bool are_unit = true;
};

Lengths lengthsOf(const AttributePlan& attribute) {
  constexpr double kUnitTolerance = 0.01;  // as the writer has it
  Lengths lengths;
  for (uint64_t i = 0; i < attribute.source.count; ++i) {
    double square = 0;
    for (uint32_t c = 0; c < std::min<uint32_t>(attribute.format.component_count, 3); ++c) {
      const double value = floatAt(attribute, i, c);
      square += value * value;
    }
    const double length = std::sqrt(square);
    if (std::fabs(length - 1) > kUnitTolerance) lengths.are_unit = false;
    if (length > 0 && (lengths.shortest == 0 || length < lengths.shortest))
      lengths.shortest = length;
  }
  return lengths;
}

/// Like fitError(), with a step that may be a little shorter: the largest side is a multiple of 64
/// steps, or of 2 if it has few. Both of its ends, its middle and its quarters are then points, so
/// that symmetric models stay symmetric, and boxes whole, which makes them smaller by much more
/// than it takes.
bool fitWholeSide(const Extent& extent, double error, Lattice& lattice, uint8_t& bits) {
  constexpr double kManySteps = 1024;
  if (!fitError(extent, error, lattice, bits)) return false;
  const double size = extent.size();
  const double steps = size / double{lattice.step};
  const double multiple = steps < kManySteps ? 2 : 64;
  const double points = std::ceil(steps / multiple) * multiple;
  Lattice whole = lattice;
  whole.step = static_cast<float>(size / points);
  if (points >= std::ldexp(1.0, kMaxLatticeBits) || !std::isnormal(whole.step) ||
      whole.step > lattice.step)
    return true;
  lattice = whole;
  bits = static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(points)));
  return true;
}

/// What was chosen for attributes of one name.
struct Tally {
  QualityChoice choice;
  double least_texels = std::numeric_limits<double>::infinity();
  double most_texels = 0;
  bool has_pixel = false;  ///< of the screen, where that is more than a texel

  void addTexels(double texels, bool is_pixel) {
    least_texels = std::min(least_texels, texels);
    most_texels = std::max(most_texels, texels);
    has_pixel |= is_pixel;
  }
  void add(const AttributePlan& attribute) {
    ++choice.attribute_count;
    if (attribute.bits == 0) {
      ++choice.exact_count;
      return;
    }
    const bool is_first = choice.most_bits == 0;
    choice.fewest_bits = is_first ? attribute.bits : std::min(choice.fewest_bits, attribute.bits);
    choice.most_bits = std::max(choice.most_bits, attribute.bits);
  }
};

class QualityPlanner {
 public:
  QualityPlanner(const Document& document, const ConvertOptions& options,
                 std::vector<PayloadPlan>& payloads, std::vector<std::string>& notes)
      : options_(options),
        errors_(options.quality),
        textures_(document),
        payloads_(payloads),
        notes_(notes) {}

  void run() {
    visitPositionGroups(options_.grid, payloads_, notes_,
                        [&](PositionGroup& group) { planPositions(group); });
    for (PayloadPlan& payload : payloads_) {
      for (PiecePlan& piece : payload.pieces) {
        for (AttributePlan& attribute : piece.attributes) planAttribute(piece, attribute);
        noteRoundedWeights(piece);
        noteLostTriangles(piece);
      }
    }
  }

  std::vector<QualityChoice> choices() const {
    std::vector<QualityChoice> all;
    for (const auto& [key, tally] : tallies_) {
      all.push_back(tally.choice);
      all.back().why = whyOf(std::get<Semantic>(key), tally);
    }
    return all;
  }

 private:
  /// Positions that are few and far away cost bits, but do not make the others less accurate: the
  /// model is as large as its box, but at most four times as large as the box without the outer
  /// hundredth of the positions at each end.
  void planPositions(PositionGroup& group) {
    constexpr double kMostOuter = 4;
    Extent& extent = group.extent;
    const double size = std::min(extent.size(), kMostOuter * extent.innerSize());
    const double distance = errors_.share * size;
    Lattice lattice;
    uint8_t bits = 1;
    const bool fits = extent.size() == 0
                          ? fitLattice(extent, bits, lattice)
                          : fitWholeSide(extent, distance / std::sqrt(3.0), lattice, bits);
    if (!fits) {
      notes_.push_back(whereIs(*group.finite[0].piece, *group.finite[0].attribute) + kTooFine);
      return;
    }
    for (const PlannedAttribute& member : group.finite) {
      useLattice(*member.attribute, lattice, bits);
      member.attribute->max_distance = distance;
    }
  }

  void planAttribute(const PiecePlan& piece, AttributePlan& attribute) {
    const Semantic semantic = attribute.format.semantic;
    const bool is_chosen = semantic != Semantic::kJoints && semantic != Semantic::kCustom;
    if (!is_chosen || !isFloat(attribute)) return;
    const bool is_target = attribute.target != kNone;
    Tally& tally = tallies_[{semantic, is_target, attribute.name}];
    tally.choice.name = (is_target ? "target " : "") + attribute.name;
    Extent extent(attribute.format.component_count);
    if (isBasePosition(attribute)) {
      // It is planned already.
    } else if (!addTo(extent, attribute)) {
      notes_.push_back(whereIs(piece, attribute) + " has NaN or infinite values and stays exact");
    } else if (is_target) {
      planDelta(piece, attribute, extent, tally);
    } else if (semantic == Semantic::kNormal || semantic == Semantic::kTangent) {
      planVectors(piece, attribute, extent);
    } else {
      planValues(piece, attribute, extent, tally);
    }
    tally.add(attribute);
  }

  /// Returns the largest error of a component of anything but positions and vectors.
  double errorOf(const PiecePlan& piece, const AttributePlan& attribute, const Extent& extent,
                 Tally& tally) const {
    const double unit = std::max(1.0, extent.farthest());
    if (attribute.format.semantic == Semantic::kColor) return errors_.color * unit;
    if (attribute.format.semantic == Semantic::kWeights) return errors_.weight * unit;
    double texels = 0;
    for (const PartPlan& part : piece.parts) {
      for (const PrimitiveRef& user : part.users)
        texels = std::max(texels, textures_.texels(user, attribute.format.set_index));
    }
    tally.addTexels(StatedErrors::countedTexels(texels), errors_.isPixel(texels, extent.size()));
    return errors_.texcoord(texels, extent.size());
  }

  /// Fits a lattice where float32 does not hold the error for the farthest values, as long as it
  /// does for all but a hundredth of them. Through 0 it rounds each value as float32 rounds that
  /// value, so those that are far away move by that as well, but do not cost the others anything.
  static bool fitAmongOutliers(Extent& extent, double error, Lattice& lattice, uint8_t& bits) {
    constexpr double kRounding = 1.0 / 64;  // most of the error that rounding may take
    if (std::ldexp(extent.innerFarthest(), -22) > kRounding * error) return false;
    return fitAroundZero(extent, static_cast<float>(2 * error * (1 - kRounding)), lattice, bits);
  }

  void planValues(const PiecePlan& piece, AttributePlan& attribute, Extent& extent, Tally& tally) {
    const double error = errorOf(piece, attribute, extent, tally);
    const Semantic semantic = attribute.format.semantic;
    Lattice lattice;
    uint8_t bits = 0;
    if (semantic != Semantic::kTexcoord && extent.isInside(0, 1)) {
      bits = unitBitsFor(semantic == Semantic::kColor ? 2 * error : error);
      useLattice(attribute, unitLattice(bits), bits);
    } else if (fitWholeSide(extent, error, lattice, bits) ||
               fitAmongOutliers(extent, error, lattice, bits)) {
      useLattice(attribute, lattice, bits);
    } else {
      notes_.push_back(whereIs(piece, attribute) + kTooFine);
    }
  }

  /// Unit vectors get the bits of the writer's own grids. Others get a lattice that keeps within
  /// the angle for the shortest of them, unless that needs more bits than vectors can have.
  void planVectors(const PiecePlan& piece, AttributePlan& attribute, const Extent& extent) {
    constexpr double kShortestTangent = 0.56;  // see octahedralBitsFor()
    const Lengths lengths = lengthsOf(attribute);
    const bool is_normal = attribute.format.semantic == Semantic::kNormal;
    uint8_t bits = octahedralBitsFor(errors_.radians);
    Lattice lattice;
    bool fits = false;
    if (!is_normal) {
      // From -1 on, in steps that are powers of two: 0 and the signs in w do not change.
      std::fill_n(lattice.origin, attribute.format.component_count, -1.0f);
      lattice.step = std::ldexp(1.0f, 1 - int{bits});
      fits = extent.isInside(-1.01f, 1.01f) && lengths.shortest >= kShortestTangent;
    } else if (lengths.are_unit) {
      fits = fitLattice(extent, bits, lattice);
    } else {
      const double error = errors_.radians * lengths.shortest / std::sqrt(3.0);
      fits = fitError(extent, error, lattice, bits) && bits <= kMaxUnitBits;
      bits = std::max<uint8_t>(bits, kMinUnitBits);
    }
    if (fits) {
      useLattice(attribute, lattice, bits);
    } else {
      notes_.push_back(whereIs(piece, attribute) + " is not of unit length and stays exact");
    }
  }

  /// Deltas are on lattices through 0, so that what does not move stays where it is. Those of
  /// positions use the step of the positions.
  void planDelta(const PiecePlan& piece, AttributePlan& attribute, const Extent& extent,
                 Tally& tally) {
    double step = 0;
    switch (attribute.format.semantic) {
      case Semantic::kPosition:
        step = piece.attributes[0].has_lattice
                   ? double{piece.attributes[0].lattice.step}
                   : 2 * errors_.share * extent.farthest() / std::sqrt(3.0);
        break;
      case Semantic::kNormal:
      case Semantic::kTangent: step = 2 * errors_.radians / std::sqrt(3.0); break;
      default: step = 2 * errorOf(piece, attribute, extent, tally);
    }
    Lattice lattice;
    uint8_t bits = 0;
    constexpr double kMargin = 1 - 0x1p-20;  // for the roundings of decoding
    const bool is_of_base =
        attribute.format.semantic == Semantic::kPosition && piece.attributes[0].has_lattice;
    const auto rounded = static_cast<float>(is_of_base ? step : step * kMargin);
    if (extent.farthest() == 0) {
      fitAroundZero(extent, 1, lattice, bits);
      useLattice(attribute, lattice, bits);
    } else if (fitAroundZero(extent, rounded, lattice, bits)) {
      useLattice(attribute, lattice, bits);
    } else {
      notes_.push_back(whereIs(piece, attribute) + " spans too many steps and stays exact");
    }
  }

  /// Adds a note when triangles that have an area have none on the lattice.
  void noteLostTriangles(const PiecePlan& piece) {
    if (piece.attributes.empty() || !piece.attributes[0].has_lattice) return;
    const AttributePlan& position = piece.attributes[0];
    uint64_t lost = 0;
    uint64_t all = 0;
    for (const PartPlan& part : piece.parts) {
      all += part.triangles.size() / 3;
      for (size_t i = 0; i + 2 < part.triangles.size(); i += 3) {
        if (isLost(position, &part.triangles[i])) ++lost;
      }
    }
    if (lost == 0) return;
    notes_.push_back(piece.parts[0].users[0].path() + ": " + std::to_string(lost) + " of " +
                     std::to_string(all) +
                     " triangles are so small that no area is left of them; a larger quality keeps "
                     "more of them");
  }

  static bool isLost(const AttributePlan& position, const uint32_t* corners) {
    std::array<std::array<double, 3>, 3> source{};
    std::array<std::array<double, 3>, 3> point{};
    for (size_t k = 0; k < 3; ++k) {
      for (uint32_t c = 0; c < 3; ++c) {
        const float value = floatAt(position, corners[k], c);
        source[k][c] = value;
        point[k][c] = latticePoint(value, position.lattice.origin[c], position.lattice.step);
      }
    }
    return !isFlat(source) && isFlat(point);
  }

  /// Whether three points are on a line. Exact for points of a lattice, which are whole numbers
  /// below 2^25.
  static bool isFlat(const std::array<std::array<double, 3>, 3>& p) {
    for (size_t c = 0; c < 3; ++c) {
      const size_t d = (c + 1) % 3;
      const double first = (p[1][c] - p[0][c]) * (p[2][d] - p[0][d]);
      const double second = (p[1][d] - p[0][d]) * (p[2][c] - p[0][c]);
      if (first != second) return false;
    }
    return true;
  }

  std::string whyOf(Semantic semantic, const Tally& tally) const {
    static constexpr const char* kOwners[] = {"of its mesh", "of all meshes", "of its primitive"};
    switch (semantic) {
      case Semantic::kPosition:
        return "nothing moves farther than 1/" + numberText(options_.quality) +
               " of the longest side " + kOwners[static_cast<size_t>(options_.grid)];
      case Semantic::kNormal: return "at most " + degreesText();
      case Semantic::kTangent: return "at most " + degreesText() + " around the normal";
      case Semantic::kTexcoord: return texelText(tally);
      case Semantic::kColor: return "half a step of 255";
      case Semantic::kWeights: return "at most 1/" + numberText(1 / errors_.weight);
      case Semantic::kJoints:
      case Semantic::kCustom: break;
    }
    return "";
  }

  std::string degreesText() const {
    const std::string number = numberText(errors_.radians * 180 / std::numbers::pi);
    return number + (number == "1" ? " degree" : " degrees");
  }

  static std::string texelText(const Tally& tally) {
    if (!std::isfinite(tally.least_texels)) return "no value is finite";
    std::string text = "a quarter of a texel of textures that count as ";
    if (tally.least_texels != tally.most_texels) text += numberText(tally.least_texels) + " to ";
    text += numberText(tally.most_texels) + " texels";
    return text + (tally.has_pixel ? ", or of a pixel" : "");
  }

  const ConvertOptions& options_;
  const StatedErrors errors_;
  const TextureUses textures_;
  std::vector<PayloadPlan>& payloads_;
  std::vector<std::string>& notes_;
  std::map<std::tuple<Semantic, bool, std::string>, Tally> tallies_;
};

}  // namespace

void planQuality(const Document& document, const ConvertOptions& options,
                 std::vector<PayloadPlan>& payloads, std::vector<std::string>& notes,
                 std::vector<QualityChoice>& choices) {
  QualityPlanner planner(document, options, payloads, notes);
  planner.run();
  choices = planner.choices();
}

}  // namespace mcc::gltf
