// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads and checks the extension objects of primitives. Collects what is wrong with a document,
// rule by rule: readers need to know whether anything is, validators need all of it.
#ifndef MCC_GLTF_DOCUMENT_EXTENSION_USES_H_
#define MCC_GLTF_DOCUMENT_EXTENSION_USES_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/document/document.h"
#include "mcc/glb.h"
#include "mcc/reader.h"
#include "mcc/status.h"

namespace mcc::gltf {

/// A rule of the specification for documents.
struct Rule {
  const char* code;  ///< used in reports
  Severity severity = Severity::kError;
};

/// The comments name sections of the specification.
namespace rule {
/// It can be loaded: GLB, JSON, buffers, buffer views, accessors.
inline constexpr Rule kDocument{"INVALID_DOCUMENT"};
inline constexpr Rule kSchema{"SCHEMA_MISMATCH"};          ///< JSON Schema of the extension object
inline constexpr Rule kReference{"UNRESOLVED_REFERENCE"};  ///< buffer views and accessors exist
inline constexpr Rule kPayloadView{"INVALID_PAYLOAD_BUFFER_VIEW"};  ///< "bufferView", "Exclusions"
inline constexpr Rule kTwoCompressions{"COMPRESSED_TWICE"};         ///< "Exclusions"
inline constexpr Rule kManifold{"MANIFOLD_WITHOUT_ORDER"};          ///< "Exclusions"
/// "Restrictions", like the following rules up to kFilledTwice.
inline constexpr Rule kMode{"MODE_NOT_TRIANGLES"};
inline constexpr Rule kIndices{"INVALID_INDICES"};  ///< they exist, with a type of indices
/// Their type holds the number of wedges.
inline constexpr Rule kIndexRange{"INDEX_TYPE_TOO_NARROW"};
/// The primitive has the attribute.
inline constexpr Rule kAttributeName{"ATTRIBUTE_NOT_IN_PRIMITIVE"};
/// The extension object has as many morph targets as the primitive.
inline constexpr Rule kTargetCount{"TARGET_COUNT_MISMATCH"};
inline constexpr Rule kPiece{"INVALID_PIECE"};  ///< the piece exists and has wedges
inline constexpr Rule kPart{"INVALID_PART"};    ///< the part exists and has triangles
/// The piece has the attribute; POSITION is number 0.
inline constexpr Rule kAttributeNumber{"INVALID_ATTRIBUTE_NUMBER"};
inline constexpr Rule kCount{"COUNT_MISMATCH"};               ///< the count of an accessor
inline constexpr Rule kType{"TYPE_MISMATCH"};                 ///< the type of an accessor
inline constexpr Rule kSemantic{"SEMANTIC_MISMATCH"};         ///< semantic, set and morph target
inline constexpr Rule kFilledTwice{"ACCESSOR_FILLED_TWICE"};  ///< an accessor has one source
/// Only what is filled from the same source refers to an accessor.
inline constexpr Rule kUsedElsewhere{"ACCESSOR_USED_ELSEWHERE"};
inline constexpr Rule kBounds{"BOUNDS_MISMATCH"};                        ///< `min` and `max`
inline constexpr Rule kListedAsUsed{"EXTENSION_NOT_LISTED_AS_USED"};     ///< "Fallback", "Writers"
inline constexpr Rule kListedAsRequired{"EXTENSION_REQUIRED_MISMATCH"};  ///< "Fallback", "Writers"
inline constexpr Rule kFallbackForAll{"FALLBACK_INCOMPLETE"};            ///< "Fallback", "Writers"
inline constexpr Rule kFallbackElements{"FALLBACK_MISMATCH"};            ///< "Fallback", "Writers"
/// A fallback should be in a buffer of its own.
inline constexpr Rule kFallbackBuffer{"FALLBACK_IN_SHARED_BUFFER", Severity::kWarning};
/// The fallback could be loaded and compared.
inline constexpr Rule kFallbackLoaded{"FALLBACK_NOT_LOADED", Severity::kInfo};
/// The payload is not malformed; the code is that of its Error.
inline constexpr Rule kPayload{"PAYLOAD_MALFORMED"};
/// The payloads together are below the caller's limit, not a format rule.
inline constexpr Rule kDecodedBytes{"FILE_ABOVE_LIMIT"};
/// The payload's version is not newer than this reader.
inline constexpr Rule kMinorVersion{"PAYLOAD_MINOR_VERSION_UNKNOWN", Severity::kInfo};
/// Every attribute of a payload is used.
inline constexpr Rule kUnusedAttribute{"UNUSED_ATTRIBUTE", Severity::kWarning};
/// Every part and piece of a payload is used.
inline constexpr Rule kUnusedPart{"UNUSED_PART", Severity::kWarning};
/// The extension is not listed without being used.
inline constexpr Rule kUnusedExtension{"UNUSED_EXTENSION", Severity::kWarning};
/// Nothing else uses the buffer view of a payload.
inline constexpr Rule kSharedPayloadView{"PAYLOAD_BUFFER_VIEW_USED_ELSEWHERE", Severity::kWarning};
}  // namespace rule

struct Issue {
  Severity severity = Severity::kError;
  std::string code;
  Result what;
};

class Issues {
 public:
  /// All issues are counted, but only the first `max_kept` are kept.
  explicit Issues(size_t max_kept) : max_kept_(max_kept) {}

  template <typename... Parts>
  void add(const Rule& rule, std::string where, const Parts&... what) {
    add(rule, error(std::move(where), what...));
  }
  /// Adds an issue if a fallible call failed. Returns whether it succeeded.
  bool passes(const Rule& rule, const Result& result) {
    if (!result.ok()) add(rule, result);
    return result.ok();
  }
  /// Adds the issues of a part that was checked separately.
  void append(const Issues& other);
  /// Adds an error of the payload reader.
  void addPayloadError(const Status& status, const std::string& where);

  const std::vector<Issue>& kept() const { return kept_; }
  uint64_t count(Severity severity) const { return counts_[static_cast<size_t>(severity)]; }
  bool hasErrors() const { return count(Severity::kError) != 0; }
  /// Returns the first issue, or ok when there is none. Meant for rules whose violations are all
  /// errors.
  Result first() const { return kept_.empty() ? Result{} : kept_[0].what; }

 private:
  void add(const Rule& rule, Result what);

  size_t max_kept_;
  std::vector<Issue> kept_;
  uint64_t counts_[4] = {};
};

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
/// The same for the preview of a use, which must have one. Its counts are its own.
void checkPreview(const Document& document, const ExtensionUse& use, const PayloadInfo& info,
                  Issues& issues);
/// Checks all uses of a payload and stops at the first issue.
Result checkAgainstPayload(const Document& document, const PayloadUse& payload,
                           const PayloadInfo& info);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_EXTENSION_USES_H_
