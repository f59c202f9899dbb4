// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tileset_walk.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "gltf/base/path_text.h"
#include "gltf/base/result.h"
#include "gltf/document/json.h"
#include "gltf/files/file_io.h"
#include "tiles/subtree.h"
#include "tiles/tile_uri.h"
#include "tiles/tileset_json.h"
#include "tiles/to_glb.h"

namespace mcc::tiles {

namespace fs = std::filesystem;
using gltf::Result;

namespace {

constexpr uint32_t kMostNesting = 128;  // of external tilesets
constexpr size_t kMostFailures = 1000;
constexpr uint64_t kMostImplicitLevels = 32;

UpAxis upAxisOf(const std::string& name) {
  if (name == "X") return UpAxis::kX;
  return name == "Z" ? UpAxis::kZ : UpAxis::kY;
}

}  // namespace

class TilesetWalker {
 public:
  TilesetWalker(TilesetWalk& out, const fs::path& folder, const FileTable& files, const Part& part,
                uint64_t max_tiles)
      : out_(out),
        folder_(folder),
        files_(files),
        part_(part),
        budget_(max_tiles),
        max_tiles_(max_tiles) {
    out_.demand_numbers_.assign(files.size(), kNone);
    kinds_.assign(files.size(), Kind::kUnknown);
  }

  /// External tilesets are visited depth first, so that those which name each other are the last
  /// ones of a list.
  Result run(const std::string& name) {
    const uint32_t first = files_.find(name);
    if (first == kNone) {
      return gltf::error(gltf::textOf(folder_ / gltf::pathOf(name)), "is no file in its folder");
    }
    stack_.push_back({first, 0, 0, 0, kIdentity});
    while (!stack_.empty()) {
      const Pending next = stack_.back();
      stack_.pop_back();
      chain_.resize(next.depth);
      chain_.push_back(next.file);
      Result read = readOne(next);
      if (read.ok()) continue;
      if (is_fatal_ || next.depth == 0) return read;
      fail(std::move(read));
    }
    return {};
  }

 private:
  enum class Kind : uint8_t { kUnknown, kTileset, kOther };

  /// An external tileset that is to be read, and what the tile that names it hands down.
  struct Pending {
    uint32_t file = 0;
    uint32_t depth = 0;
    uint32_t level = 0;
    double inherited_error = 0;
    Matrix transform = kIdentity;
  };

  /// What a tile hands down to its children.
  struct Inherited {
    uint32_t level = 0;
    bool is_left_out = false;
    uint32_t transform = 0;  ///< index into transforms_
    double error = 0;
  };

  /// A content: the file that its URI was found in, and its place there for messages.
  struct Named {
    const std::string& base;
    std::string uri;
    std::function<std::string()> where;
  };

  Result readOne(const Pending& tileset) {
    const std::string name(files_.name(tileset.file));
    path_ = folder_ / gltf::pathOf(name);
    name_ = name;
    if (tileset.depth == 0) {
      kinds_[tileset.file] = Kind::kTileset;
      out_.tilesets_.push_back(tileset.file);
    }
    Result read = readTilesetJson(path_, budget_, json_);
    if (!read.ok()) {
      is_fatal_ = json_.tiles.size() >= budget_;
      return read;
    }
    up_axis_ = upAxisOf(json_.up_axis);
    transforms_.assign(1, tileset.transform);
    inherited_.clear();
    for (const TilesetJson::Wrong& wrong : json_.wrong_places) {
      failAt(json_.pathOfTile(wrong.tile) + wrong.member, wrong.what);
    }
    sortByTile();
    const size_t first_pending = stack_.size();
    for (uint32_t tile = 0; tile < json_.tiles.size(); ++tile) {
      MCC_GLTF_TRY(readTile(tileset, tile));
    }
    std::reverse(stack_.begin() + static_cast<ptrdiff_t>(first_pending), stack_.end());
    return {};
  }

  Result readTile(const Pending& tileset, uint32_t number) {
    const TilesetJson::Tile& tile = json_.tiles[number];
    Inherited own;
    if (tile.parent == kNone) {
      const double error = json_.geometric_error;
      own = {tileset.level, false, 0, error > 0 ? error : tileset.inherited_error};
    } else {
      own = inherited_[tile.parent];
      ++own.level;
    }
    if (!own.is_left_out && tile.is_transform_wrong) {
      failAt(json_.pathOfTile(number) + "/transform",
             "is not an array of 16 numbers; the tiles from here on are only copied");
      own.is_left_out = true;
    }
    if (tile.transform != kNone) {
      transforms_.push_back(product(transforms_[own.transform], json_.transforms[tile.transform]));
      own.transform = static_cast<uint32_t>(transforms_.size() - 1);
    }
    const double error = tile.geometric_error;
    if (!(error >= 0) && !own.is_left_out) {
      failAt(json_.pathOfTile(number) + "/geometricError", "is not a number of at least 0");
    }
    TileUse use = {own.level, error > 0 ? error : own.error / 2, transforms_[own.transform],
                   up_axis_};
    if (error > 0) own.error = error;
    inherited_.push_back(own);
    const ImplicitTiling* implicit = nullptr;
    while (next_implicit_ < json_.implicit.size() &&
           json_.implicit[next_implicit_].tile == number) {
      implicit = &json_.implicit[next_implicit_++];
    }
    if (implicit == nullptr) MCC_GLTF_TRY(count(own.level, 1));
    return readContents(number, use, own, implicit);
  }

