// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/record.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <deque>
#include <thread>

#include "gltf/base/path_text.h"
#include "gltf/base/result.h"
#include "gltf/files/file_io.h"
#include "tiles/file_table.h"

namespace mcc::tiles {
namespace {

namespace fs = std::filesystem;
using gltf::Result;
using Json = Record::Json;

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

/// Returns name, size and time of a file; the size is -1 when it does not exist.
Json stampOf(const fs::path& folder, const std::string& name) {
  std::error_code code;
  const fs::path path = folder / gltf::pathOf(name);
  const uintmax_t size = fs::file_size(path, code);
  if (code) return {name, -1, 0};
  const auto time = fs::last_write_time(path, code);
  return {name, size, static_cast<int64_t>(time.time_since_epoch().count())};
}

Json stampsOf(const fs::path& folder, const std::vector<std::string>& names) {
  Json stamps = Json::array();
  for (const std::string& name : names) stamps.push_back(stampOf(folder, name));
  return stamps;
}

std::string textOf(const Json& json) {
  return json.dump(-1, true) + "\n";
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

/// Parses a line of a record. Returns null for one that was cut off or damaged.
Json parseLine(const std::string& line) {
  Json entry = Json::parse(line);
  const bool is_file = entry.is_object() && entry.contains("file") && entry["file"].is_string();
  return is_file ? entry : Json();
}

}  // namespace

bool Record::isName(std::string_view name) {
  return name.starts_with(kNameBegin) && name.ends_with(kNameEnd);
}

Record::Record(fs::path input, fs::path output, const Part& part)
    : input_(std::move(input)),
      output_(std::move(output)),
      part_(part),
      path_(output_ / nameOf(part)) {}

Result Record::open(bool waits) {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(path_, code);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return gltf::error(gltf::textOf(path_), "is not a file, as the record of this folder would be");
  }
  stream_.open(path_, std::ios::binary | std::ios::app);
  if (!stream_) return gltf::error(gltf::textOf(path_), "cannot be written");
  while (!lockAgainstOthers()) {
    if (!waits) {
      return gltf::error(gltf::textOf(output_),
                         "another run is writing to this folder; wait for its end (--wait), choose "
                         "another folder, or give each run a part of the same number (--part)");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  // A run that was killed may have left half of a line.
  stream_ << "\n" << textOf({{"tool", std::string("gltf-mcc ") + MCC_VERSION}}) << std::flush;
  if (!stream_) return gltf::error(gltf::textOf(path_), "cannot be written");
  read(path_);
  for (const fs::path& record : listRecords()) {
    if (record != path_) read(record);
  }
  return {};
}

std::vector<fs::path> Record::listRecords() const {
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
bool Record::takeLocks(const std::vector<fs::path>& records) {
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
bool Record::lockAgainstOthers() {
  std::vector<fs::path> records = listRecords();
  while (takeLocks(records)) {
    std::vector<fs::path> now = listRecords();
    if (now == records) return true;
    records = std::move(now);
  }
  return false;
}

void Record::read(const fs::path& path) {
  const auto record = static_cast<uint32_t>(records_.size());
  std::ifstream& stream = records_.emplace_back(path, std::ios::binary);
  uint64_t offset = 0;
  for (std::string line; std::getline(stream, line); offset += line.size() + 1) {
    const Json entry = parseLine(line);
    if (entry.is_null()) continue;
    const auto [known, is_new] =
        places_.try_emplace(hashOf(entry["file"].text()));
    // What was made counts more than what another part's record only announced.
    if (is_new || entry.contains("maker")) known->second = {record, offset};
  }
  stream.clear();
}

Json Record::lineOf(std::string_view name) {
  const auto found = places_.find(hashOf(name));
  if (found == places_.end()) return {};
  const std::lock_guard lock(mutex_);
  std::ifstream& stream = records_[found->second.record];
  std::string line;
  stream.clear();
  stream.seekg(static_cast<std::streamoff>(found->second.offset));
  std::getline(stream, line);
  Json entry = parseLine(line);
  const bool is_it = !entry.is_null() && entry["file"].text() == name;
  return is_it ? entry : Json();
}

bool Record::isOurs(std::string_view name) { return !lineOf(name).is_null(); }

void Record::removeTemporaries() {
  std::error_code code;
  std::vector<fs::path> found;
  for (fs::recursive_directory_iterator it(output_, code), end; !code && it != end;
       it.increment(code)) {
    const std::string name = nameOfTemporary(gltf::textOf(it->path().filename()));
    if (name.empty()) continue;
    const fs::path file = it->path().parent_path() / gltf::pathOf(name);
    const std::string relative = genericText(file.lexically_relative(output_));
    const auto place = places_.find(hashOf(relative));
    // Another part may be working on those of its own.
    const bool is_of_part =
        place != places_.end() && (part_.isWhole() || place->second.record == 0);
    if (is_of_part && isOurs(relative)) found.push_back(it->path());
  }
  for (const fs::path& path : found) fs::remove(path, code);
}

void Record::claim(std::string_view name) {
  const auto place = places_.find(hashOf(name));
  if (place != places_.end() && place->second.record == 0) return;
  stream_ << textOf({{"file", name}});
}

Result Record::endClaims() {
  stream_.flush();
  if (stream_) return {};
  return gltf::error(gltf::textOf(path_), "cannot be written");
}

std::optional<Json> Record::findUpToDate(std::string_view name, const std::string& maker,
                                         const std::vector<std::string>& inputs) {
  const Json entry = lineOf(name);
  const Json& outputs = entry["output"];
  if (entry["maker"] != maker || entry["input"] != stampsOf(input_, inputs)) return std::nullopt;
  if (!outputs.is_array() || !entry.contains("made")) return std::nullopt;  // damaged
  for (const Json& stamp : outputs) {
    if (stampOf(output_, stamp[0].get<std::string>()) != stamp) return std::nullopt;
  }
  return entry["made"];
}

void Record::add(std::string_view name, const std::string& maker,
                 const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
                 const Json& made) {
  const std::string line = textOf({{"file", name},
                                   {"maker", maker},
                                   {"input", stampsOf(input_, inputs)},
                                   {"output", stampsOf(output_, outputs)},
                                   {"made", made}});
  const std::lock_guard lock(mutex_);
  stream_ << line << std::flush;
}

Result Record::finish() {
  stream_.close();
  if (stream_) return {};
  return gltf::error(gltf::textOf(path_),
                     "cannot be written; the next run makes again what is not in it");
}

}  // namespace mcc::tiles
