// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_HOST_PARALLEL_H_
#define MCC_HOST_PARALLEL_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "host/result.h"
#include "mcc/run_jobs.h"

namespace mcc::gltf {

/// Limits how many threads work at the same time, including those of nested calls. Safe to share
/// between threads.
class ThreadBudget {
 public:
  /// `thread_count` includes the thread that calls; 0 counts as 1.
  explicit ThreadBudget(uint32_t thread_count) : spare_(thread_count == 0 ? 0 : thread_count - 1) {}

  bool take() {
    uint32_t spare = spare_;
    while (spare != 0 && !spare_.compare_exchange_weak(spare, spare - 1)) {
    }
    return spare != 0;
  }
  void giveBack() { ++spare_; }
  bool hasSpare() const { return spare_ != 0; }

 private:
  std::atomic<uint32_t> spare_;
};

/// Runs job(0) … job(count - 1), which must not throw, on this thread and on as many others as the
/// budget has at this moment. Returns when all have ended.
void runAll(size_t count, ThreadBudget& budget, const std::function<void(size_t)>& job);

/// Returns runAll() as the codec's hook, which borrows the budget. It is empty for one thread.
RunJobs runJobsOn(ThreadBudget& budget);

/// Runs job(0) … job(count - 1) in the same way. Returns the error of the lowest job that failed;
/// jobs after it may or may not have run. Exceptions become errors.
Result runParallel(size_t count, ThreadBudget& budget, const std::function<Result(size_t)>& job);

/// Runs them on up to `thread_count` threads.
Result runParallel(size_t count, uint32_t thread_count, const std::function<Result(size_t)>& job);

/// Runs a function. An exception that leaves it (out of memory) becomes an error. Messages are made
/// printable().
Result guarded(const std::function<Result()>& function);

}  // namespace mcc::gltf

#endif  // MCC_HOST_PARALLEL_H_
