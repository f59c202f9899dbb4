// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Files that a command line names twice.
#ifndef MCC_TOOL_FILE_ROLES_H_
#define MCC_TOOL_FILE_ROLES_H_

#include <filesystem>
#include <map>
#include <string>

#include "mcc/gltf.h"

namespace mcc::tool {

/// What each file is to a command, known before any is read or written. A file is known by itself and not by the spelling
/// of its name. Inputs are named first.
class FileRoles {
 public:
  void read(const std::filesystem::path& path, const std::string& role = "the input");
  /// The files beside a model that it names, as far as they can be known without loading it, and their copies in the
  /// folder of the output.
  void readBeside(const std::filesystem::path& model, const std::filesystem::path& output_folder);
  /// An output that may take the place of the input of the same command.
  void replace(const std::filesystem::path& path, const std::string& role = "the output");
  /// Fails when the file is another's already. `role` is what to rename: "the report".
  gltf::Result write(const std::filesystem::path& path, const std::string& role);
  /// What lies beside an output: its buffer and its fallback. The library sees to it that they replace nothing else.
  void replaceBeside(const std::filesystem::path& output, bool with_fallback);

 private:
  std::map<std::string, std::string> roles_;  ///< by gltf::fileKey()
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_FILE_ROLES_H_
