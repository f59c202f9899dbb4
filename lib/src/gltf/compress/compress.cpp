// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/compress.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "gltf/compress/preview.h"
#include "gltf/compress/quality.h"
#include "gltf/compress/quantize.h"
#include "gltf/compress/savings.h"
#include "gltf/compress/vertices.h"
#include "host/parallel.h"

namespace mcc::gltf {
namespace {

/// The input of the codec for one piece. The views borrow from the plan.
struct PieceInput {
  std::vector<AttributeView> attributes;
  std::vector<PartView> parts;
  PieceView view;

  explicit PieceInput(const PiecePlan& plan) {
    for (const AttributePlan& attribute : plan.attributes) attributes.push_back(attribute.view());
    // With indices_only, the codec needs the exact positions to find those that are equal.
    if (plan.attributes.empty()) attributes.push_back(plan.ordinary[0].view());
    for (const PartPlan& part : plan.parts) parts.push_back({part.triangles});
    view = {plan.wedge_count, attributes, parts};
  }
};

Status encodePieces(std::span<const PiecePlan> plans, const EncodeOptions& options,
                    EncodeResult& result) {
  std::vector<PieceInput> inputs;
  inputs.reserve(plans.size());  // the views point into the elements, which must not move
  std::vector<PieceView> views;
  for (const PiecePlan& plan : plans) {
    inputs.emplace_back(plan);
    views.push_back(inputs.back().view);
  }
  return encode(views, options, result);
}

EncodeOptions optionsOf(const ConvertOptions& options, const PayloadPlan& plan) {
  EncodeOptions encode_options;
  encode_options.prefer = options.prefer;
  encode_options.block_triangles = options.block_triangles;
  encode_options.indices_only = plan.indices_only;
  encode_options.keep_vertex_order = plan.keep_vertex_order;
  encode_options.keep_triangle_order = plan.keep_triangle_order;
  return encode_options;
}

std::string refusal(const Status& status) {
  return "the codec refuses it (" + toResult(status, "").what + "); left as it was";
}

/// Removes the pieces that the codec refuses.
void removeRefusedPieces(const EncodeOptions& options, PayloadPlan& plan,
                         std::vector<LeftAlone>& left_alone) {
  std::vector<PiecePlan> accepted;
  for (PiecePlan& piece : plan.pieces) {
    EncodeResult ignored;
    const Status status = encodePieces({&piece, 1}, options, ignored);
    if (status.ok()) {
      accepted.push_back(std::move(piece));
    } else {
      leaveAlone(piece, refusal(status), false, left_alone);
    }
  }
  plan.pieces = std::move(accepted);
}

void leaveAllAlone(const std::string& note, EncodedPayload& payload,
                   std::vector<LeftAlone>& left_alone) {
  for (const PiecePlan& piece : payload.plan.pieces) leaveAlone(piece, note, false, left_alone);
  payload = {};
}

void encodeOne(const EncodeOptions& options, EncodedPayload& payload,
               std::vector<LeftAlone>& left_alone) {
  if (!encodePieces(payload.plan.pieces, options, payload.result).ok()) {
    removeRefusedPieces(options, payload.plan, left_alone);
    payload.result = {};
    if (payload.plan.pieces.empty()) return;
    // The codec may accept each piece alone, but not all of them together.
    const Status status = encodePieces(payload.plan.pieces, options, payload.result);
    if (!status.ok()) return leaveAllAlone(refusal(status), payload, left_alone);
  }
  Payload opened;
  const Status status = opened.open(payload.result.payload);
  if (status.error == Error::kLimit) leaveAllAlone(refusal(status), payload, left_alone);
}

/// Reports how much of the payloads' triangles is encoded.
class EncodingProgress {
 public:
  EncodingProgress(const ConvertOptions& options, const std::vector<PayloadPlan>& plans)
      : options_(options) {
    for (const PayloadPlan& plan : plans) all_ += plan.triangleCount();
  }

  void advance(uint64_t triangle_count) {
    if (!options_.progress || all_ == 0) return;
    const std::lock_guard lock(mutex_);
    done_ += triangle_count;
    options_.progress("encoding", static_cast<double>(done_) / static_cast<double>(all_));
  }

