// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// JSON whose members keep their order and whose numbers keep their spelling: a number is the text
// that a file had, and becomes a value only for whoever asks. Objects find a member in logarithmic
// time, however many they have.
//
// A copy shares the elements and members of its source until one of the two is about to change
// them. An edited document therefore costs what is edited of it, and nothing is copied to print it.
#ifndef MCC_JSON_JSON_H_
#define MCC_JSON_JSON_H_

#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <iterator>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "json/spelling.h"
#include "mcc/result.h"

namespace mcc::gltf {

/// A value of JSON. A const object may be read by several threads at the same time.
/// Whoever holds a reference to an element or member of a value, other than a const one, must not
/// copy the value and then use the reference: it may be one to the copy as well.
class Json {
 public:
  enum class Kind : uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Json() = default;
  Json(std::nullptr_t) {}
  /// Becomes null unless the value is finite, because JSON has no such numbers.
  template <class T>
  requires std::is_arithmetic_v<T> Json(T value)
      : kind_(std::same_as<T, bool> ? Kind::kBoolean : Kind::kNumber) {
    if constexpr (std::same_as<T, bool>) {
      text_ = value ? "true" : "false";
    } else if constexpr (std::integral<T>) {
      text_ = std::to_string(value);
    } else {
      text_ = spellingOf(double{value});
      if (text_.empty()) kind_ = Kind::kNull;
    }
  }
  Json(std::string text) : kind_(Kind::kString), text_(std::move(text)) {}
  Json(std::string_view text) : Json(std::string(text)) {}
  Json(const char* text) : Json(std::string(text)) {}
  /// An array of the elements of a container.
  template <class T>
  requires(!std::same_as<T, Json> && !std::constructible_from<std::string, const T&> &&
           requires(const T& values) { std::begin(values); }) Json(const T& values)
      : Json(array()) {
    for (const auto& value : values) push_back(value);
  }
  /// An object if every element is an array of a text and a value; else an array.
  Json(std::initializer_list<Json> elements);
  static Json array(std::initializer_list<Json> elements = {});
  static Json object(std::initializer_list<Json> members = {});
  /// A number with this spelling, which must be one of JSON.
  static Json number(std::string spelling);
  /// Parses a text, see parseJson(). Returns null when it is damaged.
  static Json parse(std::string_view text);

  Json(const Json& other) = default;
  Json(Json&& other) noexcept
      : kind_(std::exchange(other.kind_, Kind::kNull)),
        text_(std::move(other.text_)),
        values_(std::move(other.values_)) {}
  /// By value, because json["a"] = json["b"] may move where "b" is.
  Json& operator=(Json other) noexcept;

  Kind kind() const { return kind_; }
  bool is_null() const { return kind_ == Kind::kNull; }
  bool is_boolean() const { return kind_ == Kind::kBoolean; }
  bool is_number() const { return kind_ == Kind::kNumber; }
  bool is_string() const { return kind_ == Kind::kString; }
  bool is_array() const { return kind_ == Kind::kArray; }
  bool is_object() const { return kind_ == Kind::kObject; }
  bool is_structured() const { return is_array() || is_object(); }

  /// A number's spelling, a string's content, "true", "false", or nothing.
  const std::string& text() const { return text_; }
  /// The value as a number, text or truth; zero, "" or false when it is of another kind.
  template <class T>
  T get() const {
    if constexpr (std::same_as<T, Json>) {
      return *this;
    } else if constexpr (std::same_as<T, bool>) {
      return is_boolean() && text_ == "true";
    } else if constexpr (std::integral<T>) {
      return is_number() ? static_cast<T>(wholeNumberOf(text_)) : 0;
    } else if constexpr (std::floating_point<T>) {
      return is_number() ? static_cast<T>(numberOf(text_)) : 0;
    } else if constexpr (std::same_as<T, std::string>) {
      return is_string() ? text_ : T();
    } else {
      T values;
      for (const Json& value : *this) values.push_back(value.get<typename T::value_type>());
      return values;
    }
  }
  /// The same where a number, a truth or a text is wanted.
  template <class T>
  requires(std::is_arithmetic_v<T> || std::same_as<T, std::string>) operator T() const {
    return get<T>();
  }

