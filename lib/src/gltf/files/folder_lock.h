// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Locks a folder, so that files that belong together change their names together.
#ifndef MCC_GLTF_FILES_FOLDER_LOCK_H_
#define MCC_GLTF_FILES_FOLDER_LOCK_H_

#include <cstdint>
#include <filesystem>
#include <memory>

namespace mcc::gltf {

/// An advisory lock on a folder itself, which leaves no file there. Among the programs and threads
/// that take it, either one holds it alone or several share it. The system releases it when the
/// process ends, in whatever way it ends. The thread that takes it must also release it.
///
/// It is held only while a few files are renamed or a document is read, so waiting for it is short.
/// A folder that another program keeps locked for its own purposes, or whose file system has no
/// such locks, must not stop us: after two seconds the work continues without the lock. Writers
/// therefore check at the end that their files are in place.
class FolderLock {
 public:
  enum class Kind : uint8_t { kShared, kAlone };

  FolderLock(const std::filesystem::path& folder, Kind kind);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool isHeld() const { return is_held_; }

 private:
  intptr_t lock_;  ///< of the system, see system.h
  bool is_held_ = false;
};

/// Takes a shared lock on the folder of a .gltf, which has other files. Returns null for documents
/// that are a single file.
std::unique_ptr<FolderLock> lockToRead(const std::filesystem::path& document);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILES_FOLDER_LOCK_H_
