// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress/decompress.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "gltf/base/parallel.h"
#include "gltf/base/payload.h"
#include "gltf/decompress/integers.h"
#include "gltf/document/accessors.h"

namespace mcc::gltf {
namespace {

class Decompressor {
 public:
  Decompressor(const Document& document, DecodeTo decode_to, uint32_t thread_count,
               DecodedPayloads known, Decompressed& out)
      : document_(document),
        decode_to_(decode_to),
        thread_count_(std::max(thread_count, 1u)),
        known_(std::move(known)),
        out_(out) {}

  /// Sets decoded() and the counts.
  Result decode() {
    MCC_GLTF_TRY(findExtensionUses(document_, uses_));
    const std::vector<PayloadUse> uses = payloadUses(document_, uses_);
    MCC_GLTF_TRY(checkPayloadLengths(document_, uses));
    std::vector<DecodedPayload> payloads(uses.size());
    for (size_t i = 0; i < uses.size(); ++i) MCC_GLTF_TRY(open(uses[i], payloads[i]));
    MCC_GLTF_TRY(checkDecodedBytes(uses, payloads));
    // Decodes as many payloads at a time as there are threads, to limit the memory in use.
    for (size_t begin = 0; begin < uses.size(); begin += thread_count_) {
      const size_t count = std::min<size_t>(thread_count_, uses.size() - begin);
      ThreadBudget threads(thread_count_);
      const RunJobs run_jobs = runJobsOn(threads);
      MCC_GLTF_TRY(runParallel(count, threads, [&](size_t i) {
        DecodedPayload& payload = payloads[begin + i];
        if (!payload.pieces.empty()) return Result{};
        return decodePieces(whereOf(uses[begin + i]), payload, run_jobs);
      }));
      for (size_t i = begin; i < begin + count; ++i) {
        store(uses[i], payloads[i]);
        payloads[i] = {};
      }
    }
    out_.payload_count = static_cast<uint32_t>(uses.size());
    out_.primitive_count = static_cast<uint32_t>(uses_.size());
    return {};
  }

  DecodedAccessors& decoded() { return decoded_; }

  /// Removes the extension from the document, after decode().
  Result rebuild() {
    if (uses_.empty()) return {};
    out_.json = document_.json;
    Json& accessors = out_.json["accessors"];
    for (const DecodedAccessors::Filled& filled : decoded_.filled) {
      Json& accessor = accessors[filled.accessor];
      accessor.erase("byteOffset");
      accessor.erase("sparse");
      accessor["bufferView"] = kFirstNewView + filled.view;
    }
    Json& meshes = out_.json["meshes"];
    for (const ExtensionUse& use : uses_) {
      removeExtension(meshes[use.mesh]["primitives"][use.primitive]);
    }
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      removeExtensionName(out_.json, list, kExtensionName);
    }
    if (decode_to_ == DecodeTo::kIntegers) {
      storeIntegers(document_, out_.coded_attributes, out_.json, decoded_.views, out_.notes);
    }
    const ForeignReferences foreign = findForeignReferences(document_.json);
    return rebuildBuffers(document_, foreign, decoded_.views, out_.json, out_.bin);
  }

 private:
  /// Where the elements of an accessor come from, and how they are stored: payload, piece, whether
  /// it is a part, its number, component type, columns.
  using Origin = std::tuple<uint32_t, uint64_t, bool, uint64_t, ComponentType, uint32_t>;

  static std::string whereOf(const PayloadUse& use) { return use.users[0]->path + "/bufferView"; }

  Origin originOf(uint32_t payload, const ExtensionUse& use, bool is_part, uint64_t number,
                  uint32_t accessor) const {
    const Accessor& target = document_.accessors[accessor];
    return {payload, use.piece, is_part, number, target.component_type, target.columns};
  }

  /// Opens a payload. All counts must match the accessors before memory is taken for them. A known
  /// payload gets its pieces.
  Result open(const PayloadUse& use, DecodedPayload& decoded) {
    const std::span<const uint8_t> bytes = payloadBytes(document_, use.view);
    MCC_GLTF_TRY(toResult(decoded.payload.open(bytes), whereOf(use)));
    for (const ExtensionUse* user : use.users) {
      MCC_GLTF_TRY(checkAgainstPayload(document_, *user, decoded.payload.info()));
    }
    decoded.pieces = known_.take(bytes);
    return {};
  }

  Result checkDecodedBytes(const std::vector<PayloadUse>& uses,
                           const std::vector<DecodedPayload>& payloads) {
    DecodedBytes bytes = document_.decoded;
    for (const DecodedPayload& payload : payloads) {
      out_.decoded_bytes += outputBytes(payload.payload.info());
    }
    bytes.add(out_.decoded_bytes);
    if (decode_to_ == DecodeTo::kIntegers) addCopies(uses, bytes);
    return bytes.check();
  }

