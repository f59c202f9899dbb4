// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Damages the payloads of real models and repairs the checksum: decoding must give an error or a
// valid shape, in memory linear in the counts. Prints how many mutations reached each decoder. The
// next mutation always uses a payload that can reach the decoder which was reached least.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include "container/payload_header.h"
#include "format/predictors.h"
#include "gltf/decompress/decompress.h"
#include "gltf/files/file_io.h"
#include "mcc/glb.h"
#include "robustness/damage.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMutations = MCC_IS_SANITIZED ? 800 : 16000;
constexpr uint64_t kAtLeast = kMutations / 16;  ///< for each decoder
constexpr size_t kFileBytes = 700000;
constexpr size_t kPayloadBytes = 60000;

/// The decoders that run between one call of DecodeOptions::progress and the next.
using Step = std::vector<std::string>;

void addSteps(const PieceHeader& piece, AttributeInfos attributes, std::vector<Step>& steps) {
  steps.push_back({piece.hasPivots() ? "pivots" : "connectivity"});
  Step stitching;
  if (piece.hasCopies()) stitching.push_back("stitching");
  steps.push_back(stitching);
  if (piece.attribute_count != 0) steps.push_back({"positions"});
  Step triangles;
  if (piece.has(piece_flag::kSeams)) triangles.push_back("seams");
  if (piece.has(piece_flag::kListed)) triangles.push_back("further triangles");
  if (piece.part_count > 1) triangles.push_back("parts");
  if (piece.has(piece_flag::kTriangleOrder)) triangles.push_back("order of triangles");
  if (piece.has(piece_flag::kVertexOrder)) triangles.push_back("order of vertices");
  steps.push_back(triangles);
  for (uint32_t phase = 0; phase < kCodingPhases; ++phase) {
    for (uint32_t a = 1; a < piece.attribute_count; ++a) {
      if (codingPhase(attributes[a]) != phase) continue;
      const AttributeMethod method = methodOf(attributes, a);
      // An attribute that is coded with another one has a step, but no decoder.
      steps.push_back(isWithAnother(method) ? Step{} : Step{infoOf(method).name});
    }
  }
}

/// Returns the decoders that a payload's header calls for, in their order; empty when the header is
/// refused.
std::vector<Step> stepsOf(std::span<const uint8_t> payload) {
  PayloadHeader header{Allocator{}};
  std::vector<Step> steps;
  if (!parsePayload(payload, {}, header).ok()) return steps;
  for (size_t i = 0; i < header.pieces.size(); ++i) {
    const PieceHeader& piece = header.pieces[i];
    addSteps(piece, header.attributesOf(piece), steps);
  }
  return steps;
}

struct CorpusPayload {
  std::string name;
  std::vector<uint8_t> bytes;
  size_t header_bytes = 0;
  std::set<std::string> decoders;
};

void addPayloads(const std::string& name, const std::vector<uint8_t>& converted,
                 std::vector<CorpusPayload>& payloads) {
  gltf::Document document;
  std::vector<gltf::ExtensionUse> uses;
  ASSERT_TRUE(gltf::loadDocument(converted, nullptr, document).ok());
  ASSERT_TRUE(gltf::findExtensionUses(document, uses).ok());
  std::set<uint32_t> views;
  for (const gltf::ExtensionUse& use : uses) {
    const std::span<const uint8_t> bytes = gltf::payloadBytes(document, use.view);
    if (!views.insert(use.view).second || bytes.size() > kPayloadBytes) continue;
    CorpusPayload payload{name, {bytes.begin(), bytes.end()}, 0, {"header"}};
    Payload opened;
    ASSERT_TRUE(opened.open(payload.bytes).ok());
    payload.header_bytes = static_cast<size_t>(opened.info().header_bytes);
    for (const Step& step : stepsOf(payload.bytes)) {
      payload.decoders.insert(step.begin(), step.end());
    }
    payloads.push_back(std::move(payload));
  }
}

