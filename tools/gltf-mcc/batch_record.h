// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The record of what the files in a folder were made from, kept there as .gltf-mcc.json.
#ifndef MCC_TOOL_BATCH_RECORD_H_
#define MCC_TOOL_BATCH_RECORD_H_

#include <filesystem>
#include <string>
#include <vector>

#include "batch.h"
#include "json/json.h"
#include "mcc/gltf.h"

namespace mcc::tool {

/// An output is up to date when this version made it with these options, and neither the output nor
/// any file of its input has changed its size or time since. Contents are not compared.
class BatchRecord {
 public:
  /// Returns the path of the record of a folder.
  static std::filesystem::path pathIn(const std::filesystem::path& folder);

  /// Reads the record of a folder. `settings` are those of BatchOptions. A record that is absent
  /// counts as empty. So does one that is damaged, huge, deeply nested or not a file, with a note,
  /// since other programs may have written it.
  BatchRecord(const std::filesystem::path& folder, const gltf::Json& settings);

  /// Says why the record was not used; ok when it was used or there was none.
  const gltf::Result& note() const { return note_; }

  bool isUpToDate(const std::string& output_name, const std::filesystem::path& input) const;
  /// Returns the bytes of input and output of a file that is up to date.
  std::pair<uint64_t, uint64_t> sizesOf(const std::string& output_name) const;

  /// Records an output. `outputs` are all files that belong to it.
  void add(const std::string& output_name, const BatchResult& made,
           const std::vector<std::filesystem::path>& outputs);
  void remove(const std::string& output_name);
  /// Writes the record, unless something that is not a file has its name.
  gltf::Result write() const;

 private:
  gltf::Result read();

  std::filesystem::path path_;
  std::string maker_;  ///< version and options, as one string
  gltf::Json files_;
  bool is_file_ = true;  ///< false when something other than a file has the record's name
  gltf::Result note_;    ///< result of read(), which sets files_ and is_file_, so it comes last
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_BATCH_RECORD_H_
