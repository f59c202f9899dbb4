// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "host/text.h"

namespace mcc::gltf {
namespace {

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool decodePercent(const std::string& text, std::string& decoded) {
  decoded.clear();
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hexDigit(text[i + 1]) : -1;
    const int low = high >= 0 ? hexDigit(text[i + 2]) : -1;
    if (low < 0) return false;
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
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
  for (; i < text.size(); ++i) {
    if (text[i] != '=') return false;
  }
  return true;
}

/// Whether the text starts with "name:", which is a URI scheme or a drive letter.
bool hasScheme(const std::string& text) {
  for (const char c : text) {
    if (c == ':') return true;
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '+' && c != '-' && c != '.') {
      return false;
    }
  }
  return false;
}

bool hasControlCharacter(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return true;
  }
  return false;
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
    return error(where, "the percent encoding of " + quoted(uri) + " is damaged");
  }
  if (hasControlCharacter(path)) {
    return error(where, "the URI " + quoted(uri) + " has control characters");
  }
  // No path could be made from such a text, see pathOf().
  if (kIsWindows && !isUtf8(path)) {
    return error(where, "the URI " + quoted(uri) +
                            " is not UTF-8, so no file on Windows can have that name; rename it");
  }
  // Test before and after decoding: "%66ile:" must not become a scheme, nor "a:b" a path.
  if (hasScheme(uri) || hasScheme(path)) {
    return error(where, "the URI " + quoted(uri) + " is not relative and is refused" + advice);
  }
  for (char& c : path) {
    if (c == '\\') c = '/';
  }
  if (path.front() == '/') {
    return error(where, "the URI " + quoted(uri) + " is absolute and is refused" + advice);
  }
  if (climbsOut(path)) {
    return error(where, "the URI " + quoted(uri) +
                            " leaves the folder of the model and is refused" + advice);
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

bool isVisiblePath(const std::string& path) {
  return allParts(path, [](std::string_view part) {
    return !part.starts_with('.') || part == "." || part == "..";
  });
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

bool isUsableName(const std::string& name) {
  std::string path;
  if (!relativePathOf(uriOf(name), "", path).ok()) return false;
  return path == name || path == "./" + name;  // false when the name has a backslash
}

}  // namespace mcc::gltf
