// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/file_table.h"

#include <algorithm>
#include <array>

#include "host/result.h"
#include "host/text.h"

namespace mcc::tiles {

namespace fs = std::filesystem;
using gltf::Result;

std::string genericText(const fs::path& path) {
  const std::u8string text = path.generic_u8string();
  return {text.begin(), text.end()};
}

bool isInside(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

bool isNameOfLeaf(std::string_view name) {
  static constexpr std::array<std::string_view, 14> kEndings = {
      ".glb",  ".b3dm", ".i3dm", ".cmpt", ".pnts", ".vctr", ".geom",
      ".gltf", ".bin",  ".png",  ".jpg",  ".jpeg", ".webp", ".ktx2"};
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](std::string_view ending) { return name.ends_with(ending); });
}

Result FileTable::add(const fs::directory_entry& entry, const fs::path& folder,
                      std::vector<std::string>& notes) {
  std::error_code code;
  if (entry.is_directory(code) && !entry.is_symlink(code)) return {};
  const std::string name = genericText(entry.path().lexically_relative(folder));
  if (!entry.is_regular_file(code)) {
    notes.push_back(name + ": is neither a file nor a folder, and is left out");
    return {};
  }
  if (entry.is_symlink(code) &&
      !isInside(fs::canonical(entry.path(), code), fs::canonical(folder, code))) {
    notes.push_back(name + ": is a link to a file elsewhere, and is left out");
    return {};
  }
  // A .gltf decides what becomes of its buffers, so every part must know all of them.
  const bool concerns_others = !isNameOfLeaf(name) || name.ends_with(".gltf");
  if (!concerns_others && !part_.has(name)) return {};
  if (files_.size() >= kNone - 1) return gltf::error(gltf::textOf(folder), "has too many files");
  files_.push_back({names_.size(), entry.file_size(code), static_cast<uint32_t>(name.size())});
  names_ += name;
  return {};
}

Result FileTable::read(const fs::path& folder, const Part& part,
                       bool (*is_ours)(std::string_view name), std::vector<std::string>& notes) {
  part_ = part;
  std::error_code code;
  for (fs::recursive_directory_iterator it(folder, code), end; !code && it != end;
       it.increment(code)) {
    if (it.depth() == 0 && is_ours(genericText(it->path().filename()))) {
      it.disable_recursion_pending();
      continue;
    }
    MCC_GLTF_TRY(add(*it, folder, notes));
  }
  if (code)
    return gltf::error(gltf::textOf(folder), "the folder cannot be read: " + code.message());
  std::sort(files_.begin(), files_.end(), [this](const File& a, const File& b) {
    const std::string_view names = names_;
    return names.substr(a.name_begin, a.name_bytes) < names.substr(b.name_begin, b.name_bytes);
  });
  return {};
}

uint32_t FileTable::find(std::string_view name) const {
  uint32_t low = 0;
  uint32_t high = size();
  while (low < high) {
    const uint32_t middle = low + (high - low) / 2;
    if (this->name(middle) < name) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < size() && this->name(low) == name ? low : kNone;
}

}  // namespace mcc::tiles
