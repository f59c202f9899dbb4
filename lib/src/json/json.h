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

#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

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
  template <std::integral T>
  Json(T value) {
    if constexpr (std::same_as<T, bool>) {
      kind_ = Kind::kBoolean;
      text_ = value ? "true" : "false";
    } else {
      kind_ = Kind::kNumber;
      text_ = std::to_string(value);
    }
  }
  /// Becomes null unless the value is finite, because JSON has no such numbers.
  template <std::floating_point T>
  Json(T value) {
    setNumber(static_cast<double>(value));
  }
  Json(std::string text) : kind_(Kind::kString), text_(std::move(text)) {}
  Json(std::string_view text) : kind_(Kind::kString), text_(text) {}
  Json(const char* text) : kind_(Kind::kString), text_(text) {}
  template <class T>
  Json(const std::vector<T>& values) : Json(rangeOf(values)) {}
  template <class T>
  Json(const std::set<T>& values) : Json(rangeOf(values)) {}
  template <class T, size_t kCount>
  Json(const std::array<T, kCount>& values) : Json(rangeOf(values)) {}
  template <class T, size_t kCount>
  requires(!std::same_as<T, char>) Json(const T (&values)[kCount]) : Json(rangeOf(values)) {}
  /// An object if every element is an array of a text and a value; else an array.
  Json(std::initializer_list<Json> elements);
  static Json array(std::initializer_list<Json> elements = {});
  static Json object(std::initializer_list<Json> members = {});
  /// A number with this spelling, which must be one of JSON.
  static Json number(std::string_view spelling);
  /// Parses a text, see parseJson(). Returns null when it is damaged.
  static Json parse(std::string_view text);

  Json(const Json& other) = default;
  Json(Json&& other) noexcept;
  /// By value, because json["a"] = json["b"] may move where "b" is.
  Json& operator=(Json other) noexcept;
  ~Json();

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
    if constexpr (std::same_as<T, bool>) {
      return is_boolean() && text_ == "true";
    } else if constexpr (std::integral<T>) {
      return static_cast<T>(wholeNumber());
    } else if constexpr (std::floating_point<T>) {
      return static_cast<T>(realNumber());
    } else if constexpr (std::same_as<T, std::string>) {
      return is_string() ? text_ : std::string();
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
  Json& front() { return *begin(); }
  Json& back() { return end()[-1]; }
  const Json& front() const { return *begin(); }
  const Json& back() const { return end()[-1]; }

  /// The element or member with this number, which must be there.
  template <std::integral T>
  Json& operator[](T i) {
    return begin()[i];
  }
  /// The same; null when there is none.
  template <std::integral T>
  const Json& operator[](T i) const {
    return static_cast<size_t>(i) < size() ? begin()[i] : null();
  }
  /// The member with this key, which is added as null to an object that has none, and null becomes
  /// an object; in const JSON it is null.
  Json& operator[](std::string_view key);
  const Json& operator[](std::string_view key) const;
  Json& operator[](const char* key) { return (*this)[std::string_view(key)]; }
  const Json& operator[](const char* key) const { return (*this)[std::string_view(key)]; }
  /// The first member with this key, or end().
  Json* find(std::string_view key);
  const Json* find(std::string_view key) const;
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
  Json value(std::string_view key, const Json& other) const {
    const Json* const found = find(key);
    return found == end() ? other : *found;
  }

  /// Adds to the end of an array; null becomes one.
  void push_back(Json value);
  template <class... T>
  Json& emplace_back(T&&... value) {
    push_back(Json(std::forward<T>(value)...));
    return back();
  }
  /// Adds a member to the end of an object, even if there is one with this key; null becomes an
  /// object.
  Json& append(std::string key, Json value);
  /// Puts the members of another object into this one. They replace those with the same keys.
  void update(const Json& other);
  /// Gives a member another key. It keeps its place.
  void rename(std::string_view from, std::string to);
  /// Removes the first member with this key, if there is one, or the elements or members at a
  /// place.
  void erase(std::string_view key);
  void erase(const Json* place) { erase(place, place + 1); }
  void erase(const Json* from, const Json* to);
  void clear();

  /// The key of the member with this number.
  const std::string& keyAt(size_t i) const { return values_->keys[i]; }
  /// A member for loops: for (const auto& [key, value] : json.items()).
  template <class Value>
  struct Item {
    const std::string& key;
    Value& value;
  };
  template <class Value>
  struct Items {
    struct Iterator {
      Value* json;
      size_t i;
      Item<Value> operator*() const { return {json->keyAt(i), (*json)[i]}; }
      Iterator& operator++() { return ++i, *this; }
      bool operator!=(const Iterator& other) const { return i != other.i; }
    };
    Value* json;
    Iterator begin() const { return {json, 0}; }
    Iterator end() const { return {json, json->is_object() ? json->size() : 0}; }
  };
  Items<Json> items() { return {this}; }
  Items<const Json> items() const { return {this}; }

  /// Prints without white space, or with `indent` spaces for each level. Bytes that are not UTF-8
  /// become U+FFFD. `is_ascii` escapes other characters.
  std::string dump(int indent = -1, bool is_ascii = false) const;

  /// Whether both have equal members in the same order. Numbers are equal if their values are.
  friend bool operator==(const Json& a, const Json& b) { return a.equals(b); }
  template <class T>
  requires std::is_arithmetic_v<T>
  friend bool operator==(const Json& a, T b) { return a.equals(Json(b)); }
  /// Orders numbers.
  friend std::partial_ordering operator<=>(const Json& a, const Json& b) {
    return a.get<double>() <=> b.get<double>();
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  friend std::partial_ordering operator<=>(const Json& a, T b) {
    return a.get<double>() <=> static_cast<double>(b);
  }
  template <std::derived_from<std::ostream> Stream>
  friend Stream& operator<<(Stream& out, const Json& json) {
    out << json.dump();
    return out;
  }

 private:
  /// Orders numbers of members by their keys, and equal keys by their places.
  struct ByKey {
    using is_transparent = void;
    const std::vector<std::string>* keys;
    bool operator()(uint32_t a, uint32_t b) const {
      const int order = (*keys)[a].compare((*keys)[b]);
      return order != 0 ? order < 0 : a < b;
    }
    bool operator()(uint32_t a, std::string_view key) const { return (*keys)[a] < key; }
  };
  struct Values {
    std::vector<Json> values;
    std::vector<std::string> keys;              ///< of an object
    std::set<uint32_t, ByKey> sorted{{&keys}};  ///< all members of an object that has many
  };
  template <class T>
  static Json rangeOf(const T& values) {
    Json array = Json::array();
    for (const auto& value : values) array.push_back(Json(value));
    return array;
  }
  static const Json& null();
  bool equals(const Json& other) const;
  uint64_t wholeNumber() const;
  double realNumber() const;
  void setNumber(double value);
  /// The elements or members, which must exist and which no other value shares from now on.
  Values& own();
  Values& become(Kind kind);
  void sortMembers();

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

/// Prints JSON without white space, with numbers as parseJson() found them.
inline std::string printJson(const Json& json) { return json.dump(); }

/// Returns the member `key` of an object, or null when there is none or `json` is not an object.
inline const Json* findMember(const Json& json, std::string_view key) {
  const Json* const found = json.find(key);
  return found == json.end() ? nullptr : found;
}

/// The same, where null has no members.
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
