// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/work_lock.h"

namespace mcc::gltf {

WorkLock::~WorkLock() {
  if (lock_ != system::kNoLock) system::closeLock(lock_, is_held_);
}

bool WorkLock::take(const std::filesystem::path& file) {
  lock_ = system::openLock(file);
  if (lock_ == system::kNoLock) return true;
  const system::LockOutcome outcome = system::tryLock(lock_, false);
  is_held_ = outcome == system::LockOutcome::kHeld;
  return outcome != system::LockOutcome::kBusy;
}

}  // namespace mcc::gltf
