// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The record of the files that were written to a folder, kept there as .gltf-mcc-tiles.jsonl.
#ifndef MCC_TILES_RECORD_H_
#define MCC_TILES_RECORD_H_

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "gltf/files/temporary_files.h"
#include "mcc/gltf.h"

namespace mcc::tiles {

/// One line of JSON for each file. Lines are appended while a run works, so that a run that was
/// killed loses only what it was working on, and the cost does not grow with the number of files.
/// All names of a run are recorded before it writes its first file: what is not recorded belongs to
/// somebody else.
class Record {
 public:
  using Json = nlohmann::ordered_json;

  static std::filesystem::path pathIn(const std::filesystem::path& folder);

  /// `input` and `output` are the folders that names are relative to.
  Record(std::filesystem::path input, std::filesystem::path output);

  /// Reads the record of the output folder. Lines that are damaged count as absent.
  /// Errors: something that is not a file has its name.
  gltf::Result read();

  /// Whether a name in the output folder was written, or was going to be, by an earlier run.
  bool isOurs(const std::string& name) const { return names_.contains(name); }

  /// Removes the temporary files of earlier runs that were killed.
  void removeTemporaries() const;

  /// Adds names that will be written, stores the record, and begins to append to it.
  gltf::Result begin(const std::vector<std::string>& names, gltf::TemporaryFiles* temporaries);

  /// Returns what was recorded about an output, if neither it nor its inputs have changed since and
  /// `maker` is the same. Otherwise null.
  const Json* findUpToDate(const std::string& name, const std::string& maker,
                           const std::vector<std::string>& inputs) const;

  /// Records an output that is complete. `outputs` are all its files.
  void add(const std::string& name, const std::string& maker,
           const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
           const Json& made);

 private:
  std::filesystem::path input_;
  std::filesystem::path output_;
  std::set<std::string> names_;
  std::map<std::string, Json> files_;
  std::ofstream stream_;
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_RECORD_H_
