// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/record.h"

#include <cctype>

#include "gltf/base/path_text.h"
#include "gltf/base/result.h"
#include "gltf/files/file_io.h"

namespace mcc::tiles {
namespace {

namespace fs = std::filesystem;
using gltf::Result;
using Json = Record::Json;

constexpr char kFileName[] = ".gltf-mcc-tiles.jsonl";

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

std::string lineOf(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
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

}  // namespace

fs::path Record::pathIn(const fs::path& folder) { return folder / kFileName; }

Record::Record(fs::path input, fs::path output)
    : input_(std::move(input)), output_(std::move(output)) {
  names_.insert(kFileName);
}

Result Record::read() {
  const fs::path path = pathIn(output_);
  std::error_code code;
  const fs::file_status status = fs::symlink_status(path, code);
  if (!fs::exists(status)) return {};
  if (!fs::is_regular_file(status)) {
    return gltf::error(gltf::textOf(path), "is not a file, as the record of this folder would be");
  }
  std::ifstream stream(path, std::ios::binary);
  for (std::string line; std::getline(stream, line);) {
    Json entry = Json::parse(line, nullptr, false);  // the last line may be cut off
    const bool is_file = entry.is_object() && entry.contains("file") && entry["file"].is_string();
    if (!is_file) continue;
    const auto name = entry["file"].get<std::string>();
    names_.insert(name);
    if (entry.contains("maker")) {
      files_[name] = std::move(entry);
    } else {
      files_.erase(name);
    }
  }
  return {};
}

void Record::removeTemporaries() const {
  std::error_code code;
  std::vector<fs::path> found;
  for (fs::recursive_directory_iterator it(output_, code), end; !code && it != end;
       it.increment(code)) {
    const std::string name = nameOfTemporary(gltf::textOf(it->path().filename()));
    if (name.empty()) continue;
    const fs::path file = it->path().parent_path() / gltf::pathOf(name);
    const std::u8string relative = file.lexically_relative(output_).generic_u8string();
    if (isOurs({relative.begin(), relative.end()})) found.push_back(it->path());
  }
  for (const fs::path& path : found) fs::remove(path, code);
}

Result Record::begin(const std::vector<std::string>& names, gltf::TemporaryFiles* temporaries) {
  names_.insert(names.begin(), names.end());
  std::string text = lineOf({{"tool", std::string("gltf-mcc ") + MCC_VERSION}});
  for (const std::string& name : names_) {
    const auto known = files_.find(name);
    text += known != files_.end() ? lineOf(known->second) : lineOf({{"file", name}});
  }
  const fs::path path = pathIn(output_);
  MCC_GLTF_TRY(gltf::writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()},
                               temporaries));
  stream_.open(path, std::ios::binary | std::ios::app);
  if (stream_) return {};
  return gltf::error(gltf::textOf(path), "cannot be written");
}

const Json* Record::findUpToDate(const std::string& name, const std::string& maker,
                                 const std::vector<std::string>& inputs) const {
  try {
    const auto found = files_.find(name);
    if (found == files_.end() || found->second.at("maker") != maker) return nullptr;
    const Json& entry = found->second;
    if (entry.at("input") != stampsOf(input_, inputs)) return nullptr;
    for (const Json& stamp : entry.at("output")) {
      if (stampOf(output_, stamp.at(0).get<std::string>()) != stamp) return nullptr;
    }
    return &entry.at("made");
  } catch (const Json::exception&) {
    return nullptr;  // damaged
  }
}

void Record::add(const std::string& name, const std::string& maker,
                 const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
                 const Json& made) {
  stream_ << lineOf({{"file", name},
                     {"maker", maker},
                     {"input", stampsOf(input_, inputs)},
                     {"output", stampsOf(output_, outputs)},
                     {"made", made}})
          << std::flush;
}

}  // namespace mcc::tiles
