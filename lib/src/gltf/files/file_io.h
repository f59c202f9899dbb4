// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads files: those that the user named, and those that something foreign names, which are the
// buffers and images of a document and the contents, external tilesets, subtrees and schemas of a
// tileset. Writes files so that they replace others only when everything has succeeded.
#ifndef MCC_GLTF_FILES_FILE_IO_H_
#define MCC_GLTF_FILES_FILE_IO_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/document/document.h"
#include "host/system.h"
#include "host/temporary_files.h"
#include "mcc/files.h"

namespace mcc::gltf {

/// The largest file that is read. Lengths in a GLB of version 3 have 63 bits, but a document is
/// held in memory.
inline constexpr uint64_t kMaxFileBytes = uint64_t{1} << 36;

/// How much JSON is read from what may never end.
inline constexpr uint64_t kMaxStreamedJson = uint64_t{1} << 32;

/// Reads a whole file that the user named; what a file names is read by NamedFile. A pipe, a
/// device, or anything else that is not a regular file is read by readStream(). Errors say what is
/// there instead: nothing, a folder, a file without permission, or more than kMaxFileBytes.
Result readFile(const std::filesystem::path& path, std::vector<uint8_t>& bytes);

/// Reads a glTF file from an open file that may never end. JSON is read to its end. A GLB is read
/// to the length in its header, plus what arrived with that, so that loadDocument() sees whether
/// more bytes follow. Of anything else only the beginning is read.
/// name  is used in messages.
/// Errors: it cannot be read; it has more than kMaxFileBytes, or JSON of more than
/// kMaxStreamedJson.
Result readStream(int file, const std::string& name, std::vector<uint8_t>& bytes);

/// A regular file inside of a folder, open to be read.
///
/// The folder is the one in the name of the input that the user gave. If that name is a symbolic
/// link, it is still the folder of the link, as other loaders look there, too. The folder itself
/// may be reached through links. A link below it is followed if its end is inside of it.
///
/// Whoever wrote the names could otherwise have any file of this machine put into an output. So a
/// link that leads out is refused, and so is what is not a regular file; neither makes the program
/// wait. The file that was checked is the one that is opened: a link that somebody puts there
/// meanwhile is not followed.
class NamedFile {
 public:
  NamedFile() = default;
  ~NamedFile();
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;

  /// Opens a file.
  /// name    relative to the folder, with '/', as relativePathOf() returns it
  /// within  where the file must be, if that is not `folder` but one that contains it
  /// Errors say what is there instead, without the name.
  Result open(const std::filesystem::path& folder, const std::string& name,
              const std::filesystem::path& within = {});

  uint64_t size() const { return size_; }  ///< when it was opened
  /// Returns the number of bytes that were read; 0 at the end, and when it cannot be read.
  size_t readSome(void* to, size_t byte_count);
  /// Reads the whole file. Errors: it has more than kMaxFileBytes; it has become shorter.
  Result read(std::vector<uint8_t>& bytes);

 private:
  int file_ = -1;
  uint64_t size_ = 0;
};

/// Reads a NamedFile. Errors are like those of its functions.
Result readNamed(const std::filesystem::path& folder, const std::string& name,
                 std::vector<uint8_t>& bytes, const std::filesystem::path& within = {});

/// Returns a reader of NamedFiles, for loadDocument(). Its errors have the name.
FileReader readerOf(const std::filesystem::path& folder, const std::filesystem::path& within = {});

/// A source and what is needed to read it.
struct Input {
  std::filesystem::path path;  ///< for a source in memory only a name
  std::vector<uint8_t> owned;
  std::span<const uint8_t> bytes;  ///< those of the source or `owned`
  FileReader read_file;            ///< null for a source in memory

  /// within  as NamedFile::open() takes it
  /// Errors: as readFile().
  Result open(const Source& source, const std::filesystem::path& within = {}) {
    path = source.path;
    if (!source.bytes) MCC_GLTF_TRY(readFile(path, owned));
    bytes = source.bytes ? *source.bytes : owned;
    if (!source.bytes || source.is_read) read_file = readerOf(path.parent_path(), within);
    return {};
  }
};

/// Puts the name of a file before the place in it where something is wrong.
Result inFile(const std::filesystem::path& path, Result result);

/// Returns the folder a path lies in; "." when it names none.
std::filesystem::path folderOf(const std::filesystem::path& path);

/// Whether a name stands for something that bytes are sent to, rather than for a file that can be
/// replaced: a device, a pipe, a socket, or an open stream of this process (/dev/stdout,
/// /dev/fd/3). Symbolic links are followed.
bool isStream(const std::filesystem::path& path);

/// Returns the number of the open stream that a name stands for: 1 for /dev/stdout.
std::optional<int> openStreamOf(const std::filesystem::path& path);

/// Returns a key that is equal for two names of the same file, which need not exist yet. The key is
/// empty where nothing is lost when two outputs go to it (a device), and where it cannot be
/// determined (the folder does not exist).
std::string fileKey(const std::filesystem::path& path);

/// Returns the same for an open stream of this process.
std::string keyOfStream(int stream);

/// Whether two names stand for the same file, by their keys.
bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Sends bytes to something for which isStream() is true. Waits until a named pipe has a reader.
/// Errors: it cannot be opened or written.
Result writeStream(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// A file that replaces another one only when everything has succeeded. Where the destination is a
/// symbolic link, the file that it leads to is replaced and the link stays. The new file gets the
/// permissions of the one it replaces, and its owner and group if the process may set them.
class ReplacementFile {
 public:
  /// `temporaries`, which may be null, lists the temporary file while it exists. Borrowed.
  explicit ReplacementFile(std::filesystem::path destination,
                           TemporaryFiles* temporaries = nullptr);
  /// Removes the temporary file unless it was committed.
  ~ReplacementFile();
  ReplacementFile(const ReplacementFile&) = delete;
  ReplacementFile& operator=(const ReplacementFile&) = delete;

  /// Checks whether the destination could be written, before any work is done for it. Refuses what
  /// isStream() is true for.
  Result check() const;
  /// Writes a temporary file in the folder of the destination. Where it will replace a file, it is
  /// stored safely before this returns, so that a disk that is full or broken costs no old file.
  /// older  the file that it replaces, if that is not the destination
  Result write(std::span<const uint8_t> bytes, const std::filesystem::path& older = {});
  const std::filesystem::path& destination() const { return destination_; }
  const std::filesystem::path& temporaryPath() const { return temporary_; }
  /// Renames the temporary file to the destination.
  Result commit();
  /// The same where there is no file, which is an error otherwise.
  Result commitNew();
  /// After a commit that replaced a file: waits until the folder is stored, too. On an error the
  /// new file is in place, and a crash may bring the old one back.
  Result flushName() const;

 private:
  Result create(int& file, const std::filesystem::path& older);

  TemporaryFiles* temporaries_;
  std::filesystem::path destination_;  ///< as the caller named it
  std::filesystem::path target_;       ///< the same, with symbolic links at its end followed
  std::filesystem::path temporary_;
  bool is_replacing_ = false;  ///< there was a file at the target when this one was written
};

/// Checks whether writeFile() could write, before any work is done for it.
Result checkWritable(const std::filesystem::path& path);

/// Replaces a file: writes a temporary one and renames it. Writes directly to what isStream() is
/// true for.
Result writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes,
                 TemporaryFiles* temporaries = nullptr);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILES_FILE_IO_H_