  Result readContents(uint32_t number, const TileUse& use, const Inherited& own,
                      const ImplicitTiling* implicit) {
    const size_t begin = next_content_;
    while (next_content_ < json_.contents.size() && json_.contents[next_content_].tile == number) {
      ++next_content_;
    }
    const std::span<const TilesetJson::Content> contents(json_.contents.data() + begin,
                                                         next_content_ - begin);
    if (own.is_left_out) return {};
    if (implicit != nullptr) return readImplicit(*implicit, contents, use);
    for (const TilesetJson::Content& content : contents) {
      const auto where = [&]() { return json_.pathOf(content); };
      if (content.is_uri_wrong) {
        failAt(where(), "names no file: uri is not a string");
        continue;
      }
      MCC_GLTF_TRY(addContent({name_, std::string(json_.uriOf(content)),
                               [&]() { return where() + (content.is_url ? "/url" : "/uri"); }},
                              use, own.error));
    }
    return {};
  }

  /// The parser lists contents as they come, and those of a tile may come after its children.
  void sortByTile() {
    next_content_ = 0;
    next_implicit_ = 0;
    const auto by_tile = [](const auto& a, const auto& b) { return a.tile < b.tile; };
    std::stable_sort(json_.contents.begin(), json_.contents.end(), by_tile);
    std::stable_sort(json_.implicit.begin(), json_.implicit.end(), by_tile);
  }

  Result addContent(const Named& named, const TileUse& use, double inherited_error) {
    std::string path;
    bool is_remote = false;
    const Result found = resolveTileUri(named.base, named.uri, path, is_remote);
    if (is_remote) {
      ++out_.remote_count_;
      return {};
    }
    const auto failHere = [&](const std::string& what) {
      fail(gltf::inFile(folder_ / gltf::pathOf(named.base), gltf::error(named.where(), what)));
    };
    if (!found.ok()) {
      failHere(found.what);
      return {};
    }
    const uint32_t file = files_.find(path);
    if (file != kNone && isTileset(file)) return addTileset(named, file, use, inherited_error);
    // Also what another part has, or what is missing, decides about the lattice of its group, so that
    // all parts come to the same one.
    TileDemand demand;
    if (file != kNone && out_.demand_numbers_[file] != kNone) {
      demand = out_.demands_[out_.demand_numbers_[file]];
    }
    const bool is_first = demand.scale < 0;
    const bool is_renamed = glbNameOf(named.uri).has_value() && (is_first || demand.is_renamed);
    out_.groups_.add(use, demand);
    demand.is_renamed = is_renamed;
    if (file == kNone) {
      const bool is_of_other_part = isNameOfLeaf(path) && !part_.has(path);
      if (!is_of_other_part) failHere("names no file that is there: \"" + path + "\"");
      return {};
    }
    if (is_first) {
      out_.demand_numbers_[file] = static_cast<uint32_t>(out_.demands_.size());
      out_.demands_.push_back(demand);
    } else {
      out_.demands_[out_.demand_numbers_[file]] = demand;
    }
    return {};
  }

  bool isTileset(uint32_t file) {
    if (kinds_[file] != Kind::kUnknown) return kinds_[file] == Kind::kTileset;
    const std::string_view name = files_.name(file);
    const bool is_tileset = !isNameOfLeaf(name) && isTilesetFile(folder_ / gltf::pathOf(name));
    kinds_[file] = is_tileset ? Kind::kTileset : Kind::kOther;
    if (is_tileset) out_.tilesets_.push_back(file);
    return is_tileset;
  }

  Result addTileset(const Named& named, uint32_t file, const TileUse& use, double inherited_error) {
    const fs::path base = folder_ / gltf::pathOf(named.base);
    is_fatal_ = true;  // as long as this function does not succeed
    if (std::find(chain_.begin(), chain_.end(), file) != chain_.end()) {
      return gltf::inFile(base, gltf::error(named.where(), "the external tileset \"" +
                                                               std::string(files_.name(file)) +
                                                               "\" contains itself; remove one of "
                                                               "the two"));
    }
    if (chain_.size() > kMostNesting) {
      return gltf::inFile(base,
                          gltf::error(named.where(), "external tilesets are nested deeper than " +
                                                         std::to_string(kMostNesting)));
    }
    is_fatal_ = false;
    stack_.push_back({file, static_cast<uint32_t>(chain_.size()), use.level + 1, inherited_error,
                      use.transform});
    return {};
  }

