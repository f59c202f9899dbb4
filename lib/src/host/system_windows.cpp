// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(_WIN32)
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#include <windows.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <string>

#include "host/system.h"
#include "host/text.h"

namespace mcc::gltf::system {
namespace {

constexpr int kBytes = _O_BINARY | _O_NOINHERIT;
constexpr DWORD kSharesAll = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

int openWide(const std::filesystem::path& path, int flags) {
  int file = -1;
  const errno_t failure =
      ::_wsopen_s(&file, path.c_str(), flags | kBytes, _SH_DENYNO, _S_IREAD | _S_IWRITE);
  if (failure == 0) return file;
  errno = failure;  // which some versions of the C library do not set
  return -1;
}

/// Returns the number of the C library for an error of CreateFile().
int numberOf(DWORD failure) {
  switch (failure) {
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS: return EEXIST;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION: return EACCES;
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND: return ENOENT;
    case ERROR_DISK_FULL:
    case ERROR_HANDLE_DISK_FULL: return ENOSPC;
    case ERROR_WRITE_PROTECT: return EROFS;
    default: return EIO;
  }
}

HANDLE handleOf(int file) { return reinterpret_cast<HANDLE>(::_get_osfhandle(file)); }

/// Some file systems, such as those of a network, number all files 0.
std::optional<FileIdentity> identityOfHandle(HANDLE handle) {
  BY_HANDLE_FILE_INFORMATION facts = {};
  if (handle == INVALID_HANDLE_VALUE || ::GetFileInformationByHandle(handle, &facts) == 0)
    return std::nullopt;
  const uint64_t number = uint64_t{facts.nFileIndexHigh} << 32 | uint64_t{facts.nFileIndexLow};
  if (number == 0) return std::nullopt;
  return FileIdentity{facts.dwVolumeSerialNumber, number};
}

/// Tries again while another program has the file open.
template <typename Action>
void untilReleased(const std::error_code& code, Action action) {
  constexpr DWORD kLongestPause_ms = 64;
  constexpr DWORD kPatience_ms = 1000;
  DWORD pause_ms = 1;
  for (DWORD waited_ms = 0;; waited_ms += pause_ms) {
    action();
    if (code != std::errc::permission_denied || waited_ms >= kPatience_ms) return;
    ::Sleep(pause_ms);
    pause_ms = std::min(2 * pause_ms, kLongestPause_ms);
  }
}

/// Bytes in one call: the C library takes an unsigned int and returns an int.
unsigned chunkOf(size_t byte_count) {
  return static_cast<unsigned>(std::min<size_t>(byte_count, INT_MAX));
}

}  // namespace

uint64_t processId() { return ::GetCurrentProcessId(); }

/// Open streams have no names here.
std::optional<int> openStreamNamed(const std::filesystem::path&) { return std::nullopt; }

int openToRead(const std::filesystem::path& path) { return openWide(path, _O_RDONLY); }

int openInside(const std::filesystem::path& folder, const std::filesystem::path& relative) {
  return openWide(folder / relative, _O_RDONLY);
}

std::optional<uint64_t> sizeOfRegular(int file) {
  struct _stat64 facts = {};
  if (::_fstat64(file, &facts) != 0 || (facts.st_mode & _S_IFMT) != _S_IFREG) return std::nullopt;
  return static_cast<uint64_t>(facts.st_size);
}

int openToWrite(const std::filesystem::path& path) { return openWide(path, _O_WRONLY); }

/// New files inherit who may read them from their folder. Sharing the right to delete lets the
/// thread that handles Ctrl-C remove the file while it is open, which the C library does not offer.
int createNew(const std::filesystem::path& path, bool) {
  const HANDLE handle = ::CreateFileW(path.c_str(), GENERIC_WRITE, kSharesAll, nullptr, CREATE_NEW,
                                      FILE_ATTRIBUTE_NORMAL, nullptr);
  if (handle == INVALID_HANDLE_VALUE) {
    errno = numberOf(::GetLastError());
    return -1;
  }
  const int file = ::_open_osfhandle(reinterpret_cast<intptr_t>(handle), kBytes);
  if (file < 0) ::CloseHandle(handle);  // too many files are open; errno is set
  return file;
}

/// Open streams have no names, so nothing calls this. _dup() would make other programs inherit
/// them.
int duplicate(int) {
  errno = ENOTSUP;
  return -1;
}

ptrdiff_t readSome(int file, void* to, size_t byte_count) {
  return ::_read(file, to, chunkOf(byte_count));
}

ptrdiff_t writeSome(int file, const void* from, size_t byte_count) {
  return ::_write(file, from, chunkOf(byte_count));
}

/// _commit() would report EBADF whatever is wrong.
int flush(int file) {
  if (::FlushFileBuffers(handleOf(file)) != 0) return 0;
  const DWORD failure = ::GetLastError();
  if (failure == ERROR_INVALID_FUNCTION || failure == ERROR_NOT_SUPPORTED) return 0;
  errno = numberOf(failure);
  return -1;
}

/// Names are in the journal of the file system.
int flushFolder(const std::filesystem::path&) { return 0; }

int close(int file) { return ::_close(file); }

void rename(const std::filesystem::path& from, const std::filesystem::path& to,
            std::error_code& code) {
  untilReleased(code, [&]() { std::filesystem::rename(from, to, code); });
}

void remove(const std::filesystem::path& path, std::error_code& code) {
  untilReleased(code, [&]() { std::filesystem::remove(path, code); });
}

std::optional<FileIdentity> identityOf(int file) { return identityOfHandle(handleOf(file)); }

std::optional<FileIdentity> identityOf(const std::filesystem::path& path) {
  const HANDLE handle = ::CreateFileW(path.c_str(), 0, kSharesAll, nullptr, OPEN_EXISTING,
                                      FILE_FLAG_BACKUP_SEMANTICS, nullptr);  // also opens folders
  const std::optional<FileIdentity> identity = identityOfHandle(handle);
  if (handle != INVALID_HANDLE_VALUE) ::CloseHandle(handle);
  return identity;
}

/// The file system compares names in upper case, too.
std::string nameKey(const std::filesystem::path& name) {
  std::wstring key = name.native();
  const int size = static_cast<int>(key.size());  // of a path: less than 2^15
  if (size != 0) {
    ::LCMapStringEx(LOCALE_NAME_INVARIANT, LCMAP_UPPERCASE, name.c_str(), size, key.data(), size,
                    nullptr, nullptr, 0);
  }
  return textOf(key);
}

bool isCharacterDevice(int file) { return ::GetFileType(handleOf(file)) == FILE_TYPE_CHAR; }

/// The read-only attribute of a folder says nothing about the files in it.
bool mayWrite(const std::filesystem::path& path) {
  constexpr int kWrite = 2;
  std::error_code code;
  return std::filesystem::is_directory(path, code) || ::_waccess(path.c_str(), kWrite) == 0;
}

std::optional<Permissions> permissionsOf(const std::filesystem::path&) { return std::nullopt; }

void setPermissions(int, const Permissions&) {}

/// Folders cannot be locked here, so a mutex is named after the identity of the folder, for all
/// sessions of the machine. The system releases it when its process ends. A mutex of another user
/// cannot be opened, and the lock is then impossible.
intptr_t openLock(const std::filesystem::path& path) {
  const std::optional<FileIdentity> identity = identityOf(path);
  if (!identity) return kNoLock;
  const std::wstring name = L"Global\\gltf-mcc-" + std::to_wstring(identity->device) + L"-" +
                            std::to_wstring(identity->number);
  const HANDLE mutex = ::CreateMutexW(nullptr, FALSE, name.c_str());
  return mutex == nullptr ? kNoLock : reinterpret_cast<intptr_t>(mutex);
}

LockOutcome tryLock(intptr_t lock) {
  switch (::WaitForSingleObject(reinterpret_cast<HANDLE>(lock), 0)) {
    case WAIT_OBJECT_0:
    case WAIT_ABANDONED: return LockOutcome::kHeld;
    case WAIT_TIMEOUT: return LockOutcome::kBusy;
    default: return LockOutcome::kImpossible;
  }
}

void closeLock(intptr_t lock, bool is_held) {
  const HANDLE mutex = reinterpret_cast<HANDLE>(lock);
  if (is_held) ::ReleaseMutex(mutex);
  ::CloseHandle(mutex);
}

}  // namespace mcc::gltf::system
#endif
