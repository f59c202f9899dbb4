// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/folder_lock.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "gltf/base/path_text.h"
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "gltf/files/system.h"

namespace mcc::gltf {

FolderLock::FolderLock(const std::filesystem::path& folder, Kind kind)
    : lock_(system::openLock(folder)) {
  using std::chrono::milliseconds;
  constexpr milliseconds kLongestPause(20);
  constexpr milliseconds kPatience(2000);
  milliseconds pause(1);
  for (milliseconds waited(0); lock_ != system::kNoLock && waited < kPatience; waited += pause) {
    const system::LockOutcome outcome = system::tryLock(lock_, kind == Kind::kShared);
    is_held_ = outcome == system::LockOutcome::kHeld;
    if (outcome != system::LockOutcome::kBusy) return;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, kLongestPause);
  }
}

FolderLock::~FolderLock() {
  if (lock_ != system::kNoLock) system::closeLock(lock_, is_held_);
}

std::unique_ptr<FolderLock> lockToRead(const std::filesystem::path& document) {
  Container container;
  const bool has_more =
      containerOf(textOf(document.filename()), container).ok() && container.is_gltf;
  if (!has_more) return nullptr;
  return std::make_unique<FolderLock>(folderOf(document), FolderLock::Kind::kShared);
}

}  // namespace mcc::gltf
