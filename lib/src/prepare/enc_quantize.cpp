// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "prepare/enc_quantize.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "exact/enc_grid.h"
#include "exact/grid.h"
#include "format/predictors.h"
#include "mesh/dequantize.h"
#include "values/enc_extent.h"
#include "vectors/normals.h"
#include "vectors/octahedral.h"
#include "vectors/tangent_points.h"
#include "vectors/tangents.h"

namespace mcc {
namespace {

constexpr double kUnitTolerance = 0.01;
/// Cosine between tangent and normal; 0.11 degrees.
constexpr double kPerpendicularTolerance = 0.002;

class Quantizer {
 public:
  Quantizer(const AttributeView& view, uint32_t wedge_count, const FeatureSet& without)
      : view_(view),
        count_(wedge_count),
        components_(view.format.component_count),
        without_(without) {}

  /// Sets the normals that the tangents should be perpendicular to, and how they were quantised.
  /// Both are borrowed.
  void setNormals(const AttributeView& view, const QuantizedAttribute& normal) {
    normal_view_ = &view;
    normal_ = &normal;
  }
  /// Sets the lattice step of a morph target, or 0 for none.
  void setDeltaStep(float step) { delta_step_ = step; }

  QuantizedAttribute run(std::vector<std::string>& notes) {
    result_.info.format = view_.format;
    result_.components = components_;
    if (view_.format.component_type != ComponentType::kFloat32) return copyIntegers();
    if (view_.quantization_bits == 0) return copyExactly();
    if (!allFinite()) {
      notes.push_back(name() + " holds NaN or infinite values: kept exact");
      return copyExactly();
    }
    if (components_ > 4) return copyExactly();
    const bool is_base_normal = view_.format.semantic == Semantic::kNormal &&
                                view_.format.morph_target == 0 && components_ == 3;
    if (is_base_normal && view_.quantization_bits >= 2) {
      if (allUnit()) return toOctahedral();
      notes.push_back(name() + " is not of unit length: coded by components");
    }
    if (normal_ != nullptr && view_.quantization_bits >= 2 && isTangentFrame()) {
      return toTangentAngles();
    }
    const bool is_base_tangent =
        view_.format.semantic == Semantic::kTangent && view_.format.morph_target == 0;
    if (is_base_tangent && view_.quantization_bits >= 2) {
      if (isSignedUnit()) return toOctahedral();
      notes.push_back(name() +
                      " is not of unit length with a sign of 1 or -1: coded by components");
    }
    return toLattice(notes);
  }

 private:
  const uint8_t* element(uint32_t wedge) const {
    return static_cast<const uint8_t*>(view_.data) + view_.stride_bytes * wedge;
  }
  float component(uint32_t wedge, uint32_t c) const {
    float value = 0;
    std::memcpy(&value, element(wedge) + 4 * c, 4);
    return value;
  }

  std::string name() const {
    static const char* const kNames[] = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD",
                                         "COLOR",    "JOINTS", "WEIGHTS", "a custom attribute"};
    std::string text = kNames[static_cast<size_t>(view_.format.semantic)];
    if (view_.format.semantic >= Semantic::kTexcoord &&
        view_.format.semantic <= Semantic::kWeights) {
      text += '_';
      text += std::to_string(view_.format.set_index);
    }
    if (view_.format.morph_target != 0) {
      text += " of morph target " + std::to_string(view_.format.morph_target - 1);
    }
    return text;
  }

  bool allFinite() const {
    for (uint32_t w = 0; w < count_; ++w) {
      for (uint32_t c = 0; c < components_; ++c) {
        if (!std::isfinite(component(w, c))) return false;
      }
    }
    return true;
  }

  bool allUnit() const {
    for (uint32_t w = 0; w < count_; ++w) {
      double square = 0;
      for (uint32_t c = 0; c < 3; ++c) square += double{component(w, c)} * component(w, c);
      if (std::fabs(std::sqrt(square) - 1) > kUnitTolerance) return false;
    }
    return true;
  }

  QuantizedAttribute copyIntegers() {
    result_.info.coding = AttributeCoding::kInteger;
    result_.values.resize(size_t{count_} * components_);
    const uint32_t bytes = componentBytes(view_.format.component_type);
    for (uint32_t w = 0; w < count_; ++w) {
      for (uint32_t c = 0; c < components_; ++c) {
        const uint32_t raw = loadBits(element(w) + size_t{bytes} * c, view_.format.component_type);
        int32_t value = static_cast<int32_t>(raw);
        if (view_.format.component_type == ComponentType::kInt8) value = static_cast<int8_t>(raw);
        if (view_.format.component_type == ComponentType::kInt16) value = static_cast<int16_t>(raw);
        result_.values[size_t{w} * components_ + c] = value;
      }
    }
    return std::move(result_);
  }

