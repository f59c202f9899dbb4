// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/issues.h"

#include <algorithm>

#include "gltf/document/payload.h"

namespace mcc::gltf {

Severity severityOf(Rule rule) {
  switch (rule) {
    case Rule::kFallbackBuffer:
    case Rule::kUnusedAttribute:
    case Rule::kUnusedPart:
    case Rule::kUnusedExtension:
    case Rule::kSharedPayloadView: return Severity::kWarning;
    case Rule::kFallbackLoaded:
    case Rule::kMinorVersion: return Severity::kInfo;
    default: return Severity::kError;
  }
}

const char* ruleName(Rule rule) {
  switch (rule) {
    case Rule::kDocument: return "INVALID_DOCUMENT";
    case Rule::kSchema: return "SCHEMA_MISMATCH";
    case Rule::kReference: return "UNRESOLVED_REFERENCE";
    case Rule::kPayloadView: return "INVALID_PAYLOAD_BUFFER_VIEW";
    case Rule::kTwoCompressions: return "COMPRESSED_TWICE";
    case Rule::kManifold: return "MANIFOLD_WITHOUT_ORDER";
    case Rule::kMode: return "MODE_NOT_TRIANGLES";
    case Rule::kIndices: return "INVALID_INDICES";
    case Rule::kIndexRange: return "INDEX_TYPE_TOO_NARROW";
    case Rule::kAttributeName: return "ATTRIBUTE_NOT_IN_PRIMITIVE";
    case Rule::kTargetCount: return "TARGET_COUNT_MISMATCH";
    case Rule::kPiece: return "INVALID_PIECE";
    case Rule::kPart: return "INVALID_PART";
    case Rule::kAttributeNumber: return "INVALID_ATTRIBUTE_NUMBER";
    case Rule::kCount: return "COUNT_MISMATCH";
    case Rule::kType: return "TYPE_MISMATCH";
    case Rule::kSemantic: return "SEMANTIC_MISMATCH";
    case Rule::kFilledTwice: return "ACCESSOR_FILLED_TWICE";
    case Rule::kUsedElsewhere: return "ACCESSOR_USED_ELSEWHERE";
    case Rule::kBounds: return "BOUNDS_MISMATCH";
    case Rule::kListedAsUsed: return "EXTENSION_NOT_LISTED_AS_USED";
    case Rule::kListedAsRequired: return "EXTENSION_REQUIRED_MISMATCH";
    case Rule::kFallbackForAll: return "FALLBACK_INCOMPLETE";
    case Rule::kFallbackElements: return "FALLBACK_MISMATCH";
    case Rule::kFallbackBuffer: return "FALLBACK_IN_SHARED_BUFFER";
    case Rule::kFallbackLoaded: return "FALLBACK_NOT_LOADED";
    case Rule::kPayload: return "PAYLOAD_MALFORMED";
    case Rule::kDecodedBytes: return "FILE_ABOVE_LIMIT";
    case Rule::kMinorVersion: return "PAYLOAD_MINOR_VERSION_UNKNOWN";
    case Rule::kUnusedAttribute: return "UNUSED_ATTRIBUTE";
    case Rule::kUnusedPart: return "UNUSED_PART";
    case Rule::kUnusedExtension: return "UNUSED_EXTENSION";
    case Rule::kSharedPayloadView: return "PAYLOAD_BUFFER_VIEW_USED_ELSEWHERE";
  }
  return "";
}

const char* payloadErrorName(Error error) {
  switch (error) {
    case Error::kTruncated: return "PAYLOAD_TRUNCATED";
    case Error::kBadMagic: return "PAYLOAD_BAD_MAGIC";
    case Error::kUnsupportedVersion: return "PAYLOAD_UNSUPPORTED_VERSION";
    case Error::kBadChecksum: return "PAYLOAD_BAD_CHECKSUM";
    case Error::kBadHeader: return "PAYLOAD_BAD_HEADER";
    case Error::kBadConnectivity: return "PAYLOAD_BAD_CONNECTIVITY";
    case Error::kBadStitch: return "PAYLOAD_BAD_STITCH";
    case Error::kBadAttribute: return "PAYLOAD_BAD_ATTRIBUTE";
    case Error::kTrailingBytes: return "PAYLOAD_TRAILING_BYTES";
    case Error::kLimit: return "PAYLOAD_ABOVE_LIMIT";
    default: return ruleName(Rule::kPayload);  // out of memory, which is not the file's fault
  }
}

void Issues::addPayloadError(const Status& status, const std::string& where) {
  add(Rule::kPayload, payloadErrorName(status.error), toResult(status, where));
}

void Issues::append(const Issues& other) {
  for (size_t i = 0; i < std::size(counts_); ++i) counts_[i] += other.counts_[i];
  const size_t room = std::min(max_kept_ - kept_.size(), other.kept_.size());
  kept_.insert(kept_.end(), other.kept_.begin(),
               other.kept_.begin() + static_cast<std::ptrdiff_t>(room));
}

void Issues::add(Rule rule, const char* code, Result what) {
  const Severity severity = severityOf(rule);
  ++counts_[static_cast<size_t>(severity)];
  if (kept_.size() < max_kept_) kept_.push_back({severity, code, std::move(what)});
}

}  // namespace mcc::gltf
