// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <new>
#include <thread>
#include <vector>

namespace mcc::gltf {

Result guarded(const std::function<Result()>& function) {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return error("", "there is not enough memory");
  } catch (const std::exception& exception) {
    return error("", std::string("internal error: ") + exception.what() + "; please report this");
  }
}

Result runParallel(size_t count, uint32_t thread_count, const std::function<Result(size_t)>& job) {
  std::vector<Result> results(count);
  std::atomic<size_t> next{0};
  std::atomic<bool> has_failed{false};
  const auto work = [&]() {
    for (size_t i = next++; i < count && !has_failed; i = next++) {
      results[i] = guarded([&]() { return job(i); });
      if (!results[i].ok()) has_failed = true;
    }
  };
  std::vector<std::thread> threads;
  const size_t extra = std::min<size_t>(std::max(thread_count, 1u), count);
  for (size_t i = 1; i < extra; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  for (Result& result : results) {
    if (!result.ok()) return std::move(result);
  }
  return {};
}

}  // namespace mcc::gltf
