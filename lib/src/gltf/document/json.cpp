// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "gltf/base/printable.h"

namespace mcc::gltf {
namespace {

/// Yields the numbers of a JSON text in the order in which the parser reports them.
class NumberScanner {
 public:
  explicit NumberScanner(std::string_view text) : rest_(text) {}

  /// Returns the next number, or an empty text after the last one.
  std::string_view next() {
    size_t i = 0;
    while (i < rest_.size() && !startsNumber(rest_[i])) i = rest_[i] == '"' ? pastString(i) : i + 1;
    size_t end = i;
    while (end < rest_.size() && continuesNumber(rest_[end])) ++end;
    const std::string_view number = rest_.substr(i, end - i);
    rest_.remove_prefix(end);
    return number;
  }

 private:
  static bool startsNumber(char c) { return c == '-' || (c >= '0' && c <= '9'); }
  static bool continuesNumber(char c) {
    return startsNumber(c) || c == '+' || c == '.' || c == 'e' || c == 'E';
  }

  size_t pastString(size_t i) const {
    for (++i; i < rest_.size() && rest_[i] != '"'; ++i) {
      if (rest_[i] == '\\') ++i;
    }
    return std::min(i + 1, rest_.size());
  }

  std::string_view rest_;
};

/// Whether a text is a number of JSON (RFC 8259, section 6).
bool isNumber(std::string_view text) {
  const auto digits = [&] {
    const size_t count = std::min(text.find_first_not_of("0123456789"), text.size());
    text.remove_prefix(count);
    return count;
  };
  const auto skip = [&](std::string_view any) {
    const bool is_there = !text.empty() && any.find(text[0]) != std::string_view::npos;
    if (is_there) text.remove_prefix(1);
    return is_there;
  };
  skip("-");
  const bool has_zero = text.starts_with('0');
  const size_t whole = digits();
  if (whole == 0 || (has_zero && whole > 1)) return false;
  if (skip(".") && digits() == 0) return false;
  if (skip("eE")) {
    skip("+-");
    if (digits() == 0) return false;
  }
  return text.empty();
}

/// Whether a number of JSON that binary64 cannot hold is too large, instead of too small. Compares
/// the power of ten of its first digit with 0, because it is far from it.
bool isHuge(std::string_view number) {
  if (number.starts_with('-')) number.remove_prefix(1);
  const size_t end = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, end);
  const auto point = static_cast<int64_t>(std::min(digits.find('.'), digits.size()));
  const auto first =
      static_cast<int64_t>(std::min(digits.find_first_of("123456789"), digits.size()));
  int64_t power = point - first;
  if (end == number.size()) return power > 0;
  number.remove_prefix(end + 1);
  const bool is_negative = number.starts_with('-');
  if (is_negative || number.starts_with('+')) number.remove_prefix(1);
  int64_t exponent = std::numeric_limits<int64_t>::max() / 2;  // stays if it is even larger
  std::from_chars(number.data(), number.data() + number.size(), exponent);
  power += is_negative ? -exponent : exponent;
  return power > 0;
}

/// Returns the value of a number as JSON spells it; one that is too large is infinite. strtod()
/// would look for the decimal point of the program's locale.
double numberOf(std::string_view spelling) {
#if defined(__cpp_lib_to_chars)
  double value = 0;
  const char* const end = spelling.data() + spelling.size();
  if (std::from_chars(spelling.data(), end, value).ec == std::errc()) return value;
#else  // such as libc++ before version 20; the parser knows the point of the locale
  const Json parsed = Json::parse(spelling, nullptr, false);
  if (parsed.is_number()) return parsed.get<double>();
  double value = 0;
#endif
  value = isHuge(spelling) ? std::numeric_limits<double>::infinity() : 0;
  return spelling.starts_with('-') ? -value : value;
}

Json spelt(std::string_view number) {
  return Json::binary(std::vector<uint8_t>(number.begin(), number.end()));
}

/// Replaces numbers that are too large for binary64, which nlohmann's parser refuses, by zeros of
/// the same length. Stays empty if there are none. They are valid JSON, and exporters write them
/// where they do not know bounds.
std::string withoutHugeNumbers(std::string_view text) {
  constexpr size_t kMostDigits = 300;  // with fewer, a number without an exponent is not too large
  std::string changed;
  NumberScanner numbers(text);
  for (std::string_view number = numbers.next(); !number.empty(); number = numbers.next()) {
    const bool may_be_huge =
        number.size() > kMostDigits || number.find_first_of("eE") != std::string_view::npos;
    if (!may_be_huge || !isNumber(number) || std::isfinite(numberOf(number))) continue;
    if (changed.empty()) changed = text;
    const auto begin = changed.begin() + (number.data() - text.data());
    std::fill_n(begin, number.size(), ' ');
    *begin = '0';
  }
  return changed;
}

/// Returns the message of nlohmann's parser without "[json.exception.parse_error.101] parse error
/// at line 1, column 2: ". The rest may quote any part of the text.
std::string reasonOf(std::string what) {
  const auto drop = [&](std::string_view begin, std::string_view end) {
    const size_t found = what.starts_with(begin) ? what.find(end) : std::string::npos;
    if (found != std::string::npos) what.erase(0, found + end.size());
  };
  drop("[json.exception.", "] ");
  drop("parse error", ": ");
  return what;
}

/// Builds the document from the events of nlohmann's parser.
class DocumentBuilder : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(std::string_view text, Json& root) : numbers_(text), root_(root) {}

