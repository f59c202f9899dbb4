// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Does jobs that each make a file, for commands that make many.
#ifndef MCC_JOBS_RUN_H_
#define MCC_JOBS_RUN_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "jobs/record.h"

namespace mcc::jobs {

/// What a command does with its jobs, which it knows by numbers of its own. take() and make() are
/// called in parallel, end() is not.
struct Work {
  std::function<uint64_t(uint32_t)> bytesOf;  ///< of its input
  std::function<Job(uint32_t)> describe;
  /// Takes over what an earlier run recorded. Returns false when it makes no sense.
  std::function<bool(uint32_t, const Json&)> take;
  std::function<gltf::Result(uint32_t)> make;
  /// Is told how a job has ended, and that so many have.
  std::function<void(uint32_t, const gltf::Result&, size_t)> end;
  uint32_t thread_count = 1;  ///< jobs at the same time; the results do not depend on it
  bool is_forced = false;     ///< also makes what is up to date
};

/// Does the jobs: one thread in their order, several begin with the largest, because they take
/// longest; the first ones are then also the most memory that is ever needed. A job that fails does
/// not stop the others. Errors: not all jobs were done, as there is no memory.
gltf::Result runJobs(std::vector<uint32_t> jobs, const Work& work, Record& record);

/// Returns "[####----] 1 of 2 files".
std::string progressText(size_t done, size_t count);

}  // namespace mcc::jobs

#endif  // MCC_JOBS_RUN_H_
