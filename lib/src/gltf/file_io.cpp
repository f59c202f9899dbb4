// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/file_io.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
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

fs::path folderOf(const fs::path& path) {
  return path.parent_path().empty() ? fs::path(".") : path.parent_path();
}

}  // namespace

Result readFile(const fs::path& path, std::vector<uint8_t>& bytes) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return error(path.string(), "there is no such file");
  if (fs::is_directory(status)) return error(path.string(), "is a folder, not a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return error(path.string(), "cannot be opened: " + reasonOf(errno));
  const uintmax_t size = fs::file_size(path, code);
  bytes.clear();
  if (!code) {
    bytes.resize(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<size_t>(stream.gcount()));
  } else {  // no regular file, but something that can be read
    bytes.assign(std::istreambuf_iterator<char>(stream), {});
  }
  if (stream.bad() || (!code && bytes.size() != size)) {
    return error(path.string(), "cannot be read to its end");
  }
  return {};
}

FileReader readerOf(const fs::path& folder) {
  return [folder](const std::string& path, const std::string& where, std::vector<uint8_t>& bytes) {
    Result result = readFile(folder / path, bytes);
    if (!result.ok()) return error(where, "\"" + path + "\": " + result.what);
    return result;
  };
}

ReplacementFile::ReplacementFile(fs::path destination)
    : destination_(std::move(destination)), temporary_(temporaryName(destination_)) {}

ReplacementFile::~ReplacementFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
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
  if (isReadOnly(folder)) return error(name, "the folder \"" + folder.string() + "\" is read-only");
  if (fs::exists(destination_, code) && isReadOnly(destination_)) {
    return error(name, "the file exists and is read-only");
  }
  return {};
}

Result ReplacementFile::write(std::span<const uint8_t> bytes) {
  const int file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return error(destination_.string(), "cannot be written: " + reasonOf(errno));
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
  std::error_code code;
  fs::rename(temporary_, destination_, code);
  if (code) return error(destination_.string(), "cannot be written: " + code.message());
  temporary_.clear();
  return {};
}

}  // namespace mcc::gltf
