// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/check.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "gltf/check/check_json.h"
#include "gltf/check/check_values.h"
#include "gltf/decompress/coded_input.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/accessors.h"
#include "gltf/document/bounds.h"
#include "gltf/document/contents.h"

namespace mcc::gltf {
namespace {

Result failed(Result result, const std::string& where) {
  if (result.ok()) return result;
  if (result.where.empty()) result.where = where;
  result.what = "the check of the result failed: " + result.what + "; please report this";
  return result;
}

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

class Checker {
 public:
  Checker(const Document& source, std::vector<EncodedPayload>& payloads, CheckResult& result)
      : source_(source),
        source_meshes_(arrayOf(source.json, "meshes")),
        payloads_(payloads),
        result_(result) {}

  Result run(const ForeignDecoders& decoders, std::span<const uint8_t> written,
             const FileReader& read_file, uint32_t thread_count) {
    Document compressed;
    MCC_GLTF_TRY(failed(loadDocument(written, read_file, compressed), ""));
    result_.contents = contentsOf(compressed);
    Decompressed decompressed;
    MCC_GLTF_TRY(failed(decompressDocument(compressed, decompressed, DecodeTo::kFloats,
                                           thread_count, takeDecoded()),
                        ""));
    result_.decoded_bytes = decompressed.decoded_bytes;
    coded_ = std::move(decompressed.coded_attributes);
    std::vector<ExtensionUse> uses;
    MCC_GLTF_TRY(findExtensionUses(compressed, uses));
    if (decompressed.payload_count == 0) {  // the source was stored in the other container
      decoded_ = std::move(compressed);
    } else {
      MCC_GLTF_TRY(failed(
          adoptDocument(std::move(decompressed.json), std::move(decompressed.bin), decoded_), ""));
    }
    MCC_GLTF_TRY(failed(decodeViews(decoders, decoded_, &source_), ""));
    decoded_accessors_ = &arrayOf(decoded_.json, "accessors");
    decoded_meshes_ = &arrayOf(decoded_.json, "meshes");
    for (const EncodedPayload& payload : payloads_) MCC_GLTF_TRY(checkPayload(payload));
    MCC_GLTF_TRY(failed(checkUses(uses), ""));
    if (!uses.empty()) MCC_GLTF_TRY(failed(checkFallback(compressed, uses), ""));
    return failed(compareRest(source_, decoded_, uses, reordered_), "");
  }

 private:
  DecodedPayloads takeDecoded() {
    DecodedPayloads decoded;
    for (EncodedPayload& payload : payloads_) {
      decoded.add(payload.result.payload, std::exchange(payload.decoded, {}));
    }
    return decoded;
  }

  /// Checks that the written file compresses the primitives of the plan and no others.
  Result checkUses(const std::vector<ExtensionUse>& uses) const {
    std::set<PrimitiveRef> found;
    for (const ExtensionUse& use : uses) {
      const PrimitiveRef ref = {use.mesh, use.primitive};
      if (extensionOf(primitiveAt(source_meshes_, ref), kExtensionName) == nullptr)
        found.insert(ref);
    }
    if (found != planned_) {
      return error("", "the compressed primitives are not those that were planned");
    }
    return {};
  }

  /// Checks that `min` and `max` are those of the elements, where the decoded document has them and
  /// JSON can represent them.
  Result checkBounds(uint32_t index, const AccessorData& elements) const {
    const Json& json = (*decoded_accessors_)[index];
    const Json* min = findMember(json, "min");
    const Json* max = findMember(json, "max");
    if ((min == nullptr && max == nullptr) || elements.count == 0) return {};
    const ComponentType type = decoded_.accessors[index].component_type;
    const Bounds bounds = boundsOf(elements, type);
    if (!bounds.is_finite) return {};
    const std::string in_min = min == nullptr ? "" : boundsDifference(*min, bounds.min, type);
    const std::string in_max = max == nullptr ? "" : boundsDifference(*max, bounds.max, type);
    if (!in_min.empty()) return error(at("/accessors", index) + "/min", in_min);
    if (!in_max.empty()) return error(at("/accessors", index) + "/max", in_max);
    return {};
  }

