// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Collects what is wrong with a document, rule by rule. Readers need to know whether anything is,
// validators need all of it.
#ifndef MCC_GLTF_BASE_ISSUES_H_
#define MCC_GLTF_BASE_ISSUES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gltf/base/result.h"
#include "mcc/glb.h"
#include "mcc/status.h"

namespace mcc::gltf {

/// The rules of the specification for documents. The comments name its sections; ruleName() returns
/// the code used in reports.
enum class Rule : uint8_t {
  kDocument,           ///< it can be loaded: GLB, JSON, buffers, buffer views, accessors
  kSchema,             ///< JSON Schema of the extension object
  kReference,          ///< buffer views and accessors exist
  kPayloadView,        ///< "bufferView", "Exclusions"
  kTwoCompressions,    ///< "Exclusions"
  kManifold,           ///< "Exclusions"
  kMode,               ///< "Restrictions", like the following rules up to kFilledTwice
  kIndices,            ///< they exist, with a type of indices
  kIndexRange,         ///< their type holds the number of wedges
  kAttributeName,      ///< the primitive has the attribute
  kTargetCount,        ///< the extension object has as many morph targets as the primitive
  kPiece,              ///< the piece exists and has wedges
  kPart,               ///< the part exists and has triangles
  kAttributeNumber,    ///< the piece has the attribute; POSITION is number 0
  kCount,              ///< the count of an accessor
  kType,               ///< the type of an accessor
  kSemantic,           ///< semantic, set and morph target
  kFilledTwice,        ///< an accessor has one source
  kUsedElsewhere,      ///< only what is filled from the same source refers to an accessor
  kBounds,             ///< `min` and `max`
  kListedAsUsed,       ///< "Fallback", "Writers"
  kListedAsRequired,   ///< "Fallback", "Writers"
  kFallbackForAll,     ///< "Fallback", "Writers"
  kFallbackElements,   ///< "Fallback", "Writers"
  kFallbackBuffer,     ///< a fallback should be in a buffer of its own
  kFallbackLoaded,     ///< the fallback could be loaded and compared
  kPayload,            ///< the payload is not malformed; the code is that of its Error
  kDecodedBytes,       ///< the payloads together are below the caller's limit, not a format rule
  kMinorVersion,       ///< the payload's version is not newer than this reader
  kUnusedAttribute,    ///< every attribute of a payload is used
  kUnusedPart,         ///< every part and piece of a payload is used
  kUnusedExtension,    ///< the extension is not listed without being used
  kSharedPayloadView,  ///< nothing else uses the buffer view of a payload
};

Severity severityOf(Rule rule);
/// Returns the code of a rule, such as "COUNT_MISMATCH".
const char* ruleName(Rule rule);
/// Returns the code of a malformed payload, such as "PAYLOAD_BAD_CHECKSUM".
const char* payloadErrorName(Error error);

struct Issue {
  Severity severity = Severity::kError;
  std::string code;
  Result what;
};

class Issues {
 public:
  /// All issues are counted, but only the first `max_kept` are kept.
  explicit Issues(size_t max_kept) : max_kept_(max_kept) {}

  void add(Rule rule, std::string where, std::string what) {
    add(rule, ruleName(rule), {std::move(where), std::move(what)});
  }
  /// Adds an issue if a fallible call failed. Returns whether it succeeded.
  bool passes(Rule rule, Result result) {
    if (!result.ok()) add(rule, ruleName(rule), result);
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
  void add(Rule rule, const char* code, Result what);

  size_t max_kept_;
  std::vector<Issue> kept_;
  uint64_t counts_[4] = {};
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_BASE_ISSUES_H_
