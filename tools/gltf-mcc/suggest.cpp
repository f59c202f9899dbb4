// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "suggest.h"

#include "host/text.h"

#include <algorithm>
#include <filesystem>

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;

/// Extensions of files that models come in, and that are neither GLB nor JSON.
constexpr const char* kOtherFormats[] = {".obj", ".ply", ".stl",  ".fbx", ".dae", ".3ds",
                                         ".off", ".x3d", ".usdz", ".usd", ".drc", ".blend"};

/// Returns the extension of a path in lower case, with its dot.
std::string extensionOf(const std::string& path) {
  std::string extension = gltf::textOf(gltf::pathOf(path).extension());
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

/// Returns how many letters have to be changed, added, removed, or exchanged with their neighbour.
size_t distanceOf(std::string_view a, std::string_view b) {
  std::vector<size_t> before_last(b.size() + 1);
  std::vector<size_t> last(b.size() + 1);
  std::vector<size_t> row(b.size() + 1);
  for (size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i;
    for (size_t k = 1; k <= b.size(); ++k) {
      row[k] =
          std::min({last[k] + 1, row[k - 1] + 1, last[k - 1] + (a[i - 1] != b[k - 1] ? 1 : 0)});
      const bool is_exchange = i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1];
      if (is_exchange) row[k] = std::min(row[k], before_last[k - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr size_t kPrefix = 3;  // letters from which on a prefix counts
  const size_t limit = word.size() < 5 ? 1 : std::max<size_t>(2, word.size() / 3);
  std::string best;
  size_t least = limit + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = distanceOf(word, candidate);
    if (distance >= least || distance >= std::max(word.size(), candidate.size())) continue;
    least = distance;
    best = candidate;
  }
  if (!best.empty() || word.size() < kPrefix) return best;
  const auto begins = std::find_if(candidates.begin(), candidates.end(),
                                   [&](const std::string& c) { return c.starts_with(word); });
  return begins == candidates.end() ? "" : *begins;
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearestWord(word, candidates);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

std::string didYouMeanFile(const std::string& path) {
  constexpr size_t kMostFiles = 10000;  // files of a folder that are considered
  const fs::path wanted = gltf::pathOf(path);
  std::error_code code;
  for (const char* extension : {".glb", ".gltf"}) {
    const std::string longer = path + extension;
    if (fs::is_regular_file(gltf::pathOf(longer), code)) return "; did you mean " + longer + "?";
  }
  const fs::path folder = wanted.has_parent_path() ? wanted.parent_path() : fs::path(".");
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end;
       entry.increment(code)) {
    if (names.size() == kMostFiles) return "";
    const std::string extension = gltf::textOf(entry->path().extension());
    if (extension != ".glb" && extension != ".gltf") continue;
    names.push_back(gltf::textOf(entry->path().filename()));
  }
  std::sort(names.begin(), names.end());
  const std::string nearest = nearestWord(gltf::textOf(wanted.filename()), names);
  if (nearest.empty()) return "";
  return "; did you mean " + gltf::textOf(wanted.parent_path() / gltf::pathOf(nearest)) + "?";
}

std::string shellWord(const std::string& word) {
  const auto isPlain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           static_cast<unsigned char>(c) >= 0x80 ||
           std::string_view("-_./,:=+@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), isPlain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

bool isModelName(const std::string& path) {
  const std::string extension = extensionOf(path);
  return extension == ".glb" || extension == ".gltf";
}

bool isOtherFormat(const std::string& path) {
  const auto isIt = [extension = extensionOf(path)](const char* other) {
    return extension == other;
  };
  return std::any_of(std::begin(kOtherFormats), std::end(kOtherFormats), isIt);
}

std::string howToReadOther(const std::string& path) {
  if (!isOtherFormat(path)) return "";
  const fs::path name = gltf::pathOf(path);
  return "; turn it into a .glb first, with Blender or with: assimp export " + shellWord(path) +
         " " + shellWord(gltf::textOf(fs::path(name).replace_extension(".glb"))) + " -fglb2";
}

}  // namespace mcc::tool
