// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Columns of a batch table that are JSON. Their values get a type that holds all of them exactly.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "tiles/batch_table.h"

namespace mcc::tiles {
namespace {

using gltf::Json;
using gltf::Result;

/// A number of JSON, which is whole (then `magnitude` is exact) or a double.
struct Number {
  double value = 0;
  bool is_whole = false;
  bool is_negative = false;
  bool is_double = true;  ///< `value` is exact
  uint64_t magnitude = 0;
};

struct IntegerType {
  const char* name;
  uint32_t bytes;
  uint64_t largest;
  uint64_t lowest_magnitude;  ///< of the most negative value
};

/// The types for whole numbers, of which the first that holds all is chosen. Beyond 32 bits a
/// double is better where it is exact, because JavaScript reads it as the number that JSON is.
constexpr IntegerType kSmallTypes[] = {
    {"UINT8", 1, 0xff, 0},        {"INT8", 1, 0x7f, 0x80},
    {"UINT16", 2, 0xffff, 0},     {"INT16", 2, 0x7fff, 0x8000},
    {"UINT32", 4, 0xffffffff, 0}, {"INT32", 4, 0x7fffffff, 0x80000000}};
constexpr IntegerType kLargeTypes[] = {{"UINT64", 8, ~uint64_t{0}, 0},
                                       {"INT64", 8, ~uint64_t{0} >> 1, uint64_t{1} << 63}};

constexpr double kTwoTo53 = 9007199254740992.0;

void setMagnitude(uint64_t magnitude, bool is_negative, Number& number) {
  number.is_whole = true;
  number.magnitude = magnitude;
  number.is_negative = is_negative;
  number.value = static_cast<double>(magnitude);
  // Rounding may lead to 2^64, which no integer of 64 bits equals.
  number.is_double =
      number.value < 18446744073709551616.0 && static_cast<uint64_t>(number.value) == magnitude;
  if (is_negative) number.value = -number.value;
}

/// Reads a number as JSON means it. Returns false when neither 64 bits nor a double hold it.
bool readNumber(const Json& json, Number& number) {
  if (json.is_number_unsigned()) {
    setMagnitude(json.get<uint64_t>(), false, number);
    return true;
  }
  if (json.is_number_integer()) {
    const auto value = json.get<int64_t>();
    const auto bits = static_cast<uint64_t>(value);
    setMagnitude(value < 0 ? ~bits + 1 : bits, value < 0, number);
    return true;
  }
  if (!gltf::asNumber(json, number.value) || !std::isfinite(number.value)) return false;
  const double magnitude = std::abs(number.value);
  const bool is_minus_zero = magnitude == 0 && std::signbit(number.value);
  if (magnitude <= kTwoTo53 && magnitude == std::floor(magnitude) && !is_minus_zero) {
    setMagnitude(static_cast<uint64_t>(magnitude), number.value < 0, number);
    return true;
  }
  if (!json.is_binary() || magnitude == 0) return true;
  // Digits alone are a whole number that somebody needs exactly, unlike a fraction.
  const auto& spelling = json.get_binary();
  return !std::all_of(spelling.begin(), spelling.end(),
                      [](uint8_t c) { return c == '-' || (c >= '0' && c <= '9'); });
}

bool fits(const Number& number, const IntegerType& type) {
  return number.is_whole &&
         number.magnitude <= (number.is_negative ? type.lowest_magnitude : type.largest);
}

void appendLittleEndian(uint64_t bits, uint32_t bytes, std::vector<uint8_t>& to) {
  for (uint32_t i = 0; i < bytes; ++i) to.push_back(static_cast<uint8_t>(bits >> (8 * i)));
}

bool contains(const std::vector<Number>& numbers, double value) {
  return std::any_of(numbers.begin(), numbers.end(),
                     [value](const Number& one) { return one.value == value; });
}

/// Chooses the type of numbers, and a value that none of them has if `needs_no_data`.
class NumberColumn {
 public:
  NumberColumn(std::vector<Number> numbers, bool needs_no_data)
      : numbers_(std::move(numbers)), needs_no_data_(needs_no_data) {}

