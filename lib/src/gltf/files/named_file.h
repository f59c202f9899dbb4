// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Files that something foreign names: the buffers and images of a document; the contents, external
// tilesets, subtrees and schemas of a tileset. All of them are opened here.
#ifndef MCC_GLTF_FILES_NAMED_FILE_H_
#define MCC_GLTF_FILES_NAMED_FILE_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gltf/document/document.h"

namespace mcc::gltf {

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

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILES_NAMED_FILE_H_
