// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/package.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "gltf/document/image_type.h"
#include "gltf/document/known_extensions.h"
#include "gltf/document/uri.h"

namespace mcc::gltf {
namespace {

/// Lists the relative URIs in one list, with their JSON paths. Data URIs are left out, since they
/// are not files.
void listUris(const Json& json, const char* list,
              std::vector<std::pair<std::string, std::string>>& uris) {
  const Json& items = arrayOf(json, list);
  for (size_t i = 0; i < items.size(); ++i) {
    const Json* uri = findMember(items[i], "uri");
    if (uri == nullptr || !uri->is_string() || isDataUri(uri->get<std::string>())) continue;
    uris.emplace_back(uri->get<std::string>(), at(at("", list), i) + "/uri");
  }
}

/// Returns the extension of a name in lower case, with its dot.
std::string extensionOf(const std::string& file_name) {
  const size_t dot = file_name.find_last_of("./");
  if (dot == std::string::npos || file_name[dot] == '/') return "";
  std::string extension = file_name.substr(dot);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

Result readCopy(bool is_image, const FileReader& read_file, const std::string& where,
                SideFile& file) {
  const std::string name = "\"" + file.path + "\"";
  if (!isVisiblePath(file.path)) return error(where, name + " is the name of a hidden file");
  MCC_GLTF_TRY(read_file(file.path, where, file.bytes));
  if (!is_image || !imageTypeOf(file.bytes).empty()) return {};
  return error(where, name + " is not a known type of image");
}

}  // namespace

uint64_t Package::documentBytes() const {
  uint64_t bytes = main.size();
  for (const SideFile& file : beside) {
    if (file.kind == SideFile::Kind::kBuffer) bytes += file.bytes.size();
  }
  return bytes;
}

Result containerOf(const std::string& file_name, Container& container) {
  container = {};
  const size_t dot = file_name.rfind('.');
  const std::string stem = dot == 0 ? file_name : file_name.substr(0, dot);
  container.is_gltf = extensionOf(file_name) == ".gltf";
  if (container.is_gltf) container.buffer_name = stem + ".bin";
  container.fallback_name = stem + ".fallback.bin";
  if (container.is_gltf && !isUsableName(container.buffer_name)) {
    return error(file_name,
                 "no URI can name a file \"" + container.buffer_name + "\"; choose another name");
  }
  return {};
}

namespace {

/// Pads the JSON of a GLB with property tables so that its BIN chunk begins at a multiple of 8, as
/// EXT_structural_metadata demands for numbers of 64 bits.
std::string glbText(const Json& json) {
  constexpr size_t kBytesBeforeBin = 28;  // a header of 12 bytes, and two of chunks
  std::string text = printJson(json);
  if (!mayHaveTables(json)) return text;
  while ((kBytesBeforeBin + text.size()) % 8 != 0) text += ' ';
  return text;
}

}  // namespace

Result writePackage(const Container& container, Json json, std::vector<uint8_t> bin,
                    const std::vector<GlbChunk>& other_chunks, Package& package) {
  if (!container.is_gltf) return writeGlb(glbText(json), bin, other_chunks, package.main);
  if (!bin.empty()) {
    json["buffers"][0]["uri"] = uriOf(container.buffer_name);
    package.beside.push_back({SideFile::Kind::kBuffer, container.buffer_name, std::move(bin)});
  }
  const std::string text = printJson(json) + "\n";
  package.main.assign(text.begin(), text.end());
  return {};
}

Result addCopies(const Json& json, bool with_buffers, const FileReader& read_file, Package& package,
                 std::vector<std::string>& notes) {
  std::vector<std::pair<std::string, std::string>> uris;
  if (with_buffers) listUris(json, "buffers", uris);
  const size_t buffer_count = uris.size();
  listUris(json, "images", uris);
  std::set<std::string> known;
  for (size_t i = 0; i < uris.size(); ++i) {
    const auto& [uri, where] = uris[i];
    const bool is_image = i >= buffer_count;
    SideFile file;
    file.kind = SideFile::Kind::kCopy;
    MCC_GLTF_TRY(relativePathOf(uri, where, file.path));
    if (!known.insert(file.path).second) continue;
    const Result read = readCopy(is_image, read_file, where, file);
    if (read.ok()) {
      package.beside.push_back(std::move(file));
    } else {
      notes.push_back(read.message() + "; it is not copied");
    }
  }
  return {};
}

bool canCopyBuffers(const Json& json) {
  const std::vector<std::string> paths = filesOf(json, "buffers");
  return std::all_of(paths.begin(), paths.end(), [](const std::string& path) {
    const std::string extension = extensionOf(path);
    return isVisiblePath(path) &&
           (extension == ".bin" || extension == ".glbin" || extension == ".glbuf");
  });
}

Result readJson(std::span<const uint8_t> file, Json& json) {
  GlbFile glb;
  glb.json = file;
  if (isGlb(file)) MCC_GLTF_TRY(readGlb(file, glb));
  return parseJson(glb.json, json);
}

std::vector<std::string> filesOf(const Json& json, const char* list) {
  std::vector<std::pair<std::string, std::string>> uris;
  listUris(json, list, uris);
  std::vector<std::string> paths;
  std::set<std::string> seen;
  for (const auto& [uri, where] : uris) {
    std::string path;
    const bool is_new = relativePathOf(uri, where, path).ok() && seen.insert(path).second;
    if (is_new) paths.push_back(path);
  }
  return paths;
}

std::vector<std::string> filesBeside(const Json& json) {
  std::vector<std::string> paths = filesOf(json, "buffers");
  const std::vector<std::string> images = filesOf(json, "images");
  paths.insert(paths.end(), images.begin(), images.end());
  return paths;
}

}  // namespace mcc::gltf
