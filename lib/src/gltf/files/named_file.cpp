// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/named_file.h"

#include <cerrno>
#include <cstring>

#include "gltf/document/uri.h"
#include "gltf/files/file_io.h"
#include "host/system.h"
#include "host/text.h"

namespace mcc::gltf {
namespace {

namespace fs = std::filesystem;

fs::path orHere(const fs::path& folder) { return folder.empty() ? fs::path(".") : folder; }

/// Follows all links, and returns where the file is in the folder that must contain it.
Result resolve(const fs::path& file, const fs::path& within, fs::path& base, fs::path& relative) {
  std::error_code code;
  base = fs::canonical(orHere(within), code);
  const fs::path real = code ? fs::path() : fs::canonical(file, code);
  if (code == std::errc::no_such_file_or_directory || code == std::errc::not_a_directory) {
    return error("", "there is no such file");
  }
  if (code) return error("", "cannot be opened: " + code.message());
  relative = real.lexically_relative(base);
  if (relative.empty() || *relative.begin() == "..") {
    return error("",
                 "is a symbolic link out of the folder of the input; put a copy of the file there");
  }
  const fs::file_status status = fs::status(real, code);
  if (fs::is_directory(status)) return error("", "is a folder; name a file in it");
  return fs::is_regular_file(status) ? Result{} : error("", "is not a regular file");
}

}  // namespace

NamedFile::~NamedFile() {
  if (file_ >= 0) system::close(file_);
}

Result NamedFile::open(const fs::path& folder, const std::string& name, const fs::path& within) {
  if (kIsWindows && !isPathOnWindows(name)) {
    return error("", "cannot be the name of a file on Windows; rename the file");
  }
  fs::path base;
  fs::path relative;
  MCC_GLTF_TRY(resolve(folder / pathOf(name), within.empty() ? folder : within, base, relative));
  file_ = system::openInside(base, relative);
  if (file_ < 0) return error("", std::string("cannot be opened: ") + std::strerror(errno));
  const std::optional<uint64_t> size = system::sizeOfRegular(file_);
  if (!size) return error("", "is not a regular file");
  size_ = *size;
  return {};
}

size_t NamedFile::readSome(void* to, size_t byte_count) {
  ptrdiff_t count = 0;
  do {
    count = system::readSome(file_, to, byte_count);
  } while (count < 0 && errno == EINTR);
  return count > 0 ? static_cast<size_t>(count) : 0;
}

Result NamedFile::read(std::vector<uint8_t>& bytes) {
  if (size_ > kMaxFileBytes) {
    return error("", "has more than the " + std::to_string(kMaxFileBytes) +
                         " bytes that are read of a file");
  }
  bytes.resize(size_);
  for (size_t done = 0; done < bytes.size();) {
    const size_t count = readSome(bytes.data() + done, bytes.size() - done);
    if (count == 0) return error("", "cannot be read to its end");
    done += count;
  }
  return {};
}

Result readNamed(const fs::path& folder, const std::string& name, std::vector<uint8_t>& bytes,
                 const fs::path& within) {
  NamedFile file;
  MCC_GLTF_TRY(file.open(folder, name, within));
  return file.read(bytes);
}

FileReader readerOf(const fs::path& folder, const fs::path& within) {
  return [folder, within](const std::string& name, const std::string& where,
                          std::vector<uint8_t>& bytes) {
    const Result read = readNamed(folder, name, bytes, within);
    return read.ok() ? read : error(where, "\"" + name + "\": " + read.what);
  };
}

}  // namespace mcc::gltf
