// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress/decompress.h"

#include <algorithm>
#include <deque>

#include "gltf/document/accessors.h"
#include "gltf/document/references.h"

namespace mcc::gltf {
namespace {

IndexType indexTypeOf(ComponentType type) {
  if (type == ComponentType::kUint8) return IndexType::kUint8;
  return type == ComponentType::kUint16 ? IndexType::kUint16 : IndexType::kUint32;
}

}  // namespace

uint64_t outputBytes(const PayloadInfo& info) {
  uint64_t bytes = 0;
  for (const PieceInfo& piece : info.pieces) {
    for (const AttributeInfo& attribute : piece.attributes) {
      bytes += uint64_t{piece.wedge_count} * elementBytes(attribute.format);
    }
    for (const PartInfo& part : piece.parts) bytes += uint64_t{12} * part.triangle_count;
  }
  return bytes;
}

Status decodePieces(DecodedPayload& decoded, const mcc::DecodeOptions& options) {
  const std::span<const PieceInfo> infos = decoded.payload.info().pieces;
  std::vector<std::vector<AttributeTarget>> attribute_targets(infos.size());
  std::vector<std::vector<PartTarget>> part_targets(infos.size());
  std::vector<PieceTarget> targets(infos.size());
  decoded.pieces.resize(infos.size());
  for (size_t i = 0; i < infos.size(); ++i) {
    DecodedPiece& piece = decoded.pieces[i];
    for (const AttributeInfo& attribute : infos[i].attributes) {
      const size_t bytes = elementBytes(attribute.format);
      piece.attributes.emplace_back(infos[i].wedge_count * bytes);
      attribute_targets[i].push_back({piece.attributes.back().data(), bytes});
    }
    for (const PartInfo& part : infos[i].parts) {
      piece.parts.emplace_back(size_t{3} * part.triangle_count);
      part_targets[i].push_back({piece.parts.back().data(), IndexType::kUint32});
    }
    targets[i] = {attribute_targets[i], part_targets[i]};
  }
  return decoded.payload.decode(targets, options);
}

Result decodePayload(std::span<const uint8_t> bytes, const std::string& where,
                     DecodedPayload& decoded, const RunJobs& run_jobs) {
  decoded = {};
  MCC_GLTF_TRY(toResult(decoded.payload.open(bytes), where));
  mcc::DecodeOptions options;
  options.run_jobs = runnerOf(run_jobs);
  return toResult(decodePieces(decoded, options), where);
}

Result PayloadDecoder::open() {
  MCC_GLTF_TRY(findExtensionUses(document_, uses_));
  const std::vector<PayloadUse> uses = payloadUses(document_, uses_);
  MCC_GLTF_TRY(checkPayloadLengths(document_, uses));
  for (const PayloadUse& use : uses) MCC_GLTF_TRY(openPayload(use));
  for (size_t i = 0; i < uses.size(); ++i) {
    for (const ExtensionUse* user : uses[i].users) {
      for (const auto& attribute : user->attributes) addAttribute(i, *user, attribute);
      addTarget({i, user->piece, true, user->part}, user->indices_accessor);
    }
  }
  DecodedBytes bytes = document_.decoded;
  bytes.add(counts_.bytes + copied_bytes_);
  return bytes.check();
}

/// All counts must match the accessors before memory is taken for them.
Result PayloadDecoder::openPayload(const PayloadUse& use) {
  OpenPayload& payload = payloads_.emplace_back();
  payload.where = use.where();
  MCC_GLTF_TRY(toResult(payload.payload.open(payloadBytes(document_, use.view)), payload.where));
  const PayloadInfo& info = payload.payload.info();
  MCC_GLTF_TRY(checkAgainstPayload(document_, use, info));
  for (const PieceInfo& piece : info.pieces) {
    if (use.users.empty()) break;
    counts_.wedges += piece.wedge_count;
    for (const PartInfo& part : piece.parts) counts_.triangles += part.triangle_count;
  }
  if (!use.users.empty()) ++counts_.payloads;
  counts_.bytes += outputBytes(info);
  return {};
}

void PayloadDecoder::addAttribute(size_t payload, const ExtensionUse& use,
                                  const ExtensionUse::AttributeUse& attribute) {
  const auto& attributes = payloads_[payload].payload.info().pieces[use.piece].attributes;
  AttributeInfo info = attributes[attribute.id];
  if (info.coding == AttributeCoding::kAlias) {
    const AttributeFormat format = info.format;
    info = attributes[info.alias_of];
    info.format = format;
  }
  codings_.emplace(attribute.accessor, info);
  addTarget({payload, use.piece, false, attribute.id}, attribute.accessor);
}

/// Gives an accessor a view that already gets its elements, or a new one.
void PayloadDecoder::addTarget(const Origin& origin, uint32_t number) {
  if (!known_.insert(number).second) return;
  const Accessor& accessor = document_.accessors[number];
  const bool is_indices = std::get<2>(origin);
  const uint32_t stride = attributeStride(accessor);
  const auto [found, is_new] =
      view_of_.try_emplace({origin, accessor.component_type, accessor.columns}, views_.size());
  if (!is_new && are_shared_) {
    filled_.push_back({number, found->second});
    // glTF requires a stride where several vertex attributes share a view.
    if (!is_indices) views_[found->second].stride_bytes = stride;
    return;
  }
  if (!is_new && !is_indices) copied_bytes_ += accessor.count * accessor.elementBytes();
  filled_.push_back({number, views_.size()});
  targets_[origin].push_back(filled_.back());
  NewView& view = views_.emplace_back();
  view.target = is_indices ? kElementArrayBuffer : kArrayBuffer;
  view.byte_count = accessor.count * (is_indices ? accessor.elementBytes() : stride);
  if (!is_indices && stride != accessor.tightBytes()) view.stride_bytes = stride;
}

/// Decodes one payload. What one view gets as it is decoded goes there; the rest goes through
/// memory of its own.
class PayloadDecoder::Run {
 public:
  Run(const PayloadDecoder& decoder, size_t number, const Place& place)
      : decoder_(decoder), number_(number), place_(place) {}

