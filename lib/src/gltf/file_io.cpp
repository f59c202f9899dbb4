// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/file_io.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace mcc::gltf {
namespace {

namespace fs = std::filesystem;

std::string reasonOf(int number) { return std::strerror(number); }

/// A name beside the destination that no other process or thread of ours uses.
fs::path temporaryName(const fs::path& destination) {
  static std::atomic<uint32_t> counter{0};
  fs::path name = destination.filename();
  name += ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
  return destination.parent_path() / ("." + name.string());
}

/// Without any permission to write, also for a user who needs none.
bool isReadOnly(const fs::path& path) {
  std::error_code code;
  const fs::perms write = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  const fs::perms permissions = fs::status(path, code).permissions();
  return (permissions & write) == fs::perms::none || ::access(path.c_str(), W_OK) != 0;
}

Result tooLarge(const std::string& name) {
  return error(name, "has more than the " + std::to_string(kMaxFileBytes) +
                         " bytes that a file of glTF can have");
}

/// How far to read what begins with these bytes; more than there are: on.
uint64_t wantedBytes(std::span<const uint8_t> bytes) {
  constexpr size_t kGlbHeaderBytes = 12;
  constexpr size_t kWhiteSpaceBytes = 65536;  // in front of JSON; nobody writes more
  if (bytes.size() < kGlbHeaderBytes) return kGlbHeaderBytes;
  if (isGlb(bytes)) return uint64_t{glbLength(bytes)} + 1;  // whether there are trailing bytes
  if (isJsonText(bytes.first(std::min(bytes.size(), kWhiteSpaceBytes)))) return kMaxFileBytes + 1;
  return kWhiteSpaceBytes;
}

Result readRegularFile(int file, const fs::path& path, std::vector<uint8_t>& bytes) {
  std::error_code code;
  const uintmax_t size = fs::file_size(path, code);
  if (code) return error(path.string(), "cannot be read: " + code.message());
  if (size > kMaxFileBytes) return tooLarge(path.string());
  bytes.resize(size);
  size_t done = 0;
  while (done < size) {
    const ssize_t count = ::read(file, bytes.data() + done, size - done);
    if (count == 0 || (count < 0 && errno != EINTR)) {
      return error(path.string(), "cannot be read to its end");
    }
    done += count > 0 ? static_cast<size_t>(count) : 0;
  }
  return {};
}

}  // namespace

fs::path folderOf(const fs::path& path) {
  return path.parent_path().empty() ? fs::path(".") : path.parent_path();
}

Result inFile(const fs::path& path, Result result) {
  if (result.ok()) return result;
  result.where = result.where.empty() ? path.string() : path.string() + ": " + result.where;
  return result;
}

Result readStream(int file, const std::string& name, std::vector<uint8_t>& bytes) {
  constexpr size_t kReadBytes = size_t{1} << 18;
  bytes.clear();
  while (bytes.size() < wantedBytes(bytes)) {
    const size_t size = bytes.size();
    bytes.resize(size + kReadBytes);
    const ssize_t count = ::read(file, bytes.data() + size, kReadBytes);
    bytes.resize(size + (count > 0 ? static_cast<size_t>(count) : 0));
    if (count == 0) return {};
    if (count < 0 && errno != EINTR) return error(name, "cannot be read: " + reasonOf(errno));
  }
  return bytes.size() <= kMaxFileBytes ? Result{} : tooLarge(name);
}

Result readFile(const fs::path& path, std::vector<uint8_t>& bytes) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return error(path.string(), "there is no such file");
  if (fs::is_directory(status)) return error(path.string(), "is a folder; name a file in it");
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return error(path.string(), "cannot be opened: " + reasonOf(errno));
  Result result = fs::is_regular_file(status) ? readRegularFile(file, path, bytes)
                                              : readStream(file, path.string(), bytes);
  ::close(file);
  return result;
}

bool haveSameContent(const fs::path& a, const fs::path& b) {
  std::vector<uint8_t> bytes_of_a;
  std::vector<uint8_t> bytes_of_b;
  return readFile(a, bytes_of_a).ok() && readFile(b, bytes_of_b).ok() && bytes_of_a == bytes_of_b;
}

FileReader readerOf(const fs::path& folder) {
  return [folder](const std::string& path, const std::string& where, std::vector<uint8_t>& bytes) {
    std::error_code code;
    const fs::file_status status = fs::status(folder / path, code);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
      return error(where, "\"" + path + "\": is not a regular file");
    }
    Result result = readFile(folder / path, bytes);
    if (!result.ok()) return error(where, "\"" + path + "\": " + result.what);
    return result;
  };
}

