// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/package.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include "gltf/document/references.h"
#include "gltf/document/uri.h"

namespace mcc::gltf {
namespace {

constexpr size_t kHashDigits = 16;
constexpr std::string_view kBufferEnd = ".bin";
constexpr std::string_view kFallbackEnd = ".fallback.bin";

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
  const size_t dot = file_name.rfind('.');
  container.is_gltf = extensionOf(file_name) == ".gltf";
  container.file_name = file_name;
  container.stem = dot == 0 ? file_name : file_name.substr(0, dot);
  const std::string buffer_name = container.stem + ".bin";
  if (container.is_gltf && !isUsableName(buffer_name)) {
    return error(file_name, "no URI can name a file \"" + buffer_name + "\"; choose another name");
  }
  return {};
}

std::string nameOfMade(const Container& container, SideFile::Kind kind,
                       std::span<const uint8_t> bytes) {
  uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  const auto add = [&](uint8_t byte) { hash = (hash ^ byte) * 0x100000001b3; };
  for (const char c : container.file_name) add(static_cast<uint8_t>(c));
  for (const uint8_t byte : bytes) add(byte);
  std::string digits(kHashDigits, '0');
  for (size_t i = kHashDigits; i-- != 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
  return (container.stem + "." + digits)
      .append(kind == SideFile::Kind::kFallback ? kFallbackEnd : kBufferEnd);
}

bool isNameOfMade(const Container& container, std::string_view name) {
  if (!name.starts_with(container.stem)) return false;
  name.remove_prefix(container.stem.size());
  const std::string_view digits = name.substr(0, kHashDigits + 1);
  const bool has_hash = digits.size() > kHashDigits && digits[0] == '.' &&
                        digits.find_first_not_of("0123456789abcdef", 1) == std::string_view::npos;
  if (has_hash) name.remove_prefix(digits.size());
  return name == kFallbackEnd || name == kBufferEnd;
}

namespace {

/// Pads the JSON of a GLB with property tables so that its BIN chunk begins at a multiple of 8, as
/// EXT_structural_metadata demands for numbers of 64 bits, and glTF 2.1 for such accessors. In
/// version 3 of a GLB it does so anyway.
std::string glbText(const Json& json) {
  constexpr size_t kBytesBeforeBin = 28;  // a header of 12 bytes, and two of chunks
  std::string text = printJson(json);
  const bool has_tables = extensionOf(json, kMetadataExtension) != nullptr;
  if (!has_tables && !hasWideAccessors(json)) return text;
  while ((kBytesBeforeBin + text.size()) % 8 != 0) text += ' ';
  return text;
}

}  // namespace

Result writePackage(const Container& container, Json json, const BufferContent& buffer,
                    const std::vector<GlbChunk>& other_chunks, Package& package) {
  if (!container.is_gltf) {
    std::span<uint8_t> bin;
    MCC_GLTF_TRY(startGlb(glbText(json), buffer.byte_count, other_chunks, package.main, bin,
                          container.glb_version));
    return buffer.fill(bin);
  }
  if (buffer.byte_count != 0) {
    SideFile file;
    file.bytes.resize(buffer.byte_count);
    MCC_GLTF_TRY(buffer.fill(file.bytes));
    file.path = nameOfMade(container, file.kind, file.bytes);
    json["buffers"][0]["uri"] = uriOf(file.path);
    package.beside.push_back(std::move(file));
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

bool isTileset(const Json& json) {
  return findMember(json, "root") != nullptr && findMember(json, "geometricError") != nullptr;
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

std::string imageTypeOf(std::span<const uint8_t> bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                              std::min<size_t>(bytes.size(), 12));
  if (head.starts_with("\x89PNG")) return "image/png";
  if (head.starts_with("\xff\xd8\xff")) return "image/jpeg";
  if (head.starts_with("\xabKTX 20\xbb")) return "image/ktx2";
  if (head.size() == 12 && head.starts_with("RIFF") && head.substr(8) == "WEBP")
    return "image/webp";
  if (head.starts_with("DDS ")) return "image/vnd-ms.dds";
  if (head.size() == 12 && (head.substr(4) == "ftypavif" || head.substr(4) == "ftypavis")) {
    return "image/avif";
  }
  // The signature "sB", the version, and the header's size of 77 bytes, each in two bytes.
  if (head.starts_with("sB") && head.size() >= 6 && head[4] == 77 && head[5] == 0) {
    return "image/basis";
  }
  return "";
}

}  // namespace mcc::gltf
