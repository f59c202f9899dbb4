// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_STATUS_H_
#define MCC_STATUS_H_

#include <cstdint>

namespace mcc {

#if defined(MCC_COMPACT)
using ErrorNumber = uint32_t;  // a full register, which need not be narrowed after every call
#else
using ErrorNumber = uint8_t;
#endif

/// What went wrong. The numbers never change: they are part of the C API and of the conformance
/// suite.                                                                                  [A.1.4]
enum class Error : ErrorNumber {
  kOk = 0,
  kTruncated = 1,           ///< the payload ends inside a field or a stream
  kBadMagic = 2,            ///< the bytes are not a mesh collapse payload
  kUnsupportedVersion = 3,  ///< a version of the format this reader does not know
  kBadChecksum = 4,         ///< the CRC-32 does not match: the payload is damaged
  kBadHeader = 5,           ///< a header field has a value the format does not assign
  kBadConnectivity = 6,     ///< an operation that no mesh collapse code can contain here
  kBadStitch = 7,           ///< a reference to a vertex group that does not exist
  kBadAttribute = 8,        ///< an attribute stream that no writer produces
  kTrailingBytes = 9,       ///< bytes are left over after the last stream
  kLimit = 10,              ///< a count above the caller's limits or above the format's own
  kOutOfMemory = 11,        ///< the allocator returned null
  kBadArgument = 12,  ///< the caller's arguments contradict each other; the file is not at fault
  kCancelled = 13,    ///< the caller's progress callback asked to stop
};

#if defined(MCC_COMPACT)

/// Where code size matters (the WebAssembly decoder), a status is only its error, in a register.
struct [[nodiscard]] Status {
  Error error = Error::kOk;

  constexpr bool ok() const { return error == Error::kOk; }
};
constexpr Status fail(Error error, const char*, uint64_t = 0) { return Status{error}; }

#else

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

#endif

}  // namespace mcc

/// Returns early with the status of `expression` unless it is ok.
#define MCC_TRY(expression)                         \
  do {                                              \
    const ::mcc::Status mcc_status_ = (expression); \
    if (!mcc_status_.ok()) return mcc_status_;      \
  } while (false)

#endif  // MCC_STATUS_H_
