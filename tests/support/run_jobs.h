// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Ways to run jobs, for RunJobs: what comes out must not depend on them.
#ifndef MCC_TESTS_SUPPORT_RUN_JOBS_H_
#define MCC_TESTS_SUPPORT_RUN_JOBS_H_

#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace mcc::test {

inline void runForwards(size_t count, const std::function<void(size_t)>& job) {
  for (size_t i = 0; i < count; ++i) job(i);
}

inline void runBackwards(size_t count, const std::function<void(size_t)>& job) {
  while (count-- != 0) job(count);
}

/// Four threads share the jobs.
inline void runOnThreads(size_t count, const std::function<void(size_t)>& job) {
  std::atomic<size_t> next{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (size_t i = next++; i < count; i = next++) job(i);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_RUN_JOBS_H_
