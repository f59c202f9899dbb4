// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs independent jobs of the writer on the threads that its caller offers.
#ifndef MCC_BASE_ENC_JOBS_H_
#define MCC_BASE_ENC_JOBS_H_

#include <cstddef>
#include <vector>

#include "base/enc_exceptions.h"
#include "base/status.h"
#include "mcc/run_jobs.h"

namespace mcc {

/// Jobs may run at the same time, so each writes to a place of its own. Choices between their
/// results are made after all have ended, in the order of the jobs. That is why the bytes do not
/// depend on the number of threads.
class Jobs {
 public:
  /// Borrows the hook; an empty one runs the jobs in order.
  explicit Jobs(const RunJobs& hook) : hook_(hook) {}

  /// Runs job(0) … job(count - 1), which return void. Returns when all have ended. If jobs threw,
  /// the exception of the lowest one is thrown again.
  template <class Job>
  void run(size_t count, const Job& job) const {
    if (!hook_ || count < 2) {
      for (size_t i = 0; i < count; ++i) job(i);
      return;
    }
    std::vector<Thrown> thrown(count);
    hook_(count, [&](size_t i) noexcept { thrown[i].run([&]() { job(i); }); });
    for (const Thrown& of_job : thrown) of_job.rethrow();
  }

  /// Runs jobs that return a Status. Returns that of the lowest job that failed.
  template <class Job>
  Status tryAll(size_t count, const Job& job) const {
    std::vector<Status> statuses(count);
    run(count, [&](size_t i) { statuses[i] = job(i); });
    for (const Status& status : statuses) MCC_TRY(status);
    return {};
  }

 private:
  const RunJobs& hook_;
};

}  // namespace mcc

#endif  // MCC_BASE_ENC_JOBS_H_