  /// Checks that compressed accessors which have bytes of their own hold the same as the payload.
  Result checkFallback(const Document& compressed, const std::vector<ExtensionUse>& uses) const {
    std::set<uint32_t> accessors;
    for (const ExtensionUse& use : uses) {
      accessors.insert(use.indices_accessor);
      for (const auto& attribute : use.attributes) accessors.insert(attribute.accessor);
    }
    for (const uint32_t index : accessors) {
      if (compressed.accessors[index].view == kNone) continue;
      AccessorData fallback;
      AccessorData decoded;
      MCC_GLTF_TRY(readAccessor(compressed, index, fallback));
      MCC_GLTF_TRY(readAccessor(decoded_, index, decoded));
      for (uint64_t i = 0; i < decoded.count; ++i) {
        const auto element = fallback.element(i);
        if (!std::equal(element.begin(), element.end(), decoded.element(i).begin())) {
          return error(at("/accessors", index), "the fallback differs from the payload");
        }
      }
    }
    return {};
  }

  Result checkPayload(const EncodedPayload& payload) {
    result_.attributes.emplace_back();
    result_.rows.emplace_back();
    angles_.clear();
    boxes_.clear();
    row_of_.clear();
    for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
      const PiecePlan& piece = payload.plan.pieces[i];
      const std::string where = piece.parts[0].users[0].path();
      std::vector<uint32_t> source_of = payload.result.pieces[i].source_wedge;
      MCC_GLTF_TRY(failed(checkBijection(source_of, piece.wedge_count), where));
      if (payload.plan.keep_vertex_order) MCC_GLTF_TRY(failed(checkIdentity(source_of), where));
      // If the triangles are then the same, no vertex that they use was dropped.
      for (uint32_t& wedge : source_of) {
        if (!piece.kept.empty()) wedge = piece.kept[wedge];
      }
      const Json& decoded = decodedPrimitive(piece.parts[0].users[0]);
      for (const AttributePlan& attribute : piece.attributes) {
        MCC_GLTF_TRY(failed(checkAttribute(piece, decoded, attribute, source_of), where));
      }
      for (const AttributePlan& attribute : piece.ordinary) {
        MCC_GLTF_TRY(failed(checkOrdinary(decoded, attribute, source_of), where));
        if (payload.plan.reorders()) reordered_.insert(attribute.accessor);
      }
      for (const uint32_t accessor : piece.vertex_numbers) {
        MCC_GLTF_TRY(failed(checkVertexNumbers(accessor, source_of), at("/accessors", accessor)));
        reordered_.insert(accessor);
      }
      for (const PartPlan& part : piece.parts) {
        MCC_GLTF_TRY(failed(checkPart(payload.plan, piece, part, source_of), part.users[0].path()));
      }
    }
    for (size_t row = 0; row < angles_.size(); ++row) {
      std::vector<float>& angles = angles_[row];
      AttributeReport& report = result_.attributes.back()[row];
      if (angles.empty()) continue;
      const auto middle = angles.begin() + static_cast<ptrdiff_t>(angles.size() / 2);
      std::nth_element(angles.begin(), middle, angles.end());
      report.median_error = *middle;
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

  const Json& decodedPrimitive(const PrimitiveRef& ref) const {
    return primitiveAt(*decoded_meshes_, ref);
  }

  /// Finds the accessor of an attribute of a decoded primitive.
  Result decodedAccessor(const Json& primitive, const AttributePlan& attribute,
                         uint32_t& accessor) const {
    uint64_t index = 0;
    const Json* map = findMember(primitive, "attributes");
    const Json& targets = arrayOf(primitive, "targets");
    if (attribute.target != kNone) {
      map = attribute.target < targets.size() ? &targets[attribute.target] : nullptr;
    }
    const Json* number = findMember(map, attribute.name);
    if (number == nullptr || !asUnsigned(*number, index) || index >= decoded_.accessors.size()) {
      return error("", attribute.label() + " is missing");
    }
    accessor = static_cast<uint32_t>(index);
    return {};
  }

  /// Returns the row of an attribute. Pieces whose codings differ have separate rows, because the
  /// bound of one does not hold for the other.
  size_t rowOf(const AttributePlan& attribute, AttributeCoding coding, uint8_t bits) {
    std::vector<AttributeReport>& reports = result_.attributes.back();
    const auto [found, is_new] =
        row_of_.try_emplace({attribute.label(), coding, bits}, reports.size());
    const size_t row = found->second;
    if (is_new) {
      AttributeReport& report = reports.emplace_back();
      report.name = attribute.label();
      report.coding = coding;
      report.bits = bits;
      report.component_count = attribute.format.component_count;
      angles_.emplace_back();
      boxes_.emplace_back();
    }
    result_.rows.back().push_back(row);
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

  Result checkAttribute(const PiecePlan& piece, const Json& primitive,
                        const AttributePlan& attribute, std::span<const uint32_t> source_of) {
    uint32_t index = 0;
    MCC_GLTF_TRY(decodedAccessor(primitive, attribute, index));
    const Accessor& accessor = decoded_.accessors[index];
    if (accessor.count != piece.wedge_count ||
        formatOf(attribute.name, attribute.target, accessor) != attribute.format) {
      return error("", attribute.label() + " has another count or type");
    }
    const auto coded = coded_.find(index);
    if (coded == coded_.end()) return error("", attribute.label() + " is not in the payload");
    AccessorData source_values;
    AccessorData decoded_values;
    MCC_GLTF_TRY(readAccessor(source_, attribute.accessor, source_values));
    MCC_GLTF_TRY(readAccessor(decoded_, index, decoded_values));
    MCC_GLTF_TRY(checkBounds(index, decoded_values));
    Promise promise;
    MCC_GLTF_TRY(promiseOf(attribute, coded->second, normalBits(piece), promise));
    const uint8_t bits = promise.kind == Promise::Kind::kExact ? uint8_t{0} : attribute.bits;
    const size_t row = rowOf(attribute, coded->second.coding, bits);
    AttributeReport& report = result_.attributes.back()[row];
    report.vertex_count += piece.wedge_count;
    for (const PartPlan& part : piece.parts) {
      for (const PrimitiveRef& user : part.users) report.primitives.push_back(user.path());
    }
    if (attribute.label() == "POSITION") {
      boxes_[row].add(boundsOf(decoded_values, accessor.component_type));
      report.extent = boxes_[row].longestSide();
    }
    return compareValues(source_values, decoded_values, source_of, attribute.format, promise,
                         report, angles_[row]);
  }

  /// Checks an attribute that stays next to the payload: every bit must be at its vertex.
  Result checkOrdinary(const Json& primitive, const AttributePlan& attribute,
                       std::span<const uint32_t> source_of) const {
    uint32_t index = 0;
    MCC_GLTF_TRY(decodedAccessor(primitive, attribute, index));
    const Accessor& accessor = decoded_.accessors[index];
    if (accessor.count != source_.accessors[attribute.accessor].count ||
        formatOf(attribute.name, attribute.target, accessor) != attribute.format) {
      return error("", attribute.label() + " has another count or type");
    }
    AccessorData source_values;
    AccessorData decoded_values;
    MCC_GLTF_TRY(readAccessor(source_, attribute.accessor, source_values));
    MCC_GLTF_TRY(readAccessor(decoded_, index, decoded_values));
    AttributeReport ignored;
    ignored.name = attribute.label();
    std::vector<float> no_angles;
    return compareValues(source_values, decoded_values, source_of, attribute.format, Promise{},
                         ignored, no_angles);
  }

  /// Checks that an accessor of vertex numbers still names the vertices that it named in the
  /// source.
  Result checkVertexNumbers(uint32_t accessor, std::span<const uint32_t> source_of) const {
    std::vector<uint32_t> expected;
    std::vector<uint32_t> numbers;
    MCC_GLTF_TRY(readIndices(source_, accessor, expected));
    MCC_GLTF_TRY(readIndices(decoded_, accessor, numbers));
    if (decoded_.accessors[accessor].component_type != source_.accessors[accessor].component_type ||
        numbers.size() != expected.size()) {
      return error("", "has another count or type");
    }
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] >= source_of.size() || source_of[numbers[i]] != expected[i]) {
        return error("", "element " + std::to_string(i) + " names another vertex");
      }
    }
    AccessorData elements;
    MCC_GLTF_TRY(readAccessor(decoded_, accessor, elements));
    return checkBounds(accessor, elements);
  }

