// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_ERROR_H_
#define MCC_ERROR_H_

#include <cstdint>

namespace mcc {

/// What went wrong. The numbers never change: they are part of the C API and of the conformance
/// suite.                                                                                  [A.1.4]
enum class Error : uint32_t {
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

}  // namespace mcc

#endif  // MCC_ERROR_H_
