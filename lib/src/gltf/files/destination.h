// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writes the files of a package: either all of them or none, and never over a file that does not
// belong to the document.
#ifndef MCC_GLTF_FILES_DESTINATION_H_
#define MCC_GLTF_FILES_DESTINATION_H_

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gltf/document/package.h"
#include "gltf/files/file_io.h"

namespace mcc::gltf {

class Destination {
 public:
  /// `temporaries`, which may be null, lists temporary files and new folders while they exist.
  /// Borrowed.
  explicit Destination(std::filesystem::path main, TemporaryFiles* temporaries = nullptr);
  /// Removes what was written unless commit() succeeded.
  ~Destination();
  Destination(const Destination&) = delete;
  Destination& operator=(const Destination&) = delete;

  /// Checks whether the files could be written, before any work is done. A file next to the main
  /// one is replaced only when the main file that is there now refers to it. The same holds for
  /// copies, which write() checks.
  Result check(bool with_fallback);
  /// Checks the same once the source is known: none of the source's other files may be replaced,
  /// unless the source itself is replaced.
  Result checkSource(const std::filesystem::path& source, const Json& json) const;

  const Container& container() const { return container_; }
  /// Whether the source lies in the same folder, so that relative URIs mean the same files.
  bool isBeside(const std::filesystem::path& source) const;

  /// Writes temporary files. A copy is not written when an equal file is already there.
  Result write(const Package& package);
  /// Reads the temporary main file back; reader() reads the files next to it.
  Result readBack(std::vector<uint8_t>& main) const;
  FileReader reader() const;
  /// Gives all files their names, the main one last. After an error everything is as it was. When
  /// several programs write to one name at the same time, all files of the last one are in place at
  /// the end, because each program locks the folder meanwhile. Where a folder cannot be locked,
  /// checkTogether() detects a mixture.
  Result commit();
  /// After commit(): fails when the main file is ours but a file next to it is not, because another
  /// program has replaced it.
  Result checkTogether() const;
  /// Returns the main file and its buffer, after write().
  std::vector<std::filesystem::path> files() const;

 private:
  struct Side {
    SideFile::Kind kind;
    bool is_new;      ///< no file of this name existed
    std::string key;  ///< equal for all spellings of its relative path
    ReplacementFile file;
  };

  std::vector<std::string> ownNames() const;
  Result checkOwner(const std::string& name) const;
  /// Returns the file next to the main one with this key; null if none is written.
  const Side* sideOf(const std::string& key) const;
  Result writeCopy(const SideFile& copy);
  Result writeSide(const SideFile& side);
  Result commitSide(Side& side);
  Result createFolders(const std::filesystem::path& folder);

  TemporaryFiles* temporaries_;
  std::filesystem::path main_path_;
  std::filesystem::path folder_;
  Container container_;
  bool with_fallback_ = false;
  ReplacementFile main_;
  std::vector<std::unique_ptr<Side>> sides_;
  std::vector<std::filesystem::path> new_folders_;  ///< outer folders come first
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILES_DESTINATION_H_
