// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_RUN_JOBS_H_
#define MCC_RUN_JOBS_H_

#include <cstddef>
#include <functional>

#include "mcc/job_runner.h"

namespace mcc {

/// Calls job(0) … job(count - 1), in any order and possibly at the same time, and returns when all
/// have ended. It calls every job exactly once, and does not throw. Jobs do not throw. Jobs may
/// call the function again, also at the same time.
using RunJobs = std::function<void(size_t count, const std::function<void(size_t)>& job)>;

/// Returns a hook as the reader takes it. Borrows the hook; an empty one becomes an empty runner.
inline JobRunner runnerOf(const RunJobs& hook) {
  if (!hook) return {};
  return {[](void* user, size_t count, void (*job)(void* job_user, size_t index), void* job_user) {
            (*static_cast<const RunJobs*>(user))(count,
                                                 [=](size_t index) { job(job_user, index); });
          },
          const_cast<void*>(static_cast<const void*>(&hook))};
}

}  // namespace mcc

#endif  // MCC_RUN_JOBS_H_
