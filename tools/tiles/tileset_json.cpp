// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tileset_json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gltf/files/file_io.h"
#include "host/result.h"
#include "host/text.h"
#include "json/json.h"

namespace mcc::tiles {
namespace {

using gltf::Json;
using gltf::Result;
using Place = TilesetJson::ContentPlace;

/// What an object or array that is open means.
enum class Scope : uint8_t {
  kIgnored,
  kTop,
  kAsset,
  kSchema,
  kTile,
  kChildren,
  kTransform,
  kContent,
  kContentList,
  kTileExtensions,
  kMultipleContents,  ///< the extension
  kImplicit,
  kSubtrees,
};

/// The number of an element of `children` or of a list of contents counts elements of every kind,
/// so that paths in messages are right.
class TilesetReader : public gltf::JsonListener {
 public:
  TilesetReader(uint64_t max_tiles, TilesetJson& out) : max_tiles_(max_tiles), out_(out) {}

  Result begin(Json::Kind kind, uint64_t byte) override {
    if (kind == Json::Kind::kArray) {
      beginArray();
    } else {
      beginObject();
      if (inner() == Scope::kSchema) out_.schema_begin = byte;
    }
    return result_;
  }

  Result end(uint64_t byte) override {
    switch (inner()) {
      case Scope::kTile: open_tiles_.pop_back(); break;
      case Scope::kSchema: out_.schema_end = byte; break;
      case Scope::kTransform: endTransform(); break;
      default: break;
    }
    scopes_.pop_back();
    return result_;
  }

  Result key(std::string key) override {
    key_ = std::move(key);
    return result_;
  }

  Result value(Json value) override {
    if (value.is_string()) {
      string(value.text());
    } else if (value.is_number()) {
      number(value.get<double>());
    } else {
      wrongValue();
    }
    return result_;
  }

 private:
  /// A tile that is open, and how many children it has so far.
  struct OpenTile {
    uint32_t tile = 0;
    uint32_t child_count = 0;
  };

  void beginObject() {
    Scope scope = Scope::kIgnored;
    switch (inner()) {
      case Scope::kTop: scope = objectOfTop(); break;
      case Scope::kChildren: scope = newTile(); break;
      case Scope::kTile: scope = objectOfTile(); break;
      case Scope::kContentList: scope = newContent(list_place_, list_size_++); break;
      case Scope::kTileExtensions:
        if (key_ == "3DTILES_implicit_tiling") scope = newImplicit();
        if (key_ == "3DTILES_multiple_contents") scope = Scope::kMultipleContents;
        break;
      case Scope::kMultipleContents:
        if (key_ == "content") scope = newContent(Place::kMultipleContent, kNone);
        break;
      case Scope::kImplicit:
        if (key_ == "subtrees") scope = Scope::kSubtrees;
        break;
      case Scope::kTransform: is_transform_wrong_ = true; break;
      default:
        if (scopes_.empty()) scope = Scope::kTop;
        break;
    }
    scopes_.push_back(scope);
  }

  void beginArray() {
    Scope scope = Scope::kIgnored;
    if (inner() == Scope::kTile) {
      scope = arrayOfTile();
    } else if (inner() == Scope::kMultipleContents && (key_ == "content" || key_ == "contents")) {
      scope = beginList(key_ == "content" ? Place::kMultipleContent : Place::kMultipleContents);
    } else {
      wrongValue();
    }
    scopes_.push_back(scope);
  }

  void string(const std::string& text) {
    switch (inner()) {
      case Scope::kAsset: stringOfAsset(text); break;
      case Scope::kTop:
        if (key_ == "schemaUri") out_.schema_uri = text;
        break;
      case Scope::kContent:
        if (key_ == "uri" || key_ == "url") setUri(text);
        break;
      case Scope::kImplicit:
        if (key_ == "subdivisionScheme") out_.implicit.back().scheme = text;
        break;
      case Scope::kSubtrees:
        if (key_ == "uri") out_.implicit.back().subtrees = text;
        break;
      default: wrongValue(); break;
    }
  }

  Scope inner() const { return scopes_.empty() ? Scope::kIgnored : scopes_.back(); }
  TilesetJson::Tile& tile() { return out_.tiles[open_tiles_.back().tile]; }

  Scope objectOfTop() {
    if (key_ == "asset") return Scope::kAsset;
    if (key_ == "schema") return Scope::kSchema;
    if (key_ != "root") return Scope::kIgnored;
    if (out_.tiles.empty()) return newTile();
    result_ = gltf::error("/root", "is there twice; readers differ in which of the two counts");
    return Scope::kIgnored;
  }

