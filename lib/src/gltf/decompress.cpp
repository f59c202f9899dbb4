// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress.h"

#include <tuple>

#include "gltf/accessors.h"
#include "gltf/integers.h"
#include "gltf/payload.h"
#include "gltf/rebuild.h"

namespace mcc::gltf {
namespace {

constexpr uint32_t kArrayBuffer = 34962;
constexpr uint32_t kElementArrayBuffer = 34963;

/// Where the elements of an accessor come from: (buffer view, piece, is a part, id).
using Origin = std::tuple<uint32_t, uint64_t, bool, uint64_t>;

class Decompressor {
 public:
  Decompressor(const Document& document, DecodeTo decode_to, Decompressed& out)
      : document_(document), decode_to_(decode_to), out_(out) {}

  Result run() {
    std::vector<ExtensionUse> uses;
    MCC_GLTF_TRY(findExtensionUses(document_, uses));
    if (uses.empty()) return {};
    std::map<uint32_t, std::vector<const ExtensionUse*>> by_view;
    for (const ExtensionUse& use : uses) by_view[use.view].push_back(&use);
    out_.json = document_.json;
    for (const auto& [view, users] : by_view) MCC_GLTF_TRY(decodeView(view, users));
    for (const ExtensionUse& use : uses) removeExtension(use);
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      removeExtensionName(out_.json, list, kExtensionName);
    }
    out_.payload_count = static_cast<uint32_t>(by_view.size());
    out_.primitive_count = static_cast<uint32_t>(uses.size());
    if (decode_to_ == DecodeTo::kIntegers) {
      storeIntegers(document_, out_.coded_attributes, out_.json, new_views_, out_.notes);
    }
    const ForeignReferences foreign = findForeignReferences(document_.json);
    return rebuildBuffers(document_, foreign, new_views_, out_.json, out_.bin);
  }

 private:
  Result decodeView(uint32_t view, const std::vector<const ExtensionUse*>& users) {
    const std::string where = users[0]->path + "/bufferView";
    DecodedPayload decoded;
    MCC_GLTF_TRY(toResult(decoded.payload.open(payloadBytes(document_, view)), where));
    // All counts must match the accessors before memory is taken for them.
    for (const ExtensionUse* use : users) {
      MCC_GLTF_TRY(checkAgainstPayload(document_, *use, decoded.payload.info()));
      MCC_GLTF_TRY(claimAccessors(*use));
    }
    MCC_GLTF_TRY(decodePieces(where, decoded, nullptr));
    for (const ExtensionUse* use : users) {
      storeAttributes(*use, decoded);
      storeIndices(*use, decoded);
    }
    for (const PieceInfo& piece : decoded.payload.info().pieces) {
      out_.wedge_count += piece.wedge_count;
      for (const PartInfo& part : piece.parts) out_.triangle_count += part.triangle_count;
    }
    return {};
  }

  Result claim(uint32_t accessor, const Origin& origin, const std::string& path) {
    const auto [found, is_new] = origins_.try_emplace(accessor, origin);
    if (is_new || found->second == origin) return {};
    return error(path, "accessor " + std::to_string(accessor) +
                           " is filled from two different places of the payloads");
  }

  Result claimAccessors(const ExtensionUse& use) {
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      MCC_GLTF_TRY(
          claim(attribute.accessor, {use.view, use.piece, false, attribute.id}, attribute.path));
    }
    return claim(use.indices_accessor, {use.view, use.piece, true, use.part}, use.path);
  }

  void storeAttributes(const ExtensionUse& use, const DecodedPayload& decoded) {
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      if (!stored_.insert(attribute.accessor).second) continue;
      const Accessor& accessor = document_.accessors[attribute.accessor];
      NewView view;
      view.target = kArrayBuffer;
      view.bytes = packElements(decoded.pieces[use.piece].attributes[attribute.id], accessor, true,
                                view.stride_bytes);
      setView(attribute.accessor, std::move(view));
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
    setView(use.indices_accessor, std::move(view));
  }

  void setView(uint32_t index, NewView view) {
    Json& accessor = out_.json["accessors"][index];
    accessor.erase("byteOffset");
    accessor.erase("sparse");
    accessor["bufferView"] = document_.views.size() + new_views_.size();
    new_views_.push_back(std::move(view));
  }

  void removeExtension(const ExtensionUse& use) {
    Json& primitive = out_.json["meshes"][use.mesh]["primitives"][use.primitive];
    primitive["extensions"].erase(kExtensionName);
    if (primitive["extensions"].empty()) primitive.erase("extensions");
  }

  const Document& document_;
  const DecodeTo decode_to_;
  Decompressed& out_;
  std::map<uint32_t, Origin> origins_;
  std::set<uint32_t> stored_;
  std::vector<NewView> new_views_;
};

}  // namespace

Result decompressDocument(const Document& document, Decompressed& decompressed,
                          DecodeTo decode_to) {
  decompressed = {};
  return Decompressor(document, decode_to, decompressed).run();
}

}  // namespace mcc::gltf
