// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "file_roles.h"

#include "console.h"
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "host/text.h"
#include "standard_streams.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;

/// Returns the key of an output; "-" is standard output.
std::string keyOfOutput(const fs::path& path) {
  return isStandardStream(gltf::textOf(path)) ? gltf::keyOfStream(kStandardOutput)
                                              : gltf::fileKey(path);
}

}  // namespace

void FileRoles::read(const fs::path& path, const std::string& role) {
  if (isStandardStream(gltf::textOf(path))) return;
  const std::string key = gltf::fileKey(path);
  if (!key.empty()) roles_.emplace(key, role);
}

void FileRoles::readBeside(const fs::path& model, const fs::path& output_folder) {
  if (isStandardStream(gltf::textOf(model)) || gltf::isStream(model)) return;
  std::vector<uint8_t> bytes;
  gltf::Json json;
  if (!gltf::readFile(model, bytes).ok() || !gltf::readJson(bytes, json).ok()) return;
  for (const std::string& path : gltf::filesBeside(json)) {
    read(gltf::folderOf(model) / gltf::pathOf(path), "a file of the input");
    read(output_folder / gltf::pathOf(path), "a copy of a file of the input");
  }
}

void FileRoles::replace(const fs::path& path, const std::string& role) {
  const std::string key = keyOfOutput(path);
  if (!key.empty()) roles_[key] = role;
}

gltf::Result FileRoles::write(const fs::path& path, const std::string& role) {
  const std::string key = keyOfOutput(path);
  if (key.empty()) return {};
  const auto [found, is_new] = roles_.emplace(key, role);
  if (is_new) return {};
  return {gltf::textOf(path), "is " + found->second + "; choose another name for " + role};
}

}  // namespace mcc::tool