  QuantizedAttribute copyExactly() {
    result_.info.coding = AttributeCoding::kExactFloat;
    result_.values.resize(size_t{count_} * components_);
    for (uint32_t w = 0; w < count_; ++w) {
      for (uint32_t c = 0; c < components_; ++c) {
        result_.values[size_t{w} * components_ + c] =
            orderedFromBits(std::bit_cast<uint32_t>(component(w, c)));
      }
    }
    if (!without_.has(Feature::kExactGrids)) findExactGrid(result_.values, result_.info);
    return std::move(result_);
  }

  /// Rounds each component to the nearest point, ties upwards; the inverse of [A.10.5].
  QuantizedAttribute toLattice(std::vector<std::string>& notes) {
    result_.info.coding = AttributeCoding::kLattice;
    result_.info.bits = std::min<uint8_t>(view_.quantization_bits, 24);
    Lattice lattice;
    if (view_.lattice != nullptr) {
      lattice = *view_.lattice;
    } else if (delta_step_ > 0) {
      lattice.step = delta_step_;
    } else {
      const std::string problem = fitOwn(lattice);
      if (!problem.empty()) {
        notes.push_back(name() + problem + ": kept exact");
        return copyInstead();
      }
    }
    const uint32_t origins = view_.format.morph_target != 0 ? 0 : components_;
    for (uint32_t c = origins; c < 4; ++c) lattice.origin[c] = 0;
    if (!(lattice.step > 0) || !std::isfinite(lattice.step)) {
      notes.push_back(name() + " spans a range that no lattice covers: kept exact");
      return copyExactly();
    }
    result_.info.lattice = lattice;
    result_.values.resize(size_t{count_} * components_);
    for (uint32_t w = 0; w < count_; ++w) {
      for (uint32_t c = 0; c < components_; ++c) {
        const double q = latticePoint(component(w, c), lattice.origin[c], lattice.step);
        if (std::fabs(q) > double{1 << 28}) {
          notes.push_back(name() + " reaches beyond the given lattice: kept exact");
          return copyInstead();
        }
        if (!std::isfinite(
                latticeValue(static_cast<int32_t>(q), lattice.step, lattice.origin[c]))) {
          notes.push_back(name() + " would round to infinity: kept exact");
          return copyInstead();
        }
        result_.values[size_t{w} * components_ + c] = static_cast<int32_t>(q);
      }
    }
    return std::move(result_);
  }

  /// Fits a lattice to the values, from the corner of their bounding box on. Returns why there is
  /// none; empty when there is one. Deltas and vectors have steps that do not depend on their
  /// range, so outliers ruin only others.
  std::string fitOwn(Lattice& lattice) const {
    const uint8_t bits = result_.info.bits;
    lattice.step = 1;
    if (count_ == 0) return "";
    Extent extent(components_);
    (void)extent.add(count_, [this](uint64_t w, uint32_t c) {  // all values are finite
      return component(static_cast<uint32_t>(w), c);
    });
    const Semantic semantic = view_.format.semantic;
    const bool has_step = semantic == Semantic::kNormal || semantic == Semantic::kTangent ||
                          (semantic == Semantic::kWeights && extent.isInside(0, 1));
    if (!has_step && view_.format.morph_target == 0 && isRuinedByOutliers(extent, bits)) {
      return " has outliers, for which a lattice of " + std::to_string(bits) +
             " bits would be too coarse for all other values";
    }
    return fitLattice(extent, bits, lattice) ? "" : " spans a range that no lattice covers";
  }

  /// Keeps the values exactly, if a lattice does not suit them.
  QuantizedAttribute copyInstead() {
    result_.info.lattice = Lattice{};
    result_.info.bits = 0;
    return copyExactly();
  }

  QuantizedAttribute toOctahedral() {
    result_.info.coding = AttributeCoding::kOctahedral;
    result_.info.bits = std::clamp<uint8_t>(view_.quantization_bits, 2, 16);
    const uint32_t words = components_ == 4 ? kTangentPointWords : 2;
    result_.components = words;
    result_.values.resize(size_t{count_} * words);
    for (uint32_t w = 0; w < count_; ++w) {
      const float n[3] = {component(w, 0), component(w, 1), component(w, 2)};
      int32_t* point = &result_.values[size_t{w} * words];
      nearestGridPoint(n, point);
      canonicalGridPoint(octahedralCentre(result_.info.bits), point);
      if (components_ == 4) point[2] = component(w, 3) < 0 ? 1 : 0;
    }
    return std::move(result_);
  }

