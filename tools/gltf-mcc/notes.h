// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_NOTES_H_
#define MCC_TOOL_NOTES_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace mcc::tool {

inline constexpr size_t kAllNotes = SIZE_MAX;
inline constexpr size_t kSomeNotes = 12;  ///< lines about one file, without -v

/// Returns one line per note, "note: TEXT". Notes that differ only in their place in the file and
/// in numbers share a line, which shows the first of them. Above `most` lines the others are
/// counted. With kAllNotes every note has its own line. indent  goes before each line.
std::string notesText(const std::vector<std::string>& notes, size_t most,
                      const std::string& indent = "");

}  // namespace mcc::tool

#endif  // MCC_TOOL_NOTES_H_
