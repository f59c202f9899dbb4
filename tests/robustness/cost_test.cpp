// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a payload may cost at most for its bytes, whatever it claims: 600 bytes may take 0.1 s and
// 50 MB. Counts that are proportional to time are bounded here instead of time. MCC_FORGED_PAYLOADS
// sets the number of payloads, MCC_FORGED_BYTES their size and MCC_FIRST_FORGED the first seed.
// With MCC_FORGED_TIMES the slowest payloads are printed, and the slowest one is written to that
// file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "robustness/damage.h"
#include "robustness/forged_payload.h"

namespace mcc::test {
namespace {

constexpr uint64_t kForged = 150;
constexpr uint64_t kForgedBytes = 100;
/// The promise: the work per byte is bounded. [A.2.6]
constexpr uint64_t kElementsPerByte = 1024;
constexpr uint64_t kMemoryPerByte = 50'000'000 / 600;
/// Decisions, tokens and raw bits: an element takes a few nanoseconds for each.
constexpr uint64_t kSymbolsPerElement = 4;

/// Counts faces, vertices, wedges and values that the reader walks over, independently of the
/// reader's own count.
uint64_t walkedOver(const PayloadInfo& info) {
  uint64_t count = 0;
  for (const PieceInfo& piece : info.pieces) {
    uint64_t triangles = 0;
    for (const PartInfo& part : piece.parts) triangles += part.triangle_count;
    count += triangles + piece.vertex_count + piece.wedge_count;
    for (const AttributeInfo& a : piece.attributes)
      count += triangles + uint64_t{piece.wedge_count} * a.format.component_count;
  }
  return count;
}

/// Prints the slowest payloads for a developer.
class Slowest {
 public:
  void note(uint64_t seed, const ForgedPayload& forged, const Outcome& outcome, double seconds) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "%.4f s, %.1f ns per element, seed %llu, %zu bytes, %llu symbols, %llu KB, error %d: ",
        seconds, 1e9 * seconds / static_cast<double>(forged.elements),
        static_cast<unsigned long long>(seed), forged.bytes.size(),
        static_cast<unsigned long long>(forged.symbols),
        static_cast<unsigned long long>((outcome.peak_bytes + outcome.target_bytes) >> 10),
        static_cast<int>(outcome.error));
    all_.push_back({seconds, text + forged.description, forged.bytes});
  }
  void print(const std::string& file) {
    std::sort(all_.begin(), all_.end(),
              [](const Entry& a, const Entry& b) { return a.seconds > b.seconds; });
    for (size_t i = 0; i < std::min<size_t>(all_.size(), 12); ++i)
      std::printf("%s\n", all_[i].text.c_str());
    if (all_.empty()) return;
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(all_[0].bytes.data()),
              static_cast<std::streamsize>(all_[0].bytes.size()));
  }

 private:
  struct Entry {
    double seconds;
    std::string text;
    std::vector<uint8_t> bytes;
  };
  std::vector<Entry> all_;
};

TEST(Cost, OfForgedPayloadsIsBoundedByTheirBytes) {
  const uint64_t count = fromEnvironment("MCC_FORGED_PAYLOADS", kForged);
  const uint64_t first = fromEnvironment("MCC_FIRST_FORGED", 0);
  const size_t max_bytes = fromEnvironment("MCC_FORGED_BYTES", kForgedBytes);
  const char* const times = std::getenv("MCC_FORGED_TIMES");
  Slowest slowest;
  uint64_t decoded = 0;
  uint64_t near_the_bound = 0;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    const ForgedPayload forged = forgePayload(seed, max_bytes);
    if (forged.bytes.empty()) continue;
    const uint64_t bytes = forged.bytes.size();
    ASSERT_LE(bytes, max_bytes);
    const std::clock_t before = std::clock();
    const Outcome outcome = decodeDamaged(forged.bytes);
    const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    ASSERT_EQ(outcome.failure, "") << "seed " << seed;
    Payload opened;
    if (!opened.open(forged.bytes).ok()) continue;
    EXPECT_LE(walkedOver(opened.info()), kElementsPerByte * bytes) << "seed " << seed;
    EXPECT_LE(outcome.peak_bytes + outcome.target_bytes, kMemoryPerByte * max_bytes)
        << "seed " << seed << ": " << forged.description;
    EXPECT_LE(forged.symbols, kSymbolsPerElement * kElementsPerByte * max_bytes)
        << "seed " << seed << ": " << forged.description;
    decoded += outcome.error == Error::kOk ? 1 : 0;
    near_the_bound += 10 * walkedOver(opened.info()) > 5 * kElementsPerByte * bytes ? 1 : 0;
    if (times != nullptr) slowest.note(seed, forged, outcome, seconds);
  }
  if (times != nullptr) slowest.print(times);
  std::printf("%llu decoded, %llu near the bound\n", static_cast<unsigned long long>(decoded),
              static_cast<unsigned long long>(near_the_bound));
  // Make sure that the payloads are useful: some are whole, and many come close to what they may
  // claim.
  EXPECT_GT(decoded, count / 20);
  EXPECT_GT(near_the_bound, count / 10);
}

}  // namespace
}  // namespace mcc::test