  /// Finds the best of the four grid points around the projection.
  void nearestGridPoint(const float* n, int32_t* point) const {
    const int32_t centre = octahedralCentre(result_.info.bits);
    const double sum = std::fabs(double{n[0]}) + std::fabs(double{n[1]}) + std::fabs(double{n[2]});
    double x = double{n[0]} / sum;
    double y = double{n[1]} / sum;
    if (n[2] < 0) {
      const double folded_x = 1 - std::fabs(y);
      const double folded_y = 1 - std::fabs(x);
      x = x < 0 ? -folded_x : folded_x;
      y = y < 0 ? -folded_y : folded_y;
    }
    const int32_t s0 = static_cast<int32_t>(std::floor((x + 1) * centre));
    const int32_t t0 = static_cast<int32_t>(std::floor((y + 1) * centre));
    // Compares the distances of unit vectors, because differences of cosines vanish in float32 from
    // 12 bits on.
    const double length =
        std::sqrt(double{n[0]} * n[0] + double{n[1]} * n[1] + double{n[2]} * n[2]);
    const double direction[3] = {double{n[0]} / length, double{n[1]} / length,
                                 double{n[2]} / length};
    double best = 8;
    for (int32_t s = s0; s <= s0 + 1; ++s) {
      for (int32_t t = t0; t <= t0 + 1; ++t) {
        if (s < 0 || t < 0 || s > 2 * centre || t > 2 * centre) continue;
        float unit[3];
        octahedralToUnit(s, t, centre, unit);
        double distance = 0;
        for (int c = 0; c < 3; ++c) {
          const double difference = double{unit[c]} - direction[c];
          distance += difference * difference;
        }
        if (distance >= best) continue;
        best = distance;
        point[0] = s;
        point[1] = t;
      }
    }
  }

  bool isSignedUnit() const {
    if (components_ != 4 || !allUnit()) return false;
    for (uint32_t w = 0; w < count_; ++w) {
      if (std::fabs(component(w, 3)) != 1.0f) return false;
    }
    return true;
  }

  /// Returns whether all tangents are unit vectors perpendicular to the normals, with a sign of 1
  /// or -1.
  bool isTangentFrame() const {
    if (!isSignedUnit()) return false;
    for (uint32_t w = 0; w < count_; ++w) {
      double dot = 0;
      for (uint32_t c = 0; c < 3; ++c) {
        float n = 0;
        std::memcpy(&n,
                    static_cast<const uint8_t*>(normal_view_->data) +
                        normal_view_->stride_bytes * w + 4 * c,
                    4);
        dot += double{n} * component(w, c);
      }
      if (std::fabs(dot) > kPerpendicularTolerance) return false;
    }
    return true;
  }

  QuantizedAttribute toTangentAngles() {
    result_.info.coding = AttributeCoding::kTangentAngle;
    result_.info.bits = std::clamp<uint8_t>(view_.quantization_bits, 2, 16);
    result_.components = 2;
    result_.values.resize(size_t{count_} * 2);
    for (uint32_t w = 0; w < count_; ++w) {
      const int32_t* point = &normal_->values[size_t{w} * 2];
      float normal[3];
      octahedralToUnit(point[0], point[1], octahedralCentre(normal_->info.bits), normal);
      const float tangent[3] = {component(w, 0), component(w, 1), component(w, 2)};
      result_.values[size_t{w} * 2] = nearestAngle(normal, tangent);
      result_.values[size_t{w} * 2 + 1] = component(w, 3) < 0 ? 1 : 0;
    }
    return std::move(result_);
  }

  /// Returns the polynomial's angle or one of its neighbours, whichever decodes closest.
  int32_t nearestAngle(const float* normal, const float* tangent) const {
    const uint32_t bits = result_.info.bits;
    float e1[3];
    float e2[3];
    tangentFrame(normal, e1, e2);
    float x = 0;
    float y = 0;
    for (int s = 0; s < 3; ++s) {
      x += tangent[s] * e1[s];
      y += tangent[s] * e2[s];
    }
    const float steps = static_cast<float>(uint32_t{1} << bits) * 0.159154943f * planeAngle(y, x);
    const int32_t middle = static_cast<int32_t>(std::floor(steps + 0.5f));
    int32_t best = 0;
    double best_dot = -2;
    for (int32_t angle = middle - 1; angle <= middle + 1; ++angle) {
      float unit[3];
      tangentFromAngle(normal, angle, bits, unit);
      double dot = 0;
      for (int s = 0; s < 3; ++s) dot += double{unit[s]} * tangent[s];
      if (dot <= best_dot) continue;
      best_dot = dot;
      best = angle & static_cast<int32_t>((uint32_t{1} << bits) - 1);
    }
    return best;
  }

