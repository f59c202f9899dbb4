// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "batch_record.h"

#include <chrono>

#include "gltf/base/path_text.h"
#include "gltf/files/file_io.h"
#include "interrupt.h"
#include "json/json.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;
using gltf::Json;

constexpr char kFileName[] = ".gltf-mcc.json";

/// Returns path, size and time of a file; the size is -1 when it does not exist.
Json stampOf(const fs::path& path) {
  std::error_code code;
  const fs::path absolute = fs::absolute(path, code).lexically_normal();
  const uintmax_t size = fs::file_size(path, code);
  const auto time = fs::last_write_time(path, code);
  if (code) return {gltf::textOf(absolute), -1, 0};
  return {gltf::textOf(absolute), size, static_cast<int64_t>(time.time_since_epoch().count())};
}

Json stampsOf(const std::vector<fs::path>& paths) {
  Json stamps = Json::array();
  for (const fs::path& path : paths) stamps.push_back(stampOf(path));
  return stamps;
}

bool areUnchanged(const Json& stamps) {
  for (const Json& stamp : stamps) {
    if (stampOf(gltf::pathOf(stamp[0].get<std::string>())) != stamp) return false;
  }
  return !stamps.empty();
}

}  // namespace

fs::path BatchRecord::pathIn(const fs::path& folder) { return folder / kFileName; }

BatchRecord::BatchRecord(const fs::path& folder, const gltf::Json& settings)
    : path_(pathIn(folder)),
      maker_(std::string(MCC_VERSION) + " " + settings.dump()),
      files_(Json::object()),
      note_(read()) {
  if (!note_.ok()) note_.what += "; it is ignored, and everything is made again";
}

gltf::Result BatchRecord::read() {
  constexpr uintmax_t kMostBytes = uintmax_t{1} << 26;
  std::error_code code;
  const fs::file_status status = fs::symlink_status(path_, code);
  if (!fs::exists(status)) return {};
  is_file_ = fs::is_regular_file(status);
  if (!is_file_)
    return {gltf::textOf(path_), "is not a file, as the record of this folder would be"};
  if (fs::file_size(path_, code) > kMostBytes)
    return {gltf::textOf(path_), "is too large for a record"};
  std::vector<uint8_t> bytes;
  gltf::Result result = gltf::readFile(path_, bytes);
  if (!result.ok()) return result;
  Json json;
  if (!gltf::parseJson(bytes, json).ok() || !json["files"].is_object()) return {gltf::textOf(path_), "is not a record of this program"};
  files_ = std::move(json["files"]);
  return {};
}

bool BatchRecord::isUpToDate(const std::string& output_name, const fs::path& input) const {
  const Json* const found = gltf::findMember(files_, output_name);
  if (found == nullptr || (*found)["maker"] != maker_) return false;
  const Json& inputs = (*found)["input"];
  const Json& outputs = (*found)["output"];
  const Json& bytes = (*found)["bytes"];
  return inputs[0] == stampOf(input) &&
         outputs[0] == stampOf(path_.parent_path() / gltf::pathOf(output_name)) &&
         areUnchanged(inputs) && areUnchanged(outputs) && bytes[0].is_number() &&
         bytes[1].is_number();
}

std::pair<uint64_t, uint64_t> BatchRecord::sizesOf(const std::string& output_name) const {
  const Json& bytes = files_.find(output_name)->find("bytes")[0];
  return {bytes[0].get<uint64_t>(), bytes[1].get<uint64_t>()};
}

void BatchRecord::add(const std::string& output_name, const BatchResult& made,
                      const std::vector<fs::path>& outputs) {
  std::vector<fs::path> inputs = made.files.input;
  inputs.insert(inputs.end(), made.files.other_input.begin(), made.files.other_input.end());
  files_[output_name] = {{"maker", maker_},
                         {"bytes", {made.input_bytes, made.output_bytes}},
                         {"input", stampsOf(inputs)},
                         {"output", stampsOf(outputs)}};
}

void BatchRecord::remove(const std::string& output_name) { files_.erase(output_name); }

gltf::Result BatchRecord::write() const {
  if (!is_file_) return {};
  const Json json = {{"tool", std::string("gltf-mcc ") + MCC_VERSION}, {"files", files_}};
  const std::string text = json.dump(1, true) + "\n";
  return gltf::writeFile(path_, {reinterpret_cast<const uint8_t*>(text.data()), text.size()},
                         &temporaryFiles());
}

}  // namespace mcc::tool
