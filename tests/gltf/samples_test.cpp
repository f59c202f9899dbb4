// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The sample models: they never become larger, and what shares accessors still does after decoding.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "gltf/files/file_io.h"
#include "gltf/round_trip.h"
#include "support/document_compare.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;

/// Accessor numbers of all attributes, targets and indices of triangle primitives, in file order.
std::vector<uint32_t> accessorsOf(const Json& json) {
  std::vector<uint32_t> accessors;
  for (const Json& mesh : json["meshes"]) {
    for (const Json& primitive : mesh["primitives"]) {
      if (primitive.contains("mode") && primitive["mode"] < 4) continue;
      std::map<std::string, uint32_t> sorted;
      for (const auto& [name, value] : primitive["attributes"].items()) sorted[name] = value;
      for (const auto& [name, value] : sorted) accessors.push_back(value);
      for (const Json& target : arrayOf(primitive, "targets")) {
        for (const Json& value : target) accessors.push_back(value);
      }
      if (primitive.contains("indices")) accessors.push_back(primitive["indices"]);
    }
  }
  return accessors;
}

TEST(Samples, StaySharedAndNeverGrow) {
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator(MCC_SAMPLES_DIR)) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().filename().string());
    ++count;
    std::vector<uint8_t> source;
    ASSERT_TRUE(readFile(entry.path(), source).ok());
    for (const bool is_lossless : {false, true}) {
      ConvertOptions options;
      options.lossless = is_lossless;
      const RoundTrip trip = roundTrip(source, options);
      ASSERT_EQ(trip.error, "");
      EXPECT_LT(trip.converted.size(), source.size());
      if (is_lossless) {
        EXPECT_EQ(differenceOfPrimitives(source, trip.decoded, false), "");
      }
      const RoundTrip again = roundTrip(trip.converted, options);
      ASSERT_EQ(again.error, "");
      EXPECT_EQ(again.converted, trip.converted);
      if (hasNote(trip.report, "gets its own")) continue;
      const std::vector<uint32_t> before = accessorsOf(jsonOf(source));
      const std::vector<uint32_t> after = accessorsOf(jsonOf(trip.decoded));
      const bool has_new_indices = before.size() != after.size();  // of primitives that had none
      if (!has_new_indices) {
        EXPECT_EQ(before, after);
      }
    }
  }
  EXPECT_GE(count, 13u);
}

}  // namespace
}  // namespace mcc::gltf::test
