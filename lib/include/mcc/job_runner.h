// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_JOB_RUNNER_H_
#define MCC_JOB_RUNNER_H_

#include <cstddef>

namespace mcc {

/// Threads that the caller lends to the reader; RunJobs is the writer's counterpart. Plain
/// functions, because the reader takes no memory except from its allocator.
struct JobRunner {
  /// Calls job(job_user, 0) … job(job_user, count - 1), in any order and possibly at the same time,
  /// and returns when all have ended. It calls every job exactly once, and does not throw. Null:
  /// the reader runs its jobs on the calling thread.
  void (*run)(void* user, size_t count, void (*job)(void* job_user, size_t index),
              void* job_user) = nullptr;
  void* user = nullptr;
};

}  // namespace mcc

#endif  // MCC_JOB_RUNNER_H_
