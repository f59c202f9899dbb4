// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tileset_walk.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "gltf/files/file_io.h"
#include "host/result.h"
#include "host/text.h"
#include "json/json.h"
#include "tiles/subtree.h"
#include "tiles/tile_uri.h"
#include "tiles/tileset_json.h"

namespace mcc::tiles {

namespace fs = std::filesystem;
using gltf::Result;

namespace {

constexpr uint32_t kMostNesting = 128;  // of external tilesets
constexpr size_t kMostFailures = 1000;
constexpr size_t kMostFailureBytes = 1000;  // of each of the two parts of a failure
constexpr uint64_t kMostImplicitLevels = 32;
constexpr uint64_t kMostKeptBytes = uint64_t{1} << 23;  // of the files whose contents are kept
/// How many tiles a run of 8 bytes that is read again counts for, a new group of grids that only a
/// repetition brings, and one more place of an external tileset.
constexpr uint64_t kBytesPerTile = 8;
constexpr uint64_t kTilesPerGroup = 16;
constexpr uint64_t kTilesPerPlace = 256;
/// A tile that names an external tileset takes more bytes than this.
constexpr uint64_t kBytesPerPlace = 8;

/// Counts of tiles that are multiplied may be beyond all bounds.
uint64_t sumOf(uint64_t a, uint64_t b) {
  return a > std::numeric_limits<uint64_t>::max() - b ? std::numeric_limits<uint64_t>::max()
                                                      : a + b;
}
uint64_t productOf(uint64_t a, uint64_t b) {
  if (b != 0 && a > std::numeric_limits<uint64_t>::max() / b)
    return std::numeric_limits<uint64_t>::max();
  return a * b;
}

UpAxis upAxisOf(const std::string& name) {
  if (name == "X") return UpAxis::kX;
  return name == "Z" ? UpAxis::kZ : UpAxis::kY;
}

/// Whether positions in a tile with this transform have a place in the world.
bool isFinite(const Matrix& matrix) {
  return std::all_of(matrix.begin(), matrix.end(), [](double x) { return std::isfinite(x); }) &&
         std::isfinite(largestScale(matrix));
}

/// Things made of files that may be asked for again. When they get too many, all are forgotten.
template <typename Key, typename Thing>
class Kept {
 public:
  std::shared_ptr<Thing> find(const Key& key) const {
    const auto found = things_.find(key);
    return found == things_.end() ? nullptr : found->second;
  }
  void add(const Key& key, std::shared_ptr<Thing> thing, uint64_t bytes) {
    if (bytes_ + bytes > kMostKeptBytes) {
      things_.clear();
      bytes_ = 0;
    }
    bytes_ += bytes;
    things_[key] = std::move(thing);
  }

 private:
  std::map<Key, std::shared_ptr<Thing>> things_;
  uint64_t bytes_ = 0;
};

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
  /// ones of a list. What the tiles below a place ask of files depends on nothing but the place,
  /// and asking twice changes nothing. So a place is visited once, however many tiles lead to it.
  Result run(const std::string& name) {
    const uint32_t first = files_.find(name);
    if (first == kNone) {
      return gltf::error(gltf::textOf(folder_ / gltf::pathOf(name)),
                         "is no file in its folder; a link to a tileset elsewhere is not followed");
    }
    kinds_[first] = Kind::kTileset;
    out_.tilesets_.push_back(first);
    numberOf({first, 0, 0, kIdentity}, 0);
    while (!stack_.empty()) {
      const Pending next = stack_.back();
      stack_.pop_back();
      place_ = next.place;
      const Place& place = *places_[place_].place;
      chain_.resize(next.depth);
      chain_.push_back(place.file);
      places_[place_].edges_begin = edges_.size();
      Result read = readOne(place);
      places_[place_].edges_end = edges_.size();
      if (read.ok()) continue;
      if (is_fatal_ || next.depth == 0) return read;
      fail([&]() { return std::move(read); });
    }
    return countTiles();
  }

 private:
  enum class Kind : uint8_t { kUnknown, kTileset, kOther };

  /// Where a tileset is put, and what the tile that names it hands down.
  struct Place {
    uint32_t file = 0;
    uint32_t level = 0;
    double inherited_error = 0;
    Matrix transform = kIdentity;

    /// No number in it is NaN.
    bool operator<(const Place& other) const {
      return std::tie(file, level, inherited_error, transform) <
             std::tie(other.file, other.level, other.inherited_error, other.transform);
    }
  };

