// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads and checks the extension objects of primitives.
#ifndef MCC_GLTF_DOCUMENT_EXTENSION_USES_H_
#define MCC_GLTF_DOCUMENT_EXTENSION_USES_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/document/document.h"
#include "gltf/document/issues.h"
#include "mcc/reader.h"

namespace mcc::gltf {

/// Where an object of the JSON says that the triangles of a part are.
struct PartUse {
  uint32_t view = kNone;
  uint64_t piece = 0;
  uint64_t part = 0;
  bool has_numbers = true;  ///< false: `piece` or `part` is wrong
  std::string path;         ///< JSON path of the object
};

/// The use of our extension by one primitive, checked against the document but not yet against the
/// payload. Numbers that are wrong in the document are kNone, or left out of `attributes`. The path
/// is that of the extension object.
struct ExtensionUse : PartUse {
  uint32_t mesh = 0;
  uint32_t primitive = 0;
  uint32_t indices_accessor = kNone;
  struct AttributeUse {
    std::string name;
    uint32_t target = kNone;  ///< morph target; kNone: the base mesh
    uint64_t id = 0;          ///< attribute of the piece
    uint32_t accessor = 0;
    std::string path;  ///< JSON path of the id
  };
  std::vector<AttributeUse> attributes;
  std::optional<PartUse> preview;  ///< fills no accessor; its attributes have the same numbers
  const Json* json = nullptr;      ///< the primitive, in the JSON of the document
};

/// Finds and checks the extension objects of all primitives, and checks who else refers to the
/// accessors they fill. The second form stops at the first issue.
void findExtensionUses(const Document& document, Issues& issues, std::vector<ExtensionUse>& uses);
Result findExtensionUses(const Document& document, std::vector<ExtensionUse>& uses);

/// The primitives that use one payload.
struct PayloadUse {
  uint32_t view = 0;  ///< the first buffer view with these bytes
  std::vector<const ExtensionUse*> users;
  std::vector<const ExtensionUse*> previewed;  ///< those whose preview it holds

  /// Returns the JSON path where it is named first.
  std::string where() const;
};

/// Returns the payloads of a document in the order of their buffer views. Views of the same bytes
/// hold the same payload. Uses without a view are left out. The result borrows `uses`.
std::vector<PayloadUse> payloadUses(const Document& document,
                                    const std::vector<ExtensionUse>& uses);

/// Checks that payloads do not overlap so much that together they are longer than all buffers.
/// Files have no reason to overlap them, and reading all of them could take very long.
Result checkPayloadLengths(const Document& document, const std::vector<PayloadUse>& payloads);

/// Returns the bytes of the buffer view that holds a payload.
std::span<const uint8_t> payloadBytes(const Document& document, uint32_t view);

/// Checks an extension object against the pieces of its payload: numbers, counts, types, semantics.
/// `has_numbers` of the use must be true.
void checkAgainstPayload(const Document& document, const ExtensionUse& use, const PayloadInfo& info,
                         Issues& issues);
Result checkAgainstPayload(const Document& document, const ExtensionUse& use,
                           const PayloadInfo& info);
/// The same for the preview of a use, which must have one. Its counts are its own.
void checkPreview(const Document& document, const ExtensionUse& use, const PayloadInfo& info,
                  Issues& issues);
/// Checks all uses of a payload and stops at the first issue.
Result checkAgainstPayload(const Document& document, const PayloadUse& payload,
                           const PayloadInfo& info);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_EXTENSION_USES_H_