  Result decode(const RunJobs& run_jobs) {
    const auto& [payload, where] = decoder_.payloads_[number_];
    const std::span<const PieceInfo> infos = payload.info().pieces;
    attributes_.resize(infos.size());
    parts_.resize(infos.size());
    std::vector<PieceTarget> pieces;
    for (size_t i = 0; i < infos.size(); ++i) {
      for (size_t k = 0; k < infos[i].attributes.size(); ++k) addAttribute(infos[i], i, k);
      for (size_t k = 0; k < infos[i].parts.size(); ++k) addPart(infos[i], i, k);
      pieces.push_back({attributes_[i], parts_[i]});
    }
    mcc::DecodeOptions options;
    options.run_jobs = runnerOf(run_jobs);
    MCC_GLTF_TRY(toResult(payload.decode(pieces, options), where));
    for (const Detour& detour : detours_) store(detour);
    return {};
  }

 private:
  /// Elements that are decoded without gaps and then stored for each of their accessors.
  struct Detour {
    const std::vector<Filled>* targets = nullptr;
    bool is_part = false;
    std::vector<uint8_t> elements;
  };

  const std::vector<Filled>& targetsOf(size_t piece, bool is_part, size_t number) const {
    static const std::vector<Filled> kEmpty;
    const auto found = decoder_.targets_.find({number_, piece, is_part, number});
    return found == decoder_.targets_.end() ? kEmpty : found->second;
  }
  const Accessor& accessorOf(const Filled& target) const {
    return decoder_.document_.accessors[target.accessor];
  }
  uint8_t* placeOf(const Filled& target) const { return place_ ? place_(target.view) : nullptr; }

  uint8_t* addDetour(const std::vector<Filled>& targets, bool is_part, uint64_t byte_count) {
    const auto is_wanted = [&](const Filled& target) { return placeOf(target) != nullptr; };
    if (std::none_of(targets.begin(), targets.end(), is_wanted)) return nullptr;
    detours_.push_back({&targets, is_part, std::vector<uint8_t>(byte_count)});
    return detours_.back().elements.data();
  }

  void addAttribute(const PieceInfo& info, size_t piece, size_t number) {
    const std::vector<Filled>& targets = targetsOf(piece, false, number);
    AttributeTarget& target = attributes_[piece].emplace_back();
    if (targets.empty()) return;
    const Accessor& accessor = accessorOf(targets[0]);
    const bool is_padded = accessor.elementBytes() != accessor.tightBytes();
    if (targets.size() == 1 && !is_padded) {
      target = {placeOf(targets[0]), attributeStride(accessor)};
    } else {
      const uint32_t bytes = accessor.tightBytes();
      target = {addDetour(targets, false, uint64_t{info.wedge_count} * bytes), bytes};
    }
  }

  void addPart(const PieceInfo& info, size_t piece, size_t number) {
    const std::vector<Filled>& targets = targetsOf(piece, true, number);
    PartTarget& target = parts_[piece].emplace_back();
    if (targets.size() == 1) {
      target = {placeOf(targets[0]), indexTypeOf(accessorOf(targets[0]).component_type)};
    } else if (!targets.empty()) {
      target.indices = addDetour(targets, true, uint64_t{12} * info.parts[number].triangle_count);
    }
  }

  void store(const Detour& detour) const {
    for (const Filled& target : *detour.targets) {
      uint8_t* const out = placeOf(target);
      if (out == nullptr) continue;
      const Accessor& accessor = accessorOf(target);
      if (detour.is_part) {
        narrowIndices(detour.elements, accessor.tightBytes(), out);
      } else {
        packElements(detour.elements, accessor, out);
      }
    }
  }