  /// Sets the type, the component type and `no_data`. Returns false when no type holds all.
  bool choose(Column& column) {
    column.type = "SCALAR";
    const bool are_chosen =
        std::any_of(std::begin(kSmallTypes), std::end(kSmallTypes),
                    [&](const IntegerType& type) { return chooseInteger(type); }) ||
        chooseDouble() ||
        std::any_of(std::begin(kLargeTypes), std::end(kLargeTypes), [&](const IntegerType& type) {
          return !needs_no_data_ && chooseInteger(type);
        });
    column.component_type = name_;
    column.no_data = no_data_;
    return are_chosen;
  }

  void append(const Number& number, std::vector<uint8_t>& values) const {
    const uint64_t bits = name_ == std::string_view("FLOAT64")
                              ? std::bit_cast<uint64_t>(number.value)
                              : (number.is_negative ? ~number.magnitude + 1 : number.magnitude);
    appendLittleEndian(bits, bytes_, values);
  }

  /// The number that stands for a missing one.
  const Number& substitute() const { return substitute_; }

 private:
  bool chooseInteger(const IntegerType& type) {
    if (!std::all_of(numbers_.begin(), numbers_.end(),
                     [&](const Number& number) { return fits(number, type); })) {
      return false;
    }
    if (needs_no_data_) {
      setMagnitude(type.largest, false, substitute_);
      if (contains(numbers_, substitute_.value)) {
        setMagnitude(type.lowest_magnitude, type.lowest_magnitude != 0, substitute_);
      }
      if (contains(numbers_, substitute_.value)) return false;
      no_data_ = substitute_.is_negative ? Json(static_cast<int64_t>(substitute_.value))
                                         : Json(substitute_.magnitude);
    }
    name_ = type.name;
    bytes_ = type.bytes;
    return true;
  }

  bool chooseDouble() {
    if (!std::all_of(numbers_.begin(), numbers_.end(),
                     [](const Number& number) { return number.is_double; })) {
      return false;
    }
    if (needs_no_data_) {
      substitute_.value = std::numeric_limits<double>::lowest();
      if (contains(numbers_, substitute_.value)) return false;
      no_data_ = substitute_.value;
    }
    name_ = "FLOAT64";
    bytes_ = 8;
    return true;
  }

