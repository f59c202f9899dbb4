// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What reading and replacing files needs of the system and the C++ standard library does not have.
// system_posix.cpp and system_windows.cpp implement it; nothing else in gltf/ depends on the
// system.
#ifndef MCC_HOST_SYSTEM_H_
#define MCC_HOST_SYSTEM_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace mcc::gltf {

/// Identifies a file independently of its names.
struct FileIdentity {
  uint64_t device = 0;
  uint64_t number = 0;

  bool operator==(const FileIdentity&) const = default;
};

namespace system {

/// Returns a number that no other running process has.
uint64_t processId();

/// Returns the number of the open stream of this process that a name stands for: 1 for /dev/stdout.
std::optional<int> openStreamNamed(const std::filesystem::path& path);

// Open files are descriptors of the C library, without any translation of their bytes. They are not
// inherited by other programs. Functions that return -1 have set errno.

int openToRead(const std::filesystem::path& path);
/// Opens a file below a folder without following any link on the way, and without waiting for what
/// is at its end. On Windows, links are followed.
int openInside(const std::filesystem::path& folder, const std::filesystem::path& relative);
/// Returns the size of an open file. Empty if it is not a regular file.
std::optional<uint64_t> sizeOfRegular(int file);
/// Opens something that exists and is not replaced, such as a device.
int openToWrite(const std::filesystem::path& path);
/// Creates a file; fails with EEXIST if there is one. `only_owner`: no other user may read it.
int createNew(const std::filesystem::path& path, bool only_owner);
/// Fails with ENOTSUP where openStreamNamed() knows no names.
int duplicate(int file);
ptrdiff_t readSome(int file, void* to, size_t byte_count);
ptrdiff_t writeSome(int file, const void* from, size_t byte_count);
/// Waits until what was written is stored. Every failure means that it is not: EIO, but also ENOSPC
/// and EDQUOT, where a file system finds room only when it stores. Succeeds on file systems that
/// have no such wait.
int flush(int file);
/// The same for the names in a folder. Succeeds if the folder may be written but not listed, since
/// it cannot be opened then.
int flushFolder(const std::filesystem::path& folder);
int close(int file);

/// Like the functions of std::filesystem. Where a file that somebody is reading cannot be replaced
/// or removed, they try again for a second: other programs, such as scanners for viruses, read new
/// files at once.
void rename(const std::filesystem::path& from, const std::filesystem::path& to,
            std::error_code& code);
void remove(const std::filesystem::path& path, std::error_code& code);

/// Returns the identity of an open file, or of the file at a path. Empty if there is no file, or if
/// its file system does not number files.
std::optional<FileIdentity> identityOf(int file);
std::optional<FileIdentity> identityOf(const std::filesystem::path& path);

/// Returns a text that is equal for all spellings of one name: on Windows, upper and lower case are
/// the same. `name` may have several parts.
std::string nameKey(const std::filesystem::path& name);
bool isCharacterDevice(int file);

/// Whether this process may write a file or into a folder, as far as that is known before trying.
/// False if nobody has permission to, even for users who would not need it.
bool mayWrite(const std::filesystem::path& path);

/// Who may do what with a file.
struct Permissions {
  uint32_t user = 0;
  uint32_t group = 0;
  uint32_t mode = 0;
};
/// Returns those of a file. Empty if there is none, and where new files get theirs from the folder.
std::optional<Permissions> permissionsOf(const std::filesystem::path& path);
/// Gives a new file the owner, the group and the permissions of an older one, as far as the process
/// may set them. If the group cannot be set, the group gets no more permissions than all other
/// users have, so that nobody can read what was hidden from them.
void setPermissions(int file, const Permissions& older);

/// An advisory lock on a folder or a file; see WorkLock for what it promises. It belongs to the
/// thread that took it, which must close it; on Windows that thread may take another lock on the
/// same folder or file.
enum class LockOutcome : uint8_t { kHeld, kBusy, kImpossible };
inline constexpr intptr_t kNoLock = -1;
intptr_t openLock(const std::filesystem::path& path);
/// Does not wait.
LockOutcome tryLock(intptr_t lock);
void closeLock(intptr_t lock, bool is_held);

}  // namespace system
}  // namespace mcc::gltf

#endif  // MCC_HOST_SYSTEM_H_
