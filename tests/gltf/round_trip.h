// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Converts and decodes small documents, and reads what is in them.
// If the environment names a folder by MCC_KEEP_TRIPS, all three files of each trip are kept there,
// for tools/check/documents.
#ifndef MCC_TESTS_GLTF_ROUND_TRIP_H_
#define MCC_TESTS_GLTF_ROUND_TRIP_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "gltf/document/accessors.h"
#include "mcc/glb.h"
#include "support/gltf_builder.h"
#include "support/validator.h"

namespace mcc::gltf::test {

struct RoundTrip {
  std::vector<uint8_t> source;
  std::vector<uint8_t> converted;
  std::vector<uint8_t> decoded;
  ConvertReport report;
  std::string error;
};

/// Keeps the files of a trip under the name of the test and a number. What a whole suite shares
/// belongs to no test.
inline void keepTrip(const RoundTrip& trip, const char* folder) {
  static uint32_t count = 0;
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = "suite";
  if (test != nullptr) name = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(name.begin(), name.end(), '/', '.');
  mcc::test::Validator(folder).add(name + "." + std::to_string(count++), trip.source,
                                   trip.converted, trip.decoded);
}

inline RoundTrip roundTrip(const std::vector<uint8_t>& source, const ConvertOptions& options = {}) {
  RoundTrip trip;
  trip.source = source;
  Result result = convertGlb(source, options, trip.converted, trip.report);
  DecodeReport decode_report;
  if (result.ok()) result = decodeGlb(trip.converted, trip.decoded, decode_report);
  trip.error = result.message();
  const char* const folder = std::getenv("MCC_KEEP_TRIPS");
  if (folder != nullptr && result.ok()) keepTrip(trip, folder);
  return trip;
}

inline RoundTrip roundTrip(const Builder& builder, const ConvertOptions& options = {}) {
  return roundTrip(builder.toGlb(), options);
}

inline std::vector<uint8_t> fileOf(const Builder& builder) {
  return glbOf(builder.json, builder.bin);
}

inline ConvertOptions lossless() {
  ConvertOptions options;
  options.lossless = true;
  return options;
}

inline ConvertOptions evenIfLarger() {
  ConvertOptions options;
  options.allow_larger = true;
  return options;
}

inline bool isCompressed(const Json& json, size_t mesh, size_t primitive) {
  const Json& object = json["meshes"][mesh]["primitives"][primitive];
  return object.contains("extensions") && object["extensions"].contains(kExtensionName);
}

inline bool hasNote(const ConvertReport& report, const std::string& text) {
  for (const std::vector<std::string>* list : {&report.notes, &report.remarks}) {
    for (const std::string& note : *list) {
      if (note.find(text) != std::string::npos) return true;
    }
  }
  return false;
}

/// Returns the elements of an accessor as byte strings.
inline std::vector<std::string> elementsInOrder(const std::vector<uint8_t>& file,
                                                uint32_t accessor) {
  Document document;
  std::vector<std::string> elements;
  AccessorData data;
  if (!loadDocument(file, nullptr, document).ok() || accessor >= document.accessors.size() ||
      !readAccessor(document, accessor, data).ok()) {
    return elements;
  }
  for (uint64_t i = 0; i < data.count; ++i) {
    const auto element = data.element(i);
    elements.emplace_back(element.begin(), element.end());
  }
  return elements;
}

inline std::multiset<std::string> elementsOf(const std::vector<uint8_t>& file, uint32_t accessor) {
  const std::vector<std::string> elements = elementsInOrder(file, accessor);
  return {elements.begin(), elements.end()};
}

inline std::vector<float> floatsInOrder(const std::vector<uint8_t>& file, uint32_t accessor) {
  std::vector<float> floats;
  for (const std::string& element : elementsInOrder(file, accessor)) {
    const size_t first = floats.size();
    floats.resize(first + element.size() / 4);
    std::memcpy(&floats[first], element.data(), element.size());
  }
  return floats;
}

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_GLTF_ROUND_TRIP_H_
