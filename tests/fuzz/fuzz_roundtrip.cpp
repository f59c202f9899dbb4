// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Turns bytes into a mesh, a payload and a mesh again, which must be the same. There are few
// distinct positions, so that many faces touch.
#include <cstring>
#include <vector>

#include "fuzz/byte_feed.h"
#include "support/mesh_compare.h"

namespace mcc::test {
namespace {

/// One attribute's elements, and how they are to be coded.
struct FedAttribute {
  AttributeFormat format;
  std::vector<uint8_t> bytes;
  uint8_t bits = 0;
};

/// Takes most values from a small set, so that predictors find something, and sometimes any bits at
/// all.
void fill(FedAttribute& a, uint32_t wedge_count, ByteFeed& feed) {
  a.bytes.resize(size_t{wedge_count} * elementBytes(a.format));
  const uint32_t step = componentBytes(a.format.component_type);
  for (size_t i = 0; i < a.bytes.size(); i += step) {
    uint32_t value = feed.byte();
    if (a.format.semantic == Semantic::kJoints) value &= 0x7f;  // all ones are refused
    if (a.format.component_type == ComponentType::kFloat32) {
      float number = static_cast<float>(static_cast<int8_t>(value)) / 32;
      if (value == 0x7f) {
        const uint32_t any = feed.u32();
        std::memcpy(&number, &any, 4);
      }
      std::memcpy(&a.bytes[i], &number, 4);
    } else {
      for (uint32_t k = 0; k < step; ++k) {
        a.bytes[i + k] = static_cast<uint8_t>(k == 0 || value > 250 ? value : 0);
      }
    }
  }
}

FedAttribute anyAttribute(uint32_t wedge_count, ByteFeed& feed) {
  FedAttribute a;
  const uint32_t kind = feed.byte();
  a.format.semantic = static_cast<Semantic>(kind & 7);
  a.format.component_type = static_cast<ComponentType>((kind >> 3 & 7) % 6);
  a.format.normalized = (kind & 64) != 0;
  const uint32_t shape = feed.byte();
  constexpr uint8_t kCounts[] = {1, 2, 3, 4, 9, 16};
  a.format.component_count = kCounts[(shape & 15) % sizeof kCounts];
  if (a.format.semantic < Semantic::kCustom) {
    constexpr uint8_t kComponents[] = {3, 3, 4, 2, 4, 4, 4};
    a.format.component_count = kComponents[kind & 7];
  }
  a.format.morph_target = static_cast<uint16_t>(shape >> 4 & 3);
  if (a.format.semantic == Semantic::kPosition && a.format.morph_target == 0)
    a.format.morph_target = 1;
  a.format.set_index = static_cast<uint8_t>(feed.byte() & 3);
  a.bits = static_cast<uint8_t>(feed.byte() % 17);
  if (a.bits == 1) a.bits = 2;
  fill(a, wedge_count, feed);
  return a;
}

void runRoundTrip(ByteFeed& feed) {
  const uint32_t flags = feed.byte();
  const uint32_t wedge_count = feed.byte() % 64;
  std::vector<FedAttribute> attributes(1);
  attributes[0].bits = static_cast<uint8_t>(feed.byte() % 25);
  if ((flags & 1) != 0) attributes[0].format.component_type = ComponentType::kInt16;
  fill(attributes[0], wedge_count, feed);
  const uint32_t attribute_count = feed.byte() % 5;
  for (uint32_t i = 0; i < attribute_count; ++i)
    attributes.push_back(anyAttribute(wedge_count, feed));

  std::vector<AttributeView> views;
  for (const FedAttribute& a : attributes) {
    views.push_back({a.format, a.bytes.data(), elementBytes(a.format), a.bits});
  }
  std::vector<std::vector<uint32_t>> indices((flags & 2) != 0 ? 3 : 1);
  uint32_t last[3] = {0, 1, 2};
  while (!feed.empty() && wedge_count != 0) {
    const uint32_t step = feed.byte();  // strips, with jumps
    if (step >= 192) {
      for (uint32_t& index : last) index = feed.byte();
    } else {
      last[step & 1] = last[2];
      last[2] = step >> 1;
    }
    std::vector<uint32_t>& part = indices[step % indices.size()];
    for (const uint32_t index : last) part.push_back(index % wedge_count);
  }
  std::vector<PartView> parts;
  for (const std::vector<uint32_t>& part : indices) parts.push_back({part});
  const PieceView piece{wedge_count, views, parts};
  EncodeSettings options;
  options.keep_triangle_order = (flags & 4) != 0;
  options.keep_vertex_order = (flags & 8) != 0;
  options.prefer = (flags & 16) != 0 ? Preference::kBalanced : Preference::kSize;
  const RoundTrip result = roundTrip(piece, options);
  require(result.failure.empty(), result.failure);
}

}  // namespace
}  // namespace mcc::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size > 4096) return 0;
  mcc::test::ByteFeed feed(data, size);
  mcc::test::runRoundTrip(feed);
  return 0;
}
