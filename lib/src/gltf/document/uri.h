// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_DOCUMENT_URI_H_
#define MCC_GLTF_DOCUMENT_URI_H_

#include <cstdint>
#include <string>
#include <vector>

#include "host/result.h"

namespace mcc::gltf {

bool isDataUri(const std::string& uri);

/// Decodes "data:TYPE;base64,…" (or percent-encoded text without ";base64").
Result decodeDataUri(const std::string& uri, const std::string& where, std::vector<uint8_t>& bytes);

/// Turns a relative URI of a file at or below the model's folder into a relative path with '/'.
/// Refuses everything else: schemes, absolute paths, drive letters, `..` that leaves the folder,
/// control characters, and on Windows bytes that are not UTF-8. Percent encoding is resolved before
/// the test.
Result relativePathOf(const std::string& uri, const std::string& where, std::string& path);

/// Returns a path that relativePathOf() has accepted without its parts "." and "..".
std::string withoutDots(const std::string& path);

/// Whether no part of a relative path begins with a dot, as the names of hidden files and folders
/// do.
bool isVisiblePath(const std::string& path);

/// Whether every part of a relative path is the name of a file on Windows. There "NUL", "com1.bin"
/// and "CON .png" are devices in every folder, "a.bin:b" is a hidden stream of "a.bin", dots and
/// spaces at the end of a name are dropped, and bytes that are not UTF-8 name nothing.
bool isPathOnWindows(const std::string& path);

/// Whether names of files are those of Windows.
#if defined(_WIN32)
inline constexpr bool kIsWindows = true;
#else
inline constexpr bool kIsWindows = false;
#endif

/// Returns the percent-encoded URI of a file next to the model, from which relativePathOf() returns
/// the file.
std::string uriOf(const std::string& name);

/// Whether a URI can name a file of this name.
bool isUsableName(const std::string& name);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_URI_H_
