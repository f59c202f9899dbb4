// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress.h"

#include <algorithm>
#include <set>

#include "gltf/accessors.h"
#include "gltf/integers.h"
#include "gltf/parallel.h"
#include "gltf/payload.h"

namespace mcc::gltf {
namespace {

constexpr uint32_t kArrayBuffer = 34962;
constexpr uint32_t kElementArrayBuffer = 34963;

class Decompressor {
 public:
  Decompressor(const Document& document, DecodeTo decode_to, uint32_t thread_count,
               Decompressed& out)
      : document_(document),
        decode_to_(decode_to),
        thread_count_(std::max(thread_count, 1u)),
        out_(out) {}

  /// Fills in accessors() and the counts.
  Result decode() {
    MCC_GLTF_TRY(findExtensionUses(document_, uses_));
    std::map<uint32_t, std::vector<const ExtensionUse*>> by_view;
    for (const ExtensionUse& use : uses_) by_view[use.view].push_back(&use);
    const std::vector<View> views(by_view.begin(), by_view.end());
    // As many at a time as there are threads, so that no more are in memory.
    for (size_t begin = 0; begin < views.size(); begin += thread_count_) {
      const size_t count = std::min<size_t>(thread_count_, views.size() - begin);
      MCC_GLTF_TRY(decodeViews(std::span(views).subspan(begin, count)));
    }
    out_.payload_count = static_cast<uint32_t>(by_view.size());
    out_.primitive_count = static_cast<uint32_t>(uses_.size());
    return {};
  }

  std::vector<DecodedAccessor>& accessors() { return accessors_; }

  /// After decode(): the document without the extension.
  Result rebuild() {
    if (uses_.empty()) return {};
    out_.json = document_.json;
    std::vector<NewView> views;
    for (DecodedAccessor& decoded : accessors_) {
      Json& accessor = out_.json["accessors"][decoded.index];
      accessor.erase("byteOffset");
      accessor.erase("sparse");
      accessor["bufferView"] = document_.views.size() + views.size();
      views.push_back(std::move(decoded.view));
    }
    for (const ExtensionUse& use : uses_) removeExtension(use);
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      removeExtensionName(out_.json, list, kExtensionName);
    }
    if (decode_to_ == DecodeTo::kIntegers) {
      storeIntegers(document_, out_.coded_attributes, out_.json, views, out_.notes);
    }
    const ForeignReferences foreign = findForeignReferences(document_.json);
    return rebuildBuffers(document_, foreign, views, out_.json, out_.bin);
  }

 private:
  /// A buffer view with a payload, and the primitives that use it.
  using View = std::pair<uint32_t, std::vector<const ExtensionUse*>>;

  Result decodeViews(std::span<const View> views) {
    std::vector<DecodedPayload> decoded(views.size());
    for (size_t i = 0; i < views.size(); ++i) MCC_GLTF_TRY(openView(views[i], decoded[i]));
    MCC_GLTF_TRY(runParallel(views.size(), thread_count_, [&](size_t i) {
      return decodePieces(whereOf(views[i]), decoded[i]);
    }));
    for (size_t i = 0; i < views.size(); ++i) storeView(views[i], decoded[i]);
    return {};
  }

  static std::string whereOf(const View& view) { return view.second[0]->path + "/bufferView"; }

  /// All counts must match the accessors before memory is taken for them.
  Result openView(const View& view, DecodedPayload& decoded) {
    const auto& [number, users] = view;
    MCC_GLTF_TRY(toResult(decoded.payload.open(payloadBytes(document_, number)), whereOf(view)));
    for (const ExtensionUse* use : users) {
      MCC_GLTF_TRY(checkAgainstPayload(document_, *use, decoded.payload.info()));
    }
    return {};
  }

  void storeView(const View& view, DecodedPayload& decoded) {
    for (const ExtensionUse* use : view.second) {
      storeAttributes(*use, decoded);
      storeIndices(*use, decoded);
    }
    for (const PieceInfo& piece : decoded.payload.info().pieces) {
      out_.wedge_count += piece.wedge_count;
      for (const PartInfo& part : piece.parts) out_.triangle_count += part.triangle_count;
    }
    decoded.pieces.clear();
  }

  void storeAttributes(const ExtensionUse& use, const DecodedPayload& decoded) {
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      if (!stored_.insert(attribute.accessor).second) continue;
      const Accessor& accessor = document_.accessors[attribute.accessor];
      NewView view;
      view.target = kArrayBuffer;
      view.bytes = packElements(decoded.pieces[use.piece].attributes[attribute.id], accessor, true,
                                view.stride_bytes);
      accessors_.push_back({attribute.accessor, std::move(view)});
      const auto& attributes = decoded.payload.info().pieces[use.piece].attributes;
      AttributeInfo info = attributes[attribute.id];
      if (info.coding == AttributeCoding::kAlias) {
        const AttributeFormat format = info.format;
        info = attributes[info.alias_of];
        info.format = format;
      }
      out_.coded_attributes.emplace(attribute.accessor, info);
    }
  }

  void storeIndices(const ExtensionUse& use, const DecodedPayload& decoded) {
    if (!stored_.insert(use.indices_accessor).second) return;
    const uint32_t bytes = componentBytes(document_.accessors[use.indices_accessor].component_type);
    NewView view;
    view.target = kElementArrayBuffer;
    for (const uint32_t index : decoded.pieces[use.piece].parts[use.part]) {
      for (uint32_t i = 0; i < bytes; ++i)
        view.bytes.push_back(static_cast<uint8_t>(index >> 8 * i));
    }
    accessors_.push_back({use.indices_accessor, std::move(view)});
  }

  void removeExtension(const ExtensionUse& use) {
    Json& primitive = out_.json["meshes"][use.mesh]["primitives"][use.primitive];
    primitive["extensions"].erase(kExtensionName);
    if (primitive["extensions"].empty()) primitive.erase("extensions");
  }

  const Document& document_;
  const DecodeTo decode_to_;
  const uint32_t thread_count_;
  Decompressed& out_;
  std::set<uint32_t> stored_;
  std::vector<ExtensionUse> uses_;
  std::vector<DecodedAccessor> accessors_;
};

}  // namespace

Result decodeAccessors(const Document& document, std::vector<DecodedAccessor>& accessors) {
  Decompressed ignored;
  Decompressor decompressor(document, DecodeTo::kFloats, 1, ignored);
  MCC_GLTF_TRY(decompressor.decode());
  accessors = std::move(decompressor.accessors());
  return {};
}

Result decompressDocument(const Document& document, Decompressed& decompressed, DecodeTo decode_to,
                          uint32_t thread_count) {
  decompressed = {};
  Decompressor decompressor(document, decode_to, thread_count, decompressed);
  MCC_GLTF_TRY(decompressor.decode());
  return decompressor.rebuild();
}

}  // namespace mcc::gltf
