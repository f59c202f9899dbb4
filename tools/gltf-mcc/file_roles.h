// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds files that a command line names twice.
#ifndef MCC_TOOL_FILE_ROLES_H_
#define MCC_TOOL_FILE_ROLES_H_

#include <filesystem>
#include <map>
#include <string>

#include "mcc/result.h"

namespace mcc::tool {

/// The role of each file in a command, collected before any file is read or written. A file is
/// identified by itself and not by the spelling of its name. Inputs must be added first.
class FileRoles {
 public:
  void read(const std::filesystem::path& path, const std::string& role = "the input");
  /// Adds the files that a model refers to, as far as they can be known without loading it, and
  /// their copies in the folder of the output.
  void readBeside(const std::filesystem::path& model, const std::filesystem::path& output_folder);
  /// Adds an output that may replace the input of the same command.
  void replace(const std::filesystem::path& path, const std::string& role = "the output");
  /// Adds an output. Fails when the file already has another role. `role` names what the user
  /// should rename: "the report".
  gltf::Result write(const std::filesystem::path& path, const std::string& role);

 private:
  std::map<std::string, std::string> roles_;  ///< by gltf::fileKey()
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_FILE_ROLES_H_