 private:
  const ConvertOptions& options_;
  std::mutex mutex_;
  uint64_t all_ = 0;
  uint64_t done_ = 0;
};

}  // namespace

std::vector<const PayloadPlan*> plansOf(const std::vector<EncodedPayload>& payloads) {
  std::vector<const PayloadPlan*> plans;
  for (const EncodedPayload& payload : payloads) plans.push_back(&payload.plan);
  return plans;
}

std::vector<const PayloadPlan*> plansOf(const std::vector<PayloadPlan>& payloads) {
  std::vector<const PayloadPlan*> plans;
  for (const PayloadPlan& payload : payloads) plans.push_back(&payload);
  return plans;
}

uint64_t bytesAlone(const ConvertOptions& options, const PayloadPlan& plan,
                    const PiecePlan& piece) {
  EncodeResult result;
  return encodePieces({&piece, 1}, optionsOf(options, plan), result).ok() ? result.payload.size()
                                                                          : 0;
}

Result encodePayloads(const ConvertOptions& options, std::vector<PayloadPlan> plans,
                      std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone) {
  std::vector<EncodedPayload> encoded(plans.size());
  std::vector<std::vector<LeftAlone>> refused(plans.size());
  EncodingProgress progress(options, plans);
  ThreadBudget threads(options.thread_count);
  const RunJobs run_jobs = runJobsOn(threads);
  MCC_GLTF_TRY(runParallel(plans.size(), threads, [&](size_t i) -> Result {
    PayloadPlan& plan = encoded[i].plan;
    plan = std::move(plans[i]);
    plan.keep_vertex_order |= options.keep_vertex_order;
    plan.keep_triangle_order |= options.keep_triangle_order;
    EncodeOptions encode_options = optionsOf(options, plan);
    encode_options.run_jobs = run_jobs;
    const uint64_t triangle_count = plan.triangleCount();
    encodeOne(encode_options, encoded[i], refused[i]);
    progress.advance(triangle_count);
    return {};
  }));
  for (size_t i = 0; i < encoded.size(); ++i) {
    left_alone.insert(left_alone.end(), refused[i].begin(), refused[i].end());
    if (!encoded[i].plan.pieces.empty()) payloads.push_back(std::move(encoded[i]));
  }
  return {};
}

namespace {

/// Writes the payloads into the JSON of the document.
class Applier {
 public:
  Applier(const Document& document, Compressed& compressed)
      : document_(document),
        source_accessors_(arrayOf(document.json, "accessors")),
        compressed_(compressed),
        is_taken_(accessorsInOtherUse(document, plansOf(compressed.payloads))) {}

  std::vector<NewView> run() {
    compressed_.json = document_.json;
    // Accessors that exist nowhere shall not exist by accident when new ones are added.
    hideMissingAccessors(document_.accessors.size(), compressed_.json);
    accessors_ = &compressed_.json["accessors"];
    meshes_ = &compressed_.json["meshes"];
    std::vector<NewView> views;
    std::vector<uint64_t> view_of;  // the view of each payload
    for (const EncodedPayload& payload : compressed_.payloads) {
      const bool is_new = payload.same_as == kNone;
      const uint64_t view = is_new ? kFirstNewView + views.size() : view_of[payload.same_as];
      view_of.push_back(view);
      if (is_new) views.emplace_back().borrow(payload.result.payload);
      for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
        applyPiece(payload, i, view);
        renumberVertices(document_, payload.plan.pieces[i], payload.result.pieces[i].source_wedge,
                         *accessors_, views);
        if (!payload.plan.reorders()) continue;
        reorderAttributes(document_, payload.plan.pieces[i], payload.result.pieces[i].source_wedge,
                          *accessors_, views);
      }
    }
    for (const EncodedPayload& preview : compressed_.previews) {
      const uint64_t view = kFirstNewView + views.size();
      NewView& new_view = views.emplace_back();
      new_view.borrow(preview.result.payload);
      new_view.is_in_front = true;
      namePreview(preview.plan, view);
    }
    // addFallback() removes the requirement again.
    listExtension(compressed_.json, kExtensionName, true);
    bool is_used = false;
    visitPrimitives(compressed_.json, [&](const PrimitiveRef&, const Json& primitive) {
      is_used |= extensionOf(primitive, kMeshExtension) != nullptr;
    });
    if (!is_used) listExtension(compressed_.json, kMeshExtension, false);
    return views;
  }

