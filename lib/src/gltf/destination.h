// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Where the files of a package go: none of them or all, and never over a file that is somebody else's.
#ifndef MCC_GLTF_DESTINATION_H_
#define MCC_GLTF_DESTINATION_H_

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gltf/file_io.h"
#include "gltf/package.h"

namespace mcc::gltf {

class Destination {
 public:
  /// `temporaries`, which may be null, is told of temporary files and new folders. Borrowed.
  explicit Destination(std::filesystem::path main, TemporaryFiles* temporaries = nullptr);
  /// Removes what was written unless commit() succeeded.
  ~Destination();
  Destination(const Destination&) = delete;
  Destination& operator=(const Destination&) = delete;

  /// Before any work: whether the files could be written. A file beside the main one is replaced only
  /// when the main file that is there now refers to it; so are copies, in write().
  Result check(bool with_fallback);
  /// The same, once the source is known: none of its own files may be replaced, unless it is replaced
  /// itself.
  Result checkSource(const std::filesystem::path& source, const Json& json) const;

  const Container& container() const { return container_; }
  /// Whether the source lies in the same folder, so that relative URIs mean the same files.
  bool isBeside(const std::filesystem::path& source) const;

  /// Writes temporary files. Copies that are there already are left alone, when they are equal.
  Result write(const Package& package);
  /// Reads the temporary main file again; reader() those beside it.
  Result readBack(std::vector<uint8_t>& main) const;
  FileReader reader() const;
  /// Gives all files their names, the main one last. On an error everything is as it was. Of several programs that write
  /// to one name at the same time the last has all of its files there, since each locks the folder meanwhile. Where a
  /// folder cannot be locked, checkTogether() tells.
  Result commit();
  /// After commit(): fails when the main file is ours and one beside it is not, for another program has replaced it.
  Result checkTogether() const;
  /// The main file and its buffer, after write().
  std::vector<std::filesystem::path> files() const;

 private:
  struct Side {
    SideFile::Kind kind;
    bool is_new;  ///< nothing was there
    std::string name;
    ReplacementFile file;
  };

  std::vector<std::string> ownNames() const;
  Result checkOwner(const std::string& name) const;
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
  std::vector<std::filesystem::path> new_folders_;  ///< outer ones first
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DESTINATION_H_