  const PayloadDecoder& decoder_;
  const size_t number_;  ///< of the payload
  const Place& place_;
  std::vector<std::vector<AttributeTarget>> attributes_;
  std::vector<std::vector<PartTarget>> parts_;
  std::deque<Detour> detours_;
};

Result PayloadDecoder::decode(uint32_t thread_count, const Place& place) const {
  ThreadBudget threads(thread_count);
  const RunJobs run_jobs = runJobsOn(threads);
  return runParallel(payloads_.size(), threads,
                     [&](size_t i) { return Run(*this, i, place).decode(run_jobs); });
}

namespace {

/// Makes the filled accessors read the views, and removes the extension.
void editJson(const PayloadDecoder& decoder, Json& json) {
  Json& accessors = json["accessors"];
  for (const PayloadDecoder::Filled& filled : decoder.filled()) {
    Json& accessor = accessors[filled.accessor];
    accessor.erase("byteOffset");
    accessor.erase("sparse");
    accessor["bufferView"] = kFirstNewView + filled.view;
  }
  Json& meshes = json["meshes"];
  for (const ExtensionUse& use : decoder.uses()) {
    Json& primitive = meshes[use.mesh]["primitives"][use.primitive];
    primitive["extensions"].erase(kExtensionName);
    if (primitive["extensions"].empty()) primitive.erase("extensions");
  }
  listExtension(json, kExtensionName, false);
}

}  // namespace

Result Decompressed::fill(uint32_t thread_count, std::span<uint8_t> buffer) const {
  layout.copyTo(buffer);
  if (are_filled) return {};
  return decoder->decode(thread_count,
                         [&](size_t view) { return buffer.data() + layout.offsets[view]; });
}

Result decompressDocument(const Document& document, const DecodeOptions& options,
                          Decompressed& decompressed) {
  using Views = PayloadDecoder::Views;
  decompressed = {};
  decompressed.are_filled = options.decode_to == DecodeTo::kIntegers;
  // Accessors of the same elements may become different integers.
  decompressed.decoder = std::make_unique<PayloadDecoder>(
      document, decompressed.are_filled ? Views::kOfEachAccessor : Views::kShared);
  PayloadDecoder& decoder = *decompressed.decoder;
  MCC_GLTF_TRY(decoder.open());
  if (decoder.uses().empty()) return {};
  std::vector<NewView>& views = decompressed.views;
  views = decoder.takeViews();
  decompressed.json = document.json;
  editJson(decoder, decompressed.json);
  if (decompressed.are_filled) {
    for (NewView& view : views) view.hold(std::vector<uint8_t>(view.byte_count));
    MCC_GLTF_TRY(decoder.decode(options.thread_count,
                                [&](size_t view) { return views[view].owned.data(); }));
    storeIntegers(document, decoder.codings(), decompressed.json, views, decompressed.notes);
  }
  decompressed.layout = layOut(document, views, decompressed.json);
  return {};
}

Result addFallback(const std::vector<uint8_t>& bin, Json& json, std::vector<uint8_t>& fallback) {
  std::vector<uint8_t> glb;
  Document document;
  MCC_GLTF_TRY(writeGlb(printJson(json), bin, {}, glb));
  MCC_GLTF_TRY(loadDocument(glb, nullptr, document));
  PayloadDecoder decoder(document, PayloadDecoder::Views::kShared);
  MCC_GLTF_TRY(decoder.open());
  const std::vector<NewView> decoded = decoder.takeViews();
  std::vector<uint64_t> numbers(decoded.size(), kNone);  // numbers of the views in the JSON
  std::vector<uint64_t> offsets(decoded.size());
  uint64_t end = 0;
  const size_t buffer = json["buffers"].size();
  Json& accessors = json["accessors"];
  Json& views = json["bufferViews"];
  for (const auto& [accessor, number] : decoder.filled()) {
    if (document.accessors[accessor].view != kNone) continue;  // it already has a fallback
    if (numbers[number] == kNone) {
      const NewView& view = decoded[number];
      offsets[number] = (end + 3) & ~uint64_t{3};
      end = offsets[number] + view.byte_count;
      numbers[number] = views.size();
      views.push_back(view.json(buffer, offsets[number]));
    }
    accessors[accessor]["bufferView"] = numbers[number];
  }
  json["buffers"].push_back({{"uri", ""}, {"byteLength", end}});
  removeExtensionName(json, "extensionsRequired", kExtensionName);
  fallback.assign(end, 0);
  return decoder.decode(1, [&](size_t view) {
    return numbers[view] == kNone ? nullptr : fallback.data() + offsets[view];
  });
}

}  // namespace mcc::gltf