  struct KnownPlace {
    const Place* place = nullptr;  ///< a key of numbers_
    size_t edges_begin = 0;
    size_t edges_end = 0;
    uint64_t count = 0;  ///< how many tiles lead to it, those of repeated places counted each
  };

  /// Tiles of one place that lead to another. The levels of places grow along edges.
  struct Edge {
    uint32_t to = 0;
    uint32_t count = 0;
  };

  /// A place that is to be visited.
  struct Pending {
    uint32_t place = 0;
    uint32_t depth = 0;
  };

  /// What there is to count in a tileset, wherever it is put.
  struct Facts {
    std::vector<uint64_t> level_tiles;  ///< from its root on
    uint64_t remote_count = 0;
    bool is_damaged = false;
  };

  /// The tables of a tileset, and what its schema says once that was asked.
  struct Tables {
    TilesetJson json;
    std::optional<ErrorSchema> schema;
  };

  struct KeptSubtree {
    Subtree subtree;
    Result read;
    uint64_t work = 0;  ///< in tiles
  };
  /// File, dimensions, levels, and the tileset whose schema counts.
  using SubtreeKey = std::tuple<std::string, uint32_t, uint32_t, uint32_t>;

  /// What a tile hands down to its children.
  struct Inherited {
    uint32_t level = 0;
    bool is_left_out = false;
    uint32_t transform = 0;  ///< index into transforms_
    double error = 0;
  };

  /// A content of the current tileset, and its place there for messages.
  struct Named {
    std::string uri;
    std::function<std::string()> where;
  };

  // Places of tilesets.

  /// Returns the number of a place, which will be visited if it is new.
  uint32_t numberOf(const Place& place, uint32_t depth) {
    const auto number = static_cast<uint32_t>(places_.size());
    const auto [known, is_new] = numbers_.try_emplace(place, number);
    if (is_new) {
      places_.push_back({&known->first, 0, 0, 0});
      stack_.push_back({number, depth});
    }
    return known->second;
  }

  /// Multiplies the tiles of each place by the number of tiles that lead to it.
  Result countTiles() {
    std::vector<uint32_t> order(places_.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return places_[a].place->level < places_[b].place->level;
    });
    places_[0].count = 1;
    uint64_t total = 0;
    for (const uint32_t number : order) {
      const KnownPlace& from = places_[number];
      for (size_t i = from.edges_begin; i < from.edges_end; ++i) {
        uint64_t& count = places_[edges_[i].to].count;
        count = sumOf(count, productOf(from.count, edges_[i].count));
      }
      const Facts& facts = facts_[from.place->file];
      out_.remote_count_ = sumOf(out_.remote_count_, productOf(from.count, facts.remote_count));
      if (facts.level_tiles.empty()) continue;
      const size_t end = from.place->level + facts.level_tiles.size();
      if (out_.level_tiles_.size() < end) out_.level_tiles_.resize(end);
      for (size_t i = 0; i < facts.level_tiles.size(); ++i) {
        const uint64_t count = productOf(from.count, facts.level_tiles[i]);
        uint64_t& sum = out_.level_tiles_[from.place->level + i];
        sum = sumOf(sum, count);
        total = sumOf(total, count);
      }
    }
    return total > max_tiles_ ? tooManyTiles() : Result{};
  }

  /// Reads the tables of a tileset, unless they are kept.
  Result readTables(uint32_t file) {
    tables_ = kept_tables_.find(file);
    if (tables_) return {};
    const uint64_t bytes = files_.bytes(file);
    if (is_repeated_) MCC_GLTF_TRY(spend(1 + bytes / kBytesPerTile));
    const auto tables = std::make_shared<Tables>();
    ++out_.work_.file_count;
    ++out_.work_.parse_count;
    Result read = readTilesetJson(folder_, name_, budget_, tables->json);
    if (!read.ok()) {
      is_fatal_ = tables->json.tiles.size() >= budget_;
      return read;
    }
    if (!is_repeated_) tileset_bytes_ += bytes;
    tables_ = tables;
    kept_tables_.add(file, tables, bytes);
    return {};
  }

