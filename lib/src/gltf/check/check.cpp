// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/check.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "gltf/check/compare.h"
#include "gltf/check/prove.h"
#include "gltf/decompress/coded_input.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/accessors.h"
#include "gltf/document/layout.h"

namespace mcc::gltf {
namespace {

bool areEqual(std::span<const uint8_t> a, std::span<const uint8_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

class Checker {
 public:
  Checker(const Document& source, const Compressed& compressed, CheckResult& result)
      : source_(source), compressed_(compressed), result_(result) {}

  Result run(const ForeignDecoders& decoders, std::span<const uint8_t> written,
             const FileReader& read_file, uint32_t thread_count) {
    MCC_GLTF_TRY(loadDocument(written, read_file, written_));
    result_.contents = contentsOf(written_);
    PayloadDecoder decoder(written_, PayloadDecoder::Views::kShared);
    MCC_GLTF_TRY(decoder.open());
    result_.decoded_bytes = decoder.counts().bytes;
    MCC_GLTF_TRY(decodeViews(decoders, written_, &source_));
    for (const ExtensionUse& use : decoder.uses()) use_of_[{use.mesh, use.primitive}] = &use;
    MCC_GLTF_TRY(checkPreviews());
    for (const EncodedPayload& payload : compressed_.payloads) MCC_GLTF_TRY(checkPayload(payload));
    MCC_GLTF_TRY(checkOldUses());
    if (!use_of_.empty()) {
      return error("", "the compressed primitives are not those that were planned");
    }
    MCC_GLTF_TRY(checkFallback(decoder, thread_count));
    return compareRest(source_, written_, decoder.uses(), reordered_);
  }

 private:
  /// Checks that the primitives have the previews that were proved, and no others.
  Result checkPreviews() {
    Result result;
    uint64_t count = 0;
    for (const EncodedPayload& preview : compressed_.previews) {
      is_payload_.clear();
      preview.plan.visitUsers([&](size_t i, size_t k, const PrimitiveRef& user) {
        if (result.ok()) result = checkFailed(checkPreview(preview, i, k, user), user.path());
        ++count;
      });
    }
    if (!result.ok()) return result;
    for (const auto& [ref, use] : use_of_) {
      const bool is_old = extensionOf(*source_.primitive(ref).json, kExtensionName) != nullptr;
      if (use->preview && !is_old) --count;
    }
    return count == 0 ? Result() : error("", "the previews are not those that were planned");
  }

  Result checkPreview(const EncodedPayload& preview, size_t piece, size_t part,
                      const PrimitiveRef& ref) {
    const auto found = use_of_.find(ref);
    if (found == use_of_.end() || !found->second->preview) return error("", "has no preview");
    const PartUse& use = *found->second->preview;
    if (use.piece == piece && use.part == part && holds(use.view, preview)) return {};
    return error("", "its preview is not the one that was compared");
  }

  /// Whether a view has the bytes of the payload that is being checked.
  bool holds(uint32_t view, const EncodedPayload& payload) {
    const auto [found, is_new] = is_payload_.try_emplace(view, false);
    if (is_new) found->second = areEqual(payloadBytes(written_, view), payload.result.payload);
    return found->second;
  }

  Result checkPayload(const EncodedPayload& payload) {
    is_payload_.clear();
    Result result;
    payload.plan.visitUsers([&](size_t i, size_t k, const PrimitiveRef& user) {
      if (result.ok()) result = checkFailed(checkPrimitive(payload, i, k, user), user.path());
    });
    if (!result.ok()) return result;
    for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
      const PiecePlan& piece = payload.plan.pieces[i];
      MCC_GLTF_TRY(checkFailed(checkBeside(payload, i), piece.parts[0].users[0].path()));
    }
    return {};
  }

  /// Checks that a primitive reads its part of its piece, and had that part in the source.
  Result checkPrimitive(const EncodedPayload& payload, size_t piece_number, size_t part_number,
                        const PrimitiveRef& ref) {
    const PiecePlan& piece = payload.plan.pieces[piece_number];
    const PartPlan& part = piece.parts[part_number];
    const auto found = use_of_.find(ref);
    if (found == use_of_.end()) return error("", "is not compressed, as it should be");
    const ExtensionUse& use = *found->second;
    use_of_.erase(found);
    if (!holds(use.view, payload)) {
      return error("", "the bytes of its payload are not those that were compared");
    }
    if (use.piece != piece_number || use.part != part_number) {
      return error("", "names another part of its payload");
    }
    MCC_GLTF_TRY(checkSource(piece, part, ref));
    MCC_GLTF_TRY(checkAttributes(piece, use));
    const PieceBounds& bounds = payload.bounds[piece_number];
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      MCC_GLTF_TRY(checkBounds(attribute.accessor, bounds.attributes[attribute.id]));
    }
    return checkBounds(use.indices_accessor, bounds.parts[part_number]);
  }

