// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tileset.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "gltf/base/path_text.h"
#include "gltf/base/result.h"
#include "gltf/document/glb.h"
#include "gltf/document/json.h"
#include "gltf/document/uri.h"
#include "gltf/files/file_io.h"

namespace mcc::tiles {
namespace {

namespace fs = std::filesystem;
using gltf::findMember;
using gltf::Json;
using gltf::Result;

constexpr uint64_t kMostTiles = uint64_t{1} << 24;
constexpr uint64_t kMostTilesets = uint64_t{1} << 20;
constexpr uint32_t kMostNesting = 128;  // of external tilesets

/// Parses JSON of any depth, which gltf::parseJson() would refuse: a level of tiles takes two
/// levels of JSON. Neither nlohmann's parser nor its destructor recurse.
Result parseTree(std::span<const uint8_t> file, Json& json) {
  json = Json::parse(file.begin(), file.end(), nullptr, false);
  if (!json.is_discarded()) return {};
  Result reason = gltf::parseJson(file, json);  // for its message
  return reason.ok() ? gltf::error("", "is not JSON") : reason;
}

bool hasRoot(const Json& json) {
  const Json* root = findMember(json, "root");
  return root != nullptr && root->is_object();
}

/// A tileset that is to be read, and the tile that names it.
struct PendingTileset {
  std::string path;  ///< relative to the folder
  std::string where;
  uint32_t parent = kNone;  ///< index of the tileset that names it
  uint32_t depth = 0;
  uint32_t level = 0;
  double inherited_error = 0;
  Matrix transform = kIdentity;
};

/// A tile that is to be read.
struct PendingTile {
  const Json* json;
  std::string where;  ///< JSON path
  uint32_t level;
  double inherited_error;
  Matrix transform;
};

class TilesetReader {
 public:
  TilesetReader(fs::path folder, Tileset& tileset) : folder_(std::move(folder)), out_(tileset) {}

  Result run(const std::string& name) {
    pending_.push_back({name, "", kNone, 0, 0, 0, kIdentity});
    // The list grows by the external tilesets, so this visits all. It keeps those that were read,
    // because each knows which one named it.
    for (uint32_t i = 0; i < pending_.size(); ++i) {
      Result read = readOne(i);
      if (!read.ok() && (i == 0 || is_fatal_)) return read;
      if (!read.ok()) out_.failures.push_back(std::move(read));
    }
    for (auto& [path, content] : contents_) out_.contents.push_back(std::move(content));
    return {};
  }

 private:
  Result readOne(uint32_t index) {
    const PendingTileset tileset = pending_[index];
    const fs::path path = folder_ / gltf::pathOf(tileset.path);
    std::vector<uint8_t> bytes;
    MCC_GLTF_TRY(gltf::readFile(path, bytes));
    Json json;
    MCC_GLTF_TRY(gltf::inFile(path, parseTree(bytes, json)));
    if (!hasRoot(json)) return gltf::error(gltf::textOf(path), "is not a tileset: it has no root");
    double error = tileset.inherited_error;
    const Json* own = findMember(json, "geometricError");
    double number = 0;
    if (own != nullptr && gltf::asNumber(*own, number) && number > 0 && std::isfinite(number)) {
      error = number;
    }
    const Json* asset = findMember(json, "asset");
    const Json* axis = asset == nullptr ? nullptr : findMember(*asset, "gltfUpAxis");
    up_axis_ = axis != nullptr && axis->is_string() ? axis->get<std::string>() : "";
    stack_.push_back({&json["root"], "/root", tileset.level, error, tileset.transform});
    while (!stack_.empty()) {
      const PendingTile tile = std::move(stack_.back());
      stack_.pop_back();
      MCC_GLTF_TRY(gltf::inFile(path, readTile(index, tile)));
    }
    return {};
  }

  Result tooMany(const std::string& what) {
    is_fatal_ = true;
    return gltf::error("", "the tilesets name more than " + what + "; convert parts of them alone");
  }

  void fail(uint32_t tileset, const std::string& where, const std::string& what) {
    const fs::path path = folder_ / gltf::pathOf(pending_[tileset].path);
    out_.failures.push_back(gltf::inFile(path, gltf::error(where, what)));
  }

