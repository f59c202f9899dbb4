// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/measure_blocks.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>

#include "bench/codecs.h"
#include "host/parallel.h"

namespace mcc::bench {
namespace {

constexpr uint32_t kEncodeRuns = 2;

/// Seconds that a piece of code takes on the clock, because several threads may run it.
template <class Code>
Outcome timed(double& least, const Code& code) {
  const auto start = std::chrono::steady_clock::now();
  if (Outcome done = code(); !done.ok()) return done;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  least = least == 0 ? passed.count() : std::min(least, passed.count());
  return {};
}

/// malloc and free, counted over all threads.
class SharedCount {
 public:
  Allocator allocator() {
    return {[](void* user, size_t bytes) { return static_cast<SharedCount*>(user)->take(bytes); },
            [](void* user, void* memory, size_t bytes) {
              static_cast<SharedCount*>(user)->live_ -= bytes;
              std::free(memory);
            },
            this};
  }
  uint64_t peakBytes() const { return peak_; }

 private:
  void* take(size_t bytes) {
    const uint64_t live = live_ += bytes;
    uint64_t peak = peak_;
    while (live > peak && !peak_.compare_exchange_weak(peak, live)) {
    }
    return std::malloc(bytes);
  }

  std::atomic<uint64_t> live_ = 0;
  std::atomic<uint64_t> peak_ = 0;
};

Outcome decodeAll(const EncodedFile& encoded, const Allocator& allocator, const RunJobs& run_jobs,
                  uint64_t& array_bytes) {
  array_bytes = 0;
  for (size_t i = 0; i < encoded.unitCount(); ++i) {
    DecodedUnit unit;
    if (Outcome done = decodeUnit(encoded, i, allocator, unit, run_jobs); !done.ok()) return done;
    array_bytes += unit.array_bytes;
  }
  return {};
}

Outcome measureSize(const Geometry& geometry, uint32_t run_count, BlocksFigures& figures,
                    uint64_t& array_bytes) {
  EncodedFile encoded;
  for (uint32_t threads = 1; threads <= kMostThreads; ++threads) {
    gltf::ThreadBudget budget(threads);
    const RunJobs run_jobs = gltf::runJobsOn(budget);
    for (uint32_t run = 0; run < kEncodeRuns; ++run) {
      encoded = {};
      Outcome done = timed(figures.encode_seconds[threads - 1], [&]() {
        return encodeOurs(geometry, {figures.block_triangles, run_jobs}, encoded);
      });
      if (!done.ok()) return done;
    }
    for (uint32_t run = 0; run < run_count; ++run) {
      Outcome done = timed(figures.decode_seconds[threads - 1],
                           [&]() { return decodeAll(encoded, {}, run_jobs, array_bytes); });
      if (!done.ok()) return done;
    }
    SharedCount count;
    if (Outcome done = decodeAll(encoded, count.allocator(), run_jobs, array_bytes); !done.ok())
      return done;
    figures.peak_bytes[threads - 1] = count.peakBytes();
  }
  figures.bytes = encoded.bytes();
  for (const EncodeResult& payload : encoded.payloads) figures.block_count += payload.block_count;
  return {};
}

}  // namespace

Outcome measureBlocks(const std::string& name, const Geometry& geometry,
                      const std::vector<uint32_t>& sizes, uint32_t run_count,
                      const std::function<void(const std::string&)>& progress,
                      BlocksOfFile& figures) {
  figures = {};
  figures.name = name;
  figures.triangle_count = geometry.triangle_count;
  progress(name + ": draco 5");
  EncodedFile draco;
  draco.codec = Codec::kDraco5;
  if (Outcome done = encodeFile(geometry, Codec::kDraco5, draco); !done.ok()) return done;
  for (uint32_t run = 0; run < run_count; ++run) {
    Outcome done = timed(figures.draco_decode_seconds, [&]() {
      uint64_t ignored = 0;
      return decodeAll(draco, {}, {}, ignored);
    });
    if (!done.ok()) return done;
  }
  for (const uint32_t size : sizes) {
    progress(name + (size == 0 ? ": no blocks" : ": blocks of " + std::to_string(size)));
    BlocksFigures& row = figures.sizes.emplace_back();
    row.block_triangles = size;
    if (Outcome done = measureSize(geometry, run_count, row, figures.array_bytes); !done.ok())
      return done;
  }
  return {};
}

}  // namespace mcc::bench
