// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if !defined(_WIN32)
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>

#include "host/system.h"
#include "host/text.h"

namespace mcc::gltf::system {
namespace {

FileIdentity identityOf(const struct stat& file) {
  return {static_cast<uint64_t>(file.st_dev), static_cast<uint64_t>(file.st_ino)};
}

}  // namespace

uint64_t processId() { return static_cast<uint64_t>(::getpid()); }

/// Knows "/dev/fd/3", "/dev/stdout", and so on.
std::optional<int> openStreamNamed(const std::filesystem::path& path) {
  const std::string name = path.lexically_normal().string();
  if (name == "/dev/stdin") return STDIN_FILENO;
  if (name == "/dev/stdout") return STDOUT_FILENO;
  if (name == "/dev/stderr") return STDERR_FILENO;
  const std::string own = "/proc/" + std::to_string(::getpid()) + "/fd/";
  for (const std::string_view folder :
       {std::string_view("/dev/fd/"), std::string_view("/proc/self/fd/"), std::string_view(own)}) {
    if (!name.starts_with(folder)) continue;
    const std::string digits = name.substr(folder.size());
    const bool is_number = !digits.empty() && digits.size() < 8 &&
                           digits.find_first_not_of("0123456789") == std::string::npos;
    if (is_number) return std::stoi(digits);
  }
  return std::nullopt;
}

int openToRead(const std::filesystem::path& path) {
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

int openInside(const std::filesystem::path& folder, const std::filesystem::path& relative) {
#if defined(O_PATH)
  constexpr int kFolder = O_PATH | O_DIRECTORY | O_CLOEXEC;  // which may be one without a list
#else
  constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
#endif
  constexpr int kFile = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  int file = ::open(folder.c_str(), kFolder);
  for (auto part = relative.begin(); file >= 0 && part != relative.end();) {
    const std::filesystem::path name = *part++;
    const int flags = (part == relative.end() ? kFile : kFolder) | O_NOFOLLOW;
    const int next = ::openat(file, name.c_str(), flags);
    const int failure = errno;
    ::close(file);
    errno = failure;
    file = next;
  }
  return file;
}

std::optional<uint64_t> sizeOfRegular(int file) {
  struct stat facts = {};
  if (::fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode)) return std::nullopt;
  return static_cast<uint64_t>(facts.st_size);
}

int openToWrite(const std::filesystem::path& path) {
  return ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
}

int createNew(const std::filesystem::path& path, bool only_owner) {
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, only_owner ? 0600 : 0666);
}

int duplicate(int file) { return ::fcntl(file, F_DUPFD_CLOEXEC, 0); }

ptrdiff_t readSome(int file, void* to, size_t byte_count) { return ::read(file, to, byte_count); }

ptrdiff_t writeSome(int file, const void* from, size_t byte_count) {
  return ::write(file, from, byte_count);
}

int flush(int file) {
  while (::fsync(file) != 0) {
    if (errno == EINTR) continue;
    // What fsync() reports of files that have nothing to wait for.
    return errno == EINVAL || errno == ENOTSUP || errno == EROFS ? 0 : -1;
  }
  return 0;
}

int flushFolder(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return errno == EACCES ? 0 : -1;
  const int failure = flush(file) == 0 ? 0 : errno;
  ::close(file);
  errno = failure;
  return failure == 0 ? 0 : -1;
}

int close(int file) { return ::close(file); }

void rename(const std::filesystem::path& from, const std::filesystem::path& to,
            std::error_code& code) {
  std::filesystem::rename(from, to, code);
}

void remove(const std::filesystem::path& path, std::error_code& code) {
  std::filesystem::remove(path, code);
}

std::optional<FileIdentity> identityOf(int file) {
  struct stat facts = {};
  if (::fstat(file, &facts) != 0) return std::nullopt;
  return identityOf(facts);
}

std::optional<FileIdentity> identityOf(const std::filesystem::path& path) {
  struct stat facts = {};
  if (::stat(path.c_str(), &facts) != 0) return std::nullopt;
  return identityOf(facts);
}

std::string nameKey(const std::filesystem::path& name) { return textOf(name); }

bool isCharacterDevice(int file) {
  struct stat facts = {};
  return ::fstat(file, &facts) == 0 && S_ISCHR(facts.st_mode);
}

bool mayWrite(const std::filesystem::path& path) {
  struct stat facts = {};
  const bool may_somebody = ::stat(path.c_str(), &facts) != 0 || (facts.st_mode & 0222) != 0;
  return may_somebody && ::access(path.c_str(), W_OK) == 0;
}

std::optional<Permissions> permissionsOf(const std::filesystem::path& path) {
  struct stat facts = {};
  if (::stat(path.c_str(), &facts) != 0) return std::nullopt;
  return Permissions{facts.st_uid, facts.st_gid, facts.st_mode & 0777};
}

void setPermissions(int file, const Permissions& older) {
  mode_t mode = older.mode;
  const bool has_group = ::fchown(file, older.user, older.group) == 0 ||
                         ::fchown(file, static_cast<uid_t>(-1), older.group) == 0;
  if (!has_group) mode = (mode & ~mode_t{070}) | (mode & (mode << 3) & mode_t{070});
  (void)::fchmod(file, mode);  // some file systems have no permissions
}

intptr_t openLock(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);  // NFS locks only what may be written
  if (file >= 0 || errno != EISDIR) return file;
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

LockOutcome tryLock(intptr_t lock) {
  if (::flock(static_cast<int>(lock), LOCK_EX | LOCK_NB) == 0) return LockOutcome::kHeld;
  const bool is_busy = errno == EWOULDBLOCK || errno == EINTR;
  return is_busy ? LockOutcome::kBusy : LockOutcome::kImpossible;
}

void closeLock(intptr_t lock, bool) { ::close(static_cast<int>(lock)); }

}  // namespace mcc::gltf::system
#endif
