// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Lists what has to be removed when a signal ends the process.
#ifndef MCC_HOST_TEMPORARY_FILES_H_
#define MCC_HOST_TEMPORARY_FILES_H_

#include <chrono>
#include <filesystem>
#include <mutex>
#include <vector>

namespace mcc::gltf {

/// The temporary files and new folders of all conversions in progress. Safe to share between
/// threads.
class TemporaryFiles {
 public:
  using Lock = std::unique_lock<std::recursive_timed_mutex>;

  /// Must be held while a file is created, and while several files get their names together, so
  /// that removeAll() sees either all of it or nothing.
  Lock lock() { return Lock(mutex_); }
  void add(const std::filesystem::path& path);
  void forget(const std::filesystem::path& path);

  /// Removes all files, and folders that are empty. As long as the returned lock is held, no other
  /// file appears and none gets its name, so keep it until the process ends.
  Lock removeAll();
  /// The same after a thread has failed while it may hold the lock. If the lock cannot be taken
  /// within `patience`, nothing is removed.
  Lock removeAllWithin(std::chrono::milliseconds patience);

 private:
  void removeThem();

  std::recursive_timed_mutex mutex_;
  std::vector<std::filesystem::path> paths_;
};

/// Returns the lock of `files`, or an empty lock if that is null.
inline TemporaryFiles::Lock lockOf(TemporaryFiles* files) {
  return files != nullptr ? files->lock() : TemporaryFiles::Lock();
}

}  // namespace mcc::gltf

#endif  // MCC_HOST_TEMPORARY_FILES_H_
