// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// JSON whose members keep their order and whose numbers keep their spelling. A number that printing
// would change (1e-7, -0, 2^70, 0.10 …) is stored as a *binary* value: the bytes of its source
// text.
#ifndef MCC_GLTF_DOCUMENT_JSON_H_
#define MCC_GLTF_DOCUMENT_JSON_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/base/result.h"

namespace mcc::gltf {

using Json = nlohmann::ordered_json;

/// The deepest nesting of arrays and objects that is read.
inline constexpr uint32_t kMaxJsonDepth = 256;

/// Parses UTF-8 text. Errors name the byte. Repeated keys are an error, with their JSON path,
/// because glTF forbids them and readers differ in which of them counts. In `extras` they are kept
/// as they are. Numbers may be larger than any that binary64 holds.
Result parseJson(std::span<const uint8_t> text, Json& json);

/// Prints JSON without white space, with numbers as parseJson() found them.
std::string printJson(const Json& json);

/// Returns the member `key` of an object, or null when there is none or `json` is not an object.
/// Takes time proportional to the number of members; use MemberIndex for many look-ups in an object
/// of any size.
const Json* findMember(const Json& json, std::string_view key);

/// Returns an array that is a member of an object, or an empty array.
const Json& arrayOf(const Json& object, std::string_view key);

/// The members of an object, for look-ups by key in logarithmic time. The object must outlive the
/// index and keep its members. JSON that is not an object has no members.
class MemberIndex {
 public:
  explicit MemberIndex(const Json& object);
  /// The same, where null has no members.
  explicit MemberIndex(const Json* object);

  /// Returns the first member with this key, or null.
  const Json* find(std::string_view key) const;

 private:
  std::vector<std::pair<std::string_view, const Json*>> members_;  ///< sorted by key
};

/// Reads a non-negative integer, however it is spelt (3, 3.0, 3e0). Returns false for anything
/// else.
bool asUnsigned(const Json& json, uint64_t& value);

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

#endif  // MCC_GLTF_DOCUMENT_JSON_H_
