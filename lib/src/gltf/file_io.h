// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_FILE_IO_H_
#define MCC_GLTF_FILE_IO_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "gltf/temporary_files.h"

namespace mcc::gltf {

/// Largest file that is read: lengths in a GLB have 32 bits.
inline constexpr uint64_t kMaxFileBytes = uint64_t{1} << 32;

/// Reads a whole file. What is not a regular file (a pipe, a device) is read as readStream() says.
/// Errors say plainly what is there instead (nothing, a folder, no permission, more than kMaxFileBytes).
Result readFile(const std::filesystem::path& path, std::vector<uint8_t>& bytes);

/// Reads a glTF file from an open file that may never end: to its end; of a GLB to the length in its header and what came with
/// that, so that loadDocument() sees whether bytes follow; of what does not begin as a GLB or JSON only the beginning.
/// name  for messages. Errors: it cannot be read; it has more than kMaxFileBytes.
Result readStream(int file, const std::string& name, std::vector<uint8_t>& bytes);

/// Whether two files have the same bytes; false when one cannot be read.
bool haveSameContent(const std::filesystem::path& a, const std::filesystem::path& b);

/// Reads regular files below a folder, for loadDocument().
FileReader readerOf(const std::filesystem::path& folder);

/// The same, without those that symbolic links lead to outside of the folder.
FileReader readerInside(const std::filesystem::path& folder);

/// Puts the name of the file in front of where in it something is wrong.
Result inFile(const std::filesystem::path& path, Result result);

/// The folder a path lies in; "." when it names none.
std::filesystem::path folderOf(const std::filesystem::path& path);

/// Tells files apart whatever their names.
struct FileIdentity {
  uint64_t device = 0;
  uint64_t number = 0;  ///< 0: no file

  bool operator==(const FileIdentity&) const = default;
};

/// Whether a name stands for something that bytes are sent to and that is not replaced by a file: a device, a pipe, a
/// socket, or an open stream of this process (/dev/stdout, /dev/fd/3), also by a symbolic link.
bool isStream(const std::filesystem::path& path);

/// The number of the open stream that a name stands for: 1 for /dev/stdout.
std::optional<int> openStreamOf(const std::filesystem::path& path);

/// Equal for two names of one file, which need not exist yet: it tells the file itself, not its spelling. Empty where
/// nothing is lost when two write to it (a device), and where it cannot be known (the folder does not exist).
std::string fileKey(const std::filesystem::path& path);

/// Whether the keys of two names say that they stand for one file.
bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Sends bytes to what isStream(). Waits for a reader of a named pipe. Errors: it cannot be opened or written.
Result writeStream(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// A file that takes the place of another only when all is well. Where the destination is a symbolic link, the file that
/// it leads to is replaced and the link stays. The new file has the permissions of the one it replaces, and its owner and
/// group as far as the process may give them away.
class ReplacementFile {
 public:
  /// `temporaries`, which may be null, is told of the temporary file. Borrowed.
  explicit ReplacementFile(std::filesystem::path destination,
                           TemporaryFiles* temporaries = nullptr);
  /// Removes the temporary file unless it was committed; then no undo() is possible any more.
  ~ReplacementFile();
  ReplacementFile(const ReplacementFile&) = delete;
  ReplacementFile& operator=(const ReplacementFile&) = delete;

  /// Whether the destination could be written, before any work is done for it. What isStream() is refused.
  Result check() const;
  /// Writes a temporary file in the folder of the destination.
  Result write(std::span<const uint8_t> bytes);
  const std::filesystem::path& destination() const { return destination_; }
  const std::filesystem::path& temporaryPath() const { return temporary_; }
  /// Renames it to the destination.
  Result commit();
  /// commit() that undo() can take back.
  Result commitForNow();
  /// The same where nothing is there, or an equal file that may stay; another file is an error.
  Result commitNew();
  /// Puts back what was there before commitForNow() or commitNew().
  void undo();
  /// Removes what undo() would need.
  void keep();
  /// After a commit: whether the destination is still the file that it made of it. False when another program has
  /// replaced it since.
  bool isInPlace() const;

 private:
  Result create(int& file);

  TemporaryFiles* temporaries_;
  std::filesystem::path destination_;  ///< as it was named
  std::filesystem::path target_;       ///< the same without symbolic links at its end
  std::filesystem::path temporary_;
  std::filesystem::path backup_;  ///< what was at the target, while undo() is possible
  FileIdentity identity_;         ///< of the file that was written
  bool is_for_now_ = false;
};

/// Whether writeFile() could write, before any work is done for it.
Result checkWritable(const std::filesystem::path& path);

/// Writes a file in the place of another: a temporary one first, then renamed. What isStream() is written to.
Result writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes,
                 TemporaryFiles* temporaries = nullptr);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILE_IO_H_
