// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/values.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mcc::gltf {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

bool isBase(const AttributeFormat& format, Semantic semantic) {
  return format.semantic == semantic && format.morph_target == 0;
}

Result promiseAngle(const AttributePlan& plan, double radians, Promise& promise) {
  promise.kind = Promise::Kind::kAngle;
  promise.radians = radians;
  const bool is_unit =
      isBase(plan.format, Semantic::kNormal) || isBase(plan.format, Semantic::kTangent);
  return is_unit ? Result{} : error("", plan.label() + " is coded as a unit vector");
}

Result promiseLattice(const AttributePlan& plan, const Lattice& lattice, Promise& promise) {
  promise.kind = Promise::Kind::kLattice;
  promise.step = lattice.step;
  std::copy_n(lattice.origin, 4, promise.origin);
  promise.half_steps = plan.is_rounded_with_others ? 2 : 1;
  promise.distance = plan.max_distance;
  if (plan.has_lattice && promise.step > 0 && promise.step <= double{plan.lattice.step}) return {};
  return error("", "the lattice step of " + plan.label() + " is coarser than asked for");
}

double angleBetween(const double* a, const double* b) {
  const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                           a[0] * b[1] - a[1] * b[0]};
  const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::atan2(std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]),
                    dot);
}

void readComponents(std::span<const uint8_t> element, ComponentType type, double* values) {
  const uint32_t bytes = componentBytes(type);
  for (size_t c = 0; c * bytes < element.size(); ++c) {
    values[c] = componentValue(element.data() + c * bytes, type);
  }
}

struct Deviation {
  double off = 0;      ///< deviation of the worst component, or the angle
  double allowed = 0;  ///< the largest deviation that is allowed for any component
  bool is_within = true;
};

Deviation angleDeviation(const double* source, const double* decoded, const Promise& promise) {
  const double length =
      std::sqrt(decoded[0] * decoded[0] + decoded[1] * decoded[1] + decoded[2] * decoded[2]);
  Deviation deviation;
  deviation.off = angleBetween(source, decoded);
  deviation.allowed = promise.radians;
  deviation.is_within = deviation.off <= deviation.allowed && std::abs(length - 1) < 1e-3;
  return deviation;
}

Deviation latticeDeviation(const double* source, const double* decoded, uint32_t component_count,
                           const Promise& promise) {
  Deviation deviation;
  for (uint32_t c = 0; c < component_count; ++c) {
    const double off = std::abs(source[c] - decoded[c]);
    const double allowed = latticeBound(promise, c % 4, decoded[c]);
    if (!(off <= allowed)) deviation.is_within = false;  // true for NaN, too
    deviation.off = std::max(deviation.off, off);
    deviation.allowed = std::max(deviation.allowed, allowed);
  }
  return deviation;
}

/// Returns a number with six digits, spelt as in JSON whatever the locale of the program is.
std::string number(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : "inf";
  const double places = value == 0 ? 0 : 5 - std::floor(std::log10(std::abs(value)));
  const double power = std::pow(10, std::abs(places));
  return Json(places > 0 ? std::round(value * power) / power : std::round(value / power) * power)
      .dump();
}

Result tooFar(const AttributeReport& report, uint64_t index, double off, bool is_angle) {
  return error("", report.name + " of decoded vertex " + std::to_string(index) + " is off by " +
                       number(off) + (is_angle ? " degrees" : "") + ", more than promised");
}

Result compareExact(const AccessorData& source, const AccessorData& decoded,
                    std::span<const uint32_t> source_of, const AttributeReport& report) {
  for (uint64_t i = 0; i < decoded.count; ++i) {
    const auto a = source.element(source_of[i]);
    const auto b = decoded.element(i);
    if (!std::equal(a.begin(), a.end(), b.begin(), b.end())) {
      return error("", report.name + " of decoded vertex " + std::to_string(i) +
                           " differs but should be exact");
    }
  }
  return {};
}

}  // namespace