  Scope newTile() {
    if (out_.tiles.size() >= max_tiles_) {
      result_ = gltf::error("", "there are more than " + std::to_string(max_tiles_) +
                                    " tiles; --max-tiles allows more");
      return Scope::kIgnored;
    }
    TilesetJson::Tile added;
    if (!open_tiles_.empty()) {
      added.parent = open_tiles_.back().tile;
      added.child_number = open_tiles_.back().child_count++;
    }
    open_tiles_.push_back({static_cast<uint32_t>(out_.tiles.size()), 0});
    out_.tiles.push_back(added);
    return Scope::kTile;
  }

  Scope objectOfTile() {
    if (key_ == "content") return newContent(Place::kContent, kNone);
    if (key_ == "implicitTiling") return newImplicit();
    if (key_ == "extensions") return Scope::kTileExtensions;
    wrongValue();
    return Scope::kIgnored;
  }

  Scope arrayOfTile() {
    if (key_ == "children") return Scope::kChildren;
    if (key_ == "contents") return beginList(Place::kContents);
    if (key_ != "transform") {
      wrongValue();
      return Scope::kIgnored;
    }
    transform_size_ = 0;
    is_transform_wrong_ = false;
    return Scope::kTransform;
  }

  Scope beginList(Place place) {
    list_place_ = place;
    list_size_ = 0;
    return Scope::kContentList;
  }

  Scope newContent(Place place, uint32_t number) {
    TilesetJson::Content content;
    content.tile = open_tiles_.back().tile;
    content.place = place;
    content.number = number;
    out_.contents.push_back(content);
    return Scope::kContent;
  }

  Scope newImplicit() {
    const uint32_t number = open_tiles_.back().tile;
    // The member and the extension may both be there, and say the same.
    if (out_.implicit.empty() || out_.implicit.back().tile != number) out_.implicit.emplace_back();
    out_.implicit.back().tile = number;
    return Scope::kImplicit;
  }

  void endTransform() {
    if (is_transform_wrong_ || transform_size_ != 16) {
      tile().is_transform_wrong = true;
      return;
    }
    tile().transform = static_cast<uint32_t>(out_.transforms.size());
    out_.transforms.push_back(transform_);
  }

  void setUri(const std::string& text) {
    TilesetJson::Content& content = out_.contents.back();
    const bool is_url = key_ == "url";
    if (!content.is_uri_wrong && is_url) return;  // `uri` counts where both are there
    if (text.size() > std::numeric_limits<uint32_t>::max() - out_.texts.size()) {
      result_ = gltf::error("", "the URIs take 4 GiB; divide the tileset into external ones");
      return;
    }
    content.uri_begin = static_cast<uint32_t>(out_.texts.size());
    content.uri_length = static_cast<uint32_t>(text.size());
    content.is_uri_wrong = false;
    content.is_url = is_url;
    out_.texts += text;
  }

  void stringOfAsset(const std::string& text) {
    if (key_ == "gltfUpAxis") out_.up_axis = text;
  }

  void number(double value) {
    switch (inner()) {
      case Scope::kTop:
        if (key_ == "geometricError" && std::isfinite(value)) out_.geometric_error = value;
        break;
      case Scope::kTransform:
        is_transform_wrong_ = is_transform_wrong_ || !std::isfinite(value);
        if (transform_size_ < 16) transform_[transform_size_] = value;
        transform_size_ = std::min<size_t>(transform_size_ + 1, 17);
        break;
      case Scope::kTile:
        if (key_ == "geometricError" && std::isfinite(value))
          tile().geometric_error = value;
        else
          wrongValue();
        break;
      case Scope::kImplicit: numberOfImplicit(value); break;
      default: wrongValue(); break;
    }
  }

  void numberOfImplicit(double value) {
    constexpr double kMost = 4294967295.0;
    if (!(value >= 0 && value <= kMost) || value != std::floor(value)) return;
    const auto number = static_cast<uint64_t>(value);
    ImplicitTiling& implicit = out_.implicit.back();
    if (key_ == "subtreeLevels") implicit.subtree_levels = number;
    if (key_ == "availableLevels") implicit.available_levels = number;
    if (key_ == "maximumLevel") implicit.available_levels = number + 1;  // of the extension
  }

