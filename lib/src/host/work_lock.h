// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Keeps two processes from doing the same work at the same time.
#ifndef MCC_HOST_WORK_LOCK_H_
#define MCC_HOST_WORK_LOCK_H_

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "host/system.h"

namespace mcc::gltf {

/// An advisory lock on a file or a folder that stands for the work, held for as long as this object
/// exists. It leaves no file there. The system releases it when the process ends, in whatever way
/// it ends. The thread that takes it must also release it.
class WorkLock {
 public:
  WorkLock() = default;
  ~WorkLock();
  WorkLock(const WorkLock&) = delete;
  WorkLock& operator=(const WorkLock&) = delete;

  /// Takes the lock. Returns false when another process holds it until the patience has ended, for
  /// whatever purpose. Where the file system has no locks, nothing can be known about others, and
  /// this returns true.
  bool take(const std::filesystem::path& path, std::chrono::milliseconds patience = {});
  bool isHeld() const { return is_held_; }

 private:
  intptr_t lock_ = system::kNoLock;
  bool is_held_ = false;
};

}  // namespace mcc::gltf

#endif  // MCC_HOST_WORK_LOCK_H_
