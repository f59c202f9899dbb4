// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_STATUS_H_
#define MCC_STATUS_H_

#include <cstdint>

#include "mcc/error.h"

namespace mcc {

/// Result of every fallible call. It is cheap to copy and owns nothing. `what` is a string literal
/// in plain English, "" on success; `offset_bytes` is the place in the payload when it is known,
/// else kNoOffset.
struct [[nodiscard]] Status {
  /// The offset of a status that has no known place in the payload.
  static constexpr uint64_t kNoOffset = ~uint64_t{0};

  Error error = Error::kOk;
  const char* what = "";
  uint64_t offset_bytes = kNoOffset;

  /// Whether the call succeeded.
  constexpr bool ok() const { return error == Error::kOk; }
};

/// Returns a status of failure. `what` must be a string literal.
constexpr Status fail(Error error, const char* what, uint64_t offset_bytes = Status::kNoOffset) {
  return Status{error, what, offset_bytes};
}

}  // namespace mcc

#endif  // MCC_STATUS_H_