 private:
  void applyPiece(const EncodedPayload& payload, size_t number, uint64_t view) {
    const PiecePlan& piece = payload.plan.pieces[number];
    const PieceBounds& bounds = payload.bounds[number];
    const std::string where = piece.parts[0].users[0].path();
    std::vector<uint32_t> accessors;
    for (size_t k = 0; k < piece.attributes.size(); ++k) {
      const AttributePlan& attribute = piece.attributes[k];
      const uint32_t index = take(attribute.accessor, where + ": " + attribute.label());
      Json& accessor = (*accessors_)[index];
      const bool is_position = attribute.name == "POSITION";
      accessor["count"] = piece.wedge_count;
      setBounds(bounds.attributes[k], document_.accessors[attribute.accessor].component_type,
                is_position, accessor);
      accessors.push_back(index);
    }
    for (size_t k = 0; k < piece.parts.size(); ++k) {
      const uint32_t indices = takeIndices(piece.parts[k], bounds.parts[k], piece.wedge_count);
      for (const PrimitiveRef& user : piece.parts[k].users) {
        Json& primitive = (*meshes_)[user.mesh]["primitives"][user.primitive];
        setAccessors(piece, accessors, primitive);
        primitive["indices"] = indices;
        if (piece.parts[k].mode != 4) primitive["mode"] = 4;
        if (primitive.contains("extensions")) primitive["extensions"].erase(kMeshExtension);
        primitive["extensions"][kExtensionName] = extensionJson(view, number, piece, k);
      }
    }
  }

  void namePreview(const PayloadPlan& plan, uint64_t view) {
    plan.visitUsers([&](size_t i, size_t k, const PrimitiveRef& user) {
      Json preview = {{"bufferView", view}};
      if (i != 0) preview["piece"] = i;
      if (k != 0) preview["part"] = k;
      Json& primitive = (*meshes_)[user.mesh]["primitives"][user.primitive];
      primitive["extensions"][kExtensionName]["preview"] = std::move(preview);
    });
  }

  static void setAccessors(const PiecePlan& piece, const std::vector<uint32_t>& accessors,
                           Json& primitive) {
    for (size_t k = 0; k < accessors.size(); ++k) {
      const AttributePlan& attribute = piece.attributes[k];
      if (accessors[k] == attribute.accessor) continue;
      Json& map = attribute.target == kNone ? primitive["attributes"]
                                            : primitive["targets"][attribute.target];
      map[attribute.name] = accessors[k];
    }
  }

  /// Returns the accessor to compress: the source's own, or a clone if something else needs it.
  uint32_t take(uint32_t source, const std::string& where) {
    Json& accessors = *accessors_;
    uint32_t index = source;
    if (is_taken_[source]) {
      index = static_cast<uint32_t>(accessors.size());
      accessors.push_back(cloneOf(source));
      compressed_.remarks.push_back(
          sentence(where, " shares accessor ", source, " with others and gets its own"));
    }
    is_taken_[source] = true;
    for (const char* key : {"bufferView", "byteOffset", "sparse"}) accessors[index].erase(key);
    return index;
  }

  /// Returns a copy of an accessor of the source. A long one is copied without what glTF does not
  /// need, because there may be as many copies as pieces.
  Json cloneOf(uint32_t source) {
    constexpr size_t kLong = 1000;
    const Json& original = source_accessors_[source];
    const auto [found, is_new] = is_long_.try_emplace(source, false);
    if (is_new) found->second = printJson(original).size() > kLong;
    if (!found->second) return original;
    Json clone = Json::object();
    for (const char* key : {"componentType", "count", "type", "normalized"}) {
      if (const Json* value = findMember(original, key)) clone[key] = *value;
    }
    for (const char* key : {"min", "max"}) {
      if (findMember(original, key) != nullptr)
        clone[key] = Json::array();  // set from the elements
    }
    return clone;
  }

