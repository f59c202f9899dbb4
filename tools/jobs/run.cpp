// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "jobs/run.h"

#include <algorithm>
#include <mutex>

#include "host/parallel.h"

namespace mcc::jobs {
namespace {

using gltf::Result;

bool isUpToDate(uint32_t job, const Work& work, Record& record) {
  if (work.is_forced) return false;
  const std::optional<Json> made = record.findUpToDate(work.describe(job));
  return made && work.take(job, *made);
}

}  // namespace

Result runJobs(std::vector<uint32_t> jobs, const Work& work, Record& record) {
  // The last ones should be small, so that all threads end at about the same time.
  if (work.thread_count > 1) {
    std::stable_sort(jobs.begin(), jobs.end(),
                     [&](uint32_t a, uint32_t b) { return work.bytesOf(a) > work.bytesOf(b); });
  }
  std::mutex mutex;  // guards `done` and all that end() does
  size_t done = 0;
  return gltf::runParallel(jobs.size(), work.thread_count, [&](size_t i) -> Result {
    const uint32_t job = jobs[i];
    const Result made =
        gltf::guarded([&]() { return isUpToDate(job, work, record) ? Result{} : work.make(job); });
    const std::lock_guard lock(mutex);
    work.end(job, made, ++done);
    return {};
  });
}

std::string progressText(size_t done, size_t count) {
  constexpr size_t kWidth = 24;
  const size_t filled = count == 0 ? kWidth : kWidth * done / count;
  return "[" + std::string(filled, '#') + std::string(kWidth - filled, '-') + "] " +
         std::to_string(done) + " of " + std::to_string(count) + " files";
}

}  // namespace mcc::jobs
