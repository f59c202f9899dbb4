// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Payloads that no writer makes: as expensive to decode for their few bytes as the format allows.
#ifndef MCC_TESTS_ROBUSTNESS_FORGED_PAYLOAD_H_
#define MCC_TESTS_ROBUSTNESS_FORGED_PAYLOAD_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace mcc::test {

struct ForgedPayload {
  std::vector<uint8_t>
      bytes;  ///< valid, of at most as many bytes as were asked for; empty: none was found
  uint64_t elements = 0;    ///< the elements it claims, see elementsOf()
  uint64_t symbols = 0;     ///< decisions, tokens and raw bits that decoding it reads
  std::string description;  ///< flags, counts and codings
};

/// Makes one piece with random flags, attributes and decisions, and with so many decisions that the
/// claims come close to what `max_bytes` may claim. Nearly all decisions are those that the models
/// expect, and cost nothing. The same seed gives the same bytes.
ForgedPayload forgePayload(uint64_t seed, size_t max_bytes);

}  // namespace mcc::test

#endif  // MCC_TESTS_ROBUSTNESS_FORGED_PAYLOAD_H_
