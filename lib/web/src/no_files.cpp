// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Replaces what the glTF layer needs of an operating system, in a module that has none: files
// cannot be read or written, and the clock stands still.
#include <wasi/api.h>
#include <ctime>

#include "gltf/files/destination.h"
#include "gltf/files/file_io.h"
#include "host/result.h"

namespace mcc::gltf {
namespace {

constexpr char kNoFiles[] = "this module has no file system";

}  // namespace

Result readFile(const std::filesystem::path& path, std::vector<uint8_t>&) {
  return error(path.string(), kNoFiles);
}
FileReader readerOf(const std::filesystem::path&, const std::filesystem::path&) { return nullptr; }
Result inFile(const std::filesystem::path&, Result result) { return result; }
std::filesystem::path folderOf(const std::filesystem::path&) { return {}; }

ReplacementFile::ReplacementFile(std::filesystem::path destination, TemporaryFiles* temporaries)
    : temporaries_(temporaries), destination_(std::move(destination)) {}
ReplacementFile::~ReplacementFile() = default;

Destination::Destination(std::filesystem::path main, TemporaryFiles* temporaries)
    : temporaries_(temporaries), main_(std::move(main)) {}
Destination::~Destination() = default;
Result Destination::check(bool) { return error("", kNoFiles); }
Result Destination::checkSource(const std::filesystem::path&, const Json&) {
  return error("", kNoFiles);
}
bool Destination::isBeside(const std::filesystem::path&) const { return false; }
Result Destination::write(const Package&) { return error("", kNoFiles); }
Result Destination::readBack(std::vector<uint8_t>&) const { return error("", kNoFiles); }
FileReader Destination::reader() const { return nullptr; }
Result Destination::commit() { return error("", kNoFiles); }
void Destination::listFiles(FilesInUse&) const {}

}  // namespace mcc::gltf

// The following functions of the C library would otherwise be imported from the host.

/// Reports contain no times; the caller of the module can measure them.
extern "C" int clock_gettime(clockid_t, struct timespec* time) {
  *time = {};
  return 0;
}
/// Called only for the last words of abort(), which the host notices anyway.
extern "C" __wasi_errno_t __wasi_fd_write(__wasi_fd_t, const __wasi_ciovec_t*, size_t,
                                          __wasi_size_t*) {
  return __WASI_ERRNO_BADF;
}
extern "C" __wasi_errno_t __wasi_fd_seek(__wasi_fd_t, __wasi_filedelta_t, __wasi_whence_t,
                                         __wasi_filesize_t*) {
  return __WASI_ERRNO_BADF;
}
extern "C" __wasi_errno_t __wasi_fd_close(__wasi_fd_t) { return __WASI_ERRNO_BADF; }