  const AttributeView& view_;
  const uint32_t count_;
  const uint32_t components_;
  const FeatureSet without_;
  const AttributeView* normal_view_ = nullptr;
  const QuantizedAttribute* normal_ = nullptr;
  float delta_step_ = 0;
  QuantizedAttribute result_;
};

bool isBase(const AttributeFormat& f, Semantic semantic) {
  return f.semantic == semantic && f.morph_target == 0;
}

float floatAt(const AttributeView& view, uint32_t wedge, uint32_t c) {
  float value = 0;
  std::memcpy(&value, static_cast<const uint8_t*>(view.data) + view.stride_bytes * wedge + 4 * c,
              4);
  return value;
}

/// Quantises weights between 0 and 1 to a lattice with points at both. Where all sets share one
/// lattice, the weights of a vertex are rounded together, so that tuples that sum to 1 still do.
class WeightQuantizer {
 public:
  WeightQuantizer(const PieceView& piece, std::vector<QuantizedAttribute>& all)
      : piece_(piece), all_(all) {}

  void run() {
    useUnitLattices();
    bool is_shared = true;
    for (size_t i = 1; i < all_.size(); ++i) {
      const AttributeInfo& info = all_[i].info;
      if (!isBase(info.format, Semantic::kWeights)) continue;
      is_shared &= info.coding == AttributeCoding::kLattice &&
                   info.lattice == unitLattice(info.bits) &&
                   (sets_.empty() || info.lattice == all_[sets_[0]].info.lattice);
      sets_.push_back(i);
    }
    if (sets_.empty() || !is_shared) return;
    for (uint32_t w = 0; w < piece_.wedge_count; ++w) roundTuple(w);
  }

 private:
  /// Gives one lattice to all sets for which the caller did not set one. It has the fewest bits
  /// that any of them asks for.
  void useUnitLattices() {
    std::vector<size_t> own;
    uint8_t bits = 24;
    for (size_t i = 1; i < all_.size(); ++i) {
      const AttributeView& view = piece_.attributes[i];
      if (!isBase(view.format, Semantic::kWeights) || view.lattice != nullptr ||
          view.quantization_bits == 0 || !isInUnitRange(view)) {
        continue;
      }
      own.push_back(i);
      bits = std::min(bits, view.quantization_bits);
    }
    for (const size_t i : own) {
      AttributeView view = piece_.attributes[i];
      const Lattice lattice = unitLattice(bits);
      view.quantization_bits = bits;
      view.lattice = &lattice;
      std::vector<std::string> notes;  // stays empty: every value is near a point
      all_[i] = Quantizer(view, piece_.wedge_count, FeatureSet{}).run(notes);
    }
  }

  bool isInUnitRange(const AttributeView& view) const {
    if (view.format.component_type != ComponentType::kFloat32) return false;
    if (view.format.component_count > kLatticeComponents) return false;
    for (uint32_t w = 0; w < piece_.wedge_count; ++w) {
      for (uint32_t c = 0; c < view.format.component_count; ++c) {
        const float x = floatAt(view, w, c);
        if (!(x >= 0 && x <= 1)) return false;
      }
    }
    return true;
  }

  void roundTuple(uint32_t w) {
    const double step = double{all_[sets_[0]].info.lattice.step};
    points_.clear();
    for (const size_t i : sets_) {
      const AttributeView& view = piece_.attributes[i];
      for (uint32_t c = 0; c < view.format.component_count; ++c) {
        const double point = double{floatAt(view, w, c)} / step;
        if (point < 0) return;  // on a lattice of the caller; such weights are rounded one by one
        points_.push_back(point);
      }
    }
    roundTogether(points_, std::round(1 / step));
    const double* point = points_.data();
    for (const size_t i : sets_) {
      const uint32_t components = piece_.attributes[i].format.component_count;
      for (uint32_t c = 0; c < components; ++c)
        all_[i].values[size_t{w} * components + c] = static_cast<int32_t>(*point++);
    }
  }