  /// Checks that the plan read the primitive as it is in the source.
  Result checkSource(const PiecePlan& piece, const PartPlan& part, const PrimitiveRef& ref) const {
    const Primitive& primitive = source_.primitive(ref);
    const AccessorMap accessors = accessorsOf(primitive);
    const auto isAsPlanned = [&](const AttributePlan& attribute) {
      const auto found = accessors.find({attribute.target, attribute.name});
      return found != accessors.end() && found->second == attribute.accessor;
    };
    const bool is_same =
        primitive.indices == part.indices_accessor && primitive.mode == part.mode &&
        hasPlannedCounts(primitive, piece) &&
        std::all_of(piece.attributes.begin(), piece.attributes.end(), isAsPlanned) &&
        std::all_of(piece.ordinary.begin(), piece.ordinary.end(), isAsPlanned);
    return is_same ? Result() : error("", "does not share the accessors of its piece");
  }

  static bool hasPlannedCounts(const Primitive& primitive, const PiecePlan& piece) {
    return primitive.attributes.size() == piece.attributes.size() + piece.ordinary.size() &&
           primitive.target_count == piece.target_count;
  }

  /// Checks that each attribute of a primitive is the one of its payload, or stays next to it.
  Result checkAttributes(const PiecePlan& piece, const ExtensionUse& use) const {
    if (!hasPlannedCounts(written_.primitive({use.mesh, use.primitive}), piece)) {
      return error("", "has another number of attributes or morph targets");
    }
    if (use.attributes.size() != piece.attributes.size()) {
      return error("", "reads another number of attributes from its payload");
    }
    // No two have the same name, so that no attribute of the piece is left out.
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      const AttributePlan& planned = piece.attributes[attribute.id];
      if (attribute.name != planned.name || attribute.target != planned.target) {
        return error(attribute.path, "is the number of another attribute");
      }
    }
    return {};
  }

  /// Checks the accessors next to the payload that belong to the vertices of a piece.
  Result checkBeside(const EncodedPayload& payload, size_t number) {
    const PiecePlan& piece = payload.plan.pieces[number];
    if (piece.ordinary.empty() && piece.vertex_numbers.empty()) return {};
    // No vertex was dropped: attributes next to a payload and numbers of vertices forbid that.
    const std::vector<uint32_t>& source_of = payload.result.pieces[number].source_wedge;
    const AccessorMap accessors = accessorsOf(written_.primitive(piece.parts[0].users[0]));
    for (const AttributePlan& attribute : piece.ordinary) {
      const auto found = accessors.find({attribute.target, attribute.name});
      if (found == accessors.end() || found->second == kNone) {
        return error("", attribute.label(), " is missing");
      }
      MCC_GLTF_TRY(checkOrdinary(found->second, attribute, source_of));
      if (payload.plan.reorders()) reordered_.insert(attribute.accessor);
    }
    for (const uint32_t accessor : piece.vertex_numbers) {
      MCC_GLTF_TRY(
          checkFailed(checkVertexNumbers(accessor, source_of), at("/accessors", accessor)));
      reordered_.insert(accessor);
    }
    return {};
  }

  /// The accessors of a primitive by morph target and name.
  using AccessorMap = std::map<std::pair<uint32_t, std::string_view>, uint32_t>;

  static AccessorMap accessorsOf(const Primitive& primitive) {
    AccessorMap accessors;
    for (const auto& [name, target, accessor] : primitive.attributes) {
      accessors[{target, name}] = accessor;
    }
    return accessors;
  }

  /// Checks an attribute that stays next to the payload: every bit must be at its vertex.
  Result checkOrdinary(uint32_t index, const AttributePlan& attribute,
                       std::span<const uint32_t> source_of) const {
    const Accessor& accessor = written_.accessors[index];
    if (accessor.count != source_.accessors[attribute.accessor].count ||
        formatOf(attribute.name, attribute.target, accessor) != attribute.format) {
      return error("", attribute.label(), " has another count or type");
    }
    AccessorData source_values;
    AccessorData written_values;
    MCC_GLTF_TRY(readAccessor(source_, attribute.accessor, source_values));
    MCC_GLTF_TRY(readAccessor(written_, index, written_values));
    return compareExact(source_values, written_values, source_of, attribute.label());
  }

