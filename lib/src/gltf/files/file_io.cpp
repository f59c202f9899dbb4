// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/file_io.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "gltf/document/package.h"
#include "host/text.h"

namespace mcc::gltf {
namespace {

namespace fs = std::filesystem;

std::string reasonOf(int number) { return std::strerror(number); }

/// Returns a name in the folder of the destination that no other process or thread of ours uses.
fs::path temporaryName(const fs::path& destination) {
  constexpr size_t kLongestName = 200;  // leaves room for the rest within the usual 255 bytes
  static std::atomic<uint32_t> counter{0};
  fs::path name(".");
  name += destination.filename().native().substr(0, kLongestName);
  name += ".tmp-" + std::to_string(system::processId()) + "-" + std::to_string(counter++);
  return destination.parent_path() / name;
}

/// Follows symbolic links as far as they lead, but not into an open stream.
fs::path withoutLinks(fs::path path) {
  constexpr int kMostLinks = 40;
  std::error_code code;
  for (int i = 0; i < kMostLinks && !system::openStreamNamed(path); ++i) {
    const fs::path next = fs::read_symlink(path, code);
    if (code) break;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

/// Writes all bytes, however many the system takes at a time. Returns 0 or the number of the error.
int writeAll(int file, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ptrdiff_t count = system::writeSome(file, bytes.data(), bytes.size());
    if (count == 0) return ENOSPC;  // nothing was taken, and trying again could last forever
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) bytes = bytes.subspan(static_cast<size_t>(count));
  }
  return 0;
}

Result tooLarge(const std::string& name, uint64_t most_bytes) {
  return error(name, "has more than the ", most_bytes, " bytes that are read of a file");
}

/// Returns how far to read a file that begins with these bytes. More than there are means:
/// continue.
uint64_t wantedBytes(std::span<const uint8_t> bytes) {
  constexpr size_t kWhiteSpaceBytes = 65536;  // before the JSON; more is not accepted
  if (bytes.size() < kGlbHeaderBytes) return kGlbHeaderBytes;
  if (isGlb(bytes)) {
    return std::min(glbLength(bytes), kMaxFileBytes) + 1;  // one more shows trailing bytes
  }
  if (isJsonText(bytes.first(std::min(bytes.size(), kWhiteSpaceBytes))))
    return kMaxStreamedJson + 1;
  return kWhiteSpaceBytes;
}

/// Returns a key that begins with a digit, unlike those of files without an identity.
std::string keyOf(const FileIdentity& file) {
  return std::to_string(file.device) + ":" + std::to_string(file.number);
}

/// Returns the number of bytes that were read; 0 at the end, and when it cannot be read.
size_t readSome(int file, void* to, size_t byte_count) {
  ptrdiff_t count = 0;
  do {
    count = system::readSome(file, to, byte_count);
  } while (count < 0 && errno == EINTR);
  return count > 0 ? static_cast<size_t>(count) : 0;
}

/// Reads a regular file of this size. `name` is used in messages.
Result readWhole(int file, uint64_t size, const std::string& name, std::vector<uint8_t>& bytes) {
  if (size > kMaxFileBytes) return tooLarge(name, kMaxFileBytes);
  bytes.resize(size);
  for (size_t done = 0; done < size;) {
    const size_t count = readSome(file, bytes.data() + done, size - done);
    if (count == 0) return error(name, "cannot be read to its end");
    done += count;
  }
  return {};
}

}  // namespace

fs::path folderOf(const fs::path& path) {
  return path.parent_path().empty() ? fs::path(".") : path.parent_path();
}

Result inFile(const fs::path& path, Result result) {
  if (result.ok()) return result;
  result.where = result.where.empty() ? textOf(path) : textOf(path) + ": " + result.where;
  return result;
}

Result readStream(int file, const std::string& name, std::vector<uint8_t>& bytes) {
  constexpr size_t kReadBytes = size_t{1} << 18;
  bytes.clear();
  while (bytes.size() < wantedBytes(bytes)) {
    const size_t size = bytes.size();
    bytes.resize(size + kReadBytes);
    const ptrdiff_t count = system::readSome(file, bytes.data() + size, kReadBytes);
    bytes.resize(size + (count > 0 ? static_cast<size_t>(count) : 0));
    if (count == 0) return {};
    if (count < 0 && errno != EINTR) return error(name, "cannot be read: ", reasonOf(errno));
  }
  const uint64_t most = isGlb(bytes) ? kMaxFileBytes : kMaxStreamedJson;
  return bytes.size() <= most ? Result{} : tooLarge(name, most);
}

Result readFile(const fs::path& path, std::vector<uint8_t>& bytes) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return error(textOf(path), "there is no such file");
  if (fs::is_directory(status)) return error(textOf(path), "is a folder; name a file in it");
  const int file = system::openToRead(path);
  if (file < 0) return error(textOf(path), "cannot be opened: ", reasonOf(errno));
  const std::optional<uint64_t> size = system::sizeOfRegular(file);
  Result result =
      size ? readWhole(file, *size, textOf(path), bytes) : readStream(file, textOf(path), bytes);
  system::close(file);
  return result;
}