  Result decodedTriangles(const PrimitiveRef& ref, std::vector<uint32_t>& indices) const {
    const Json* number = findMember(decodedPrimitive(ref), "indices");
    uint64_t index = 0;
    if (number == nullptr || !asUnsigned(*number, index) || index >= decoded_.accessors.size()) {
      return error("", "the indices are missing");
    }
    MCC_GLTF_TRY(readIndices(decoded_, static_cast<uint32_t>(index), indices));
    AccessorData elements;
    MCC_GLTF_TRY(readAccessor(decoded_, static_cast<uint32_t>(index), elements));
    return checkBounds(static_cast<uint32_t>(index), elements);
  }

  /// Reads the source's triangles again, instead of taking them from the plan.
  Result sourceTriangles(const PrimitiveRef& ref, uint32_t wedge_count,
                         std::vector<uint32_t>& indices) const {
    const Json& primitive = primitiveAt(source_meshes_, ref);
    uint64_t mode = 4;
    MCC_GLTF_TRY(readOptionalUnsigned(primitive, "mode", ref.path(), 6, mode));
    uint64_t accessor = 0;
    if (const Json* number = findMember(primitive, "indices"); number != nullptr) {
      if (!asUnsigned(*number, accessor)) return error("", "the indices are missing");
      MCC_GLTF_TRY(readIndices(source_, static_cast<uint32_t>(accessor), indices));
    } else {
      for (uint32_t i = 0; i < wedge_count; ++i) indices.push_back(i);
    }
    if (!expandTriangles(mode, indices)) return error("", "the source has no triangles");
    return {};
  }

