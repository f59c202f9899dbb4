// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "host/work_lock.h"

#include <algorithm>
#include <thread>

namespace mcc::gltf {

WorkLock::~WorkLock() {
  if (lock_ != system::kNoLock) system::closeLock(lock_, is_held_);
}

bool WorkLock::take(const std::filesystem::path& path, std::chrono::milliseconds patience) {
  using std::chrono::milliseconds;
  constexpr milliseconds kLongestPause(20);
  lock_ = system::openLock(path);
  if (lock_ == system::kNoLock) return true;
  milliseconds pause(1);
  system::LockOutcome outcome = system::tryLock(lock_);
  for (milliseconds waited(0); outcome == system::LockOutcome::kBusy && waited < patience;
       waited += pause) {
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, kLongestPause);
    outcome = system::tryLock(lock_);
  }
  is_held_ = outcome == system::LockOutcome::kHeld;
  return outcome != system::LockOutcome::kBusy;
}

}  // namespace mcc::gltf