  /// Checks that an accessor of vertex numbers still names the vertices that it named in the
  /// source.
  Result checkVertexNumbers(uint32_t accessor, std::span<const uint32_t> source_of) {
    std::vector<uint32_t> expected;
    std::vector<uint32_t> numbers;
    MCC_GLTF_TRY(readIndices(source_, accessor, expected));
    MCC_GLTF_TRY(readIndices(written_, accessor, numbers));
    if (written_.accessors[accessor].component_type != source_.accessors[accessor].component_type ||
        numbers.size() != expected.size()) {
      return error("", "has another count or type");
    }
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] >= source_of.size() || source_of[numbers[i]] != expected[i]) {
        return error("", "element ", i, " names another vertex");
      }
    }
    return numbers.empty() ? Result() : checkBounds(accessor, boundsOf(numbers));
  }

  /// Checks that `min` and `max` of an accessor are those of its elements, where it has them and
  /// JSON can represent them.
  Result checkBounds(uint32_t index, const Bounds& bounds) {
    if (!bounds.is_finite || !with_bounds_.insert(index).second) return {};
    const Json& json = arrayOf(written_.json, "accessors")[index];
    const ComponentType type = written_.accessors[index].component_type;
    const std::string path = at("/accessors", index);
    MCC_GLTF_TRY(checkBound(json, "min", bounds.min, type, path));
    return checkBound(json, "max", bounds.max, type, path);
  }

  /// Checks that what the source had compressed already has the same payloads, and takes it out of
  /// `use_of_`. Its JSON is compared with the rest.
  Result checkOldUses() {
    std::vector<ExtensionUse> old_uses;
    MCC_GLTF_TRY(findExtensionUses(source_, old_uses));
    std::map<std::pair<uint32_t, uint32_t>, bool> is_same;  // many primitives may name a payload
    for (const ExtensionUse& old : old_uses) {
      const auto use = use_of_.find({old.mesh, old.primitive});
      if (use == use_of_.end()) return error(old.path, "is lost");
      const auto isSame = [&](uint32_t old_view, uint32_t view) {
        const auto [found, is_new] = is_same.try_emplace({old_view, view}, false);
        if (is_new) {
          found->second = areEqual(payloadBytes(source_, old_view), payloadBytes(written_, view));
        }
        return found->second;
      };
      const ExtensionUse& now = *use->second;
      use_of_.erase(use);
      if (!isSame(old.view, now.view)) return error(old.path, "has another payload");
      const bool has_same = old.preview.has_value() == now.preview.has_value() &&
                            (!old.preview || isSame(old.preview->view, now.preview->view));
      if (!has_same) return error(old.path, "has another preview");
    }
    return {};
  }

  /// Checks that compressed accessors which have bytes of their own hold the same as the payload.
  Result checkFallback(PayloadDecoder& decoder, uint32_t thread_count) const {
    const auto hasFallback = [&](const PayloadDecoder::Filled& filled) {
      return written_.accessors[filled.accessor].view != kNone;
    };
    const std::vector<NewView> views = decoder.takeViews();
    std::vector<std::vector<uint8_t>> elements(views.size());
    for (const PayloadDecoder::Filled& filled : decoder.filled()) {
      if (hasFallback(filled)) elements[filled.view].resize(views[filled.view].byte_count);
    }
    if (std::none_of(decoder.filled().begin(), decoder.filled().end(), hasFallback)) return {};
    MCC_GLTF_TRY(decoder.decode(thread_count, [&](size_t view) {
      return elements[view].empty() ? nullptr : elements[view].data();
    }));
    for (const PayloadDecoder::Filled& filled : decoder.filled()) {
      if (!hasFallback(filled)) continue;
      AccessorData fallback;
      AccessorData decoded;
      MCC_GLTF_TRY(readAccessor(written_, filled.accessor, fallback));
      readElements(written_.accessors[filled.accessor], elements[filled.view].data(),
                   views[filled.view].stride_bytes, decoded);
      if (fallback.firstDifference(decoded) != decoded.count)
        return error(at("/accessors", filled.accessor), "the fallback differs from the payload");
    }
    return {};
  }

  const Document& source_;
  const Compressed& compressed_;
  CheckResult& result_;
  Document written_;
  std::map<PrimitiveRef, const ExtensionUse*> use_of_;  ///< that were not checked yet
  std::map<uint32_t, bool> is_payload_;  ///< whether a view holds the payload that is being checked
  std::set<uint32_t> with_bounds_;       ///< accessors whose bounds were checked
  std::set<uint32_t> reordered_;         ///< accessors next to payloads, compared in another order
};

}  // namespace

Result checkConversion(const Document& source, const Compressed& compressed,
                       const ForeignDecoders& decoders, std::span<const uint8_t> written,
                       const FileReader& read_file, uint32_t thread_count, CheckResult& result) {
  result = {};
  Checker checker(source, compressed, result);
  return checkFailed(checker.run(decoders, written, read_file, thread_count), "");
}

}  // namespace mcc::gltf
