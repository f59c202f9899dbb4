// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tileset_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "gltf/base/path_text.h"
#include "gltf/base/result.h"
#include "gltf/files/file_io.h"
#include "gltf/files/named_file.h"
#include "tiles/json_file.h"

namespace mcc::tiles {
namespace {

using gltf::Result;
using Json = nlohmann::json;
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
class TilesetHandler final : public nlohmann::json_sax<Json> {
 public:
  TilesetHandler(const JsonFile& file, uint64_t max_tiles, TilesetJson& out)
      : file_(file), max_tiles_(max_tiles), out_(out) {}

  const Result& result() const { return result_; }

  bool key(string_t& name) override {
    key_ = std::move(name);
    return true;
  }

  bool start_object(std::size_t) override {
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
    if (!result_.ok()) return false;
    scopes_.push_back(scope);
    return true;
  }

  bool end_object() override {
    if (inner() == Scope::kTile) open_tiles_.pop_back();
    if (inner() == Scope::kSchema) out_.schema_end = file_.position();
    scopes_.pop_back();
    return true;
  }

  bool start_array(std::size_t) override {
    Scope scope = Scope::kIgnored;
    if (inner() == Scope::kTile) {
      scope = arrayOfTile();
    } else if (inner() == Scope::kMultipleContents && (key_ == "content" || key_ == "contents")) {
      scope = beginList(key_ == "content" ? Place::kMultipleContent : Place::kMultipleContents);
    } else {
      wrongValue();
    }
    scopes_.push_back(scope);
    return true;
  }

  bool end_array() override {
    if (inner() == Scope::kTransform) endTransform();
    scopes_.pop_back();
    return true;
  }

  bool string(string_t& text) override {
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
    return result_.ok();
  }

  bool number_integer(number_integer_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool null() override { return wrongValue(); }
  bool boolean(bool) override { return wrongValue(); }
  bool binary(binary_t&) override { return wrongValue(); }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception&) override {
    result_ = gltf::error("JSON byte " + std::to_string(position), "the JSON is damaged");
    return false;
  }

 private:
  /// A tile that is open, and how many children it has so far.
  struct OpenTile {
    uint32_t tile = 0;
    uint32_t child_count = 0;
  };

  Scope inner() const { return scopes_.empty() ? Scope::kIgnored : scopes_.back(); }
  TilesetJson::Tile& tile() { return out_.tiles[open_tiles_.back().tile]; }

  Scope objectOfTop() {
    if (key_ == "asset") return Scope::kAsset;
    if (key_ == "schema") {
      out_.schema_begin = file_.position() - 1;
      return Scope::kSchema;
    }
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

  bool number(double value) {
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
    return true;
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
  bool wrongValue() {
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
    return true;
  }

  void addWrong(const std::string& member, const char* what) {
    constexpr size_t kMost = 1000;
    ++out_.wrong_count;
    if (out_.wrong_places.size() == kMost) return;
    out_.wrong_places.push_back({open_tiles_.back().tile, member, what});
  }

  const JsonFile& file_;
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

/// Looks for the object `root` of a document, and ends the parser as soon as it is there.
class RootFinder final : public nlohmann::json_sax<Json> {
 public:
  bool isFound() const { return is_found_; }

  bool key(string_t& name) override {
    is_root_ = depth_ == 1 && name == "root";
    return true;
  }
  bool start_object(std::size_t) override {
    is_found_ = is_root_;
    is_root_ = false;
    ++depth_;
    return !is_found_;
  }
  bool end_object() override {
    --depth_;
    return true;
  }
  bool start_array(std::size_t) override {
    is_root_ = false;
    ++depth_;
    return true;
  }
  bool end_array() override { return end_object(); }
  bool string(string_t&) override { return depth_ != 0; }
  bool number_integer(number_integer_t) override { return depth_ != 0; }
  bool number_unsigned(number_unsigned_t) override { return depth_ != 0; }
  bool number_float(number_float_t, const string_t&) override { return depth_ != 0; }
  bool null() override { return depth_ != 0; }
  bool boolean(bool) override { return depth_ != 0; }
  bool binary(binary_t&) override { return depth_ != 0; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

 private:
  uint64_t depth_ = 0;
  bool is_root_ = false;
  bool is_found_ = false;
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
  JsonFile file(opened);
  TilesetHandler handler(file, max_tiles, tileset);
  Json::sax_parse(file.begin(), JsonFile::end(), &handler);
  if (!handler.result().ok()) return gltf::inFile(path, handler.result());
  if (!tileset.tiles.empty()) return {};
  return gltf::error(gltf::textOf(path), "is not a tileset: it has no root");
}

bool isTilesetFile(const std::filesystem::path& folder, const std::string& name) {
  gltf::NamedFile opened;
  if (!opened.open(folder, name).ok()) return false;
  JsonFile file(opened);
  if (file.isAtEnd()) return false;
  RootFinder finder;
  Json::sax_parse(file.begin(), JsonFile::end(), &finder);
  return finder.isFound();
}

}  // namespace mcc::tiles
