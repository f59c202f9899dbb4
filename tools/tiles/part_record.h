// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The record of a tileset in its folder: .gltf-mcc-tiles.jsonl, or .gltf-mcc-tiles.3-of-8.jsonl for
// a part.
#ifndef MCC_TILES_PART_RECORD_H_
#define MCC_TILES_PART_RECORD_H_

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "host/work_lock.h"
#include "jobs/record.h"
#include "tiles/part.h"

namespace mcc::tiles {

/// Each part of a tileset has a record of its own, and every run reads all of them. So parts may be
/// made in one folder or in several that are merged later. All names of a run are recorded before
/// it writes its first file: what is not recorded belongs to somebody else.
class PartRecord {
 public:
  /// Whether a file at the top of a folder has the name of a record.
  static bool isName(std::string_view name);

  /// `input` and `output` are the folders that names are relative to.
  PartRecord(const std::filesystem::path& input, std::filesystem::path output, const Part& part);

  /// Opens the record of the part, and makes sure that nobody else works on it, or on another part
  /// that has files in common with it, as long as this object exists. Reads all records in the
  /// folder.
  /// waits  for the end of other runs
  /// Errors: another run is working; something that is not a file has the name of the record.
  gltf::Result open(bool waits);

  jobs::Record& lines() { return lines_; }

  /// Removes the temporary files of earlier runs of this part that were killed.
  void removeTemporaries();

 private:
  /// Returns the records in the folder, sorted; this one is among them.
  std::vector<std::filesystem::path> listRecords() const;
  /// Takes the locks of this record and of all that overlap with it, and keeps that of this one.
  bool takeLocks(const std::vector<std::filesystem::path>& records);
  /// Returns whether no other run works, and keeps it so.
  bool lockAgainstOthers();

  std::filesystem::path output_;
  Part part_;
  std::filesystem::path path_;
  std::optional<gltf::WorkLock> lock_;
  jobs::Record lines_;
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_PART_RECORD_H_