  std::vector<Number> numbers_;
  bool needs_no_data_ = false;
  const char* name_ = "";
  uint32_t bytes_ = 0;
  Number substitute_;
  Json no_data_;
};

Result makeNumbers(const std::vector<const Json*>& elements, Column& column) {
  std::vector<Number> numbers;
  bool has_null = false;
  for (const Json* element : elements) {
    has_null = has_null || element->is_null();
    if (element->is_null()) continue;
    if (!readNumber(*element, numbers.emplace_back())) {
      return gltf::error("", "a number is beyond 64 bits");
    }
  }
  NumberColumn chosen(numbers, has_null);
  if (!chosen.choose(column)) return gltf::error("", "no type holds all of its numbers exactly");
  size_t next = 0;
  for (const Json* element : elements) {
    chosen.append(element->is_null() ? chosen.substitute() : numbers[next++], column.values);
  }
  return {};
}

/// Returns a text that none of the strings equals.
std::string unusedText(const std::vector<const Json*>& elements) {
  std::set<std::string_view> used;
  for (const Json* element : elements) {
    if (element->is_string()) used.insert(element->get_ref<const std::string&>());
  }
  std::string text;
  for (size_t i = 1; used.contains(text); ++i) {
    text = i == 1 ? "no data" : "no data " + std::to_string(i);
  }
  return text;
}

Result makeStrings(const std::vector<const Json*>& elements, Column& column) {
  column.type = "STRING";
  const bool has_null = std::any_of(elements.begin(), elements.end(),
                                    [](const Json* element) { return element->is_null(); });
  const std::string missing = has_null ? unusedText(elements) : "";
  if (has_null) column.no_data = missing;
  column.string_offsets = {0};
  for (const Json* element : elements) {
    const std::string& text = element->is_null() ? missing : element->get_ref<const std::string&>();
    column.values.insert(column.values.end(), text.begin(), text.end());
    column.string_offsets.push_back(column.values.size());
  }
  if (!column.values.empty()) return {};
  // glTF has no buffer view of zero bytes, but it has properties that are the same everywhere.
  if (column.is_array || has_null) {
    return gltf::error("", "all of its strings are empty, which has no binary form");
  }
  column.default_value = "";
  column.is_required = false;
  column.string_offsets.clear();
  return {};
}

void makeBooleans(const std::vector<const Json*>& elements, Column& column) {
  column.type = "BOOLEAN";
  column.values.assign((elements.size() + 7) / 8, 0);
  for (size_t i = 0; i < elements.size(); ++i) {
    if (elements[i]->get<bool>()) column.values[i / 8] |= static_cast<uint8_t>(1 << (i % 8));
  }
}

enum class Kind : uint8_t { kNull, kNumber, kString, kBoolean, kArray, kOther };

Kind kindOf(const Json& json) {
  if (json.is_null()) return Kind::kNull;
  if (json.is_number() || json.is_binary()) return Kind::kNumber;
  if (json.is_string()) return Kind::kString;
  if (json.is_boolean()) return Kind::kBoolean;
  return json.is_array() ? Kind::kArray : Kind::kOther;
}

/// Finds the kind of all elements apart from null, which is kNull when there is no other.
Result commonKind(const std::vector<const Json*>& elements, Kind& common, bool& has_null) {
  common = Kind::kNull;
  has_null = false;
  for (const Json* element : elements) {
    const Kind kind = kindOf(*element);
    has_null = has_null || kind == Kind::kNull;
    if (kind == Kind::kNull || kind == common) continue;
    if (kind == Kind::kOther) return gltf::error("", "objects have no counterpart");
    if (common != Kind::kNull) return gltf::error("", "its values are of different types");
    common = kind;
  }
  return {};
}

/// Makes the values of a column, or of all arrays of a column in a row.
Result makeValues(const std::vector<const Json*>& elements, Column& column) {
  Kind kind = Kind::kNull;
  bool has_null = false;
  MCC_GLTF_TRY(commonKind(elements, kind, has_null));
  if (has_null && (column.is_array || kind == Kind::kBoolean)) {
    return gltf::error("", "null among booleans or inside of arrays has no counterpart");
  }
  if (has_null) column.is_required = false;
  switch (kind) {
    case Kind::kNumber: return makeNumbers(elements, column);
    case Kind::kString: return makeStrings(elements, column);
    case Kind::kBoolean: makeBooleans(elements, column); return {};
    case Kind::kNull:
      if (column.is_array) return gltf::error("", "all of its arrays are empty, so have no type");
      // A property that the table leaves out is missing everywhere, and its type does not matter.
      column.type = "STRING";
      return {};
    case Kind::kArray:
    case Kind::kOther: break;
  }
  return gltf::error("", "arrays of arrays have no counterpart");
}

}  // namespace

Result readJsonColumn(const Json& values, Column& column) {
  std::vector<const Json*> rows;
  for (const Json& value : values) rows.push_back(&value);
  Kind kind = Kind::kNull;
  bool has_null = false;
  MCC_GLTF_TRY(commonKind(rows, kind, has_null));
  if (kind != Kind::kArray) return makeValues(rows, column);
  if (has_null) return gltf::error("", "null among arrays has no counterpart");
  column.is_array = true;
  column.array_length = rows[0]->size();
  std::vector<const Json*> elements;
  column.array_offsets = {0};
  for (const Json* row : rows) {
    for (const Json& element : *row) elements.push_back(&element);
    column.array_offsets.push_back(elements.size());
    if (row->size() != column.array_length) column.array_length = 0;
  }
  // The 3D Metadata Specification asks for at least two elements where the length is fixed.
  if (column.array_length < 2) column.array_length = 0;
  if (column.array_length != 0) column.array_offsets.clear();
  return makeValues(elements, column);
}

}  // namespace mcc::tiles
