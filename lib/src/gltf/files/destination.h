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
#include "mcc/files.h"

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

  /// Checks whether the files could be written, before any work is done. write() checks the copies.
  Result check(bool with_fallback);
  /// Checks the same once the source is known: the main file must be none of its other files. None
  /// of them is removed, unless the source itself is replaced.
  Result checkSource(const std::filesystem::path& source, const Json& json);

  const Container& container() const { return container_; }
  /// Whether the source lies in the same folder, so that relative URIs mean the same files.
  bool isBeside(const std::filesystem::path& source) const;

  /// Writes temporary files. A copy is not written when an equal file is already there.
  Result write(const Package& package);
  /// Reads the temporary main file back; reader() reads the files next to it.
  Result readBack(std::vector<uint8_t>& main) const;
  FileReader reader() const;
  /// Gives all files their names, the main one last; after an error everything is as it was, except
  /// for copies that have replaced older ones. Buffer and fallback get names that nothing else has
  /// (nameOfMade()), so when several programs write to one main file at the same time, it has the
  /// buffer of its own writer at every moment. At the end those of the main file that was replaced
  /// are removed. Programs do that one at a time: the folder is locked, and where it cannot be,
  /// they stay.
  Result commit();
  /// Adds the main file, its buffer and its fallback to a list, after write().
  void listFiles(FilesInUse& files) const;

 private:
  struct Side {
    SideFile::Kind kind;
    std::string key;  ///< equal for all spellings of its relative path
    ReplacementFile file;
  };

  /// Returns the files made with the main file that is there now.
  std::vector<std::filesystem::path> madeFiles() const;
  /// Returns the file next to the main one with this key; null if none is written.
  const Side* sideOf(const std::string& key) const;
  Result writeCopy(const SideFile& copy);
  Result writeSide(const SideFile& side, const std::filesystem::path& older = {});
  Result commitSide(Side& side);
  void removeUnnamed(const std::vector<std::filesystem::path>& paths) const;
  Result createFolders(const std::filesystem::path& folder);

  TemporaryFiles* temporaries_;
  std::filesystem::path main_path_;
  std::filesystem::path folder_;
  Container container_;
  ReplacementFile main_;
  std::vector<std::unique_ptr<Side>> sides_;
  std::vector<std::filesystem::path> new_files_;    ///< that commit() put where nothing was
  std::vector<std::filesystem::path> kept_;         ///< files of the source, which stay
  std::vector<std::filesystem::path> new_folders_;  ///< outer folders come first
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILES_DESTINATION_H_
