// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_JOBS_HASH_H_
#define MCC_JOBS_HASH_H_

#include <cstdint>
#include <string_view>

namespace mcc::jobs {

/// Returns a number of 64 bits for a text, the same on every machine: FNV-1a, and MurmurHash3's
/// last steps, so that all bits depend on all bytes.
constexpr uint64_t hashOf(std::string_view text) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3u;
  hash = (hash ^ (hash >> 33)) * 0xff51afd7ed558ccdu;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53u;
  return hash ^ (hash >> 33);
}

}  // namespace mcc::jobs

#endif  // MCC_JOBS_HASH_H_
