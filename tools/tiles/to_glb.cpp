// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/to_glb.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gltf/base/path_text.h"
#include "gltf/base/result.h"
#include "gltf/files/file_io.h"
#include "gltf/files/named_file.h"
#include "tiles/tile_uri.h"
#include "tiles/tileset_json.h"

namespace mcc::tiles {
namespace {

using gltf::Result;

/// A string of the JSON that is replaced: the last one before `end`, which begins after `begin`.
struct Edit {
  uint64_t begin = 0;
  uint64_t end = 0;
  std::string text;
};

std::vector<Edit> editsOf(const std::string& name, const TilesetJson& tileset) {
  std::vector<Edit> edits;
  if (tileset.version == "1.0") {
    edits.push_back({tileset.version_begin, tileset.version_end, "1.1"});
  }
  for (const TilesetJson::Content& content : tileset.contents) {
    if (content.is_uri_wrong) continue;
    const std::string uri(tileset.uriOf(content));
    std::optional<std::string> renamed = glbNameOf(uri);
    std::string path;
    bool is_remote = false;
    const bool is_ours = renamed && resolveTileUri(name, uri, path, is_remote).ok() && !is_remote;
    if (!is_ours) continue;
    edits.push_back({content.token_begin, content.token_end, std::move(*renamed)});
  }
  std::sort(edits.begin(), edits.end(),
            [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
  return edits;
}

}  // namespace

std::optional<std::string> glbNameOf(std::string_view name) {
  constexpr std::string_view kOld = ".b3dm";
  const size_t end = std::min(name.find_first_of("?#"), name.size());
  if (!name.substr(0, end).ends_with(kOld)) return std::nullopt;
  std::string renamed(name.substr(0, end - kOld.size()));
  return renamed.append(".glb").append(name.substr(end));
}

Result renameContents(const std::filesystem::path& folder, const std::string& name,
                      uint64_t max_tiles, std::vector<uint8_t>& json) {
  const std::filesystem::path path = folder / gltf::pathOf(name);
  TilesetJson tileset;
  MCC_GLTF_TRY(readTilesetJson(folder, name, max_tiles, tileset));
  std::vector<uint8_t> source;
  MCC_GLTF_TRY(gltf::inFile(path, gltf::readNamed(folder, name, source)));
  json.clear();
  uint64_t kept = 0;
  for (const Edit& edit : editsOf(name, tileset)) {
    if (edit.end > source.size())
      return gltf::error(gltf::textOf(path), "changes while it is read");
    // Between a key and its string there are only white space and a colon.
    const auto quote = std::find(source.begin() + static_cast<ptrdiff_t>(edit.begin),
                                 source.begin() + static_cast<ptrdiff_t>(edit.end), '"');
    json.insert(json.end(), source.begin() + static_cast<ptrdiff_t>(kept), quote);
    const std::string text = nlohmann::json(edit.text).dump();
    json.insert(json.end(), text.begin(), text.end());
    kept = edit.end;
  }
  json.insert(json.end(), source.begin() + static_cast<ptrdiff_t>(kept), source.end());
  return {};
}

}  // namespace mcc::tiles