  // Implicit tilings.

  /// Everything that the subtrees of a tile have in common.
  struct Tiling {
    const ImplicitTiling& json;
    std::span<const TilesetJson::Content> contents;
    TileUse use;  ///< of the tile with the tiling
    uint32_t dimensions = 2;
    uint32_t levels = 1;  ///< of a subtree
    ErrorSchema schema;
  };

  Result readImplicit(const ImplicitTiling& json, std::span<const TilesetJson::Content> contents,
                      const TileUse& use) {
    const std::string where = json_.pathOfTile(json.tile) + "/implicitTiling";
    Tiling tiling = {json, contents, use, json.scheme == "OCTREE" ? 3u : 2u, 1, {}};
    const uint64_t most = Subtree::kMostLevels[tiling.dimensions];
    if (json.scheme != "QUADTREE" && json.scheme != "OCTREE") {
      failAt(where + "/subdivisionScheme", "is neither QUADTREE nor OCTREE");
      return {};
    }
    if (json.subtree_levels == 0 || json.subtree_levels > most) {
      failAt(where + "/subtreeLevels", "is not a number from 1 to " + std::to_string(most));
      return {};
    }
    if (json.available_levels > kMostImplicitLevels) {
      failAt(where + "/availableLevels", "is more than " + std::to_string(kMostImplicitLevels));
      return {};
    }
    tiling.levels = static_cast<uint32_t>(json.subtree_levels);
    const Result schema = readSchema(tiling.schema);
    if (!schema.ok()) fail(schema);
    std::vector<ImplicitPlace> pending = {{}};
    while (!pending.empty()) {
      const ImplicitPlace root = pending.back();
      pending.pop_back();
      if (root.level >= json.available_levels) continue;
      std::vector<ImplicitPlace> below;
      Result read = readSubtree(tiling, root, below);
      if (!read.ok() && is_fatal_) return read;
      if (!read.ok()) fail(std::move(read));
      pending.insert(pending.end(), below.rbegin(), below.rend());
    }
    return {};
  }

  Result readSchema(ErrorSchema& schema) const {
    std::vector<uint8_t> bytes;
    std::span<const uint8_t> text;
    fs::path from = path_;
    if (!json_.schema_uri.empty()) {
      std::string path;
      bool is_remote = false;
      Result found = resolveTileUri(name_, json_.schema_uri, path, is_remote);
      if (is_remote) found = gltf::error("", "is on a server; its tiles may have geometric errors");
      if (!found.ok()) return gltf::inFile(path_, gltf::error("/schemaUri", found.what));
      from = folder_ / gltf::pathOf(path);
    } else if (json_.schema_begin == json_.schema_end) {
      return {};
    }
    MCC_GLTF_TRY(gltf::readFile(from, bytes));
    text = bytes;
    if (json_.schema_uri.empty()) {
      if (json_.schema_end > bytes.size()) return gltf::error(gltf::textOf(from), "changes");
      text = text.subspan(json_.schema_begin, json_.schema_end - json_.schema_begin);
    }
    gltf::Json json;
    MCC_GLTF_TRY(gltf::inFile(from, gltf::parseJson(text, json)));
    schema = errorSchemaOf(json);
    return {};
  }

  Result readSubtree(const Tiling& tiling, const ImplicitPlace& root,
                     std::vector<ImplicitPlace>& below) {
    std::string path;
    bool is_remote = false;
    Result found = resolveTileUri(name_, root.uriOf(tiling.json.subtrees), path, is_remote);
    if (is_remote) found = gltf::error("", "is on a server; its tiles are not listed");
    if (!found.ok()) {
      return gltf::inFile(
          path_, gltf::error(json_.pathOfTile(tiling.json.tile) + "/implicitTiling/subtrees/uri",
                             found.what));
    }
    const fs::path file = folder_ / gltf::pathOf(path);
    std::vector<uint8_t> bytes;
    MCC_GLTF_TRY(gltf::readFile(file, bytes));
    // A template without variables names one subtree any number of times.
    const uint64_t work = 1 + bytes.size() / 8;
    MCC_GLTF_TRY(spend(work));
    Subtree subtree;
    const auto read_buffer = [&](const std::string& uri, std::vector<uint8_t>& buffer) -> Result {
      std::string name;
      bool is_far = false;
      MCC_GLTF_TRY(resolveTileUri(path, uri, name, is_far));
      if (is_far) return gltf::error("", "the buffer is on a server");
      MCC_GLTF_TRY(gltf::readFile(folder_ / gltf::pathOf(name), buffer));
      return spend(buffer.size() / 8);
    };
    MCC_GLTF_TRY(gltf::inFile(file, subtree.read(std::move(bytes), tiling.dimensions, tiling.levels,
                                                 tiling.schema, read_buffer)));
    MCC_GLTF_TRY(readSubtreeTiles(tiling, root, subtree));
    const uint64_t child_count = uint64_t{1} << (tiling.levels * tiling.dimensions);
    if (root.level + tiling.levels >= tiling.json.available_levels) return {};
    for (uint64_t m = 0; m < child_count && !subtree.children().isNothing(); ++m) {
      if (!subtree.children()[m]) continue;
      MCC_GLTF_TRY(spend(1));
      below.push_back(root.below(tiling.levels, m, tiling.dimensions));
    }
    return {};
  }