ReplacementFile::ReplacementFile(fs::path destination, TemporaryFiles* temporaries)
    : temporaries_(temporaries),
      destination_(std::move(destination)),
      temporary_(temporaryName(destination_)) {}

ReplacementFile::~ReplacementFile() {
  keep();
  if (temporary_.empty()) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  if (temporaries_ != nullptr) temporaries_->forget(temporary_);
}

void ReplacementFile::keep() {
  std::error_code ignored;
  if (!backup_.empty()) fs::remove(backup_, ignored);
  backup_.clear();
  is_for_now_ = false;
}

Result ReplacementFile::check() const {
  std::error_code code;
  const std::string name = destination_.string();
  const fs::path folder = folderOf(destination_);
  if (destination_.filename().empty() || fs::is_directory(destination_, code)) {
    return error(name, "is a folder; name the file to write");
  }
  if (!fs::exists(folder, code)) {
    return error(name, "the folder \"" + folder.string() + "\" does not exist; create it first");
  }
  if (!fs::is_directory(folder, code)) {
    return error(name, "\"" + folder.string() + "\" is no folder");
  }
  if (isReadOnly(folder)) {
    return error(name, "the folder \"" + folder.string() + "\" is read-only; choose another one");
  }
  if (fs::exists(destination_, code) && isReadOnly(destination_)) {
    return error(name, "the file exists and is read-only; make it writable or choose another name");
  }
  return {};
}

Result ReplacementFile::write(std::span<const uint8_t> bytes) {
  int file = -1;
  {
    const TemporaryFiles::Lock held = lockOf(temporaries_);
    if (temporaries_ != nullptr) temporaries_->add(temporary_);
    file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return error(destination_.string(), "cannot be written: " + reasonOf(errno));
  }
  size_t done = 0;
  int failure = 0;
  while (done < bytes.size() && failure == 0) {
    const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
    if (count >= 0) {
      done += static_cast<size_t>(count);
    } else if (errno != EINTR) {
      failure = errno;
    }
  }
  if (::close(file) != 0 && failure == 0) failure = errno;
  if (failure == 0) return {};
  return error(destination_.string(), "cannot be written: " + reasonOf(failure));
}

Result ReplacementFile::commit() {
  const TemporaryFiles::Lock held = lockOf(temporaries_);
  std::error_code code;
  fs::rename(temporary_, destination_, code);
  if (code) return error(destination_.string(), "cannot be written: " + code.message());
  if (temporaries_ != nullptr) temporaries_->forget(temporary_);
  temporary_.clear();
  return {};
}

Result ReplacementFile::commitForNow() {
  std::error_code code;
  if (fs::exists(fs::symlink_status(destination_, code))) {
    const fs::path backup = temporaryName(destination_);
    // Linked where the file system can, so that the destination is there at every moment.
    fs::create_hard_link(destination_, backup, code);
    if (code) fs::rename(destination_, backup, code);
    if (code) return error(destination_.string(), "cannot be written: " + code.message());
    backup_ = backup;
  }
  is_for_now_ = true;
  Result result = commit();
  if (!result.ok()) undo();
  return result;
}

Result ReplacementFile::commitNew() {
  if (::link(temporary_.c_str(), destination_.c_str()) == 0) {
    is_for_now_ = true;
    return {};  // the temporary name goes with this object
  }
  std::error_code code;
  if (!fs::exists(fs::symlink_status(destination_, code))) return commitForNow();  // without links
  if (haveSameContent(temporary_, destination_)) return {};
  return error(destination_.string(), "another file appeared there; choose another folder");
}

void ReplacementFile::undo() {
  if (!is_for_now_) return;
  is_for_now_ = false;
  std::error_code ignored;
  if (backup_.empty()) {
    fs::remove(destination_, ignored);
  } else {
    fs::rename(backup_, destination_, ignored);
    fs::remove(backup_, ignored);  // two links of one file: rename() left both
    backup_.clear();
  }
}

Result writeFile(const fs::path& path, std::span<const uint8_t> bytes,
                 TemporaryFiles* temporaries) {
  ReplacementFile file(path, temporaries);
  Result result = file.check();
  if (result.ok()) result = file.write(bytes);
  return result.ok() ? file.commit() : result;
}

}  // namespace mcc::gltf
