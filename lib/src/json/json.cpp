// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "json/json.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "json/json_scanner.h"
#include "json/numbers.h"
#include "json/path.h"
#include "json/utf8.h"

namespace mcc::gltf {
namespace {

/// Objects with more members are searched by their sorted keys.
constexpr size_t kFewMembers = 16;

}  // namespace

Json::Json(std::initializer_list<Json> elements) {
  const bool is_object = std::all_of(elements.begin(), elements.end(), [](const Json& element) {
    return element.is_array() && element.size() == 2 && element[0].is_string();
  });
  *this = is_object ? object(elements) : array(elements);
}

Json Json::array(std::initializer_list<Json> elements) {
  Json json;
  json.become(Kind::kArray).values = elements;
  return json;
}

Json Json::object(std::initializer_list<Json> members) {
  Json json;
  json.become(Kind::kObject);
  for (const Json& member : members) json.append(member[0].text(), member[1]);
  return json;
}

Json Json::number(std::string_view spelling) {
  Json json(spelling);
  json.kind_ = Kind::kNumber;
  return json;
}

Json Json::parse(std::string_view text) {
  Json json;
  const std::span bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  return parseJson(bytes, json).ok() ? json : Json();
}

Json::Json(Json&& other) noexcept
    : kind_(std::exchange(other.kind_, Kind::kNull)),
      text_(std::move(other.text_)),
      values_(std::move(other.values_)) {}

Json& Json::operator=(Json other) noexcept {
  kind_ = other.kind_;
  text_ = std::move(other.text_);
  values_.swap(other.values_);
  return *this;
}

Json::~Json() = default;

Json::Values& Json::own() {
  if (values_.use_count() == 1) return *values_;
  const std::shared_ptr<Values> shared = std::exchange(values_, std::make_shared<Values>());
  values_->values = shared->values;
  values_->keys = shared->keys;
  sortMembers();
  return *values_;
}

Json::Values& Json::become(Kind kind) {
  if (kind_ != kind) {
    *this = Json();  // a value of another kind is replaced
    values_ = std::make_shared<Values>();
    kind_ = kind;
  }
  return own();
}

void Json::sortMembers() {
  Values& all = *values_;
  all.sorted.clear();
  if (all.keys.size() <= kFewMembers) return;
  for (uint32_t i = 0; i < all.keys.size(); ++i) all.sorted.insert(i);
}

const Json* Json::find(std::string_view key) const {
  if (!is_object()) return end();
  const Values& all = *values_;
  if (all.sorted.empty()) {
    const auto found = std::find(all.keys.begin(), all.keys.end(), key);
    return begin() + (found - all.keys.begin());
  }
  const auto found = all.sorted.lower_bound(key);
  return found == all.sorted.end() || all.keys[*found] != key ? end() : begin() + *found;
}

Json* Json::find(std::string_view key) {
  const ptrdiff_t place = std::as_const(*this).find(key) - std::as_const(*this).begin();
  return begin() + place;
}

Json& Json::operator[](std::string_view key) {
  Json* const found = find(key);
  return found != end() ? *found : append(std::string(key), nullptr);
}

const Json& Json::operator[](std::string_view key) const {
  const Json* const found = find(key);
  return found == end() ? null() : *found;
}

const Json& Json::null() {
  static const Json kNull;
  return kNull;
}

void Json::push_back(Json value) { become(Kind::kArray).values.push_back(std::move(value)); }

Json& Json::append(std::string key, Json value) {
  Values& all = become(Kind::kObject);
  all.keys.push_back(std::move(key));
  all.values.push_back(std::move(value));
  if (!all.sorted.empty()) {
    all.sorted.insert(static_cast<uint32_t>(all.keys.size() - 1));
  } else if (all.keys.size() > kFewMembers) {
    sortMembers();
  }
  return all.values.back();
}

void Json::update(const Json& other) {
  for (const auto& [key, value] : other.items()) (*this)[key] = value;
}

void Json::rename(std::string_view from, std::string to) {
  const auto i = static_cast<uint32_t>(find(from) - begin());
  if (i == size()) return;
  const bool is_sorted = values_->sorted.erase(i) != 0;
  values_->keys[i] = std::move(to);
  if (is_sorted) values_->sorted.insert(i);
}

void Json::erase(std::string_view key) {
  const Json* const found = std::as_const(*this).find(key);
  if (found != std::as_const(*this).end()) erase(found);
}

void Json::erase(const Json* from, const Json* to) {
  if (from == to) return;
  const ptrdiff_t first = from - std::as_const(*this).begin();
  const ptrdiff_t last = to - std::as_const(*this).begin();
  auto& [values, keys, sorted] = own();
  if (is_object()) keys.erase(keys.begin() + first, keys.begin() + last);
  values.erase(values.begin() + first, values.begin() + last);
  sortMembers();
}

void Json::clear() {
  const Kind kind = kind_;
  *this = Json();
  if (kind == Kind::kArray || kind == Kind::kObject) become(kind);
}

bool Json::equals(const Json& other) const {
  if (kind_ != other.kind_ || size() != other.size()) return false;
  if (is_number()) return areEqualNumbers(text_, other.text_);
  return text_ == other.text_ && std::equal(begin(), end(), other.begin()) &&
         (!is_object() || values_->keys == other.values_->keys);
}

uint64_t Json::wholeNumber() const { return is_number() ? wholeNumberOf(text_) : 0; }
double Json::realNumber() const { return is_number() ? numberOf(text_) : 0; }

void Json::setNumber(double value) {
  if (!std::isfinite(value)) return;
  kind_ = Kind::kNumber;
  text_ = spellingOf(value);
}

namespace {

void printEscaped(uint32_t code, std::string& out) {
  constexpr char kDigits[] = "0123456789abcdef";
  out += "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) out += kDigits[code >> shift & 0xf];
}

void printCharacter(std::string_view bytes, uint32_t code, bool is_ascii, std::string& out) {
  constexpr std::string_view kMeanings = "\"\\\b\f\n\r\t";
  constexpr std::string_view kLetters = "\"\\bfnrt";
  const size_t found = code < 0x80 ? kMeanings.find(static_cast<char>(code)) : std::string::npos;
  if (found != std::string::npos) {
    out += '\\';
    out += kLetters[found];
  } else if (code >= 0x20 && (code < 0x7f || !is_ascii)) {
    out += bytes;
  } else if (code < 0x10000) {
    printEscaped(code, out);
  } else {
    printEscaped(0xd800 | (code - 0x10000) >> 10, out);
    printEscaped(0xdc00 | (code & 0x3ff), out);
  }
}

void printString(std::string_view text, bool is_ascii, std::string& out) {
  constexpr uint32_t kReplacement = 0xfffd;
  out += '"';
  while (!text.empty()) {
    const Character first = firstCharacter(text);
    if (first.byte_count == 0) {
      printCharacter("\xef\xbf\xbd", kReplacement, is_ascii, out);
      text.remove_prefix(1);
      continue;
    }
    printCharacter(text.substr(0, first.byte_count), first.code, is_ascii, out);
    text.remove_prefix(first.byte_count);
  }
  out += '"';
}

struct Style {
  int indent = -1;
  bool is_ascii = false;
};

/// Prints a value at a level of nesting. Only what this program made, or parseJson() within its
/// limit of depth, gets here, so that recursion ends.
void print(const Json& json, const Style& style, int level, std::string& out) {
  if (json.is_string()) return printString(json.text(), style.is_ascii, out);
  if (!json.is_structured()) {
    out += json.is_null() ? "null" : json.text();
    return;
  }
  const auto newLine = [&](int at) {
    if (style.indent < 0) return;
    out += '\n';
    out.append(static_cast<size_t>(at * style.indent), ' ');
  };
  out += json.is_object() ? '{' : '[';
  for (size_t i = 0; i < json.size(); ++i) {
    if (i != 0) out += ',';
    newLine(level + 1);
    if (json.is_object()) {
      printString(json.keyAt(i), style.is_ascii, out);
      out += style.indent < 0 ? ":" : ": ";
    }
    print(json[i], style, level + 1, out);
  }
  if (!json.empty()) newLine(level);
  out += json.is_object() ? '}' : ']';
}

/// Builds JSON of the tokens of a text.
class Builder {
 public:
  Builder(std::string_view text, Json& root) : scanner_(text), root_(root) {}