namespace {

fs::path orHere(const fs::path& folder) { return folder.empty() ? fs::path(".") : folder; }

/// Follows all links, and returns where the file is in the folder that must contain it.
Result resolve(const fs::path& file, const fs::path& within, fs::path& base, fs::path& relative) {
  std::error_code code;
  base = fs::canonical(orHere(within), code);
  const fs::path real = code ? fs::path() : fs::canonical(file, code);
  if (code == std::errc::no_such_file_or_directory || code == std::errc::not_a_directory) {
    return error("", "there is no such file");
  }
  if (code) return error("", "cannot be opened: ", code.message());
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
  if (file_ < 0) return error("", "cannot be opened: ", std::strerror(errno));
  const std::optional<uint64_t> size = system::sizeOfRegular(file_);
  if (!size) return error("", "is not a regular file");
  size_ = *size;
  return {};
}

size_t NamedFile::readSome(void* to, size_t byte_count) {
  return gltf::readSome(file_, to, byte_count);
}

Result NamedFile::read(std::vector<uint8_t>& bytes) { return readWhole(file_, size_, "", bytes); }

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
    return read.ok() ? read : error(where, "\"", name, "\": ", read.what);
  };
}

bool isStream(const fs::path& path) {
  const fs::path target = withoutLinks(path);
  if (system::openStreamNamed(target)) return true;
  std::error_code code;
  switch (fs::status(target, code).type()) {
    case fs::file_type::character:
    case fs::file_type::block:
    case fs::file_type::fifo:
    case fs::file_type::socket: return true;
    default: return false;
  }
}

std::optional<int> openStreamOf(const fs::path& path) {
  return system::openStreamNamed(withoutLinks(path));
}

std::string keyOfStream(int stream) {
  if (system::isCharacterDevice(stream)) return "";
  const std::optional<FileIdentity> file = system::identityOf(stream);
  return file ? keyOf(*file) : "stream " + std::to_string(stream);
}

std::string fileKey(const fs::path& path) {
  const fs::path target = withoutLinks(path);
  if (const std::optional<int> stream = system::openStreamNamed(target)) {
    return keyOfStream(*stream);
  }
  std::error_code code;
  if (fs::is_character_file(target, code)) return "";
  if (const std::optional<FileIdentity> file = system::identityOf(target)) return keyOf(*file);
  const fs::path folder = folderOf(target);
  if (const std::optional<FileIdentity> known = system::identityOf(folder)) {
    return keyOf(*known) + "/" + system::nameKey(target.filename());
  }
  if (!fs::exists(folder, code)) return "";
  const fs::path whole = fs::weakly_canonical(target, code);
  return code ? "" : system::nameKey(whole);
}

bool isSameFile(const fs::path& a, const fs::path& b) {
  const std::string key = fileKey(a);
  return !key.empty() && key == fileKey(b);
}

Result writeStream(const fs::path& path, std::span<const uint8_t> bytes) {
  const fs::path target = withoutLinks(path);
  const std::optional<int> stream = system::openStreamNamed(target);
  // Duplicate an open stream instead of opening it again, which would begin at the start of a file.
  const int file = stream ? system::duplicate(*stream) : system::openToWrite(target);
  if (file < 0) return error(textOf(path), "cannot be opened: ", reasonOf(errno));
  int failure = writeAll(file, bytes);
  if (system::close(file) != 0 && failure == 0) failure = errno;
  if (failure == 0) return {};
  return error(textOf(path), "cannot be written: ", reasonOf(failure));
}

ReplacementFile::ReplacementFile(fs::path destination, TemporaryFiles* temporaries)
    : temporaries_(temporaries),
      destination_(std::move(destination)),
      target_(withoutLinks(destination_)),
      temporary_(temporaryName(target_)) {}

ReplacementFile::~ReplacementFile() {
  if (temporary_.empty()) return;
  std::error_code ignored;
  system::remove(temporary_, ignored);
  if (temporaries_ != nullptr) temporaries_->forget(temporary_);
}