  const PieceView& piece_;
  std::vector<QuantizedAttribute>& all_;
  std::vector<size_t> sets_;
  std::vector<double> points_;
};

/// Returns what the weights of tuples sum to.
SkinSums sumsOf(uint32_t wedge_count, const QuantizedAttribute& weights) {
  const int32_t unit = unitSum(weights.info);
  if (unit == 0) return SkinSums::kUnknown;
  uint32_t unit_sums = 0;
  for (uint32_t w = 0; w < wedge_count; ++w) {
    const int32_t* tuple = &weights.values[4 * size_t{w}];
    unit_sums += std::accumulate(tuple, tuple + 4, int64_t{0}) == unit ? 1 : 0;
  }
  return unit_sums == wedge_count      ? SkinSums::kUnit
         : 2 * unit_sums < wedge_count ? SkinSums::kUnknown
                                       : SkinSums::kUsual;
}

/// Returns the lattice step of a morph target: that of the base attribute, for directions the
/// precision of unit vectors, or 0 if the base attribute is not on a lattice.
float deltaStep(const AttributeView& view, const std::vector<QuantizedAttribute>& all) {
  const AttributeFormat& f = view.format;
  if (f.semantic == Semantic::kNormal || f.semantic == Semantic::kTangent) {
    return static_cast<float>(2.0 / (std::ldexp(1.0, view.quantization_bits) - 1));
  }
  for (const QuantizedAttribute& a : all) {
    if (isBase(a.info.format, f.semantic) && a.info.format.set_index == f.set_index &&
        a.info.coding == AttributeCoding::kLattice) {
      return a.info.lattice.step;
    }
  }
  return 0;
}

bool isEqual(const QuantizedAttribute& a, const QuantizedAttribute& b) {
  const AttributeInfo& x = a.info;
  const AttributeInfo& y = b.info;
  return x.coding == y.coding && x.bits == y.bits && x.lattice == y.lattice &&
         x.format.component_type == y.format.component_type &&
         x.format.component_count == y.format.component_count && a.values == b.values;
}

/// Makes attributes that equal an earlier one its aliases.
void findAliases(std::vector<QuantizedAttribute>& all) {
  for (uint32_t i = 1; i < all.size(); ++i) {
    for (uint32_t source = 1; source < i; ++source) {
      if (all[source].info.coding == AttributeCoding::kAlias || !isEqual(all[source], all[i]))
        continue;
      AttributeInfo info;
      info.format = all[i].info.format;
      info.coding = AttributeCoding::kAlias;
      info.alias_of = source;
      all[i].info = info;
      all[i].values.clear();
      break;
    }
  }
}

/// Turns joints and weights into custom attributes, so that each is coded by itself.
void hideSkin(std::vector<QuantizedAttribute>& all) {
  for (QuantizedAttribute& a : all) {
    Semantic& semantic = a.info.format.semantic;
    if (semantic == Semantic::kJoints || semantic == Semantic::kWeights)
      semantic = Semantic::kCustom;
  }
}

}  // namespace

std::vector<QuantizedAttribute> quantizeAttributes(const PieceView& piece,
                                                   const FeatureSet& without,
                                                   std::vector<std::string>& notes) {
  const size_t count = piece.attributes.size();
  std::vector<QuantizedAttribute> all(count);
  size_t normal = count;
  for (size_t i = count; i-- != 0;) {
    const AttributeView& view = piece.attributes[i];
    if (isBase(view.format, Semantic::kTangent) || view.format.morph_target != 0) continue;
    all[i] = Quantizer(view, piece.wedge_count, without).run(notes);
    if (all[i].info.coding == AttributeCoding::kOctahedral) normal = i;
  }
  // Tangents come last, because they need to know how the normals were quantised.
  for (size_t i = 0; i < count; ++i) {
    const AttributeView& view = piece.attributes[i];
    if (!isBase(view.format, Semantic::kTangent)) continue;
    Quantizer quantizer(view, piece.wedge_count, without);
    if (normal != count && !without.has(Feature::kTangentAngle)) {
      quantizer.setNormals(piece.attributes[normal], all[normal]);
    }
    all[i] = quantizer.run(notes);
  }
  for (size_t i = 0; i < count; ++i) {
    const AttributeView& view = piece.attributes[i];
    if (view.format.morph_target == 0) continue;
    Quantizer quantizer(view, piece.wedge_count, without);
    quantizer.setDeltaStep(deltaStep(view, all));
    all[i] = quantizer.run(notes);
  }
  WeightQuantizer(piece, all).run();
  if (!without.has(Feature::kAliases)) findAliases(all);
  if (without.has(Feature::kSkin)) hideSkin(all);
  std::vector<AttributeInfo> infos;
  for (const QuantizedAttribute& a : all) infos.push_back(a.info);
  for (uint32_t i = 1; i < count; ++i) {
    if (methodOf(infos, i) != AttributeMethod::kSkin) continue;
    QuantizedAttribute& weights = all[skinPartner(infos, i)];
    weights.info.predictor = static_cast<uint8_t>(sumsOf(piece.wedge_count, weights));
  }
  return all;
}

}  // namespace mcc