std::vector<CorpusPayload> corpusPayloads() {
  gltf::ConvertOptions quantized, lossless, ordered;
  lossless.lossless = true;
  ordered.keep_triangle_order = ordered.keep_vertex_order = true;
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(MCC_CORPUS_DIR, ignored)) {
    if (entry.path().extension() == ".glb" && fs::file_size(entry.path()) <= kFileBytes) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<CorpusPayload> payloads;
  for (const fs::path& file : files) {
    std::vector<uint8_t> source;
    EXPECT_TRUE(gltf::readFile(file, source).ok());
    for (const gltf::ConvertOptions* options : {&quantized, &lossless, &ordered}) {
      std::vector<uint8_t> converted;
      gltf::ConvertReport report;
      const gltf::Result result = gltf::convertGlb(source, *options, converted, report);
      EXPECT_EQ(result.message(), "") << file;
      if (result.ok()) addPayloads(file.filename().string(), converted, payloads);
    }
  }
  return payloads;
}

/// How often each decoder was reached.
class Reached {
 public:
  explicit Reached(const std::vector<CorpusPayload>& payloads) {
    for (const CorpusPayload& payload : payloads) {
      for (const std::string& decoder : payload.decoders) counts_[decoder] = 0;
    }
  }

  const std::string& least() const {
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    return std::min_element(counts_.begin(), counts_.end(), less)->first;
  }

  /// A decoder counts as reached when the one before it has finished. Where two share a step, the
  /// later one may have been reached without being counted.
  void add(std::span<const uint8_t> payload, const Outcome& outcome) {
    ++counts_["header"];
    if (!outcome.reached_decode) return;
    const std::vector<Step> steps = stepsOf(payload);
    std::set<std::string> reached;
    for (size_t i = 0; i < steps.size() && i <= outcome.finished_steps; ++i) {
      const bool is_through = i < outcome.finished_steps;
      const size_t count = is_through ? steps[i].size() : std::min<size_t>(steps[i].size(), 1);
      reached.insert(steps[i].begin(), steps[i].begin() + static_cast<std::ptrdiff_t>(count));
    }
    // Damage to a header may ask for a decoder that no payload of the corpus reaches.
    for (const std::string& decoder : reached) {
      const auto count = counts_.find(decoder);
      if (count != counts_.end()) ++count->second;
    }
  }

  const std::map<std::string, uint64_t>& counts() const { return counts_; }

 private:
  std::map<std::string, uint64_t> counts_;
};

TEST(CorpusDamage, MutationsWithAGoodChecksum) {
  const std::vector<CorpusPayload> payloads = corpusPayloads();
  if (payloads.empty()) GTEST_SKIP() << "no corpus in " << MCC_CORPUS_DIR;
  std::map<std::string, std::vector<size_t>> with;
  for (size_t p = 0; p < payloads.size(); ++p) {
    for (const std::string& decoder : payloads[p].decoders) with[decoder].push_back(p);
  }
  Reached reached(payloads);
  std::map<std::string, size_t> turns;
  std::map<Error, uint64_t> errors;
  double slowest_ms = 0;
  Watchdog watchdog;
  for (uint64_t i = 0; i < kMutations; ++i) {
    const std::string decoder = reached.least();
    const std::vector<size_t>& choice = with[decoder];
    const size_t p = choice[turns[decoder]++ % choice.size()];
    Random random(i);
    std::vector<uint8_t> damaged = mutated(payloads[p].bytes, payloads[p].header_bytes, random);
    repairChecksum(damaged);
    watchdog.step(p, i);
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = decodeDamaged(damaged);
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - begin;
    slowest_ms = std::max(slowest_ms, spent.count());
    ASSERT_EQ(outcome.failure, "") << payloads[p].name << ", mutation " << i;
    ++errors[outcome.error];
    reached.add(damaged, outcome);
  }
  std::printf("%llu mutations of %zu payloads, the slowest took %.0f ms\n",
              static_cast<unsigned long long>(kMutations), payloads.size(), slowest_ms);
  for (const auto& [decoder, times] : reached.counts()) {
    std::printf("%-20s %6llu\n", decoder.c_str(), static_cast<unsigned long long>(times));
    EXPECT_GE(times, kAtLeast) << decoder;
  }
  for (const auto& [error, times] : errors) {
    std::printf("error %-14d %6llu\n", static_cast<int>(error),
                static_cast<unsigned long long>(times));
  }
  EXPECT_GE(reached.counts().size(), 14u) << "the corpus has lost something";
}

}  // namespace
}  // namespace mcc::test