Result ReplacementFile::check() const {
  std::error_code code;
  const std::string name = textOf(destination_);
  const fs::path folder = folderOf(target_);
  if (destination_.filename().empty() || fs::is_directory(target_, code)) {
    return error(name, "is a folder; name the file to write");
  }
  if (isStream(target_)) {
    return error(name, "is a device or a pipe, which cannot be replaced; name a file");
  }
  if (fs::is_symlink(fs::symlink_status(target_, code))) {
    return error(name, "is a symbolic link that leads nowhere; remove it");
  }
  if (!fs::exists(folder, code)) {
    return error(name, "the folder \"", textOf(folder), "\" does not exist; create it first");
  }
  if (!fs::is_directory(folder, code)) {
    return error(name, "\"", textOf(folder), "\" is not a folder");
  }
  if (!system::mayWrite(folder)) {
    return error(name, "the folder \"", textOf(folder), "\" is read-only; choose another one");
  }
  if (fs::exists(target_, code) && !system::mayWrite(target_)) {
    return error(name, "the file exists and is read-only; make it writable or choose another name");
  }
  return {};
}

/// Creates the temporary file. A file of the same name may be left over from a process that was
/// killed and had the same process id.
Result ReplacementFile::create(int& file, const fs::path& older) {
  constexpr int kMostNames = 100;
  // Asked once: a file that disappears meanwhile must not leave permissions for its owner alone.
  const std::optional<system::Permissions> permissions = system::permissionsOf(older);
  const TemporaryFiles::Lock held = lockOf(temporaries_);
  for (int i = 0; i < kMostNames; ++i) {
    file = system::createNew(temporary_, permissions.has_value());
    if (file >= 0 || errno != EEXIST) break;
    temporary_ = temporaryName(target_);
  }
  if (file < 0) {
    const int failure = errno;
    temporary_.clear();  // a file of that name is not ours
    return error(textOf(destination_), "cannot be written: ", reasonOf(failure));
  }
  if (temporaries_ != nullptr) temporaries_->add(temporary_);
  if (permissions) system::setPermissions(file, *permissions);
  return {};
}

Result ReplacementFile::write(std::span<const uint8_t> bytes, const fs::path& older) {
  const fs::path& replaced = older.empty() ? target_ : older;
  int file = -1;
  MCC_GLTF_TRY(create(file, replaced));
  int failure = writeAll(file, bytes);
  // The file that is there now is replaced only when the new bytes are safely stored.
  std::error_code code;
  is_replacing_ = fs::exists(replaced, code);
  if (failure == 0 && is_replacing_ && system::flush(file) != 0) failure = errno;
  if (system::close(file) != 0 && failure == 0) failure = errno;
  if (failure == 0) return {};
  return error(textOf(destination_), "cannot be written: ", reasonOf(failure));
}

Result ReplacementFile::flushName() const {
  if (!is_replacing_ || system::flushFolder(folderOf(target_)) == 0) return {};
  return error(textOf(destination_),
               "was replaced, but its folder cannot be stored: ", reasonOf(errno),
               "; check the disk and write it again");
}

Result ReplacementFile::commit() {
  const TemporaryFiles::Lock held = lockOf(temporaries_);
  std::error_code code;
  system::rename(temporary_, target_, code);
  if (code) return error(textOf(destination_), "cannot be written: ", code.message());
  if (temporaries_ != nullptr) temporaries_->forget(temporary_);
  temporary_.clear();
  return {};
}

Result ReplacementFile::commitNew() {
  const TemporaryFiles::Lock held = lockOf(temporaries_);
  std::error_code code;
  fs::create_hard_link(temporary_, target_, code);
  if (!code) return {};  // the destructor removes the temporary name
  if (!fs::exists(fs::symlink_status(target_, code))) return commit();  // no hard links here
  return error(textOf(destination_), "another file appeared there; choose another folder");
}

Result checkWritable(const fs::path& path) {
  return isStream(path) ? Result{} : ReplacementFile(path).check();
}

Result writeFile(const fs::path& path, std::span<const uint8_t> bytes,
                 TemporaryFiles* temporaries) {
  if (isStream(path)) return writeStream(path, bytes);
  ReplacementFile file(path, temporaries);
  Result result = file.check();
  if (result.ok()) result = file.write(bytes);
  if (result.ok()) result = file.commit();
  return result.ok() ? file.flushName() : result;
}

}  // namespace mcc::gltf
