// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "notes.h"

#include <fmt/format.h>

#include <map>

#include "host/text.h"
#include "table.h"

namespace mcc::tool {
namespace {

/// Returns a note without its numbers and without the place that it begins with.
std::string kindOf(const std::string& note) {
  const size_t place_end = note.starts_with('/') ? note.find(": ") : std::string::npos;
  std::string kind = place_end == std::string::npos ? note : note.substr(place_end);
  std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
  return kind;
}

}  // namespace

std::string notesText(const std::vector<std::string>& notes, size_t most,
                      const std::string& indent) {
  std::map<std::string, size_t> line_of;
  std::vector<std::pair<const std::string*, size_t>> lines;  // the first of a kind, and how many
  for (const std::string& note : notes) {
    const auto [found, is_new] =
        line_of.try_emplace(most == kAllNotes ? note : kindOf(note), lines.size());
    if (is_new) lines.emplace_back(&note, 0);
    ++lines[found->second].second;
  }
  std::string text;
  size_t unsaid = notes.size();
  for (size_t i = 0; i < lines.size() && i < most; ++i) {
    const auto& [note, count] = lines[i];
    text += fmt::format("{}note: {}", indent, gltf::printable(*note));
    text += count == 1 ? "\n" : fmt::format(" (and {} more like this)\n", grouped(count - 1));
    unsaid -= count;
  }
  if (unsaid == 0) return text;
  return text + fmt::format("{}and {}; -v shows all\n", indent,
                            counted(unsaid, "other note", "other notes"));
}

}  // namespace mcc::tool
