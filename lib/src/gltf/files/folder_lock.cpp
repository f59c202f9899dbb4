// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <thread>

#include "gltf/document/package.h"
#include "gltf/files/file_io.h"

namespace mcc::gltf {

FolderLock::FolderLock(const std::filesystem::path& folder, Kind kind)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  using std::chrono::milliseconds;
  constexpr milliseconds kLongestPause(20);
  constexpr milliseconds kPatience(2000);
  const int operation = (kind == Kind::kAlone ? LOCK_EX : LOCK_SH) | LOCK_NB;
  milliseconds pause(1);
  for (milliseconds waited(0); folder_ >= 0 && waited < kPatience; waited += pause) {
    is_held_ = ::flock(folder_, operation) == 0;
    if (is_held_ || (errno != EWOULDBLOCK && errno != EINTR)) return;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, kLongestPause);
  }
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) ::close(folder_);
}

std::unique_ptr<FolderLock> lockToRead(const std::filesystem::path& document) {
  Container container;
  const bool has_more =
      containerOf(document.filename().string(), container).ok() && container.is_gltf;
  if (!has_more) return nullptr;
  return std::make_unique<FolderLock>(folderOf(document), FolderLock::Kind::kShared);
}

}  // namespace mcc::gltf
