// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// JSON whose members keep their order and whose numbers keep their spelling. A number that printing
// would change (1e-7, -0, 2^70, 0.10 …) is held as a *binary* value: the bytes of its source text.
#ifndef MCC_GLTF_JSON_H_
#define MCC_GLTF_JSON_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/result.h"

namespace mcc::gltf {

using Json = nlohmann::ordered_json;

/// Deepest nesting of arrays and objects that is read.
inline constexpr uint32_t kMaxJsonDepth = 256;

/// Parses UTF-8 text. Errors name the byte. glTF forbids repeated keys, and readers differ in which of them counts: they are
/// an error, with its JSON path, except in `extras`, whose members are kept as they are.
Result parseJson(std::span<const uint8_t> text, Json& json);

/// Prints without white space; numbers as parseJson() found them.
std::string printJson(const Json& json);

/// The member `key` of an object, or null when there is none or `json` is not an object. Takes time in
/// proportion to the number of members: for many look-ups in an object of any size there is MemberIndex.
const Json* findMember(const Json& json, std::string_view key);

/// Array of an object, or an empty array.
const Json& arrayOf(const Json& object, std::string_view key);

/// The members of an object, to be looked up by key in logarithmic time. The object must outlive the
/// index and keep its members; what is not an object has none.
class MemberIndex {
 public:
  explicit MemberIndex(const Json& object);
  /// Of null: without members.
  explicit MemberIndex(const Json* object);

  /// The first member with this key, or null.
  const Json* find(std::string_view key) const;

 private:
  std::vector<std::pair<std::string_view, const Json*>> members_;  ///< sorted by key
};

/// Value of a non-negative integer however it is spelt (3, 3.0, 3e0); false for anything else.
bool asUnsigned(const Json& json, uint64_t& value);

/// Value of any number; false for anything else.
bool asNumber(const Json& json, double& value);

/// Reads the member `key` of the object at `path`. The first form requires it, the second leaves
/// `value` alone when it is absent. Values above `max` are errors.
Result readUnsigned(const Json& object, std::string_view key, const std::string& path, uint64_t max,
                    uint64_t& value);
Result readOptionalUnsigned(const Json& object, std::string_view key, const std::string& path,
                            uint64_t max, uint64_t& value);

/// The same of the value at `path` itself.
Result readUnsigned(const Json& json, const std::string& path, uint64_t max, uint64_t& value);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_JSON_H_