  uint32_t takeIndices(const PartPlan& part, const Bounds& bounds, uint32_t wedge_count) {
    Json& accessors = *accessors_;
    uint32_t index = 0;
    if (part.indices_accessor == kNone) {
      index = static_cast<uint32_t>(accessors.size());
      accessors.push_back({{"componentType", 0}, {"count", 0}, {"type", "SCALAR"}});
    } else {
      index = take(part.indices_accessor, part.users[0].path() + ": indices");
    }
    Json& accessor = accessors[index];
    const bool fits =
        part.indices_accessor != kNone &&
        holdsIndices(document_.accessors[part.indices_accessor].component_type, wedge_count);
    const bool is_short = holdsIndices(ComponentType::kUint16, wedge_count);
    if (!fits) {
      accessor["componentType"] =
          kGlTypes[static_cast<size_t>(is_short ? ComponentType::kUint16 : ComponentType::kUint32)];
    }
    accessor["count"] = part.triangles.size();
    setBounds(bounds, ComponentType::kUint32, false, accessor);
    return index;
  }

  const Document& document_;
  const Json& source_accessors_;
  Compressed& compressed_;
  Json* accessors_ = nullptr;  ///< of the result; it has them, since something is compressed
  Json* meshes_ = nullptr;
  std::vector<bool> is_taken_;        ///< source accessors that must not be changed (any more)
  std::map<uint32_t, bool> is_long_;  ///< by source accessor: the JSON of its copies is shortened
};

/// Finds the payloads that repeat an earlier one: of meshes that the source has twice, in different
/// accessors.
void findTwins(std::vector<EncodedPayload>& payloads) {
  const auto isLess = [](std::span<const uint8_t> a, std::span<const uint8_t> b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::map<std::span<const uint8_t>, uint32_t, decltype(isLess)> first_of(isLess);
  for (uint32_t i = 0; i < payloads.size(); ++i) {
    const auto [found, is_new] = first_of.try_emplace(payloads[i].result.payload, i);
    payloads[i].same_as = is_new ? kNone : found->second;
  }
}

}  // namespace

Result compressDocument(const Document& document, const ConvertOptions& options,
                        Compressed& compressed) {
  compressed = {};
  std::vector<PayloadPlan> plans;
  MCC_GLTF_TRY(planPayloads(document, plans, compressed.left_alone));
  planVertexNumbers(document, plans);
  if (options.indices_only) {
    planIndicesOnly(document, plans);
  } else {
    planUnused(options, plans, compressed.notes);
    if (options.quality != 0) {
      planQuality(document, options, plans, compressed.notes, compressed.quality_choices);
    } else {
      planQuantization(options, plans, compressed.notes);
    }
  }
  gatherPayloads(plans);
  if (!options.allow_larger) {
    MCC_GLTF_TRY(dropTinyPieces(document, options, plans, compressed.left_alone));
  }
  splitPayloads(options, plans);
  MCC_GLTF_TRY(
      encodePayloads(options, std::move(plans), compressed.payloads, compressed.left_alone));
  if (options.allow_larger) {
    countFreedBytes(document, compressed.payloads);
  } else {
    dropLosers(document, compressed.payloads, compressed.left_alone);
  }
  findTwins(compressed.payloads);
  std::stable_sort(
      compressed.left_alone.begin(), compressed.left_alone.end(),
      [](const LeftAlone& a, const LeftAlone& b) { return a.primitive < b.primitive; });
  MCC_GLTF_TRY(makePreviews(options, compressed.payloads, compressed.previews, compressed.remarks));
  for (const EncodedPayload& payload : compressed.payloads) {
    for (const std::string& note : payload.result.notes) {
      compressed.notes.push_back(at("/meshes", payload.plan.mesh) + ": " + note);
    }
  }
  return {};
}

void storePayloads(const Document& document, Compressed& compressed) {
  compressed.views = Applier(document, compressed).run();
  compressed.layout = layOut(document, compressed.views, compressed.json);
}

}  // namespace mcc::gltf
