// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Damaging payloads, and decoding what came of it under watch.
#ifndef MCC_TESTS_ROBUSTNESS_DAMAGE_H_
#define MCC_TESTS_ROBUSTNESS_DAMAGE_H_

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "mcc/reader.h"
#include "support/mesh_generators.h"

namespace mcc::test {

/// Makes the checksum fit the bytes.
void repairChecksum(std::vector<uint8_t>& payload);

/// Some damage: flipped bits, other bytes, moved, cut or inserted stretches, other numbers in the header.
/// `header_bytes` is where the streams begin in the intact payload. The checksum is not repaired.
std::vector<uint8_t> mutated(std::span<const uint8_t> payload, size_t header_bytes, Random& random);

/// How decoding ended, and what is wrong with that.
struct Outcome {
  Error error = Error::kOk;
  bool reached_decode = false;
  uint64_t finished_steps = 0;  ///< calls of DecodeOptions::progress
  uint64_t peak_bytes = 0;      ///< that the decoder held at a time
  uint64_t target_bytes = 0;    ///< that its caller took for the outputs
  std::string failure;  ///< "" for an error, or for a shape that is as valid as the reader promises
};

/// Opens and decodes. Checks: every index below wedge_count; octahedral normals of unit length; an error has a text;
/// memory linear in the claimed counts; everything given back to the allocator.
Outcome decodeDamaged(std::span<const uint8_t> payload);

/// Ends the process with a message when no call of step() has come for a minute: decoding hangs.
class Watchdog {
 public:
  Watchdog();
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  /// `payload` and `mutation` name what is decoded next.
  void step(uint64_t payload, uint64_t mutation) {
    payload_ = payload;
    mutation_ = mutation;
    ++steps_;
  }

 private:
  void watch();

  std::atomic<uint64_t> payload_{0};
  std::atomic<uint64_t> mutation_{0};
  std::atomic<uint64_t> steps_{0};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_ROBUSTNESS_DAMAGE_H_