/// Half a step of the angle, plus the normal's bound, by which the plane of the angle is off, plus
/// a margin for source tangents that are not quite perpendicular to their normals.
double tangentBound(uint32_t bits, uint32_t normal_bits) {
  constexpr double kPerpendicular = 0.0025;
  return std::numbers::pi / static_cast<double>(uint64_t{1} << bits) + kPerpendicular +
         octahedralBound(normal_bits);
}

double latticeBound(const Promise& promise, uint32_t component, double decoded) {
  // |fl(q * step) - q * step| and |fl(sum) - sum| are at most 2^-24 of the result. The writer
  // computes its quotient in binary64, so it may miss the middle between two points by very little.
  const double scaled = std::abs(decoded - promise.origin[component]);
  const double rounding = std::ldexp(1.01 * (scaled + std::abs(decoded)), -24);
  return promise.half_steps * promise.step / 2 * (1 + 1e-7) + rounding + 1e-44;
}

Result promiseOf(const AttributePlan& plan, const AttributeInfo& coded, uint8_t normal_bits,
                 Promise& promise) {
  promise = {};
  const bool is_float = plan.format.component_type == ComponentType::kFloat32;
  if (plan.bits == 0 || !is_float) return {};
  switch (coded.coding) {
    case AttributeCoding::kInteger:
    case AttributeCoding::kExactFloat:
    case AttributeCoding::kGrid: return {};
    case AttributeCoding::kLattice: return promiseLattice(plan, coded.lattice, promise);
    case AttributeCoding::kAlias: break;  // resolved by the decoder
    case AttributeCoding::kOctahedral:
      if (coded.bits < plan.bits) break;
      return promiseAngle(plan, octahedralBound(plan.bits), promise);
    case AttributeCoding::kTangentAngle:
      if (coded.bits < plan.bits || normal_bits < 2) break;
      return promiseAngle(plan, tangentBound(plan.bits, normal_bits), promise);
  }
  return error("", plan.label() + " is coded with fewer bits than asked for");
}

Result compareValues(const AccessorData& source, const AccessorData& decoded,
                     std::span<const uint32_t> source_of, const AttributeFormat& format,
                     const Promise& promise, AttributeReport& report, std::vector<float>& angles) {
  if (promise.kind == Promise::Kind::kExact) {
    return compareExact(source, decoded, source_of, report);
  }
  const bool is_angle = promise.kind == Promise::Kind::kAngle;
  const double unit = is_angle ? kDegrees : 1;
  const bool has_sign = isBase(format, Semantic::kTangent) && format.component_count == 4;
  report.is_angle |= is_angle;
  double a[16] = {};
  double b[16] = {};
  report.promised_distance = std::max(report.promised_distance, promise.distance);
  for (uint64_t i = 0; i < decoded.count; ++i) {
    readComponents(source.element(source_of[i]), format.component_type, a);
    readComponents(decoded.element(i), format.component_type, b);
    const Deviation deviation = is_angle ? angleDeviation(a, b, promise)
                                         : latticeDeviation(a, b, format.component_count, promise);
    const bool sign_is_lost = has_sign && std::abs(a[3]) == 1 && a[3] != b[3];
    if (!deviation.is_within || sign_is_lost)
      return tooFar(report, i, deviation.off * unit, is_angle);
    if (promise.distance > 0) {
      const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
      report.max_distance = std::max(report.max_distance, distance);
      if (!(distance <= promise.distance)) return tooFar(report, i, distance, false);
    }
    report.max_error = std::max(report.max_error, deviation.off * unit);
    report.promised_error = std::max(report.promised_error, deviation.allowed * unit);
    if (is_angle) angles.push_back(static_cast<float>(deviation.off * unit));
  }
  return {};
}

std::vector<Triangle> canonicalTriangles(std::span<const uint32_t> indices,
                                         std::span<const uint32_t> source_of) {
  std::vector<Triangle> triangles(indices.size() / 3);
  for (size_t i = 0; i < triangles.size(); ++i) {
    Triangle corners = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
    if (!source_of.empty()) {
      for (uint32_t& corner : corners) corner = source_of[corner];
    }
    const Triangle second = {corners[1], corners[2], corners[0]};
    const Triangle third = {corners[2], corners[0], corners[1]};
    triangles[i] = std::min({corners, second, third});
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace mcc::gltf
