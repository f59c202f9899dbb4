// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Names of files as text: UTF-8 in documents, messages and command lines, whatever the system
// takes.
#ifndef MCC_GLTF_BASE_PATH_TEXT_H_
#define MCC_GLTF_BASE_PATH_TEXT_H_

#include <filesystem>
#include <string>
#include <string_view>

namespace mcc::gltf {

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

#endif  // MCC_GLTF_BASE_PATH_TEXT_H_