  /// A value of another kind than this place has.
  void wrongValue() {
    switch (inner()) {
      case Scope::kTransform: is_transform_wrong_ = true; break;
      case Scope::kTile:
        if (key_ == "transform") tile().is_transform_wrong = true;
        if (key_ == "children") addWrong("/children", "is not an array");
        if (key_ == "content") newContent(Place::kContent, kNone);
        break;
      case Scope::kChildren:
        addWrong("/children/" + std::to_string(open_tiles_.back().child_count++),
                 "is not an object");
        break;
      case Scope::kContentList: newContent(list_place_, list_size_++); break;
      default: break;
    }
  }

  void addWrong(const std::string& member, const char* what) {
    constexpr size_t kMost = 1000;
    ++out_.wrong_count;
    if (out_.wrong_places.size() == kMost) return;
    out_.wrong_places.push_back({open_tiles_.back().tile, member, what});
  }

  const uint64_t max_tiles_;
  TilesetJson& out_;
  Result result_;
  std::vector<Scope> scopes_;
  std::vector<OpenTile> open_tiles_;
  std::string key_;
  Place list_place_ = Place::kContents;
  uint32_t list_size_ = 0;
  Matrix transform_ = kIdentity;
  size_t transform_size_ = 0;
  bool is_transform_wrong_ = false;
};

/// Returns a file in parts. Borrows it.
gltf::JsonParts partsOf(gltf::NamedFile& file) {
  return [&file, part = std::vector<char>(size_t{1} << 16)]() mutable {
    return std::string_view(part.data(), file.readSome(part.data(), part.size()));
  };
}

/// Looks for the object `root` of a document, and ends the text as soon as it is there.
class RootFinder : public gltf::JsonListener {
 public:
  bool has_root = false;

  Result begin(Json::Kind kind, uint64_t) override {
    has_root = depth_++ == 1 && kind == Json::Kind::kObject && key_ == "root";
    return has_root ? gltf::error("/root", "is there") : Result();
  }
  Result end(uint64_t) override {
    --depth_;
    return key("");
  }
  Result key(std::string key) override {
    key_ = std::move(key);
    return {};
  }
  Result value(Json) override { return key(""); }

 private:
  uint64_t depth_ = 0;
  std::string key_;  ///< of the value that comes next
};

}  // namespace

std::string TilesetJson::pathOfTile(uint32_t tile) const {
  std::vector<uint32_t> numbers;
  for (uint32_t at = tile; tiles[at].parent != kNone; at = tiles[at].parent) {
    numbers.push_back(tiles[at].child_number);
  }
  constexpr size_t kShownAtEachEnd = 16;
  std::string path = "/root";
  for (size_t i = numbers.size(); i-- > 0;) {
    path += "/children/" + std::to_string(numbers[i]);
    if (numbers.size() - i != kShownAtEachEnd || i <= kShownAtEachEnd) continue;
    path += "/… " + std::to_string(i - kShownAtEachEnd) + " levels …";
    i = kShownAtEachEnd;
  }
  return path;
}

std::string TilesetJson::pathOf(const Content& content) const {
  static constexpr const char* kPlaces[] = {"/content", "/contents",
                                            "/extensions/3DTILES_multiple_contents/content",
                                            "/extensions/3DTILES_multiple_contents/contents"};
  std::string path = pathOfTile(content.tile) + kPlaces[static_cast<size_t>(content.place)];
  return content.number == kNone ? path : gltf::at(path, content.number);
}

Result readTilesetJson(const std::filesystem::path& folder, const std::string& name,
                       uint64_t max_tiles, TilesetJson& tileset) {
  tileset = {};
  const std::filesystem::path path = folder / gltf::pathOf(name);
  gltf::NamedFile opened;
  MCC_GLTF_TRY(gltf::inFile(path, opened.open(folder, name)));
  TilesetReader reader(max_tiles, tileset);
  MCC_GLTF_TRY(gltf::inFile(path, gltf::scanJson(partsOf(opened), reader)));
  if (!tileset.tiles.empty()) return {};
  return gltf::error(gltf::textOf(path), "is not a tileset: it has no root");
}

bool isTilesetFile(const std::filesystem::path& folder, const std::string& name) {
  gltf::NamedFile opened;
  if (!opened.open(folder, name).ok()) return false;
  RootFinder finder;
  (void)gltf::scanJson(partsOf(opened), finder);
  return finder.has_root;
}

}  // namespace mcc::tiles