  const Result& result() const { return result_; }

  bool null() override { return add(nullptr) != nullptr; }
  bool boolean(bool value) override { return add(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return addNumber(value); }
  bool number_unsigned(number_unsigned_t value) override { return addNumber(value); }
  bool number_float(number_float_t value, const string_t&) override { return addNumber(value); }
  bool string(string_t& value) override { return add(std::move(value)) != nullptr; }
  bool binary(binary_t&) override { return false; }  // never called for JSON text
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return checkKeys() && close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    key_ = std::move(value);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& exception) override {
    constexpr size_t kMostBytes = 300;  // the message may quote a string of any length
    const std::string reason = shortened(reasonOf(exception.what()), kMostBytes);
    result_ = error("JSON byte " + std::to_string(position),
                    "the JSON is damaged (" + printable(reason) + ")");
    return false;
  }

 private:
  Json* add(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    // Append directly to the ordered map's vector, which avoids a search and keeps repeated keys.
    auto& members = parent.get_ref<Json::object_t&>();
    members.emplace_back(std::move(key_), std::move(value));
    return &members.back().second;
  }

  bool addNumber(Json value) {
    const std::string_view spelling = numbers_.next();
    if (value.dump() != spelling) {
      value = spelt(spelling);
    }
    return add(std::move(value)) != nullptr;
  }

  bool open(Json value) {
    if (open_.size() >= kMaxJsonDepth) {
      result_ = error("JSON", "objects and arrays are nested deeper than " +
                                  std::to_string(kMaxJsonDepth) + " levels");
      return false;
    }
    const bool is_extras = !open_.empty() && open_.back()->is_object() && key_ == "extras";
    open_.push_back(add(std::move(value)));
    if (is_extras && extras_depth_ == 0) extras_depth_ = open_.size();
    return true;
  }

  /// Checks that no key is repeated in the object that ends.
  bool checkKeys() {
    const auto& members = open_.back()->get_ref<const Json::object_t&>();
    if (extras_depth_ != 0 || members.size() < 2) return true;
    std::vector<std::string_view> keys;
    for (const auto& [key, value] : members) keys.push_back(key);
    std::sort(keys.begin(), keys.end());
    const auto repeated = std::adjacent_find(keys.begin(), keys.end());
    if (repeated == keys.end()) return true;
    result_ = error(at(pathOfOpen(), std::string(*repeated)),
                    "the key appears twice in one object, which glTF forbids");
    return false;
  }

  /// Returns the JSON path of the innermost object or array that is open.
  std::string pathOfOpen() const {
    std::string path;
    for (size_t i = 0; i + 1 < open_.size(); ++i) {
      const Json& parent = *open_[i];
      path = parent.is_array() ? at(path, parent.size() - 1)
                               : at(path, parent.get_ref<const Json::object_t&>().back().first);
    }
    return path;
  }

  bool close() {
    if (extras_depth_ == open_.size()) extras_depth_ = 0;
    open_.pop_back();
    return true;
  }

  NumberScanner numbers_;
  Json& root_;
  std::vector<Json*> open_;
  size_t extras_depth_ = 0;  ///< depth of the outermost open `extras`; 0: none is open
  std::string key_;
  Result result_;
};