  Result build() {
    JsonToken token = scanner_.next();
    for (; token != JsonToken::kEnd && token != JsonToken::kError; token = scanner_.next()) {
      take(token);
      if (!result_.ok()) return result_;
    }
    return token == JsonToken::kEnd ? Result() : scanner_.error();
  }

 private:
  void take(JsonToken token) {
    switch (token) {
      case JsonToken::kKey: key_ = std::move(scanner_.text()); break;
      case JsonToken::kString: add(Json(std::move(scanner_.text()))); break;
      case JsonToken::kNumber: add(Json::number(scanner_.text())); break;
      case JsonToken::kBoolean: add(scanner_.text() == "true"); break;
      case JsonToken::kObject: open(Json::object()); break;
      case JsonToken::kArray: open(Json::array()); break;
      case JsonToken::kObjectEnd: checkKeys(); [[fallthrough]];
      case JsonToken::kArrayEnd:
        if (extras_depth_ == open_.size()) extras_depth_ = 0;
        open_.pop_back();
        break;
      default: add(nullptr); break;
    }
  }

  Json* add(Json value) {
    if (open_.empty()) return &(root_ = std::move(value));
    Json& parent = *open_.back();
    if (parent.is_object()) return &parent.append(std::move(key_), std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }

  void open(Json value) {
    if (open_.size() >= kMaxJsonDepth) {
      result_ = {"JSON", "objects and arrays are nested deeper than " +
                             std::to_string(kMaxJsonDepth) + " levels"};
      return;
    }
    const bool is_extras = !open_.empty() && open_.back()->is_object() && key_ == "extras";
    open_.push_back(add(std::move(value)));
    if (is_extras && extras_depth_ == 0) extras_depth_ = open_.size();
  }

  /// Checks that no key is repeated in the object that ends: each is found where it stands.
  void checkKeys() {
    const Json& object = *open_.back();
    if (extras_depth_ != 0) return;
    for (size_t i = 0; i < object.size(); ++i) {
      if (object.find(object.keyAt(i)) == &object[i]) continue;
      result_ = {at(pathOfOpen(), object.keyAt(i)),
                 "the key appears twice in one object, which glTF forbids"};
      return;
    }
  }

  /// Returns the JSON path of the innermost object or array that is open.
  std::string pathOfOpen() const {
    std::string path;
    for (size_t i = 0; i + 1 < open_.size(); ++i) {
      const Json& parent = *open_[i];
      const size_t last = parent.size() - 1;
      path = parent.is_array() ? at(path, last) : at(path, parent.keyAt(last));
    }
    return path;
  }

  JsonScanner scanner_;
  Json& root_;
  std::vector<Json*> open_;
  size_t extras_depth_ = 0;  ///< depth of the outermost open `extras`; 0: none is open
  std::string key_;
  Result result_;
};

}  // namespace

std::string Json::dump(int indent, bool is_ascii) const {
  std::string out;
  print(*this, {indent, is_ascii}, 0, out);
  return out;
}

Result parseJson(std::span<const uint8_t> text, Json& json) {
  json = Json();
  std::string_view view(reinterpret_cast<const char*>(text.data()), text.size());
  while (view.ends_with('\0')) view.remove_suffix(1);  // what old exporters pad a GLB with
  Builder builder(view, json);
  return builder.build();
}

const Json& arrayOf(const Json& object, std::string_view key) {
  static const Json kEmpty = Json::array();
  const Json* const member = findMember(object, key);
  return member != nullptr && member->is_array() ? *member : kEmpty;
}

bool asNumber(const Json& json, double& value) {
  if (!json.is_number()) return false;
  value = numberOf(json.text());
  return true;
}

bool asUnsigned(const Json& json, uint64_t& value) {
  return json.is_number() && readUnsigned(json.text(), value);
}

Result readUnsigned(const Json& json, const std::string& path, uint64_t max, uint64_t& value) {
  if (!asUnsigned(json, value)) return {path, "must be a whole number that is not negative"};
  if (value <= max) return {};
  return {path, std::to_string(value) + " is too large (at most " + std::to_string(max) + ")"};
}

Result readUnsigned(const Json& object, std::string_view key, const std::string& path, uint64_t max,
                    uint64_t& value) {
  const Json* const member = findMember(object, key);
  if (member == nullptr) return {path, "\"" + std::string(key) + "\" is missing"};
  return readUnsigned(*member, at(path, std::string(key)), max, value);
}

Result readOptionalUnsigned(const Json& object, std::string_view key, const std::string& path,
                            uint64_t max, uint64_t& value) {
  if (findMember(object, key) == nullptr) return {};
  return readUnsigned(object, key, path, max, value);
}

}  // namespace mcc::gltf