  Result readOne(const Place& tileset) {
    const auto [facts, is_new] = facts_.try_emplace(tileset.file);
    facts_now_ = &facts->second;
    is_repeated_ = !is_new;
    if (facts_now_->is_damaged) return {};
    name_ = files_.name(tileset.file);
    path_ = folder_ / gltf::pathOf(name_);
    Result read = readTables(tileset.file);
    facts_now_->is_damaged = !read.ok();
    if (!read.ok()) return read;
    const TilesetJson& json = tables_->json;
    up_axis_ = upAxisOf(json.up_axis);
    transforms_.assign(1, tileset.transform);
    inherited_.clear();
    for (const TilesetJson::Wrong& wrong : json.wrong_places) {
      failAt([&]() { return json.pathOfTile(wrong.tile) + wrong.member; }, wrong.what);
    }
    if (!is_repeated_) out_.failure_count_ += json.wrong_count - json.wrong_places.size();
    sortByTile();
    const size_t first_pending = stack_.size();
    for (uint32_t tile = 0; tile < json.tiles.size(); ++tile) {
      MCC_GLTF_TRY(readTile(tileset, tile));
    }
    std::reverse(stack_.begin() + static_cast<ptrdiff_t>(first_pending), stack_.end());
    return {};
  }

  /// Returns what a tile hands down, apart from its geometric error.
  Inherited inheritedBy(const Place& tileset, uint32_t number) {
    const TilesetJson::Tile& tile = tables_->json.tiles[number];
    Inherited own;
    if (tile.parent == kNone) {
      const double error = tables_->json.geometric_error;
      own = {0, false, 0, error > 0 ? error : tileset.inherited_error};
    } else {
      own = inherited_[tile.parent];
      ++own.level;
    }
    if (own.is_left_out) return own;
    const auto where = [&]() { return tables_->json.pathOfTile(number) + "/transform"; };
    if (tile.is_transform_wrong) {
      failAt(where, "is not an array of 16 numbers; the tiles from here on are only copied");
      own.is_left_out = true;
    } else if (tile.transform != kNone) {
      const Matrix placed =
          product(transforms_[own.transform], tables_->json.transforms[tile.transform]);
      own.is_left_out = !isFinite(placed);
      if (own.is_left_out) {
        failAt(where,
               "with those above it reaches beyond the numbers of 64 bits; the tiles from here on "
               "are only copied");
      }
      transforms_.push_back(placed);
      own.transform = static_cast<uint32_t>(transforms_.size() - 1);
    }
    return own;
  }

  Result readTile(const Place& tileset, uint32_t number) {
    const TilesetJson& json = tables_->json;
    Inherited own = inheritedBy(tileset, number);
    const double error = json.tiles[number].geometric_error;
    if (!(error >= 0) && !own.is_left_out) {
      failAt([&]() { return json.pathOfTile(number) + "/geometricError"; },
             "is not a number of at least 0");
    }
    const TileUse use = {tileset.level + own.level, error > 0 ? error : own.error / 2,
                         transforms_[own.transform], up_axis_};
    if (error > 0) own.error = error;
    inherited_.push_back(own);
    const ImplicitTiling* implicit = nullptr;
    while (next_implicit_ < json.implicit.size() && json.implicit[next_implicit_].tile == number) {
      implicit = &json.implicit[next_implicit_++];
    }
    if (implicit == nullptr) MCC_GLTF_TRY(count(own.level));
    return readContents(number, use, own, implicit);
  }