  Result readSubtreeTiles(const Tiling& tiling, const ImplicitPlace& root, const Subtree& subtree) {
    if (subtree.tiles().isNothing()) return {};
    uint64_t bit = 0;
    uint64_t rank = 0;
    for (uint32_t level = 0; level < tiling.levels; ++level) {
      if (root.level + level >= tiling.json.available_levels) break;
      const uint64_t end = bit + (uint64_t{1} << (level * tiling.dimensions));
      for (uint64_t m = 0; bit < end; ++bit, ++m) {
        if (!subtree.tiles()[bit]) continue;
        const ImplicitPlace place = root.below(level, m, tiling.dimensions);
        TileUse use = tiling.use;
        use.level += place.level;
        use.geometric_error = std::ldexp(use.geometric_error, -static_cast<int>(place.level));
        if (const auto error = subtree.errorOf(rank)) {
          // As elsewhere, a leaf takes half of what its parent has.
          use.geometric_error = *error > 0 ? *error : use.geometric_error;
        }
        ++rank;
        MCC_GLTF_TRY(count(use.level, 1));
        MCC_GLTF_TRY(readSubtreeContents(tiling, place, subtree, bit, use));
      }
    }
    return {};
  }

  Result readSubtreeContents(const Tiling& tiling, const ImplicitPlace& place,
                             const Subtree& subtree, uint64_t bit, const TileUse& use) {
    for (size_t i = 0; i < tiling.contents.size() && i < subtree.contents().size(); ++i) {
      const TilesetJson::Content& content = tiling.contents[i];
      if (!subtree.contents()[i][bit] || content.is_uri_wrong) continue;
      const std::string uri = place.uriOf(std::string(json_.uriOf(content)));
      MCC_GLTF_TRY(addContent({name_, uri, [&]() { return json_.pathOf(content) + "/uri"; }}, use,
                              use.geometric_error));
    }
    return {};
  }

  // Counting and failing.

  Result spend(uint64_t tile_count) {
    if (tile_count <= budget_) {
      budget_ -= tile_count;
      return {};
    }
    is_fatal_ = true;
    return gltf::error("", "the tilesets have more than " + std::to_string(max_tiles_) +
                               " tiles; --max-tiles allows more");
  }

  Result count(uint32_t level, uint64_t tile_count) {
    MCC_GLTF_TRY(spend(tile_count));
    if (out_.level_tiles_.size() <= level) out_.level_tiles_.resize(size_t{level} + 1);
    out_.level_tiles_[level] += tile_count;
    return {};
  }

  void failAt(const std::string& where, const std::string& what) {
    fail(gltf::inFile(path_, gltf::error(where, what)));
  }

  void fail(Result failure) {
    ++out_.failure_count_;
    if (out_.failures_.size() < kMostFailures) out_.failures_.push_back(std::move(failure));
  }

  TilesetWalk& out_;
  const fs::path& folder_;
  const FileTable& files_;
  const Part& part_;
  uint64_t budget_;
  const uint64_t max_tiles_;
  std::vector<Kind> kinds_;  ///< by file
  std::vector<Pending> stack_;
  std::vector<uint32_t> chain_;  ///< the tilesets that name each other, down to the current one
  bool is_fatal_ = false;

  // The current tileset.
  fs::path path_;
  std::string name_;
  TilesetJson json_;
  UpAxis up_axis_ = UpAxis::kY;
  std::vector<Matrix> transforms_;
  std::vector<Inherited> inherited_;  ///< by tile
  size_t next_content_ = 0;
  size_t next_implicit_ = 0;
};

Result TilesetWalk::run(const fs::path& folder, const std::string& name, const FileTable& files,
                        const Part& part, uint64_t max_tiles) {
  *this = {};
  return TilesetWalker(*this, folder, files, part, max_tiles).run(name);
}

}  // namespace mcc::tiles
