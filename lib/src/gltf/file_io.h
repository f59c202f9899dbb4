// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_FILE_IO_H_
#define MCC_GLTF_FILE_IO_H_

#include <cstdint>
#include <filesystem>
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

/// Puts the name of the file in front of where in it something is wrong.
Result inFile(const std::filesystem::path& path, Result result);

/// The folder a path lies in; "." when it names none.
std::filesystem::path folderOf(const std::filesystem::path& path);

/// A file that takes the place of another only when all is well.
class ReplacementFile {
 public:
  /// `temporaries`, which may be null, is told of the temporary file. Borrowed.
  explicit ReplacementFile(std::filesystem::path destination,
                           TemporaryFiles* temporaries = nullptr);
  /// Removes the temporary file unless it was committed; then no undo() is possible any more.
  ~ReplacementFile();
  ReplacementFile(const ReplacementFile&) = delete;
  ReplacementFile& operator=(const ReplacementFile&) = delete;

  /// Whether the destination could be written, before any work is done for it.
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

 private:
  TemporaryFiles* temporaries_;
  std::filesystem::path destination_;
  std::filesystem::path temporary_;
  std::filesystem::path backup_;  ///< what was at the destination, while undo() is possible
  bool is_for_now_ = false;
};

/// Writes a file in the place of another: a temporary one first, then renamed.
Result writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes,
                 TemporaryFiles* temporaries = nullptr);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILE_IO_H_
