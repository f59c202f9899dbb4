// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "json/json.h"

#include <algorithm>
#include <cmath>

namespace mcc::gltf {

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

Json Json::number(std::string spelling) {
  Json json(std::move(spelling));
  json.kind_ = Kind::kNumber;
  return json;
}

Json Json::parse(std::string_view text) {
  Json json;
  const std::span bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  return parseJson(bytes, json).ok() ? json : Json();
}

Json& Json::operator=(Json other) noexcept {
  kind_ = other.kind_;
  text_ = std::move(other.text_);
  values_.swap(other.values_);
  return *this;
}

Json::Values& Json::own() {
  if (values_.use_count() == 1) return *values_;
  const std::shared_ptr<Values> shared = std::exchange(values_, std::make_shared<Values>());
  values_->values = shared->values;
  values_->keys = shared->keys;
  values_->index();
  return *values_;
}

Json::Values& Json::become(Kind kind) {
  if (kind_ == kind) return own();
  *this = Json();  // a value of another kind is replaced
  kind_ = kind;
  return *(values_ = std::make_shared<Values>());
}

/// Sorts what is new in `keys`. Few are searched one by one.
void Json::Values::index() {
  constexpr size_t kFew = 16;
  if (keys.size() <= kFew) return;
  for (; indexed < keys.size(); ++indexed) sorted.insert(indexed);
}

const Json* Json::find(std::string_view key) const {
  if (!is_object()) return end();
  const auto& [values, keys, sorted, indexed] = *values_;
  if (sorted.empty()) return begin() + (std::find(keys.begin(), keys.end(), key) - keys.begin());
  const auto found = sorted.find(key);
  return found == sorted.end() ? end() : begin() + *found;
}

Json* Json::find(std::string_view key) {
  const ptrdiff_t i = std::as_const(*this).find(key) - std::as_const(*this).begin();
  return begin() + i;
}

Json& Json::place(std::string_view key) {
  Json* const found = find(key);
  return found == end() ? append(std::string(key), nullptr) : *found;
}

const Json& Json::null() {
  static const Json kNull;
  return kNull;
}

Json& Json::append(std::string key, Json value) {
  Values& all = become(Kind::kObject);
  all.keys.push_back(std::move(key));
  all.values.push_back(std::move(value));
  all.index();
  return all.values.back();
}

void Json::update(const Json& other) {
  for (const auto& [key, value] : other.items()) (*this)[key] = value;
}

void Json::erase(std::string_view key) {
  if (contains(key)) erase(std::as_const(*this).find(key));
}

void Json::erase(const Json* from, const Json* to) {
  if (from == to) return;
  const ptrdiff_t first = from - std::as_const(*this).begin();
  const ptrdiff_t last = to - std::as_const(*this).begin();
  auto& [values, keys, sorted, indexed] = own();
  values.erase(values.begin() + first, values.begin() + last);
  if (is_object()) keys.erase(keys.begin() + first, keys.begin() + last);
  sorted.clear();
  indexed = 0;
  values_->index();
}

bool Json::equals(const Json& other) const {
  if (kind_ != other.kind_ || size() != other.size()) return false;
  if (is_number()) return areEqualNumbers(text_, other.text_);
  return text_ == other.text_ && std::equal(begin(), end(), other.begin()) &&
         (!is_object() || values_->keys == other.values_->keys);
}

namespace {

void printString(std::string_view text, bool is_ascii, std::string& out) {
  const auto escape = [&](uint32_t unit) {
    constexpr char kDigits[] = "0123456789abcdef";
    out += "\\u";
    for (int shift = 12; shift >= 0; shift -= 4) out += kDigits[unit >> shift & 0xf];
  };
  out += '"';
  while (!text.empty()) {
    const auto end = std::find_if_not(text.begin(), text.end(), isPlain);
    const auto plain = static_cast<size_t>(end - text.begin());
    out.append(text, 0, plain);
    text.remove_prefix(plain);
    if (text.empty()) break;
    auto [code, byte_count] = firstCharacter(text);
    std::string_view bytes = text.substr(0, byte_count);
    text.remove_prefix(std::max<size_t>(byte_count, 1));
    if (byte_count == 0) {
      bytes = "\xef\xbf\xbd";
      code = 0xfffd;
    }
    const size_t found = kEscaped.find(bytes);
    if (found != kEscaped.npos) {
      out += '\\';
      out += kEscapes[found];
    } else if (code >= 0x20 && (code < 0x7f || !is_ascii)) {
      out += bytes;
    } else if (code < 0x10000) {
      escape(code);
    } else {
      escape(0xd800 | (code - 0x10000) >> 10);
      escape(0xdc00 | (code & 0x3ff));
    }
  }
  out += '"';
}

/// Prints a value at a level of nesting. Only what this program made, or parseJson() within its
/// limit of depth, gets here, so that recursion ends.
void print(const Json& json, int indent, bool is_ascii, int level, std::string& out) {
  if (json.is_string()) return printString(json.text(), is_ascii, out);
  if (!json.is_structured()) {
    out += json.is_null() ? "null" : json.text();
    return;
  }
  const auto newLine = [&](int at) {
    if (indent < 0) return;
    out += '\n';
    out.append(static_cast<size_t>(at * indent), ' ');
  };
  out += json.is_object() ? '{' : '[';
  for (size_t i = 0; i < json.size(); ++i) {
    if (i != 0) out += ',';
    newLine(level + 1);
    if (json.is_object()) {
      printString(json.keyAt(i), is_ascii, out);
      out += indent < 0 ? ":" : ": ";
    }
    print(json[i], indent, is_ascii, level + 1, out);
  }
  if (!json.empty()) newLine(level);
  out += json.is_object() ? '}' : ']';
}

}  // namespace

std::string Json::dump(int indent, bool is_ascii) const {
  std::string out;
  print(*this, indent, is_ascii, 0, out);
  return out;
}

const Json& arrayOf(const Json& object, std::string_view key) {
  static const Json kEmpty = Json::array();
  const Json* const member = findMember(object, key);
  return member != nullptr && member->is_array() ? *member : kEmpty;
}

bool asNumber(const Json& json, double& value) {
  if (json.is_number()) value = numberOf(json.text());
  return json.is_number();
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
  return object.contains(key) ? readUnsigned(object, key, path, max, value) : Result();
}

}  // namespace mcc::gltf
