// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DECOMPRESS_H_
#define MCC_GLTF_DECOMPRESS_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gltf/integer_accessors.h"
#include "gltf/issues.h"
#include "gltf/rebuild.h"
#include "mcc/gltf.h"

namespace mcc::gltf {

/// Our extension on one primitive, checked against the document but not yet against the payload. What is wrong in the
/// document is kNone, or left out of `attributes`.
struct ExtensionUse {
  uint32_t mesh = 0;
  uint32_t primitive = 0;
  uint32_t view = kNone;
  uint64_t piece = 0;
  uint64_t part = 0;
  bool has_numbers = true;  ///< false: `piece` or `part` is wrong
  uint32_t indices_accessor = kNone;
  struct AttributeUse {
    std::string name;
    uint32_t target = kNone;  ///< morph target, kNone: the base mesh
    uint64_t id = 0;          ///< attribute of the piece
    uint32_t accessor = 0;
    std::string path;  ///< of the id in the JSON
  };
  std::vector<AttributeUse> attributes;
  std::string path;  ///< of the extension object
};

/// Finds and checks the extension objects of all primitives, and who else refers to the accessors they fill. The second
/// form ends with the first issue.
void findExtensionUses(const Document& document, Issues& issues, std::vector<ExtensionUse>& uses);
Result findExtensionUses(const Document& document, std::vector<ExtensionUse>& uses);

/// Bytes of the buffer view that holds a payload.
std::span<const uint8_t> payloadBytes(const Document& document, uint32_t view);

/// Checks an extension object with `has_numbers` against the pieces of its payload: numbers, counts, types, semantics.
void checkAgainstPayload(const Document& document, const ExtensionUse& use, const PayloadInfo& info,
                         Issues& issues);
Result checkAgainstPayload(const Document& document, const ExtensionUse& use,
                           const PayloadInfo& info);

struct Decompressed {
  Json json;
  std::vector<uint8_t> bin;
  uint32_t payload_count = 0;
  uint32_t primitive_count = 0;
  uint64_t triangle_count = 0;
  uint64_t wedge_count = 0;
  CodedAttributes coded_attributes;
  std::vector<std::string> notes;
};

/// The elements of an accessor that a payload fills.
struct DecodedAccessor {
  uint32_t index = 0;
  NewView view;
};

/// Decodes all payloads. Errors carry JSON paths. Safe for untrusted documents.
Result decodeAccessors(const Document& document, std::vector<DecodedAccessor>& accessors);

/// Replaces all payloads by ordinary accessors and removes the extension from the document. With no
/// payload in the document `payload_count` is 0 and `json` and `bin` are not filled in.
/// decode_to     what quantised attributes become; with integers `notes` names what stays float.
/// thread_count  payloads decoded at the same time; the result does not depend on it.
/// Errors carry JSON paths. Safe for untrusted documents.
Result decompressDocument(const Document& document, Decompressed& decompressed,
                          DecodeTo decode_to = DecodeTo::kFloats, uint32_t thread_count = 1);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_H_
