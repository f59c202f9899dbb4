// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The record of what the files in a folder were made from, so that a command that is run again
// makes only what is missing or has changed.
#ifndef MCC_JOBS_RECORD_H_
#define MCC_JOBS_RECORD_H_

#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "json/json.h"
#include "mcc/result.h"

namespace mcc::jobs {

using gltf::Json;

/// What a job makes, and what that depends on.
struct Job {
  std::string name;                 ///< of its output
  std::string maker;                ///< equal as long as everything is that is not a file
  std::vector<std::string> inputs;  ///< those that are known before the job is done
};

/// Returns the maker of a job, which has these settings and this version of the program.
std::string makerOf(std::string_view settings);

/// A file with one line of JSON for each output that was made. Lines are appended while a run
/// works, so that a run that was killed loses only what it was working on, and the cost does not
/// grow with the number of files. They stay in the file, and only their places are kept in memory.
///
/// An output is up to date when it was made by the same maker, and neither it nor any file that it
/// belongs together with or was made from has changed its size or time since.
class Record {
 public:
  /// `input` and `output` are the folders that names are relative to.
  Record(std::filesystem::path path, std::filesystem::path input, std::filesystem::path output);

  /// Whether the file can be continued: it is absent, or begins as a record does. Other programs
  /// may have written it.
  /// Errors: it is not a file; it has more bytes; it is not a record.
  gltf::Result check(uintmax_t most_bytes) const;

  /// Opens the file for new lines, and empties it if it is not to be continued. Until then, and
  /// after an error, the record is empty, and nothing is added to it.
  /// Errors: it is not a file; it cannot be written.
  gltf::Result open(bool continues);
  /// Reads what is recorded there. The first file that is read must be that of this record.
  void read(const std::filesystem::path& path);

  /// Whether a name is recorded at all, or in the own file.
  bool has(std::string_view name) { return !lineOf(name).is_null(); }
  bool hasOfOwn(std::string_view name) const;

  /// Records that a name will be written. Also forgets how it was made.
  void claim(std::string_view name);
  /// Returns what add() recorded about a job, if its output is up to date.
  std::optional<Json> findUpToDate(const Job& job);
  /// Records that a job is done.
  /// inputs   all files that it has read, those of the job first
  /// outputs  all files that it has made, the one that is named like the job first
  void add(const Job& job, const std::vector<std::string>& inputs,
           const std::vector<std::string>& outputs, const Json& made);
  /// Errors: a line could not be stored.
  gltf::Result flush();

 private:
  /// Where the last line about a name is.
  struct Place {
    uint32_t file = 0;  ///< index into files_
    uint64_t offset = 0;
  };

  gltf::Result checkIsFile() const;
  void append(const Json& line);
  /// Returns the last line about a name, or null.
  Json lineOf(std::string_view name);

  std::filesystem::path path_;
  std::filesystem::path input_;
  std::filesystem::path output_;
  std::unordered_map<uint64_t, Place> places_;  ///< by the hash of the name
  std::vector<std::ifstream> files_;            ///< the first is the record's own
  std::ofstream stream_;
  std::mutex mutex_;  ///< guards files_ and stream_: all functions from claim() on may be parallel
};

}  // namespace mcc::jobs

#endif  // MCC_JOBS_RECORD_H_
