// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the files in a folder were made of: the file .gltf-mcc.json in it.
#ifndef MCC_TOOL_BATCH_RECORD_H_
#define MCC_TOOL_BATCH_RECORD_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batch.h"
#include "mcc/gltf.h"

namespace mcc::tool {

/// An output is up to date when it was made by this version with these options, and neither it nor
/// any file of its input has another size or time than then. Contents are not compared.
class BatchRecord {
 public:
  /// The file of a folder that holds its record.
  static std::filesystem::path pathIn(const std::filesystem::path& folder);

  /// `settings` as in BatchOptions. Reads the record of a folder. One that is absent counts as empty; so does one that is
  /// damaged, huge, deeply nested or no file at all, with a note. Somebody else may have written it.
  BatchRecord(const std::filesystem::path& folder, const nlohmann::ordered_json& settings);

  /// Why the record was not used; ok when there was none or it was.
  const gltf::Result& note() const { return note_; }

  bool isUpToDate(const std::string& output_name, const std::filesystem::path& input) const;
  /// Bytes before and after, of a file that is up to date.
  std::pair<uint64_t, uint64_t> sizesOf(const std::string& output_name) const;

  /// outputs  all files that belong to the output.
  void add(const std::string& output_name, const BatchResult& made,
           const std::vector<std::filesystem::path>& outputs);
  void remove(const std::string& output_name);
  /// Where the record is no file, it is left alone.
  gltf::Result write() const;

 private:
  gltf::Result read();

  std::filesystem::path path_;
  std::string maker_;  ///< version and options
  nlohmann::json files_;
  bool is_file_ = true;  ///< or nothing yet
  gltf::Result note_;    ///< of read(), which sets the two before
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_BATCH_RECORD_H_
