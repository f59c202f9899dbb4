// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_DECODED_LIMIT_H_
#define MCC_DECODED_LIMIT_H_

#include <cstdint>

namespace mcc {

/// Returns how many bytes of decoded geometry a file may ask for: those of all its payloads, each
/// counted once, with all attributes and indices of 32 bits. A file that asks for more is
/// refused before memory is taken.
/// max_decoded_bytes  the caller's own limit. 0 means the default: 1024 for each byte of the file,
///                    but at least 256 MiB and at most 4 GiB. Real models take 20 to 45 bytes for
///                    each byte, smooth synthetic surfaces 320, a flat grid up to 10,000.
/// file_bytes         the size of the file with all its buffers.
constexpr uint64_t decodedLimit(uint64_t max_decoded_bytes, uint64_t file_bytes) {
  constexpr uint64_t kAlways = uint64_t{1} << 28;
  constexpr uint64_t kPerByte = 1024;
  constexpr uint64_t kMost = uint64_t{1} << 32;
  if (max_decoded_bytes != 0) return max_decoded_bytes;
  if (file_bytes >= kMost / kPerByte) return kMost;
  return file_bytes * kPerByte > kAlways ? file_bytes * kPerByte : kAlways;
}

}  // namespace mcc

#endif  // MCC_DECODED_LIMIT_H_
