// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_RUN_JOBS_H_
#define MCC_RUN_JOBS_H_

#include <cstddef>
#include <functional>

namespace mcc {

/// Calls job(0) … job(count - 1), in any order and possibly at the same time, and returns when all
/// have ended. It calls every job exactly once, and does not throw. Jobs do not throw. Jobs may
/// call the function again, also at the same time.
using RunJobs = std::function<void(size_t count, const std::function<void(size_t)>& job)>;

}  // namespace mcc

#endif  // MCC_RUN_JOBS_H_