  Result checkPart(const PayloadPlan& payload, const PiecePlan& piece, const PartPlan& part,
                   std::span<const uint32_t> source_of) {
    for (const PrimitiveRef& user : part.users) {
      planned_.insert(user);
      MCC_GLTF_TRY(checkSharing(piece, part, user));
    }
    std::vector<uint32_t> indices;
    MCC_GLTF_TRY(decodedTriangles(part.users[0], indices));
    for (const uint32_t index : indices) {
      if (index >= source_of.size()) return error("", "an index is out of range");
    }
    std::vector<uint32_t> expected;
    const uint64_t source_count = piece.kept.empty()
                                      ? piece.wedge_count
                                      : source_.accessors[piece.attributes[0].accessor].count;
    MCC_GLTF_TRY(sourceTriangles(part.users[0], static_cast<uint32_t>(source_count), expected));
    if (indices.size() != expected.size()) {
      return error("", "there are " + std::to_string(indices.size() / 3) +
                           " triangles, the source has " + std::to_string(expected.size() / 3));
    }
    if (payload.keep_triangle_order) {
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

  /// Checks that all users of a part refer to the accessors of the first, in the result as in the
  /// source.
  Result checkSharing(const PiecePlan& piece, const PartPlan& part,
                      const PrimitiveRef& user) const {
    for (const Json* meshes : {&source_meshes_, decoded_meshes_}) {
      const Json& own = primitiveAt(*meshes, user);
      const Json& first = primitiveAt(*meshes, piece.parts[0].users[0]);
      const Json& first_of_part = primitiveAt(*meshes, part.users[0]);
      const bool has_same = sameMap(own, first, "attributes") && sameMap(own, first, "targets") &&
                            sameMap(own, first_of_part, "indices");
      if (!has_same) return error(user.path(), "does not share the accessors of its piece");
    }
    if (arrayOf(decodedPrimitive(user), "targets").size() != piece.target_count) {
      return error(user.path(), "has another number of morph targets");
    }
    return {};
  }

  static bool sameMap(const Json& a, const Json& b, const char* key) {
    const Json* in_a = findMember(a, key);
    const Json* in_b = findMember(b, key);
    if (in_a == nullptr || in_b == nullptr) return in_a == in_b;
    return equalNumbers(*in_a, *in_b);
  }

  /// Compares numbers of accessors under the same names, however each is spelt.
  static bool equalNumbers(const Json& a, const Json& b) {
    if (a.is_structured()) {
      if (a.kind() != b.kind() || a.size() != b.size()) return false;
      for (size_t i = 0; i < a.size(); ++i) {
        const Json* other = a.is_array() ? &b[i] : findMember(b, a.keyAt(i));
        if (other == nullptr || !equalNumbers(a[i], *other)) return false;
      }
      return true;
    }
    uint64_t of_a = 0;
    uint64_t of_b = 0;
    return asUnsigned(a, of_a) && asUnsigned(b, of_b) && of_a == of_b;
  }

  const Document& source_;
  const Json& source_meshes_;
  std::vector<EncodedPayload>& payloads_;
  CheckResult& result_;
  Document decoded_;
  const Json* decoded_accessors_ = nullptr;
  const Json* decoded_meshes_ = nullptr;
  CodedAttributes coded_;
  std::vector<std::vector<float>> angles_;  ///< per row of the current payload's reports
  std::vector<Box> boxes_;                  ///< of the positions, per row
  /// Rows of the current payload.
  std::map<std::tuple<std::string, AttributeCoding, uint8_t>, size_t> row_of_;
  std::set<uint32_t> reordered_;  ///< accessors next to payloads, compared in another order
  std::set<PrimitiveRef> planned_;
};

}  // namespace

Result checkConversion(const Document& source, std::vector<EncodedPayload>& payloads,
                       const ForeignDecoders& decoders, std::span<const uint8_t> written,
                       const FileReader& read_file, uint32_t thread_count, CheckResult& result) {
  result = {};
  return Checker(source, payloads, result).run(decoders, written, read_file, thread_count);
}

}  // namespace mcc::gltf
