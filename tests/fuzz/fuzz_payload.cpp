// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a payload. Magic, version and checksum are repaired, so that decoding gets past
// them.
#include <algorithm>
#include <vector>

#include "container/payload_header.h"
#include "fuzz/byte_feed.h"
#include "robustness/damage.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace mcc;
  if (size > 1 << 16) return 0;
  std::vector<uint8_t> payload(data, data + size);
  if (size > kChecksummedFrom) {
    payload[0] = kMagic;
    payload[kVersionOffset] = kVersionMajor << 4 | kVersionMinor;
    test::repairChecksum(payload);
  }
  const test::Outcome outcome = test::decodeDamaged(payload);
  test::require(outcome.failure.empty(), outcome.failure);
  return 0;
}
