// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What is wrong with a document, rule by rule. Readers ask whether anything is, validators for all of it.
#ifndef MCC_GLTF_ISSUES_H_
#define MCC_GLTF_ISSUES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gltf/result.h"
#include "mcc/status.h"

namespace mcc::gltf {

/// What the specification asks of documents. The comments name its sections; ruleName() is the code in reports.
enum class Rule : uint8_t {
  kDocument,           ///< it can be loaded at all: GLB, JSON, buffers, buffer views, accessors
  kSchema,             ///< JSON Schema of the extension object
  kReference,          ///< buffer views and accessors exist
  kPayloadView,        ///< "bufferView", "Exclusions"
  kTwoCompressions,    ///< "Exclusions"
  kManifold,           ///< "Exclusions"
  kMode,               ///< "Restrictions", as far as kFilledTwice
  kIndices,            ///< they exist, with a type of indices
  kIndexRange,         ///< their type holds the number of wedges
  kAttributeName,      ///< the primitive has the attribute
  kTargetCount,        ///< as many morph targets
  kPiece,              ///< the piece exists and has wedges
  kPart,               ///< the part exists and has triangles
  kAttributeNumber,    ///< the piece has the attribute; POSITION is number 0
  kCount,              ///< of an accessor
  kType,               ///< of an accessor
  kSemantic,           ///< semantic, set and morph target
  kFilledTwice,        ///< an accessor has one source
  kUsedElsewhere,      ///< ... and only what is filled from there refers to it
  kBounds,             ///< `min` and `max`
  kListedAsUsed,       ///< "Fallback", "Writers"
  kListedAsRequired,   ///< the same
  kFallbackForAll,     ///< the same
  kFallbackElements,   ///< the same
  kFallbackBuffer,     ///< a fallback should be in a buffer of its own
  kFallbackLoaded,     ///< it could not be compared
  kPayload,            ///< the payload is not malformed; the code is that of its Error
  kDecodedBytes,       ///< no rule: the payloads of the file together are above the caller's limit
  kMinorVersion,       ///< of the payload: newer than this reader
  kUnusedAttribute,    ///< of the payload
  kUnusedPart,         ///< the same, and of pieces
  kUnusedExtension,    ///< listed, but not there
  kSharedPayloadView,  ///< nothing else is in the buffer view of a payload
};

Severity severityOf(Rule rule);
/// "COUNT_MISMATCH".
const char* ruleName(Rule rule);
/// The code of a malformed payload: "PAYLOAD_BAD_CHECKSUM".
const char* payloadErrorName(Error error);

struct Issue {
  Severity severity = Severity::kError;
  std::string code;
  Result what;
};

class Issues {
 public:
  /// All are counted, the first `max_kept` are kept.
  explicit Issues(size_t max_kept) : max_kept_(max_kept) {}

  void add(Rule rule, std::string where, std::string what) {
    add(rule, ruleName(rule), {std::move(where), std::move(what)});
  }
  /// Of a fallible call; returns whether it went well.
  bool passes(Rule rule, Result result) {
    if (!result.ok()) add(rule, ruleName(rule), result);
    return result.ok();
  }
  /// Those of a part that was looked at alone.
  void append(const Issues& other);
  /// Of the reader.
  void addPayloadError(const Status& status, const std::string& where);

  const std::vector<Issue>& kept() const { return kept_; }
  uint64_t count(Severity severity) const { return counts_[static_cast<size_t>(severity)]; }
  bool hasErrors() const { return count(Severity::kError) != 0; }
  /// The first issue; ok when there is none. Of rules that only errors violate.
  Result first() const { return kept_.empty() ? Result{} : kept_[0].what; }

 private:
  void add(Rule rule, const char* code, Result what);

  size_t max_kept_;
  std::vector<Issue> kept_;
  uint64_t counts_[4] = {};
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_ISSUES_H_
