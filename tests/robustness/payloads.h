// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Payloads to damage. Every stage of the codec and both kinds of container occur in them.
#ifndef MCC_TESTS_ROBUSTNESS_PAYLOADS_H_
#define MCC_TESTS_ROBUSTNESS_PAYLOADS_H_

#include <cstdint>
#include <string>
#include <vector>

namespace mcc::test {

struct NamedPayload {
  std::string name;
  std::vector<uint8_t> bytes;
};

/// All payloads, made once.
const std::vector<NamedPayload>& robustnessPayloads();

}  // namespace mcc::test

#endif  // MCC_TESTS_ROBUSTNESS_PAYLOADS_H_
