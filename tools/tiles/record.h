// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The record of the files that were written to a folder, kept there as .gltf-mcc-tiles.jsonl, or
// as .gltf-mcc-tiles.3-of-8.jsonl for a part.
#ifndef MCC_TILES_RECORD_H_
#define MCC_TILES_RECORD_H_

#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gltf/files/work_lock.h"
#include "json/json.h"
#include "mcc/gltf.h"
#include "tiles/part.h"

namespace mcc::tiles {

/// One line of JSON for each file. Lines are appended while a run works, so that a run that was
/// killed loses only what it was working on, and the cost does not grow with the number of files.
/// All names of a run are recorded before it writes its first file: what is not recorded belongs to
/// somebody else. The lines stay in the file, and only their places are kept in memory.
///
/// Each part of a tileset has a record of its own, and every run reads all of them. So parts may be
/// made in one folder or in several that are merged later.
class Record {
 public:
  using Json = gltf::Json;

  /// Whether a file at the top of a folder has the name of a record.
  static bool isName(std::string_view name);

  /// `input` and `output` are the folders that names are relative to.
  Record(std::filesystem::path input, std::filesystem::path output, const Part& part);

  /// Opens the record of the part, and makes sure that nobody else works on it, or on another part
  /// that has files in common with it, as long as this object exists. Reads all records in the
  /// folder. Lines that are damaged count as absent.
  /// waits  for the end of other runs
  /// Errors: another run is working; something that is not a file has the name of the record.
  gltf::Result open(bool waits);

  /// Whether a name in the output folder was written, or was going to be, by an earlier run.
  bool isOurs(std::string_view name);

  /// Removes the temporary files of earlier runs of this part that were killed.
  void removeTemporaries();

  /// Records that names will be written. The second function is called when all are claimed.
  void claim(std::string_view name);
  gltf::Result endClaims();

  /// Returns what was recorded about an output, if neither it nor its inputs have changed since and
  /// `maker` is the same. Safe to call in parallel, like add().
  std::optional<Json> findUpToDate(std::string_view name, const std::string& maker,
                                   const std::vector<std::string>& inputs);

  /// Records an output that is complete. `outputs` are all its files.
  void add(std::string_view name, const std::string& maker, const std::vector<std::string>& inputs,
           const std::vector<std::string>& outputs, const Json& made);

  /// Ends the record after the last add(). Errors: a line of it could not be stored.
  gltf::Result finish();

 private:
  /// Where the last line about a name is.
  struct Place {
    uint32_t record = 0;  ///< index into records_
    uint64_t offset = 0;
  };

  /// Returns the records in the folder, sorted; this one is among them.
  std::vector<std::filesystem::path> listRecords() const;
  /// Takes the locks of this record and of all that overlap with it, and keeps that of this one.
  bool takeLocks(const std::vector<std::filesystem::path>& records);
  /// Returns whether no other run works, and keeps it so.
  bool lockAgainstOthers();
  void read(const std::filesystem::path& path);
  /// Returns the last line about a name, or null.
  Json lineOf(std::string_view name);

  std::filesystem::path input_;
  std::filesystem::path output_;
  Part part_;
  std::filesystem::path path_;
  std::optional<gltf::WorkLock> lock_;
  std::unordered_map<uint64_t, Place> places_;  ///< by the hash of the name
  std::vector<std::ifstream> records_;          ///< the first is that of the part
  std::ofstream stream_;
  std::mutex mutex_;  ///< guards records_ and stream_
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_RECORD_H_