  /// The values of an array or of the members of an object.
  Json* begin() { return values_ == nullptr ? nullptr : own().values.data(); }
  Json* end() { return begin() + size(); }
  const Json* begin() const { return values_ == nullptr ? nullptr : values_->values.data(); }
  const Json* end() const { return begin() + size(); }
  size_t size() const { return values_ == nullptr ? 0 : values_->values.size(); }
  bool empty() const { return size() == 0; }
  Json& back() { return end()[-1]; }
  const Json& back() const { return end()[-1]; }

  /// The element or member with this number, which must be there; or the member with this key,
  /// which is added as null to an object that has none, and null becomes an object.
  template <class Key>
  Json& operator[](const Key& key) {
    return place(key);
  }
  /// The same; null when there is none.
  template <class Key>
  const Json& operator[](const Key& key) const {
    const Json* const found = find(key);
    return found == end() ? null() : *found;
  }
  /// The first member with this key, or the value with this number; end() when there is none.
  Json* find(std::string_view key);
  const Json* find(std::string_view key) const;
  const Json* find(std::integral auto i) const {
    return static_cast<size_t>(i) < size() ? begin() + i : end();
  }
  bool contains(std::string_view key) const { return find(key) != end(); }
  /// The member with this key, or `other` when there is none.
  template <class T>
  T value(std::string_view key, T other) const {
    const Json* const found = find(key);
    return found == end() ? other : found->get<T>();
  }
  std::string value(std::string_view key, const char* other) const {
    return value(key, std::string(other));
  }

  /// Adds to the end of an array; null becomes one.
  void push_back(Json value) { become(Kind::kArray).values.push_back(std::move(value)); }
  /// Adds a member to the end of an object, even if there is one with this key; null becomes an
  /// object.
  Json& append(std::string key, Json value);
  /// Puts the members of another object into this one. They replace those with the same keys.
  void update(const Json& other);
  /// Removes the first member with this key, if there is one, or the elements or members at a
  /// place.
  void erase(std::string_view key);
  void erase(const Json* place) { erase(place, place + 1); }
  void erase(const Json* from, const Json* to);

  /// The key of the member with this number.
  const std::string& keyAt(size_t i) const { return values_->keys[i]; }
  /// The members for loops: for (const auto& [key, value] : json.items()).
  struct Items {  ///< is its own iterator
    const Json* json;
    size_t i;
    Items begin() const { return *this; }
    Items end() const { return {json, json->is_object() ? json->size() : 0}; }
    std::pair<const std::string&, const Json&> operator*() const {
      return {json->keyAt(i), (*json)[i]};
    }
    Items& operator++() { return ++i, *this; }
    bool operator!=(const Items& other) const { return i != other.i; }
  };
  Items items() const { return {this, 0}; }

  /// Prints without white space, or with `indent` spaces for each level. Bytes that are not UTF-8
  /// become U+FFFD. `is_ascii` escapes other characters.
  std::string dump(int indent = -1, bool is_ascii = false) const;

  /// Whether both have equal members in the same order. Numbers are equal if their values are.
  template <class T>
  friend bool operator==(const Json& a, const T& b) {
    return a.equals(b);
  }
  /// Orders numbers.
  template <class T>
  requires std::convertible_to<const T&, double>
  friend std::partial_ordering operator<=>(const Json& a, const T& b) {
    return a.get<double>() <=> static_cast<double>(b);
  }
  template <std::derived_from<std::ostream> Stream>
  friend Stream& operator<<(Stream& out, const Json& json) {
    out << json.dump();
    return out;
  }

