// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Text and paths: what may be printed on a terminal, and names of files as UTF-8, whatever the
// system takes.
#ifndef MCC_HOST_TEXT_H_
#define MCC_HOST_TEXT_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "mcc/result.h"

namespace mcc::gltf {

/// Makes a text that may come from a file, or from a file's name, safe for one line of a terminal:
/// control characters (C0, DEL, C1), line and paragraph separators, marks that change the direction
/// of writing, and bytes that are not UTF-8 become '?'. Other characters stay. Linear in the
/// length.
std::string printable(std::string_view text);

/// Does the same for both parts of a result.
Result printable(Result result);

/// Whether every byte of a text belongs to a character of UTF-8. Linear in the length.
bool isUtf8(std::string_view text);

/// Returns at most `max_bytes` bytes of a text, cut between two characters and marked with "…".
std::string shortened(const std::string& text, size_t max_bytes);

/// Returns the path that a text in UTF-8 names. The constructor of a path would take the text for
/// one in the code page of the user on Windows. There it throws when the text is not UTF-8, which
/// relativePathOf() makes sure of for names from documents.
inline std::filesystem::path pathOf(std::string_view text) {
  return std::u8string(text.begin(), text.end());
}

/// The inverse of pathOf(). Where paths are bytes, any bytes come back.
inline std::string textOf(const std::filesystem::path& path) {
  const std::u8string text = path.u8string();
  return {text.begin(), text.end()};
}

}  // namespace mcc::gltf

#endif  // MCC_HOST_TEXT_H_
