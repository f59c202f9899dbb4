// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DECOMPRESS_DECOMPRESS_H_
#define MCC_GLTF_DECOMPRESS_DECOMPRESS_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gltf/base/payload.h"
#include "gltf/decompress/integer_accessors.h"
#include "gltf/document/extension_json.h"
#include "gltf/document/rebuild.h"
#include "mcc/glb.h"

namespace mcc::gltf {

struct Decompressed {
  Json json;
  std::vector<uint8_t> bin;
  uint32_t payload_count = 0;  ///< distinct payloads
  uint64_t decoded_bytes = 0;  ///< see outputBytes()
  uint32_t primitive_count = 0;
  uint64_t triangle_count = 0;
  uint64_t wedge_count = 0;
  CodedAttributes coded_attributes;
  std::vector<std::string> notes;
};

/// The elements of the accessors that payloads fill.
struct DecodedAccessors {
  struct Filled {
    uint32_t accessor = 0;
    size_t view = 0;  ///< index into `views`; accessors of the same elements share one
  };
  std::vector<Filled> filled;
  std::vector<NewView> views;
};

/// Decodes all payloads. Errors carry JSON paths. Safe for untrusted documents.
Result decodeAccessors(const Document& document, DecodedAccessors& decoded);

/// Replaces all payloads by ordinary accessors and removes the extension from the document. If
/// there is no payload in the document, `payload_count` is 0, and `json` and `bin` are not set.
/// decode_to     what quantised attributes become; with integers, `notes` names what stays float.
/// thread_count  the number of payloads decoded at the same time; the result does not depend on it.
/// known         payloads that need not be decoded again. Their memory is freed as they are used.
/// Errors carry JSON paths. It is an error when document.decoded is above its limit, which is
/// checked before memory is taken. Safe for untrusted documents.
Result decompressDocument(const Document& document, Decompressed& decompressed,
                          DecodeTo decode_to = DecodeTo::kFloats, uint32_t thread_count = 1,
                          DecodedPayloads known = {});

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_DECOMPRESS_H_
