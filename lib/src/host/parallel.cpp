// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "host/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <new>
#include <vector>

#include "host/text.h"

#if defined(__cpp_exceptions)
#include <thread>
#endif

namespace mcc::gltf {

#if defined(__cpp_exceptions)

Result guarded(const std::function<Result()>& function) {
  try {
    return printable(function());
  } catch (const std::bad_alloc&) {
    return error("", "there is not enough memory");
  } catch (const std::exception& exception) {
    return error("", std::string("internal error: ") + exception.what() + "; please report this");
  }
}

void runAll(size_t count, ThreadBudget& budget, const std::function<void(size_t)>& job) {
  std::atomic<size_t> next{0};
  const auto work = [&]() {
    for (size_t i = next++; i < count; i = next++) job(i);
  };
  // A thread gives its place back as soon as it finds no more jobs: others may still be running,
  // and can use it.
  const auto workAndLeave = [&]() {
    work();
    budget.giveBack();
  };
  std::vector<std::thread> threads;
  for (size_t i = 1; i < count && budget.take(); ++i) {
    try {
      threads.emplace_back(workAndLeave);
    } catch (const std::exception&) {  // the system has no more threads; continue with these
      budget.giveBack();
      break;
    }
  }
  work();
  for (std::thread& thread : threads) thread.join();
}

#else  // WebAssembly, which has no threads either

Result guarded(const std::function<Result()>& function) { return printable(function()); }

void runAll(size_t count, ThreadBudget&, const std::function<void(size_t)>& job) {
  for (size_t i = 0; i < count; ++i) job(i);
}

#endif

RunJobs runJobsOn(ThreadBudget& budget) {
  if (!budget.hasSpare()) return {};
  return [&budget](size_t count, const std::function<void(size_t)>& job) {
    runAll(count, budget, job);
  };
}

Result runParallel(size_t count, ThreadBudget& budget, const std::function<Result(size_t)>& job) {
  std::vector<Result> results(count);
  std::atomic<bool> has_failed{false};
  runAll(count, budget, [&](size_t i) {
    if (has_failed) return;
    results[i] = guarded([&]() { return job(i); });
    if (!results[i].ok()) has_failed = true;
  });
  for (Result& result : results) {
    if (!result.ok()) return std::move(result);
  }
  return {};
}

Result runParallel(size_t count, uint32_t thread_count, const std::function<Result(size_t)>& job) {
  ThreadBudget budget(thread_count);
  return runParallel(count, budget, job);
}

}  // namespace mcc::gltf
