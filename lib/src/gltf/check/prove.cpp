// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/prove.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <tuple>

#include "gltf/check/values.h"
#include "gltf/document/accessors.h"
#include "gltf/document/payload.h"
#include "host/parallel.h"

namespace mcc::gltf {
namespace {

/// The box around the positions of several pieces.
struct Box {
  double low[3];
  double high[3];
  bool is_empty = true;

  void add(const Bounds& bounds) {
    for (size_t i = 0; i < std::min<size_t>(bounds.min.size(), 3); ++i) {
      low[i] = is_empty ? bounds.min[i] : std::min(low[i], bounds.min[i]);
      high[i] = is_empty ? bounds.max[i] : std::max(high[i], bounds.max[i]);
    }
    is_empty = false;
  }
  double longestSide() const {
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  }
};

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
    if (payload_.plan.keep_vertex_order) MCC_GLTF_TRY(checkIdentity(source_of));
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

  static Result checkIdentity(const std::vector<uint32_t>& source_of) {
    for (uint32_t i = 0; i < source_of.size(); ++i) {
      if (source_of[i] != i) return error("", "the order of vertices differs");
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
      const bool is_normal =
          attribute.format.semantic == Semantic::kNormal && attribute.target == kNone;
      if (is_normal) return attribute.bits;
    }
    return 0;
  }

  Result proveAttribute(size_t piece_number, size_t number, std::span<const uint32_t> source_of) {
    const PiecePlan& piece = payload_.plan.pieces[piece_number];
    const AttributePlan& attribute = piece.attributes[number];
    const auto& infos = decoded_.payload.info().pieces[piece_number].attributes;
    if (infos[number].format != attribute.format) {
      return error("", attribute.label() + " has another count or type");
    }
    const bool is_alias = infos[number].coding == AttributeCoding::kAlias;
    const AttributeInfo& coded = infos[is_alias ? infos[number].alias_of : number];
    const std::vector<uint8_t>& bytes = decoded_.pieces[piece_number].attributes[number];
    AccessorData source_values;
    MCC_GLTF_TRY(readAccessor(source_, attribute.accessor, source_values));
    AccessorData decoded_values;
    decoded_values.data = bytes.data();
    decoded_values.count = piece.wedge_count;
    decoded_values.element_bytes = elementBytes(attribute.format);
    decoded_values.stride_bytes = decoded_values.element_bytes;
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

  /// Reads the source's triangles again, instead of taking them from the plan.
  Result sourceTriangles(const PrimitiveRef& ref, uint64_t vertex_count,
                         std::vector<uint32_t>& indices) const {
    const Primitive& primitive = source_.primitive(ref);
    uint64_t mode = 4;
    MCC_GLTF_TRY(readOptionalUnsigned(*primitive.json, "mode", ref.path(), 6, mode));
    if (primitive.indices != kNone) {
      MCC_GLTF_TRY(readIndices(source_, primitive.indices, indices));
    } else {
      for (uint32_t i = 0; i < vertex_count; ++i) indices.push_back(i);
    }
    if (!expandTriangles(mode, indices)) return error("", "the source has no triangles");
    return {};
  }

  /// Returns what a part has to be. The source has no triangles of a preview, only its vertices.
  Result expectedTriangles(const PiecePlan& piece, const PartPlan& part,
                           std::vector<uint32_t>& expected) const {
    if (payload_.plan.is_preview) {
      for (const uint32_t vertex : part.triangles) expected.push_back(piece.kept[vertex]);
      return {};
    }
    const uint64_t source_count = piece.kept.empty()
                                      ? piece.wedge_count
                                      : source_.accessors[piece.attributes[0].accessor].count;
    return sourceTriangles(part.users[0], source_count, expected);
  }

  Result provePart(const PiecePlan& piece, const PartPlan& part, std::span<const uint32_t> indices,
                   std::span<const uint32_t> source_of) const {
    for (const uint32_t index : indices) {
      if (index >= source_of.size()) return error("", "an index is out of range");
    }
    std::vector<uint32_t> expected;
    MCC_GLTF_TRY(expectedTriangles(piece, part, expected));
    if (indices.size() != expected.size()) {
      return error("", "there are " + std::to_string(indices.size() / 3) +
                           " triangles, the source has " + std::to_string(expected.size() / 3));
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
  std::vector<Box> boxes_;                  ///< of the positions, per row
  std::map<std::tuple<uint32_t, std::string, AttributeCoding, uint8_t>, size_t> row_of_;
};

}  // namespace

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