void print(const Json& json, std::string& out) {
  switch (json.type()) {
    case Json::value_t::object: {
      char separator = '{';
      for (const auto& [key, value] : json.get_ref<const Json::object_t&>()) {
        out += separator;
        out += Json(key).dump();
        out += ':';
        print(value, out);
        separator = ',';
      }
      out += separator == '{' ? "{}" : "}";
      break;
    }
    case Json::value_t::array: {
      char separator = '[';
      for (const Json& value : json) {
        out += separator;
        print(value, out);
        separator = ',';
      }
      out += separator == '[' ? "[]" : "]";
      break;
    }
    case Json::value_t::binary: {
      const auto& spelling = json.get_binary();
      out.append(spelling.begin(), spelling.end());
      break;
    }
    default: out += json.dump(); break;
  }
}

}  // namespace

std::string Result::message() const {
  if (where.empty()) return what;
  return what.empty() ? where : where + ": " + what;
}

Result parseJson(std::span<const uint8_t> text, Json& json) {
  const std::string_view view(reinterpret_cast<const char*>(text.data()), text.size());
  const std::string changed = withoutHugeNumbers(view);
  const std::string_view parsed = changed.empty() ? view : changed;
  DocumentBuilder builder(view, json);
  if (Json::sax_parse(parsed.begin(), parsed.end(), &builder)) return {};
  if (!builder.result().ok()) return builder.result();
  return error("JSON", "the JSON is damaged");
}

std::string printJson(const Json& json) {
  std::string out;
  print(json, out);
  return out;
}

const Json* findMember(const Json& json, std::string_view key) {
  if (!json.is_object()) return nullptr;
  for (const auto& [name, value] : json.get_ref<const Json::object_t&>()) {
    if (name == key) return &value;
  }
  return nullptr;
}

const Json& arrayOf(const Json& object, std::string_view key) {
  static const Json kEmpty = Json::array();
  const Json* member = findMember(object, key);
  return member != nullptr && member->is_array() ? *member : kEmpty;
}

MemberIndex::MemberIndex(const Json& object) {
  if (!object.is_object()) return;
  members_.reserve(object.size());
  for (const auto& [name, value] : object.get_ref<const Json::object_t&>()) {
    members_.emplace_back(name, &value);
  }
  std::stable_sort(members_.begin(), members_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

MemberIndex::MemberIndex(const Json* object)
    : MemberIndex(object == nullptr ? static_cast<const Json&>(Json()) : *object) {}

const Json* MemberIndex::find(std::string_view key) const {
  const auto found = std::lower_bound(
      members_.begin(), members_.end(), key,
      [](const auto& member, std::string_view name) { return member.first < name; });
  return found == members_.end() || found->first != key ? nullptr : found->second;
}

bool asUnsigned(const Json& json, uint64_t& value) {
  if (json.is_number_unsigned()) {
    value = json.get<uint64_t>();
    return true;
  }
  double number = -1;
  if (!asNumber(json, number) || !(number >= 0 && number <= 9007199254740992.0) ||
      number != std::floor(number))
    return false;
  value = static_cast<uint64_t>(number);
  return true;
}

bool asNumber(const Json& json, double& value) {
  if (json.is_binary()) {
    const auto& spelling = json.get_binary();
    value = numberOf({reinterpret_cast<const char*>(spelling.data()), spelling.size()});
  } else if (json.is_number()) {
    value = json.get<double>();
  } else {
    return false;
  }
  return true;
}

Result readUnsigned(const Json& json, const std::string& path, uint64_t max, uint64_t& value) {
  if (!asUnsigned(json, value)) return error(path, "must be a whole number that is not negative");
  if (value <= max) return {};
  return error(path, std::to_string(value) + " is too large (at most " + std::to_string(max) + ")");
}

Result readUnsigned(const Json& object, std::string_view key, const std::string& path, uint64_t max,
                    uint64_t& value) {
  const Json* member = findMember(object, key);
  if (member == nullptr) return error(path, "\"" + std::string(key) + "\" is missing");
  return readUnsigned(*member, at(path, std::string(key)), max, value);
}

Result readOptionalUnsigned(const Json& object, std::string_view key, const std::string& path,
                            uint64_t max, uint64_t& value) {
  if (findMember(object, key) == nullptr) return {};
  return readUnsigned(object, key, path, max, value);
}

}  // namespace mcc::gltf
