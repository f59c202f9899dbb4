// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a process that is ended from outside has to clear away.
#ifndef MCC_GLTF_TEMPORARY_FILES_H_
#define MCC_GLTF_TEMPORARY_FILES_H_

#include <chrono>
#include <filesystem>
#include <mutex>
#include <vector>

namespace mcc::gltf {

/// The temporary files and new folders of the conversions that are going on. Safe to share between threads.
class TemporaryFiles {
 public:
  using Lock = std::unique_lock<std::recursive_timed_mutex>;

  /// Held while a file appears, and while several get their names together: removeAll() sees all of it or nothing.
  Lock lock() { return Lock(mutex_); }
  void add(const std::filesystem::path& path);
  void forget(const std::filesystem::path& path);

  /// Removes them all, new folders where they are empty. As long as the lock is held no other file appears and none gets
  /// its name: keep it until the process ends.
  Lock removeAll();
  /// The same when a thread has failed, which may hold the lock: without it after so long nothing is removed.
  Lock removeAllWithin(std::chrono::milliseconds patience);

 private:
  void removeThem();

  std::recursive_timed_mutex mutex_;
  std::vector<std::filesystem::path> paths_;
};

/// An empty lock where there are no files to be told of.
inline TemporaryFiles::Lock lockOf(TemporaryFiles* files) {
  return files != nullptr ? files->lock() : TemporaryFiles::Lock();
}

}  // namespace mcc::gltf

#endif  // MCC_GLTF_TEMPORARY_FILES_H_
