// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_FILE_TABLE_H_
#define MCC_TILES_FILE_TABLE_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mcc/result.h"
#include "mcc/types.h"
#include "tiles/part.h"

namespace mcc::tiles {

/// The regular files in a folder and below, sorted by name. A file takes its name and 24 bytes.
class FileTable {
 public:
  /// Lists a folder. Files that are not in `part` are left out, unless they may say something about
  /// other files: JSON, subtrees, and everything whose name does not tell what it is. Links that
  /// lead out of the folder, and what is neither a file nor a folder, are noted and left out.
  /// is_ours  says of a name that it is never listed.
  /// Errors: the folder cannot be read.
  gltf::Result read(const std::filesystem::path& folder, const Part& part,
                    bool (*is_ours)(std::string_view name), std::vector<std::string>& notes);

  uint32_t size() const { return static_cast<uint32_t>(files_.size()); }
  /// Returns the name relative to the folder, with '/'.
  std::string_view name(uint32_t file) const {
    return std::string_view(names_).substr(files_[file].name_begin, files_[file].name_bytes);
  }
  uint64_t bytes(uint32_t file) const { return files_[file].bytes; }
  /// Returns the number of a file, or kNone.
  uint32_t find(std::string_view name) const;

 private:
  struct File {
    uint64_t name_begin = 0;
    uint64_t bytes = 0;
    uint32_t name_bytes = 0;
  };

  gltf::Result add(const std::filesystem::directory_entry& entry,
                   const std::filesystem::path& folder, std::vector<std::string>& notes);

  Part part_;
  std::string names_;
  std::vector<File> files_;
};

/// Whether the ending of a name says that a file is no tileset and no subtree.
bool isNameOfLeaf(std::string_view name);

/// Whether a path is a folder or lies in it. Both are absolute and without links.
bool isInside(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Returns a path as text with '/'.
std::string genericText(const std::filesystem::path& path);

}  // namespace mcc::tiles

#endif  // MCC_TILES_FILE_TABLE_H_
