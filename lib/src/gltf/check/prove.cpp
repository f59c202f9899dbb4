// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/prove.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "gltf/compress/quality.h"
#include "gltf/compress/vertices.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/accessors.h"
#include "host/parallel.h"

namespace mcc::gltf {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

bool isBase(const AttributeFormat& format, Semantic semantic) {
  return format.semantic == semantic && format.morph_target == 0;
}

/// How far a decoded value may be from its source.
struct Promise {
  enum class Kind : uint8_t { kExact, kLattice, kAngle };
  Kind kind = Kind::kExact;
  double step = 0;        ///< for kLattice: the lattice step
  double half_steps = 1;  ///< for kLattice: 1 for rounding, 2 for weights moved to a sum of one
  double origin[4] = {0, 0, 0, 0};
  double radians = 0;   ///< for kAngle
  double distance = 0;  ///< for positions: between two points; 0: none promised
};

Result promiseAngle(const AttributePlan& plan, double radians, Promise& promise) {
  promise.kind = Promise::Kind::kAngle;
  promise.radians = radians;
  const bool is_unit =
      isBase(plan.format, Semantic::kNormal) || isBase(plan.format, Semantic::kTangent);
  return is_unit ? Result{} : error("", plan.label(), " is coded as a unit vector");
}

Result promiseLattice(const AttributePlan& plan, const Lattice& lattice, Promise& promise) {
  promise.kind = Promise::Kind::kLattice;
  promise.step = lattice.step;
  std::copy_n(lattice.origin, 4, promise.origin);
  promise.half_steps = plan.is_rounded_with_others ? 2 : 1;
  promise.distance = plan.max_distance;
  if (plan.has_lattice && promise.step > 0 && promise.step <= double{plan.lattice.step}) return {};
  return error("", "the lattice step of ", plan.label(), " is coarser than asked for");
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

/// Returns the largest deviation of a decoded value that the promise allows, from lattice rounding
/// and the two float32 roundings of decoding.
double latticeBound(const Promise& promise, uint32_t component, double decoded) {
  // |fl(q * step) - q * step| and |fl(sum) - sum| are at most 2^-24 of the result. The writer
  // computes its quotient in binary64, so it may miss the middle between two points by very little.
  const double scaled = std::abs(decoded - promise.origin[component]);
  const double rounding = std::ldexp(1.01 * (scaled + std::abs(decoded)), -24);
  return promise.half_steps * promise.step / 2 * (1 + 1e-7) + rounding + 1e-44;
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

Result tooFar(const AttributeReport& report, uint64_t index, double off, bool is_angle) {
  return error("", report.name, " of decoded vertex ", index, " is off by ", numberText(off),
               (is_angle ? " degrees" : ""), ", more than promised");
}

/// Finds the promise that follows from the plan and from how the payload codes the attribute. Fails
/// when the coding is coarser than planned.
/// normal_bits  the bits of the piece's NORMAL, since the angles of tangents are angles around it.
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
  return error("", plan.label(), " is coded with fewer bits than asked for");
}

/// Compares decoded elements like compareExact(), but with what was promised. Sets promised_error,
/// max_error and is_angle of `report`, and adds angles to `angles`.
Result compareValues(const AccessorData& source, const AccessorData& decoded,
                     std::span<const uint32_t> source_of, const AttributeFormat& format,
                     const Promise& promise, AttributeReport& report, std::vector<float>& angles) {
  if (promise.kind == Promise::Kind::kExact) {
    return compareExact(source, decoded, source_of, report.name);
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

class Prover {
 public:
  Prover(const Document& source, EncodedPayload& payload, PayloadProof& proof)
      : source_(source), payload_(payload), proof_(proof) {}

  Result run(const RunJobs& run_jobs) {
    MCC_GLTF_TRY(decode(run_jobs));
    for (size_t i = 0; i < payload_.plan.pieces.size(); ++i) {
      const std::string where = payload_.plan.pieces[i].parts[0].users[0].path();
      MCC_GLTF_TRY(checkFailed(provePiece(i), where));
    }
    for (size_t row = 0; row < angles_.size(); ++row) {
      std::vector<float>& angles = angles_[row];
      if (angles.empty()) continue;
      const auto middle = angles.begin() + static_cast<ptrdiff_t>(angles.size() / 2);
      std::nth_element(angles.begin(), middle, angles.end());
      proof_.attributes[row].median_error = *middle;
    }
    return {};
  }

 private:
  Result decode(const RunJobs& run_jobs) {
    const auto start = std::chrono::steady_clock::now();
    Result result = decodePayload(payload_.result.payload, at("/meshes", payload_.plan.mesh),
                                  decoded_, run_jobs);
    if (!result.ok()) {
      result.what = "the payload cannot be decoded again: " + result.what + "; please report this";
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    proof_.decode_seconds = time.count();
    return result;
  }

  Result provePiece(size_t number) {
    const PiecePlan& piece = payload_.plan.pieces[number];
    const PieceInfo& info = decoded_.payload.info().pieces[number];
    const DecodedPiece& decoded = decoded_.pieces[number];
    PieceBounds& bounds = payload_.bounds.emplace_back();
    std::vector<uint32_t> source_of = payload_.result.pieces[number].source_wedge;
    MCC_GLTF_TRY(checkBijection(source_of, piece.wedge_count));
    if (payload_.plan.keep_vertex_order && !isIdentity(source_of)) {
      return error("", "the order of vertices differs");
    }
    // If the triangles are then the same, no vertex that they use was dropped.
    for (uint32_t& wedge : source_of) {
      if (!piece.kept.empty()) wedge = piece.kept[wedge];
    }
    if (info.wedge_count != piece.wedge_count ||
        info.attributes.size() != piece.attributes.size() ||
        info.parts.size() != piece.parts.size()) {
      return error("", "the payload has other counts than were planned");
    }
    for (size_t k = 0; k < piece.attributes.size(); ++k) {
      const Accessor& accessor = source_.accessors[piece.attributes[k].accessor];
      bounds.attributes.push_back(
          boundsOf(decoded.attributes[k], accessor.component_type, accessor.componentCount()));
      MCC_GLTF_TRY(proveAttribute(number, k, source_of));
    }
    for (size_t k = 0; k < piece.parts.size(); ++k) {
      const PartPlan& part = piece.parts[k];
      bounds.parts.push_back(boundsOf(decoded.parts[k]));
      MCC_GLTF_TRY(
          checkFailed(provePart(piece, part, decoded.parts[k], source_of), part.users[0].path()));
    }
    return {};
  }

  static Result checkBijection(const std::vector<uint32_t>& source_of, uint32_t wedge_count) {
    if (source_of.size() != wedge_count) return error("", "the vertex permutation is incomplete");
    std::vector<bool> is_seen(wedge_count, false);
    for (const uint32_t wedge : source_of) {
      if (wedge >= wedge_count || is_seen[wedge]) {
        return error("", "the vertex permutation is not a permutation");
      }
      is_seen[wedge] = true;
    }
    return {};
  }

  /// Returns the row of an attribute. Pieces whose meshes or codings differ have separate rows,
  /// because the bound of one does not hold for the other.
  size_t rowOf(uint32_t mesh, const AttributePlan& attribute, AttributeCoding coding,
               uint8_t bits) {
    const auto [found, is_new] =
        row_of_.try_emplace({mesh, attribute.label(), coding, bits}, proof_.attributes.size());
    const size_t row = found->second;
    if (is_new) {
      AttributeReport& report = proof_.attributes.emplace_back();
      report.name = attribute.label();
      report.coding = coding;
      report.bits = bits;
      report.component_count = attribute.format.component_count;
      angles_.emplace_back();
      boxes_.emplace_back();
    }
    proof_.rows.push_back(row);
    return row;
  }

  static uint8_t normalBits(const PiecePlan& piece) {
    for (const AttributePlan& attribute : piece.attributes) {
      if (attribute.isBase(Semantic::kNormal)) return attribute.bits;
    }
    return 0;
  }

  Result proveAttribute(size_t piece_number, size_t number, std::span<const uint32_t> source_of) {
    const PiecePlan& piece = payload_.plan.pieces[piece_number];
    const AttributePlan& attribute = piece.attributes[number];
    const auto& infos = decoded_.payload.info().pieces[piece_number].attributes;
    if (infos[number].format != attribute.format) {
      return error("", attribute.label(), " has another count or type");
    }
    const bool is_alias = infos[number].coding == AttributeCoding::kAlias;
    const AttributeInfo& coded = infos[is_alias ? infos[number].alias_of : number];
    const std::vector<uint8_t>& bytes = decoded_.pieces[piece_number].attributes[number];
    AccessorData source_values;
    MCC_GLTF_TRY(readAccessor(source_, attribute.accessor, source_values));
    const AccessorData decoded_values =
        AccessorData::packed(bytes, static_cast<uint32_t>(elementBytes(attribute.format)));
    Promise promise;
    MCC_GLTF_TRY(promiseOf(attribute, coded, normalBits(piece), promise));
    const uint8_t bits = promise.kind == Promise::Kind::kExact ? uint8_t{0} : attribute.bits;
    const size_t row = rowOf(piece.mesh(), attribute, coded.coding, bits);
    AttributeReport& report = proof_.attributes[row];
    report.vertex_count += piece.wedge_count;
    for (const PartPlan& part : piece.parts) {
      for (const PrimitiveRef& user : part.users) report.primitives.push_back(user.path());
    }
    if (attribute.label() == "POSITION") {
      boxes_[row].add(payload_.bounds.back().attributes.back());
      report.extent = boxes_[row].longestSide();
    }
    return compareValues(source_values, decoded_values, source_of, attribute.format, promise,
                         report, angles_[row]);
  }

  /// Returns what a part has to be. Reads the source's triangles again, instead of taking them from
  /// the plan; of a preview, the source has only the vertices.
  Result expectedTriangles(const PiecePlan& piece, const PartPlan& part,
                           std::vector<uint32_t>& expected) const {
    if (payload_.plan.is_preview) {
      for (const uint32_t vertex : part.triangles) expected.push_back(piece.kept[vertex]);
      return {};
    }
    const Primitive& primitive = source_.primitive(part.users[0]);
    if (primitive.indices != kNone) {
      MCC_GLTF_TRY(readIndices(source_, primitive.indices, expected));
    } else {
      expected.resize(source_.accessors[primitive.attributes[0].accessor].count);
      std::iota(expected.begin(), expected.end(), 0u);
    }
    return expandTriangles(primitive.mode, expected) ? Result()
                                                     : error("", "the source has no triangles");
  }

  Result provePart(const PiecePlan& piece, const PartPlan& part, std::span<const uint32_t> indices,
                   std::span<const uint32_t> source_of) const {
    for (const uint32_t index : indices) {
      if (index >= source_of.size()) return error("", "an index is out of range");
    }
    std::vector<uint32_t> expected;
    MCC_GLTF_TRY(expectedTriangles(piece, part, expected));
    if (indices.size() != expected.size()) {
      return error("", "there are ", indices.size() / 3, " triangles, the source has ",
                   expected.size() / 3);
    }
    if (payload_.plan.keep_triangle_order) {
      for (size_t i = 0; i < indices.size(); ++i) {
        if (source_of[indices[i]] != expected[i])
          return error("", "the order of triangles differs");
      }
    }
    if (canonicalTriangles(indices, source_of) != canonicalTriangles(expected, {})) {
      return error("", "the triangles differ");
    }
    return {};
  }

  const Document& source_;
  EncodedPayload& payload_;
  PayloadProof& proof_;
  DecodedPayload decoded_;
  std::vector<std::vector<float>> angles_;  ///< per row
  std::vector<Bounds> boxes_;               ///< of the positions, per row
  std::map<std::tuple<uint32_t, std::string, AttributeCoding, uint8_t>, size_t> row_of_;
};

}  // namespace

/// Half a step of the angle, plus the normal's bound, by which the plane of the angle is off, plus
/// a margin for source tangents that are not quite perpendicular to their normals.
double tangentBound(uint32_t bits, uint32_t normal_bits) {
  constexpr double kPerpendicular = 0.0025;
  return std::numbers::pi / static_cast<double>(uint64_t{1} << bits) + kPerpendicular +
         octahedralBound(normal_bits);
}

Result compareExact(const AccessorData& source, const AccessorData& decoded,
                    std::span<const uint32_t> source_of, const std::string& label) {
  for (uint64_t i = 0; i < decoded.count; ++i) {
    const auto a = source.element(source_of[i]);
    const auto b = decoded.element(i);
    if (!std::equal(a.begin(), a.end(), b.begin(), b.end())) {
      return error("", label, " of decoded vertex ", i, " differs but should be exact");
    }
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

Result checkFailed(Result result, const std::string& where) {
  constexpr std::string_view kBegin = "the check of the result failed: ";
  if (result.ok() || result.what.starts_with(kBegin)) return result;
  if (result.where.empty()) result.where = where;
  result.what = std::string(kBegin) + result.what + "; please report this";
  return result;
}

Result provePayloads(const Document& source, uint32_t thread_count,
                     std::vector<EncodedPayload>& payloads, std::vector<PayloadProof>& proofs) {
  proofs.assign(payloads.size(), {});
  ThreadBudget threads(thread_count);
  const RunJobs run_jobs = runJobsOn(threads);
  return runParallel(payloads.size(), threads, [&](size_t i) {
    payloads[i].bounds.clear();
    return Prover(source, payloads[i], proofs[i]).run(run_jobs);
  });
}

}  // namespace mcc::gltf
