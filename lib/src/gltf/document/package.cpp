// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/package.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <set>

#include "gltf/document/references.h"
#include "host/text.h"

namespace mcc::gltf {
namespace {

bool decodePercent(const std::string& text, std::string& decoded) {
  decoded.clear();
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    uint8_t code = 0;
    const char* const digits = text.data() + i + 1;
    i += 2;
    if (i >= text.size() || std::from_chars(digits, digits + 2, code, 16).ptr != digits + 2)
      return false;
    decoded += static_cast<char>(code);
  }
  return true;
}

int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;  // '-' and '_': the URL-safe alphabet
  if (c == '/' || c == '_') return 63;
  return -1;
}

bool decodeBase64(const std::string& text, size_t begin, std::vector<uint8_t>& bytes) {
  bytes.reserve((text.size() - begin) / 4 * 3);
  uint32_t bits = 0;
  int bit_count = 0;
  size_t i = begin;
  for (; i < text.size() && text[i] != '='; ++i) {
    const int digit = base64Digit(text[i]);
    if (digit < 0) return false;
    bits = (bits << 6 | static_cast<uint32_t>(digit)) & 0xffffff;
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(static_cast<uint8_t>(bits >> bit_count));
    }
  }
  if (bit_count == 6) return false;  // a single digit is less than a byte
  return text.find_first_not_of('=', i) == std::string::npos;
}

/// Whether the text starts with "name:", which is a URI scheme or a drive letter.
bool hasScheme(const std::string& text) {
  const auto end = std::find_if(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '+' && c != '-' && c != '.';
  });
  return end != text.end() && *end == ':';
}

bool hasControlCharacter(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

/// Whether all parts of a path between its '/' pass.
template <typename Passes>
bool allParts(std::string_view path, const Passes& passes) {
  for (size_t begin = 0; begin <= path.size();) {
    const size_t end = std::min(path.find('/', begin), path.size());
    if (!passes(path.substr(begin, end - begin))) return false;
    begin = end + 1;
  }
  return true;
}

/// Whether following the path leaves its starting folder at any point.
bool climbsOut(const std::string& path) {
  int depth = 0;
  return !allParts(path, [&](std::string_view part) {
    if (part == "..") {
      --depth;
    } else if (!part.empty() && part != ".") {
      ++depth;
    }
    return depth >= 0;
  });
}

/// Whether Windows takes a name for a device: the part before the first dot decides.
bool isDeviceOnWindows(std::string_view name) {
  std::string device(name.substr(0, name.find('.')));
  while (device.ends_with(' ')) device.pop_back();
  for (char& c : device) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const std::string_view known : {"CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"}) {
    if (device == known) return true;
  }
  if (!device.starts_with("COM") && !device.starts_with("LPT")) return false;
  const std::string number = device.substr(3);
  const bool is_digit = number.size() == 1 && number[0] >= '0' && number[0] <= '9';
  return is_digit || number == "¹" || number == "²" || number == "³";
}

std::string quoted(const std::string& uri) { return "\"" + printable(shortened(uri, 80)) + "\""; }

}  // namespace

bool isDataUri(const std::string& uri) { return uri.starts_with("data:"); }

Result decodeDataUri(const std::string& uri, const std::string& where,
                     std::vector<uint8_t>& bytes) {
  bytes.clear();
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) return error(where, "the data URI has no comma");
  const std::string_view header = std::string_view(uri).substr(0, comma);
  if (header.ends_with(";base64")) {
    if (decodeBase64(uri, comma + 1, bytes)) return {};
    return error(where, "the base64 of the data URI is damaged");
  }
  std::string text;
  if (!decodePercent(uri.substr(comma + 1), text)) {
    return error(where, "the percent encoding of the data URI is damaged");
  }
  bytes.assign(text.begin(), text.end());
  return {};
}