  Result readTile(uint32_t tileset, const PendingTile& tile) {
    if (++tile_count_ > kMostTiles) return tooMany(std::to_string(kMostTiles) + " tiles");
    TileUse use = {tile.level, 0, tile.transform, up_axis_};
    Matrix local = kIdentity;
    if (const Json* given = findMember(*tile.json, "transform")) {
      if (!readNumbers(*given, local.data(), 16)) {
        fail(tileset, tile.where + "/transform",
             "is not an array of 16 numbers; the tiles from here on are only copied");
        return {};
      }
      use.transform = product(tile.transform, local);
    }
    double error = 0;
    const Json* given = findMember(*tile.json, "geometricError");
    if (given == nullptr || !gltf::asNumber(*given, error) || !(error >= 0) ||
        !std::isfinite(error)) {
      fail(tileset, tile.where + "/geometricError", "is not a number of at least 0");
      error = 0;
    }
    const double inherited = error > 0 ? error : tile.inherited_error;
    use.geometric_error = error > 0 ? error : tile.inherited_error / 2;
    if (out_.level_tiles.size() <= tile.level) out_.level_tiles.resize(size_t{tile.level} + 1);
    ++out_.level_tiles[tile.level];
    MCC_GLTF_TRY(readContents(tileset, tile, use, inherited));
    const Json* children = findMember(*tile.json, "children");
    if (children == nullptr) return {};
    if (!children->is_array()) {
      fail(tileset, tile.where + "/children", "is not an array");
      return {};
    }
    for (size_t i = children->size(); i-- > 0;) {  // the stack turns the order around
      if ((*children)[i].is_object()) {
        stack_.push_back({&(*children)[i], gltf::at(tile.where + "/children", i), tile.level + 1,
                          inherited, use.transform});
      } else {
        fail(tileset, gltf::at(tile.where + "/children", i), "is not an object");
      }
    }
    return {};
  }

  Result readContents(uint32_t tileset, const PendingTile& tile, const TileUse& use,
                      double inherited) {
    const Json* extensions = findMember(*tile.json, "extensions");
    const bool is_implicit =
        findMember(*tile.json, "implicitTiling") != nullptr ||
        (extensions != nullptr && findMember(*extensions, "3DTILES_implicit_tiling") != nullptr);
    if (is_implicit) {  // its URIs are templates
      ++out_.implicit_count;
      return {};
    }
    if (const Json* content = findMember(*tile.json, "content")) {
      MCC_GLTF_TRY(readContent(tileset, *content, tile.where + "/content", use, inherited));
    }
    MCC_GLTF_TRY(readList(tileset, *tile.json, "contents", tile.where, use, inherited));
    const Json* multiple =
        extensions == nullptr ? nullptr : findMember(*extensions, "3DTILES_multiple_contents");
    if (multiple == nullptr) return {};
    const std::string where = tile.where + "/extensions/3DTILES_multiple_contents";
    MCC_GLTF_TRY(readList(tileset, *multiple, "content", where, use, inherited));
    return readList(tileset, *multiple, "contents", where, use, inherited);
  }

  Result readList(uint32_t tileset, const Json& object, const char* key, const std::string& where,
                  const TileUse& use, double inherited) {
    const Json& list = gltf::arrayOf(object, key);
    for (size_t i = 0; i < list.size(); ++i) {
      MCC_GLTF_TRY(readContent(tileset, list[i], gltf::at(where + "/" + key, i), use, inherited));
    }
    return {};
  }

  /// Reads one content. Errors: a cycle, or too many tilesets.
  Result readContent(uint32_t tileset, const Json& content, const std::string& where,
                     const TileUse& use, double inherited) {
    const Json* uri = findMember(content, "uri");
    if (uri == nullptr) uri = findMember(content, "url");  // until version 1.0
    if (uri == nullptr || !uri->is_string()) {
      fail(tileset, where, "names no file: uri is not a string");
      return {};
    }
    std::string path;
    bool is_remote = false;
    const Result found = resolve(pending_[tileset].path, uri->get<std::string>(), path, is_remote);
    if (is_remote) {
      ++out_.remote_count;
      return {};
    }
    if (!found.ok()) {
      fail(tileset, where + "/uri", found.what);
      return {};
    }
    if (looksLikeTileset(path)) return addTileset(tileset, path, where, use, inherited);
    TileContent& known = contents_[path];
    if (known.uses.empty()) {
      known.path = path;
      known.where =
          gltf::textOf(folder_ / gltf::pathOf(pending_[tileset].path)) + ": " + where + "/uri";
    }
    known.uses.push_back(use);
    return {};
  }