  Result readContents(uint32_t number, const TileUse& use, const Inherited& own,
                      const ImplicitTiling* implicit) {
    const TilesetJson& json = tables_->json;
    const size_t begin = next_content_;
    while (next_content_ < json.contents.size() && json.contents[next_content_].tile == number) {
      ++next_content_;
    }
    const std::span<const TilesetJson::Content> contents(json.contents.data() + begin,
                                                         next_content_ - begin);
    if (own.is_left_out) return {};
    if (implicit != nullptr) return readImplicit(*implicit, contents, use, own.level);
    for (const TilesetJson::Content& content : contents) {
      const auto where = [&]() { return json.pathOf(content); };
      if (content.is_uri_wrong) {
        failAt(where, "names no file: uri is not a string");
        continue;
      }
      MCC_GLTF_TRY(addContent({std::string(json.uriOf(content)),
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
    const auto sort = [&](auto& list) {
      if (!std::is_sorted(list.begin(), list.end(), by_tile)) {
        std::stable_sort(list.begin(), list.end(), by_tile);
      }
    };
    sort(tables_->json.contents);
    sort(tables_->json.implicit);
  }

  Result addContent(const Named& named, const TileUse& use, double inherited_error) {
    std::string path;
    bool is_remote = false;
    const Result found = resolveTileUri(name_, named.uri, path, is_remote);
    if (is_remote) {
      if (!is_repeated_) ++facts_now_->remote_count;
      return {};
    }
    if (!found.ok()) {
      failAt(named.where, found.what);
      return {};
    }
    const uint32_t file = files_.find(path);
    if (file != kNone && isTileset(file)) return addTileset(named, file, use, inherited_error);
    // Also what another part has, or what is missing, decides about the lattice of its group, so
    // that all parts come to the same one.
    TileDemand demand;
    if (file != kNone && out_.demand_numbers_[file] != kNone) {
      demand = out_.demands_[out_.demand_numbers_[file]];
    }
    const bool is_first = demand.scale < 0;
    const size_t group_count = out_.groups_.size();
    out_.groups_.add(use, demand);
    // Groups of a tileset's first place are as many as its tiles say; those of further ones take
    // memory that nothing in the files accounts for.
    if (is_repeated_ && out_.groups_.size() != group_count) MCC_GLTF_TRY(spend(kTilesPerGroup));
    if (file == kNone) {
      const bool is_of_other_part = isNameOfLeaf(path) && !part_.has(path);
      if (!is_of_other_part) failAt(named.where, "names no file that is there: \"" + path + "\"");
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
    const bool may_be_tileset = !isNameOfLeaf(name);
    if (may_be_tileset) ++out_.work_.file_count;
    const bool is_tileset = may_be_tileset && isTilesetFile(folder_, std::string(name));
    kinds_[file] = is_tileset ? Kind::kTileset : Kind::kOther;
    if (is_tileset) out_.tilesets_.push_back(file);
    return is_tileset;
  }

  Result addTileset(const Named& named, uint32_t file, const TileUse& use, double inherited_error) {
    const auto refuse = [&](const std::string& what) {
      is_fatal_ = true;
      return gltf::inFile(path_, gltf::error(named.where(), what));
    };
    if (std::find(chain_.begin(), chain_.end(), file) != chain_.end()) {
      return refuse("the external tileset \"" + std::string(files_.name(file)) +
                    "\" contains itself; remove one of the two");
    }
    if (chain_.size() > kMostNesting) {
      return refuse("external tilesets are nested deeper than " + std::to_string(kMostNesting));
    }
    ++out_.work_.naming_count;
    const uint64_t most = max_tiles_ / kTilesPerPlace + tileset_bytes_ / kBytesPerPlace;
    if (out_.work_.naming_count > most) {
      return refuse("external tilesets that contain others are repeated more than " +
                    std::to_string(most) + " times in all; --max-tiles allows more");
    }
    const uint32_t place = numberOf({file, use.level + 1, inherited_error, use.transform},
                                    static_cast<uint32_t>(chain_.size()));
    const bool is_first = edges_.size() == places_[place_].edges_begin;
    if (is_first || edges_.back().to != place) edges_.push_back({place, 0});
    ++edges_.back().count;
    return {};
  }

  // Implicit tilings.

  /// Everything that the subtrees of a tile have in common.
  struct Tiling {
    const ImplicitTiling& json;
    std::span<const TilesetJson::Content> contents;
    TileUse use;         ///< of the tile with the tiling
    uint32_t level = 0;  ///< of that tile in its tileset
    uint32_t dimensions = 2;
    uint32_t levels = 1;  ///< of a subtree
  };

  Result readImplicit(const ImplicitTiling& json, std::span<const TilesetJson::Content> contents,
                      const TileUse& use, uint32_t level) {
    const auto failIn = [&](const char* member, const std::string& what) {
      failAt([&]() { return pathOfTiling(json) + member; }, what);
      return Result{};
    };
    Tiling tiling = {json, contents, use, level, json.scheme == "OCTREE" ? 3u : 2u, 1};
    const uint64_t most = Subtree::kMostLevels[tiling.dimensions];
    if (json.scheme != "QUADTREE" && json.scheme != "OCTREE") {
      return failIn("/subdivisionScheme", "is neither QUADTREE nor OCTREE");
    }
    if (json.subtree_levels == 0 || json.subtree_levels > most) {
      return failIn("/subtreeLevels", "is not a number from 1 to " + std::to_string(most));
    }
    if (json.available_levels > kMostImplicitLevels) {
      return failIn("/availableLevels", "is more than " + std::to_string(kMostImplicitLevels));
    }
    tiling.levels = static_cast<uint32_t>(json.subtree_levels);
    readSchema();
    std::vector<ImplicitPlace> pending = {{}};
    while (!pending.empty()) {
      const ImplicitPlace root = pending.back();
      pending.pop_back();
      if (root.level >= json.available_levels) continue;
      std::vector<ImplicitPlace> below;
      Result read = readSubtree(tiling, root, below);
      if (!read.ok() && is_fatal_) return read;
      if (!read.ok()) fail([&]() { return std::move(read); });
      pending.insert(pending.end(), below.rbegin(), below.rend());
    }
    return {};
  }

  std::string pathOfTiling(const ImplicitTiling& json) const {
    return tables_->json.pathOfTile(json.tile) + "/implicitTiling";
  }

  /// Reads a file of the tileset, and counts that.
  Result readFile(const std::string& name, std::vector<uint8_t>& bytes) {
    ++out_.work_.file_count;
    return gltf::inFile(folder_ / gltf::pathOf(name), gltf::readNamed(folder_, name, bytes));
  }

  /// Finds out once what the schema of the current tileset says.
  void readSchema() {
    if (tables_->schema) return;
    tables_->schema.emplace();
    const TilesetJson& json = tables_->json;
    Result read;
    if (!json.schema_uri.empty()) {
      read = readSchemaFile(*tables_->schema);
    } else if (json.schema_begin != json.schema_end) {
      std::vector<uint8_t> bytes;
      read = readFile(name_, bytes);
      if (read.ok() && json.schema_end > bytes.size()) {
        read = gltf::error(gltf::textOf(path_), "changes while it is read");
      }
      const std::span<const uint8_t> text(bytes);
      if (read.ok()) {
        read = parseSchema(text.subspan(json.schema_begin, json.schema_end - json.schema_begin),
                           path_, *tables_->schema);
      }
    }
    if (!read.ok()) fail([&]() { return std::move(read); });
  }

  /// A schema that several tilesets name is parsed once.
  Result readSchemaFile(ErrorSchema& schema) {
    std::string path;
    bool is_remote = false;
    Result found = resolveTileUri(name_, tables_->json.schema_uri, path, is_remote);
    if (is_remote) found = gltf::error("", "is on a server; its tiles may have geometric errors");
    if (!found.ok()) return gltf::inFile(path_, gltf::error("/schemaUri", found.what));
    const auto [known, is_new] = schemas_.try_emplace(path);
    if (is_new) {
      std::vector<uint8_t> bytes;
      MCC_GLTF_TRY(readFile(path, bytes));
      MCC_GLTF_TRY(parseSchema(bytes, folder_ / gltf::pathOf(path), known->second));
    }
    schema = known->second;
    return {};
  }

  Result parseSchema(std::span<const uint8_t> text, const fs::path& from, ErrorSchema& schema) {
    ++out_.work_.parse_count;
    gltf::Json json;
    MCC_GLTF_TRY(gltf::inFile(from, gltf::parseJson(text, json)));
    schema = errorSchemaOf(json);
    return {};
  }

  /// Reads a subtree, unless it is kept. A template without variables names one subtree any number
  /// of times, and the tiles of a tiling any number of files that are not there.
  Result findSubtree(const Tiling& tiling, const std::string& path,
                     std::shared_ptr<KeptSubtree>& found) {
    const SubtreeKey key(path, tiling.dimensions, tiling.levels, places_[place_].place->file);
    found = kept_subtrees_.find(key);
    if (found) {
      MCC_GLTF_TRY(spend(found->work));
      return found->read;
    }
    found = std::make_shared<KeptSubtree>();
    uint64_t bytes = 0;
    std::vector<uint8_t> file;
    found->read = readFile(path, file);
    if (found->read.ok()) {
      bytes = file.size();
      found->read = gltf::inFile(folder_ / gltf::pathOf(path),
                                 parseSubtree(tiling, path, std::move(file), *found, bytes));
    }
    found->work = 1 + bytes / kBytesPerTile;
    MCC_GLTF_TRY(spend(found->work));
    if (is_fatal_) return found->read;
    kept_subtrees_.add(key, found, sizeof(KeptSubtree) + path.size() + bytes);
    return found->read;
  }

  Result parseSubtree(const Tiling& tiling, const std::string& path, std::vector<uint8_t> file,
                      KeptSubtree& kept, uint64_t& byte_count) {
    ++out_.work_.parse_count;
    const auto read_buffer = [&](const std::string& uri, std::vector<uint8_t>& buffer) -> Result {
      std::string name;
      bool is_far = false;
      MCC_GLTF_TRY(resolveTileUri(path, uri, name, is_far));
      if (is_far) return gltf::error("", "the buffer is on a server");
      MCC_GLTF_TRY(readFile(name, buffer));
      byte_count += buffer.size();
      if (byte_count / kBytesPerTile <= budget_) return {};
      is_fatal_ = true;
      return tooManyTiles();
    };
    return kept.subtree.read(std::move(file), tiling.dimensions, tiling.levels, *tables_->schema,
                             read_buffer);
  }

  Result readSubtree(const Tiling& tiling, const ImplicitPlace& root,
                     std::vector<ImplicitPlace>& below) {
    std::string path;
    bool is_remote = false;
    Result found = resolveTileUri(name_, root.uriOf(tiling.json.subtrees), path, is_remote);
    if (is_remote) found = gltf::error("", "is on a server; its tiles are not listed");
    if (!found.ok()) {
      return gltf::inFile(path_,
                          gltf::error(pathOfTiling(tiling.json) + "/subtrees/uri", found.what));
    }
    std::shared_ptr<KeptSubtree> kept;
    MCC_GLTF_TRY(findSubtree(tiling, path, kept));
    const Subtree& subtree = kept->subtree;
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
        MCC_GLTF_TRY(count(tiling.level + place.level));
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
      const std::string uri = place.uriOf(std::string(tables_->json.uriOf(content)));
      MCC_GLTF_TRY(addContent({uri, [&]() { return tables_->json.pathOf(content) + "/uri"; }}, use,
                              use.geometric_error));
    }
    return {};
  }

  // Counting and failing.

  Result tooManyTiles() const {
    return gltf::error("", "the tilesets have more than " + std::to_string(max_tiles_) +
                               " tiles; --max-tiles allows more");
  }

  Result spend(uint64_t tile_count) {
    if (tile_count <= budget_) {
      budget_ -= tile_count;
      return {};
    }
    is_fatal_ = true;
    return tooManyTiles();
  }

  /// Counts a tile of a level of the current tileset.
  Result count(uint32_t level) {
    ++out_.work_.tile_count;
    MCC_GLTF_TRY(spend(1));
    if (is_repeated_) return {};
    std::vector<uint64_t>& tiles = facts_now_->level_tiles;
    if (tiles.size() <= level) tiles.resize(size_t{level} + 1);
    ++tiles[level];
    return {};
  }

  template <typename Where>
  void failAt(const Where& where, const std::string& what) {
    fail([&]() { return gltf::inFile(path_, gltf::error(where(), what)); });
  }

  /// Adds a failure, unless the same was found at another place of the tileset. The text is only
  /// made if it is kept, since the path of a tile may be as long as the tree is deep.
  template <typename Make>
  void fail(const Make& make) {
    if (is_repeated_) return;
    if (++out_.failure_count_ > kMostFailures) return;
    Result failure = make();
    failure.where = gltf::shortened(failure.where, kMostFailureBytes);
    failure.what = gltf::shortened(failure.what, kMostFailureBytes);
    out_.failures_.push_back(std::move(failure));
  }

  TilesetWalk& out_;
  const fs::path& folder_;
  const FileTable& files_;
  const Part& part_;
  uint64_t budget_;
  const uint64_t max_tiles_;
  std::vector<Kind> kinds_;            ///< by file
  std::map<Place, uint32_t> numbers_;  ///< of places
  std::vector<KnownPlace> places_;
  std::vector<Edge> edges_;  ///< those of a place are in a row
  std::vector<Pending> stack_;
  std::vector<uint32_t> chain_;  ///< the tilesets that name each other, down to the current one
  std::unordered_map<uint32_t, Facts> facts_;   ///< by file
  std::map<std::string, ErrorSchema> schemas_;  ///< by file
  Kept<uint32_t, Tables> kept_tables_;
  Kept<SubtreeKey, KeptSubtree> kept_subtrees_;
  uint64_t tileset_bytes_ = 0;  ///< of all tilesets, each counted once
  bool is_fatal_ = false;

  // The current tileset.
  uint32_t place_ = 0;
  Facts* facts_now_ = nullptr;
  bool is_repeated_ = false;  ///< it was visited at another place
  fs::path path_;
  std::string name_;
  std::shared_ptr<Tables> tables_;
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
