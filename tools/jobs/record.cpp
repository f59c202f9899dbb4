// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "jobs/record.h"

#include <chrono>
#include <cstdio>

#include "host/result.h"
#include "host/text.h"
#include "jobs/hash.h"

namespace mcc::jobs {
namespace {

namespace fs = std::filesystem;
using gltf::Result;

constexpr std::string_view kBegin = "{\"tool\":\"gltf-mcc ";

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

/// Whether stamps begin with these names, and all files are as they were.
bool areUnchanged(const fs::path& folder, const Json& stamps,
                  const std::vector<std::string>& names) {
  if (!stamps.is_array() || stamps.size() < names.size()) return false;
  for (size_t i = 0; i < stamps.size(); ++i) {
    const Json& stamp = stamps[i];
    if (!stamp.is_array() || stamp.empty() || !stamp[0].is_string()) return false;
    const std::string name = stamp[0].get<std::string>();
    if (i < names.size() && name != names[i]) return false;
    if (stampOf(folder, name) != stamp) return false;
  }
  return true;
}

std::string textOf(const Json& json) { return json.dump(-1, true) + "\n"; }

/// Parses a line of a record. Returns null for one that was cut off or damaged.
Json parseLine(const std::string& line) {
  Json entry = Json::parse(line);
  const bool is_file = entry.is_object() && entry.contains("file") && entry["file"].is_string();
  return is_file ? entry : Json();
}

}  // namespace

std::string makerOf(std::string_view settings) {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx",
                static_cast<unsigned long long>(hashOf(settings)));
  return std::string(MCC_VERSION) + " " + digits;
}

Record::Record(fs::path path, fs::path input, fs::path output)
    : path_(std::move(path)), input_(std::move(input)), output_(std::move(output)) {}

Result Record::checkIsFile() const {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(path_, code);
  if (!fs::exists(status) || fs::is_regular_file(status)) return {};
  return gltf::error(gltf::textOf(path_), "is not a file, as the record of this folder would be");
}

Result Record::check(uintmax_t most_bytes) const {
  MCC_GLTF_TRY(checkIsFile());
  std::error_code code;
  const uintmax_t bytes = fs::file_size(path_, code);
  if (!code && bytes > most_bytes)
    return gltf::error(gltf::textOf(path_), "is too large for a record");
  std::ifstream stream(path_, std::ios::binary);
  std::string begin(kBegin.size() + 1, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (stream.gcount() == 0 || begin.find(kBegin) <= 1) return {};
  return gltf::error(gltf::textOf(path_), "is not a record of this program");
}

Result Record::open(bool continues) {
  MCC_GLTF_TRY(checkIsFile());
  stream_.open(path_, std::ios::binary | (continues ? std::ios::app : std::ios::trunc));
  stream_ << "\n";  // an earlier run that was killed may have left half of a line
  append({{"tool", std::string("gltf-mcc ") + MCC_VERSION}});
  return flush();
}

void Record::read(const fs::path& path) {
  const auto file = static_cast<uint32_t>(files_.size());
  std::ifstream& stream = files_.emplace_back(path, std::ios::binary);
  uint64_t offset = 0;
  for (std::string line; std::getline(stream, line); offset += line.size() + 1) {
    const Json entry = parseLine(line);
    if (entry.is_null()) continue;
    Place& known =
        places_.try_emplace(hashOf(entry["file"].get<std::string>()), Place{file, offset})
            .first->second;
    // What was made counts more than what another record only announced.
    if (known.file == file || entry.contains("maker")) known = {file, offset};
  }
  stream.clear();
}

bool Record::hasOfOwn(std::string_view name) const {
  const auto found = places_.find(hashOf(name));
  return found != places_.end() && found->second.file == 0;
}

Json Record::lineOf(std::string_view name) {
  const auto found = places_.find(hashOf(name));
  if (found == places_.end()) return {};
  const std::lock_guard lock(mutex_);
  std::ifstream& stream = files_[found->second.file];
  std::string line;
  stream.clear();
  stream.seekg(static_cast<std::streamoff>(found->second.offset));
  std::getline(stream, line);
  Json entry = parseLine(line);
  return !entry.is_null() && entry["file"].get<std::string>() == name ? entry : Json();
}

void Record::append(const Json& line) {
  const std::string text = textOf(line);
  const std::lock_guard lock(mutex_);
  if (stream_.is_open()) stream_ << text;
}

void Record::claim(std::string_view name) { append({{"file", name}}); }

std::optional<Json> Record::findUpToDate(const Job& job) {
  const Json entry = lineOf(job.name);
  for (const char* key : {"maker", "input", "output", "made"}) {
    if (entry.is_null() || !entry.contains(key)) return std::nullopt;
  }
  const bool is_unchanged = entry["maker"] == job.maker &&
                            areUnchanged(input_, entry["input"], job.inputs) &&
                            areUnchanged(output_, entry["output"], {job.name});
  return is_unchanged ? std::optional<Json>(entry["made"]) : std::nullopt;
}

void Record::add(const Job& job, const std::vector<std::string>& inputs,
                 const std::vector<std::string>& outputs, const Json& made) {
  append({{"file", job.name},
          {"maker", job.maker},
          {"input", stampsOf(input_, inputs)},
          {"output", stampsOf(output_, outputs)},
          {"made", made}});
  const std::lock_guard lock(mutex_);
  stream_.flush();
}

Result Record::flush() {
  stream_.flush();
  return stream_ ? Result{} : gltf::error(gltf::textOf(path_), "cannot be written");
}

}  // namespace mcc::jobs