  /// Finds the file that a URI in a tileset names. It must be in the folder of the first tileset.
  static Result resolve(const std::string& base, std::string uri, std::string& path,
                        bool& is_remote) {
    const size_t scheme = uri.find(':');
    is_remote =
        (scheme != std::string::npos && scheme < uri.find_first_of("/?#")) || uri.starts_with("//");
    if (is_remote) return {};
    uri = uri.substr(0, uri.find_first_of("?#"));
    if (uri.empty()) return gltf::error("", "is empty");
    if (uri.starts_with('/')) return gltf::error("", "is absolute; use a relative one");
    const size_t slash = base.rfind('/');
    std::string folder;
    if (slash != std::string::npos) {
      for (const char c : base.substr(0, slash + 1)) {
        folder += c == '/' ? "/" : gltf::uriOf(std::string(1, c));
      }
    }
    std::string joined;
    MCC_GLTF_TRY(gltf::relativePathOf(folder + uri, "", joined));
    const std::u8string normal = gltf::pathOf(joined).lexically_normal().generic_u8string();
    path.assign(normal.begin(), normal.end());
    return {};
  }

  /// Whether a file is an external tileset. Files that cannot be read are not; that is reported
  /// when they are to be converted.
  bool looksLikeTileset(const std::string& path) {
    const auto [known, is_new] = is_tileset_.try_emplace(path, false);
    if (!is_new) return known->second;
    const fs::path file = folder_ / gltf::pathOf(path);
    std::error_code code;
    if (!fs::is_regular_file(file, code)) return false;
    char start[256] = {};
    std::ifstream stream(file, std::ios::binary);
    stream.read(start, sizeof(start));
    const auto count = static_cast<size_t>(std::max<std::streamsize>(stream.gcount(), 0));
    if (!gltf::isJsonText({reinterpret_cast<const uint8_t*>(start), count})) return false;
    std::vector<uint8_t> bytes;
    known->second = gltf::readFile(file, bytes).ok() && isTileset(bytes);
    return known->second;
  }

  Result addTileset(uint32_t tileset, const std::string& path, const std::string& where,
                    const TileUse& use, double inherited) {
    is_fatal_ = true;  // as long as this function does not succeed
    for (uint32_t above = tileset; above != kNone; above = pending_[above].parent) {
      if (pending_[above].path == path) {
        return gltf::error(where + "/uri", "the external tileset \"" + path +
                                               "\" contains itself; remove one of the two");
      }
    }
    const uint32_t depth = pending_[tileset].depth + 1;
    if (depth > kMostNesting) {
      return gltf::error(where + "/uri", "external tilesets are nested deeper than " +
                                             std::to_string(kMostNesting));
    }
    if (pending_.size() >= kMostTilesets) {
      return tooMany(std::to_string(kMostTilesets) + " tilesets");
    }
    is_fatal_ = false;
    pending_.push_back({path, where, tileset, depth, use.level + 1, inherited, use.transform});
    return {};
  }

  const fs::path folder_;
  Tileset& out_;
  std::vector<PendingTileset> pending_;
  std::vector<PendingTile> stack_;
  std::map<std::string, TileContent> contents_;
  std::map<std::string, bool> is_tileset_;
  std::string up_axis_;
  uint64_t tile_count_ = 0;
  bool is_fatal_ = false;
};

}  // namespace

bool isTileset(std::span<const uint8_t> file) {
  if (!gltf::isJsonText(file)) return false;
  return hasRoot(Json::parse(file.begin(), file.end(), nullptr, false));
}

Result readTileset(const fs::path& file, Tileset& tileset) {
  tileset = {};
  return TilesetReader(gltf::folderOf(file), tileset).run(gltf::textOf(file.filename()));
}

}  // namespace mcc::tiles
