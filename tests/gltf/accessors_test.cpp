// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/accessors.h"

#include <gtest/gtest.h>

#include "support/gltf_builder.h"

namespace mcc::gltf::test {
namespace {

class Accessors : public testing::Test {
 protected:
  /// Loads the builder's file, and returns the message of the failure.
  std::string load() {
    file_ = builder_.toGlb();
    return loadDocument(file_, nullptr, document_).message();
  }

  template <typename T>
  std::vector<T> read(uint32_t accessor) {
    AccessorData elements;
    const Result result = readAccessor(document_, accessor, elements);
    EXPECT_TRUE(result.ok()) << result.message();
    std::vector<T> values(elements.count * elements.element_bytes / sizeof(T));
    for (uint64_t i = 0; i < elements.count; ++i) {
      std::memcpy(reinterpret_cast<uint8_t*>(values.data()) + i * elements.element_bytes,
                  elements.element(i).data(), elements.element_bytes);
    }
    return values;
  }

  Builder builder_;
  std::vector<uint8_t> file_;
  Document document_;
};

TEST_F(Accessors, InterleavedAndStrided) {
  const uint32_t view = builder_.addView(bytesOf(std::vector<float>{1, 2, 3, 9, 4, 5, 6, 8}), 16);
  builder_.addAccessor(
      {{"bufferView", view}, {"componentType", kFloat}, {"count", 2}, {"type", "VEC3"}});
  builder_.addAccessor({{"bufferView", view},
                        {"byteOffset", 12},
                        {"componentType", kFloat},
                        {"count", 2},
                        {"type", "SCALAR"}});
  ASSERT_EQ(load(), "");
  EXPECT_EQ(read<float>(0), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(read<float>(1), (std::vector<float>{9, 8}));
}

TEST_F(Accessors, AllComponentTypes) {
  builder_.addAccessor(std::vector<int8_t>{-1, 2, -128}, kByte, "SCALAR", 3);
  builder_.addAccessor(std::vector<uint8_t>{1, 255}, kUnsignedByte, "SCALAR", 2);
  builder_.addAccessor(std::vector<int16_t>{-1, 300}, kShort, "VEC2", 1);
  builder_.addAccessor(std::vector<uint16_t>{65535, 3}, kUnsignedShort, "VEC2", 1);
  builder_.addAccessor(std::vector<uint32_t>{0xfffffffe}, kUnsignedInt, "SCALAR", 1);
  ASSERT_EQ(load(), "");
  EXPECT_EQ(read<int8_t>(0), (std::vector<int8_t>{-1, 2, -128}));
  EXPECT_EQ(read<uint8_t>(1), (std::vector<uint8_t>{1, 255}));
  EXPECT_EQ(read<int16_t>(2), (std::vector<int16_t>{-1, 300}));
  EXPECT_EQ(read<uint16_t>(3), (std::vector<uint16_t>{65535, 3}));
  EXPECT_EQ(read<uint32_t>(4), (std::vector<uint32_t>{0xfffffffe}));
}

TEST_F(Accessors, SparseOverViewAndOverZeros) {
  const uint32_t base = builder_.addView(bytesOf(std::vector<float>{1, 2, 3, 4}));
  const uint32_t indices = builder_.addView(bytesOf(std::vector<uint16_t>{1, 3}));
  const uint32_t values = builder_.addView(bytesOf(std::vector<float>{20, 40}));
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                       {"values", {{"bufferView", values}}}};
  Json accessor = {{"bufferView", base},
                   {"componentType", kFloat},
                   {"count", 4},
                   {"type", "SCALAR"},
                   {"sparse", sparse}};
  builder_.addAccessor(accessor);
  accessor.erase("bufferView");
  builder_.addAccessor(accessor);
  accessor.erase("sparse");
  builder_.addAccessor(accessor);
  ASSERT_EQ(load(), "");
  EXPECT_EQ(read<float>(0), (std::vector<float>{1, 20, 3, 40}));
  EXPECT_EQ(read<float>(1), (std::vector<float>{0, 20, 0, 40}));
  EXPECT_EQ(read<float>(2), (std::vector<float>{0, 0, 0, 0}));
}

TEST_F(Accessors, SparseIndexOutOfRangeIsAnError) {
  const uint32_t indices = builder_.addView(bytesOf(std::vector<uint8_t>{4}));
  const uint32_t values = builder_.addView(bytesOf(std::vector<float>{20}));
  builder_.addAccessor({{"componentType", kFloat},
                        {"count", 4},
                        {"type", "SCALAR"},
                        {"sparse",
                         {{"count", 1},
                          {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                          {"values", {{"bufferView", values}}}}}});
  ASSERT_EQ(load(), "");
  AccessorData elements;
  EXPECT_EQ(readAccessor(document_, 0, elements).message(),
            "/accessors/0/sparse/indices: index 4 is outside the accessor of 4 elements");
}

TEST_F(Accessors, MatrixColumnsArePadded) {
  // MAT3 of bytes: each column takes 4 bytes.
  builder_.addAccessor(std::vector<uint8_t>{1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99}, kUnsignedByte,
                       "MAT3", 1);
  builder_.addAccessor(std::vector<uint16_t>{1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99}, kUnsignedShort,
                       "MAT3", 1);
  builder_.addAccessor(std::vector<float>{1, 2, 3, 4}, kFloat, "MAT2", 1);
  ASSERT_EQ(load(), "");
  EXPECT_EQ(read<uint8_t>(0), (std::vector<uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(read<uint16_t>(1), (std::vector<uint16_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(read<float>(2), (std::vector<float>{1, 2, 3, 4}));
  uint32_t stride = 1;
  const std::vector<uint8_t> packed = packAttribute(std::vector<uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9},
                                                    document_.accessors[0], stride);
  EXPECT_EQ(stride,
            12u);  // without the padding of the last column elements would be 11 bytes apart
  EXPECT_EQ(packed, (std::vector<uint8_t>{1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0}));
}

TEST_F(Accessors, VertexAttributesArePackedAtMultiplesOfFour) {
  builder_.addAccessor(std::vector<uint8_t>{1, 2, 3, 4, 5, 6}, kUnsignedByte, "VEC3", 2);
  ASSERT_EQ(load(), "");
  uint32_t stride = 0;
  const auto packed =
      packAttribute(std::vector<uint8_t>{1, 2, 3, 4, 5, 6}, document_.accessors[0], stride);
  EXPECT_EQ(stride, 4u);
  EXPECT_EQ(packed, (std::vector<uint8_t>{1, 2, 3, 0, 4, 5, 6, 0}));
}

TEST_F(Accessors, RangesAreChecked) {
  const uint32_t view = builder_.addView(bytesOf(std::vector<float>{1, 2, 3}));
  Json accessor = {{"bufferView", view}, {"componentType", kFloat}, {"count", 1}, {"type", "VEC3"}};
  const auto with = [&](const char* key, const Json& value) {
    builder_.json["accessors"] = Json::array({accessor});
    builder_.json["accessors"][0][key] = value;
    EXPECT_EQ(load(), "");  // what is wrong concerns only this accessor
    AccessorData elements;
    EXPECT_EQ(document_.accessors[0].fault.ok() && document_.accessors[0].is_known_type,
              readAccessor(document_, 0, elements).ok());
    return document_.accessors[0].fault.message();
  };
  EXPECT_EQ(with("count", 1), "");
  EXPECT_NE(with("count", 2), "");
  EXPECT_NE(with("count", 4294967295u), "");
  EXPECT_NE(with("count", 4294967296u), "");
  EXPECT_NE(with("count", -1), "");
  EXPECT_NE(with("byteOffset", 4), "");
  EXPECT_NE(with("byteOffset", 9007199254740992u), "");
  EXPECT_NE(with("byteOffset", 18446744073709551612u), "");
  EXPECT_NE(with("bufferView", 1), "");
  EXPECT_NE(with("bufferView", "0"), "");
  EXPECT_NE(with("type", 3), "");
  EXPECT_EQ(with("type", "VEC9"), "");  // may belong to some extension, so we do not judge it
}

TEST_F(Accessors, ViewsAreChecked) {
  builder_.addView({1, 2, 3, 4});
  const auto with = [&](const char* key, const Json& value) {
    Builder copy = builder_;
    copy.json["bufferViews"][0][key] = value;
    file_ = copy.toGlb();
    return loadDocument(file_, nullptr, document_).message();
  };
  const auto bytesWith = [&](const char* key, const Json& value) {
    EXPECT_EQ(with(key, value), "");
    const BufferView& view = document_.views[0];
    EXPECT_LE(view.offset, 4u);
    EXPECT_LE(view.length, 4 - view.offset);
    return view.fault.ok() ? -1 : static_cast<int>(view.length);
  };
  EXPECT_EQ(bytesWith("byteLength", 4), -1);
  EXPECT_EQ(bytesWith("byteLength", 5), 4);
  EXPECT_EQ(bytesWith("byteOffset", 1), 3);
  EXPECT_EQ(bytesWith("byteOffset", 5), 0);
  EXPECT_EQ(bytesWith("byteLength", 9007199254740992u), 4);
  EXPECT_EQ(bytesWith("byteOffset", 9007199254740992u), 0);
  EXPECT_NE(with("byteOffset", 18446744073709551615u), "");
  EXPECT_NE(with("buffer", 1), "");
  EXPECT_NE(with("byteStride", 70000), "");
}

TEST_F(Accessors, IndicesMustBeUnsignedScalars) {
  builder_.addAccessor(std::vector<uint8_t>{3, 255}, kUnsignedByte, "SCALAR", 2);
  builder_.addAccessor(std::vector<int16_t>{1, 2}, kShort, "SCALAR", 2);
  builder_.addAccessor(std::vector<uint16_t>{1, 2}, kUnsignedShort, "VEC2", 1);
  ASSERT_EQ(load(), "");
  std::vector<uint32_t> indices;
  ASSERT_TRUE(readIndices(document_, 0, indices).ok());
  EXPECT_EQ(indices, (std::vector<uint32_t>{3, 255}));
  EXPECT_FALSE(readIndices(document_, 1, indices).ok());
  EXPECT_NE(readIndices(document_, 2, indices).message().find("VEC2 of UNSIGNED_SHORT"),
            std::string::npos);
}

TEST(ExpandTriangles, FollowsGltf) {
  std::vector<uint32_t> strip = {0, 1, 2, 3, 4};
  ASSERT_TRUE(expandTriangles(5, strip));
  EXPECT_EQ(strip, (std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  std::vector<uint32_t> fan = {0, 1, 2, 3};
  ASSERT_TRUE(expandTriangles(6, fan));
  EXPECT_EQ(fan, (std::vector<uint32_t>{1, 2, 0, 2, 3, 0}));
  std::vector<uint32_t> list = {0, 1, 2};
  EXPECT_TRUE(expandTriangles(4, list));
  std::vector<uint32_t> odd = {0, 1, 2, 3};
  EXPECT_FALSE(expandTriangles(4, odd));
  std::vector<uint32_t> few = {0, 1};
  EXPECT_FALSE(expandTriangles(5, few));
  EXPECT_FALSE(expandTriangles(1, list));
}

}  // namespace
}  // namespace mcc::gltf::test