Result relativePathOf(const std::string& uri, const std::string& where, std::string& path) {
  const std::string advice = "; use a relative URI of a file next to the model";
  if (uri.empty()) return error(where, "the URI is empty");
  if (!decodePercent(uri, path)) {
    return error(where, "the percent encoding of ", quoted(uri), " is damaged");
  }
  if (hasControlCharacter(path)) {
    return error(where, "the URI ", quoted(uri), " has control characters");
  }
  // No path could be made from such a text, see pathOf().
  if (kIsWindows && !isUtf8(path)) {
    return error(where, "the URI ", quoted(uri),
                 " is not UTF-8, so no file on Windows can have that name; rename it");
  }
  // Test before and after decoding: "%66ile:" must not become a scheme, nor "a:b" a path.
  if (hasScheme(uri) || hasScheme(path)) {
    return error(where, "the URI ", quoted(uri), " is not relative and is refused", advice);
  }
  std::replace(path.begin(), path.end(), '\\', '/');
  if (path.front() == '/') {
    return error(where, "the URI ", quoted(uri), " is absolute and is refused", advice);
  }
  if (climbsOut(path)) {
    return error(where, "the URI ", quoted(uri), " leaves the folder of the model and is refused",
                 advice);
  }
  return {};
}

std::string withoutDots(const std::string& path) {
  std::vector<std::string_view> parts;
  allParts(path, [&](std::string_view part) {
    if (part == ".." && !parts.empty()) {
      parts.pop_back();
    } else if (!part.empty() && part != ".") {
      parts.push_back(part);
    }
    return true;
  });
  std::string joined;
  for (const std::string_view part : parts) joined.append(joined.empty() ? "" : "/").append(part);
  return joined;
}

bool isPathOnWindows(const std::string& path) {
  if (!isUtf8(path)) return false;  // names are made of characters there
  return allParts(path, [](std::string_view part) {
    if (part.empty() || part == "." || part == "..") return true;
    if (part.ends_with('.') || part.ends_with(' ') || isDeviceOnWindows(part)) return false;
    return part.find_first_of("<>:\"|?*\\") == std::string_view::npos;
  });
}

std::string uriOf(const std::string& name) {
  static constexpr std::string_view kPlain = "-._~!$&'()*+,;=@";
  static constexpr char kHexDigits[] = "0123456789ABCDEF";
  std::string uri = hasScheme(name) ? "./" : "";  // "a:b.bin" would have the scheme "a"
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80 && (std::isalnum(code) != 0 || kPlain.find(c) != std::string_view::npos)) {
      uri += c;
    } else {
      uri += {'%', kHexDigits[code >> 4], kHexDigits[code & 15]};
    }
  }
  return uri;
}

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
std::string endingOf(const std::string& file_name) {
  const size_t dot = file_name.find_last_of("./");
  if (dot == std::string::npos || file_name[dot] == '/') return "";
  std::string extension = file_name.substr(dot);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// Whether no part of a relative path begins with a dot, as the names of hidden files and folders
/// do.
bool isVisiblePath(const std::string& path) {
  return allParts(path, [](std::string_view part) {
    return !part.starts_with('.') || part == "." || part == "..";
  });
}

Result readCopy(bool is_image, const FileReader& read_file, const std::string& where,
                SideFile& file) {
  const std::string name = "\"" + file.path + "\"";
  if (!isVisiblePath(file.path)) return error(where, name, " is the name of a hidden file");
  MCC_GLTF_TRY(read_file(file.path, where, file.bytes));
  if (!is_image || !imageTypeOf(file.bytes).empty()) return {};
  return error(where, name, " is not a known type of image");
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
  container.is_gltf = endingOf(file_name) == ".gltf";
  container.file_name = file_name;
  container.stem = dot == 0 ? file_name : file_name.substr(0, dot);
  return container.is_gltf ? checkName(container.stem + ".bin", file_name) : Result();
}

Result checkName(const std::string& name, const std::string& where) {
  std::string path;
  const bool is_path = relativePathOf(uriOf(name), "", path).ok();
  // They differ when the name has a backslash.
  if (is_path && (path == name || path == "./" + name)) return {};
  return error(where, "no URI can name a file \"", name, "\"; choose another name");
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
    const std::string extension = endingOf(path);
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
  std::string path;
  for (const auto& [uri, where] : uris) {
    if (relativePathOf(uri, where, path).ok() && seen.insert(path).second) paths.push_back(path);
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