  /// Adds the bytes of accessors that get the same elements as another one. With integers each
  /// needs its own copy, because they may become different integers.
  void addCopies(const std::vector<PayloadUse>& uses, DecodedBytes& bytes) const {
    std::set<uint32_t> accessors;
    std::set<Origin> origins;
    for (const PayloadUse& use : uses) {
      for (const ExtensionUse* user : use.users) {
        for (const ExtensionUse::AttributeUse& attribute : user->attributes) {
          const Accessor& accessor = document_.accessors[attribute.accessor];
          const Origin origin = originOf(use.view, *user, false, attribute.id, attribute.accessor);
          const bool is_copy =
              accessors.insert(attribute.accessor).second && !origins.insert(origin).second;
          if (is_copy) bytes.add(accessor.count * accessor.elementBytes());
        }
      }
    }
  }

  void store(const PayloadUse& use, const DecodedPayload& decoded) {
    for (const ExtensionUse* user : use.users) {
      storeAttributes(use.view, *user, decoded);
      storeIndices(use.view, *user, decoded);
    }
    for (const PieceInfo& piece : decoded.payload.info().pieces) {
      out_.wedge_count += piece.wedge_count;
      for (const PartInfo& part : piece.parts) out_.triangle_count += part.triangle_count;
    }
  }

  /// Gives an accessor a view that already holds its elements. Returns false if there is none, and
  /// the accessor gets a new one.
  bool share(uint32_t accessor, const Origin& origin) {
    const auto [found, is_new] = views_.try_emplace(origin, decoded_.views.size());
    // Integers are made for each accessor separately.
    if (is_new || decode_to_ == DecodeTo::kIntegers) {
      decoded_.filled.push_back({accessor, decoded_.views.size()});
      decoded_.views.emplace_back();
      return false;
    }
    decoded_.filled.push_back({accessor, found->second});
    NewView& view = decoded_.views[found->second];
    const uint32_t stride = (document_.accessors[accessor].elementBytes() + 3) & ~3u;
    // glTF requires a stride where several vertex attributes share a view.
    if (view.target == kArrayBuffer) view.stride_bytes = stride;
    return true;
  }

  void storeAttributes(uint32_t payload, const ExtensionUse& use, const DecodedPayload& decoded) {
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      if (!stored_.insert(attribute.accessor).second) continue;
      const auto& attributes = decoded.payload.info().pieces[use.piece].attributes;
      AttributeInfo info = attributes[attribute.id];
      if (info.coding == AttributeCoding::kAlias) {
        const AttributeFormat format = info.format;
        info = attributes[info.alias_of];
        info.format = format;
      }
      out_.coded_attributes.emplace(attribute.accessor, info);
      const Origin origin = originOf(payload, use, false, attribute.id, attribute.accessor);
      if (share(attribute.accessor, origin)) continue;
      NewView& view = decoded_.views.back();
      view.target = kArrayBuffer;
      view.bytes = packElements(decoded.pieces[use.piece].attributes[attribute.id],
                                document_.accessors[attribute.accessor], true, view.stride_bytes);
    }
  }

  void storeIndices(uint32_t payload, const ExtensionUse& use, const DecodedPayload& decoded) {
    if (!stored_.insert(use.indices_accessor).second) return;
    const Origin origin = originOf(payload, use, true, use.part, use.indices_accessor);
    if (share(use.indices_accessor, origin)) return;
    const uint32_t bytes = componentBytes(document_.accessors[use.indices_accessor].component_type);
    NewView& view = decoded_.views.back();
    view.target = kElementArrayBuffer;
    const std::vector<uint32_t>& indices = decoded.pieces[use.piece].parts[use.part];
    view.bytes.reserve(bytes * indices.size());
    for (const uint32_t index : indices) {
      for (uint32_t i = 0; i < bytes; ++i)
        view.bytes.push_back(static_cast<uint8_t>(index >> 8 * i));
    }
  }

  static void removeExtension(Json& primitive) {
    primitive["extensions"].erase(kExtensionName);
    if (primitive["extensions"].empty()) primitive.erase("extensions");
  }

  const Document& document_;
  const DecodeTo decode_to_;
  const uint32_t thread_count_;
  DecodedPayloads known_;
  Decompressed& out_;
  std::set<uint32_t> stored_;
  std::vector<ExtensionUse> uses_;
  DecodedAccessors decoded_;
  std::map<Origin, size_t> views_;  ///< indices into decoded_.views
};

}  // namespace

Result decodeAccessors(const Document& document, DecodedAccessors& decoded) {
  Decompressed ignored;
  Decompressor decompressor(document, DecodeTo::kFloats, 1, {}, ignored);
  MCC_GLTF_TRY(decompressor.decode());
  decoded = std::move(decompressor.decoded());
  return {};
}

Result decompressDocument(const Document& document, Decompressed& decompressed, DecodeTo decode_to,
                          uint32_t thread_count, DecodedPayloads known) {
  decompressed = {};
  Decompressor decompressor(document, decode_to, thread_count, std::move(known), decompressed);
  MCC_GLTF_TRY(decompressor.decode());
  return decompressor.rebuild();
}

}  // namespace mcc::gltf
