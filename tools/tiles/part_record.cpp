// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/part_record.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <deque>
#include <thread>

#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "host/result.h"
#include "host/text.h"
#include "tiles/file_table.h"

namespace mcc::tiles {
namespace {

namespace fs = std::filesystem;
using gltf::Result;

constexpr std::string_view kNameBegin = ".gltf-mcc-tiles.";
constexpr std::string_view kNameEnd = "jsonl";

std::string nameOf(const Part& part) {
  std::string name(kNameBegin);
  if (!part.isWhole()) name += part.name() + ".";
  return name.append(kNameEnd);
}

/// Returns the part of a record by its name. A name that says nothing is that of a whole, which
/// overlaps everything.
Part partOf(std::string_view name) {
  Part part;
  name.remove_prefix(std::min(name.size(), kNameBegin.size()));
  const char* const end = name.data() + name.size();
  const auto [first, code] = std::from_chars(name.data(), end, part.number);
  constexpr std::string_view kOf = "-of-";
  const std::string_view rest = name.substr(static_cast<size_t>(first - name.data()));
  if (code != std::errc() || !rest.starts_with(kOf)) return {};
  std::from_chars(first + kOf.size(), end, part.count);
  return part;
}

/// Returns the name of which ".NAME.tmp-12-3" is a temporary file, or an empty text.
std::string nameOfTemporary(const std::string& file_name) {
  const size_t mark = file_name.rfind(".tmp-");
  if (!file_name.starts_with('.') || mark == std::string::npos || mark == 0) return "";
  for (const char c : file_name.substr(mark + 5)) {
    if (c != '-' && std::isdigit(static_cast<unsigned char>(c)) == 0) return "";
  }
  return file_name.substr(1, mark - 1);
}

/// Returns the name of the file that was being written when a temporary file of this name was. The
/// buffer of a .gltf has a name that nobody knows before it is made.
std::string writtenAs(const std::string& name) {
  constexpr size_t kEnd = sizeof(".0123456789abcdef.bin") - 1;
  const std::string stem = name.substr(0, name.size() - std::min(name.size(), kEnd));
  return gltf::isNameOfMade({true, "", stem}, name) ? stem + ".gltf" : name;
}

}  // namespace

bool PartRecord::isName(std::string_view name) {
  return name.starts_with(kNameBegin) && name.ends_with(kNameEnd);
}

PartRecord::PartRecord(const fs::path& input, fs::path output, const Part& part)
    : output_(std::move(output)),
      part_(part),
      path_(output_ / nameOf(part)),
      lines_(path_, input, output_) {}

Result PartRecord::open(bool waits) {
  MCC_GLTF_TRY(lines_.open(true));
  while (!lockAgainstOthers()) {
    if (!waits) {
      return gltf::error(gltf::textOf(output_),
                         "another run is writing to this folder; wait for its end (--wait), choose "
                         "another folder, or give each run a part of the same number (--part)");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  lines_.read(path_);
  for (const fs::path& record : listRecords()) {
    if (record != path_) lines_.read(record);
  }
  return {};
}

std::vector<fs::path> PartRecord::listRecords() const {
  std::vector<fs::path> records = {path_};
  std::error_code code;
  for (fs::directory_iterator it(output_, code), end; !code && it != end; it.increment(code)) {
    const std::string name = genericText(it->path().filename());
    if (isName(name) && it->path() != path_ && it->is_regular_file(code)) {
      records.push_back(it->path());
    }
  }
  std::sort(records.begin(), records.end());
  return records;
}

/// All runs take locks in the order of the names. So of those that begin at the same time, the one
/// that holds the last name of all takes every lock that it still needs: no two wait for each
/// other.
bool PartRecord::takeLocks(const std::vector<fs::path>& records) {
  std::deque<gltf::WorkLock> others;
  lock_.reset();
  for (const fs::path& record : records) {
    const bool is_own = record == path_;
    if (!is_own && !part_.overlaps(partOf(genericText(record.filename())))) continue;
    if ((is_own ? lock_.emplace() : others.emplace_back()).take(record)) continue;
    lock_.reset();
    return false;
  }
  return true;
}

/// A run has its record in the folder before it looks for others. One that begins after the second
/// look therefore finds the lock of this run.
bool PartRecord::lockAgainstOthers() {
  std::vector<fs::path> records = listRecords();
  while (takeLocks(records)) {
    std::vector<fs::path> now = listRecords();
    if (now == records) return true;
    records = std::move(now);
  }
  return false;
}

void PartRecord::removeTemporaries() {
  std::error_code code;
  std::vector<fs::path> found;
  for (fs::recursive_directory_iterator it(output_, code), end; !code && it != end;
       it.increment(code)) {
    const std::string name = nameOfTemporary(gltf::textOf(it->path().filename()));
    if (name.empty()) continue;
    const fs::path file = it->path().parent_path() / gltf::pathOf(writtenAs(name));
    const std::string relative = genericText(file.lexically_relative(output_));
    // Another part may be working on those of its own.
    const bool is_of_part = part_.isWhole() || lines_.hasOfOwn(relative);
    if (is_of_part && lines_.has(relative)) found.push_back(it->path());
  }
  for (const fs::path& path : found) fs::remove(path, code);
}

}  // namespace mcc::tiles
