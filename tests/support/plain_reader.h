// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads glTF by separate, plain code, so that comparisons share nothing with the library except the
// JSON parser. Other codecs are decoded where the build has them.
#ifndef MCC_TESTS_SUPPORT_PLAIN_READER_H_
#define MCC_TESTS_SUPPORT_PLAIN_READER_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "json/json.h"

namespace mcc::gltf::test {

using Bytes = std::vector<uint8_t>;
/// Files by their names.
using Files = std::map<std::string, Bytes>;

/// The elements of an accessor without padding, sparse values applied.
struct Elements {
  std::string type;
  uint64_t component_type = 0;
  bool is_normalized = false;
  uint32_t component_count = 0;
  std::vector<std::string> values;

  bool sameFormat(const Elements& other) const {
    return type == other.type && component_type == other.component_type &&
           is_normalized == other.is_normalized;
  }
};

/// Component `c` of element `i`.
double component(const Elements& elements, size_t i, size_t c);

/// A document whose buffers were found, with what other codecs hold in it decoded.
class PlainDocument {
 public:
  Json json;

  /// Returns an empty string, or why the document cannot be read.
  std::string load(const Files& files, const std::string& main);

  /// Throws std::runtime_error when the accessor is damaged.
  Elements elements(uint64_t accessor) const;
  /// The components of all elements, and what an accessor of indices holds.
  std::vector<double> numbers(uint64_t accessor) const;
  bool isHeldByDraco(uint64_t accessor) const { return decoded_.count(accessor) != 0; }
  Bytes viewBytes(uint64_t view) const;
  /// Returns the bytes of an image, wherever they are.
  Bytes imageBytes(uint64_t image) const;

 private:
  Bytes fetch(const std::string& uri) const;
  void decodeMeshes();
  static Bytes decodedView(const Json& coding, const Bytes& coded);

  Files files_;
  std::vector<Bytes> buffers_;
  std::map<uint64_t, Bytes> decoded_;  ///< packed elements of accessors that Draco holds
};

/// Returns the member, or null where there is none.
const Json& memberOf(const Json& object, const char* key);
/// Returns the number, however it is spelt, or `otherwise` where there is none.
uint64_t numberOf(const Json& object, const char* key, uint64_t otherwise);
uint64_t numberOf(const Json& value);

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_SUPPORT_PLAIN_READER_H_
