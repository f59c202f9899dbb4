// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Damages payloads, and watches how they are decoded.
#ifndef MCC_TESTS_ROBUSTNESS_DAMAGE_H_
#define MCC_TESTS_ROBUSTNESS_DAMAGE_H_

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "mcc/reader.h"
#include "support/mesh_generators.h"

namespace mcc::test {

/// Makes the checksum fit the bytes.
void repairChecksum(std::vector<uint8_t>& payload);

/// Damages bytes: flips bits, changes bytes, moves, cuts or inserts stretches, or changes numbers
/// in the header. `header_bytes` is where the streams begin in the intact payload. The checksum is
/// not repaired.
std::vector<uint8_t> mutated(std::span<const uint8_t> payload, size_t header_bytes, Random& random);

/// How decoding ended, and what was wrong with it.
struct Outcome {
  Error error = Error::kOk;
  bool reached_decode = false;
  uint64_t finished_steps = 0;  ///< calls of DecodeOptions::progress
  uint64_t peak_bytes = 0;      ///< the most that the decoder held at a time
  uint64_t target_bytes = 0;    ///< memory that its caller took for the outputs
  std::string failure;          ///< "" for an error, or for a shape as valid as the reader promises
};

/// Opens and decodes. Checks that every index is below wedge_count, octahedral normals have unit
/// length, an error has a text, memory is linear in the claimed counts, and everything was returned
/// to the allocator.
Outcome decodeDamaged(std::span<const uint8_t> payload);

/// Ends the process with a message when step() was not called for a minute, because decoding hangs.
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

/// The number in an environment variable, for longer runs by hand.
inline uint64_t fromEnvironment(const char* name, uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace mcc::test

#endif  // MCC_TESTS_ROBUSTNESS_DAMAGE_H_