 private:
  /// Orders numbers of members by their keys.
  struct ByKey {
    using is_transparent = void;
    const std::vector<std::string>* keys;
    bool operator()(uint32_t a, uint32_t b) const { return (*keys)[a] < (*keys)[b]; }
    bool operator()(uint32_t a, std::string_view b) const { return (*keys)[a] < b; }
    bool operator()(std::string_view a, uint32_t b) const { return a < (*keys)[b]; }
  };
  struct Values {
    std::vector<Json> values;
    std::vector<std::string> keys;              ///< of an object
    std::set<uint32_t, ByKey> sorted{{&keys}};  ///< the first members with their keys, if many
    uint32_t indexed = 0;                       ///< so many members are considered there
    void index();
  };
  static const Json& null();
  Json& place(std::integral auto i) { return begin()[i]; }
  Json& place(std::string_view key);
  bool equals(const Json& other) const;
  /// The elements or members, which must exist and which no other value shares from now on.
  Values& own();
  Values& become(Kind kind);

  Kind kind_ = Kind::kNull;
  std::string text_;
  std::shared_ptr<Values> values_;
};

/// The deepest nesting of arrays and objects that is read.
inline constexpr uint32_t kMaxJsonDepth = 256;

/// Parses UTF-8 text. Errors name the byte. Repeated keys are an error, with their JSON path,
/// because glTF forbids them and readers differ in which of them counts. In `extras` they are kept
/// as they are. Numbers may be larger than any that binary64 holds.
Result parseJson(std::span<const uint8_t> text, Json& json);

/// Is told what a text of JSON consists of. Whatever it returns but success ends the text.
class JsonListener {
 public:
  virtual ~JsonListener() = default;
  /// An array or object begins with this byte.
  virtual Result begin(Json::Kind kind, uint64_t byte) = 0;
  /// The innermost one ends before this byte.
  virtual Result end(uint64_t byte) = 0;
  virtual Result key(std::string key) = 0;
  /// A value that is neither an array nor an object.
  virtual Result value(Json value) = 0;
};

/// Returns the next bytes of a text, which stay until the next call; none at its end.
using JsonParts = std::function<std::string_view()>;

/// Reads a text of any depth piece by piece, see parseJson(). Its memory is that of the longest
/// string or number and a byte for each level.
Result scanJson(const JsonParts& parts, JsonListener& listener);

/// Prints JSON without white space, with numbers as parseJson() found them.
inline std::string printJson(const Json& json) { return json.dump(); }

/// Returns the member `key` of an object, or null when there is none or `json` is not an object.
inline const Json* findMember(const Json& json, std::string_view key) {
  const Json* const found = json.find(key);
  return found == json.end() ? nullptr : found;
}
inline const Json* findMember(const Json* json, std::string_view key) {
  return json == nullptr ? nullptr : findMember(*json, key);
}

/// Returns an array that is a member of an object, or an empty array.
const Json& arrayOf(const Json& object, std::string_view key);

/// Reads a non-negative integer, however it is spelt (3, 3.0, 3e0). Returns false for anything
/// else.
bool asUnsigned(const Json& json, uint64_t& value);

/// The same, where null is no number.
inline bool asUnsigned(const Json* json, uint64_t& value) {
  return json != nullptr && asUnsigned(*json, value);
}

/// Reads any number; one too large for binary64 is infinite. Returns false for anything else.
bool asNumber(const Json& json, double& value);

/// Reads the member `key` of the object at `path`. The first form requires it; the second leaves
/// `value` alone when it is absent. Values above `max` are errors.
Result readUnsigned(const Json& object, std::string_view key, const std::string& path, uint64_t max,
                    uint64_t& value);
Result readOptionalUnsigned(const Json& object, std::string_view key, const std::string& path,
                            uint64_t max, uint64_t& value);

/// Reads the value at `path` itself.
Result readUnsigned(const Json& json, const std::string& path, uint64_t max, uint64_t& value);

}  // namespace mcc::gltf

#endif  // MCC_JSON_JSON_H_
