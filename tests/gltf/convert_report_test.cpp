// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <limits>

#include "gltf/inspect/report.h"
#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

const AttributeReport* find(const PayloadReport& payload, const std::string& name, bool is_exact) {
  for (const AttributeReport& attribute : payload.attributes) {
    if (attribute.name == name && (attribute.bits == 0) == is_exact) return &attribute;
  }
  return nullptr;
}

/// Two pieces of a payload, one of which has texture coordinates that no lattice can hold: the
/// report must not mix them up.
TEST(ConvertReport, PiecesCodedDifferentlyHaveRowsOfTheirOwn) {
  Builder builder;
  Sheet coarse(12);
  for (float& texcoord : coarse.texcoords) texcoord *= 1e6f;
  Sheet exact(20);
  exact.texcoords[7] = std::numeric_limits<float>::infinity();
  builder.addMesh({coarse.addTo(builder), exact.addTo(builder), coarse.addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  ASSERT_EQ(trip.report.payloads.size(), 1u);
  const PayloadReport& payload = trip.report.payloads[0];
  EXPECT_EQ(payload.attributes.size(), 4u);
  const AttributeReport* on_lattice = find(payload, "TEXCOORD_0", false);
  const AttributeReport* bit_by_bit = find(payload, "TEXCOORD_0", true);
  const AttributeReport* positions = find(payload, "POSITION", false);
  ASSERT_TRUE(on_lattice != nullptr && bit_by_bit != nullptr && positions != nullptr);
  EXPECT_EQ(on_lattice->coding, AttributeCoding::kLattice);
  EXPECT_EQ(on_lattice->vertex_count, 2 * coarse.count());
  EXPECT_GT(on_lattice->promised_error, 100);
  EXPECT_GT(on_lattice->max_error, 1);
  EXPECT_LE(on_lattice->max_error, on_lattice->promised_error);
  EXPECT_EQ(bit_by_bit->vertex_count, exact.count());
  EXPECT_EQ(bit_by_bit->promised_error, 0);
  EXPECT_EQ(bit_by_bit->max_error, 0);
  // Each row says which primitives it is about.
  using Paths = std::vector<std::string>;
  EXPECT_EQ(on_lattice->primitives, (Paths{"/meshes/0/primitives/0", "/meshes/0/primitives/2"}));
  EXPECT_EQ(bit_by_bit->primitives, Paths{"/meshes/0/primitives/1"});
  EXPECT_EQ(positions->primitives.size(), 3u);
  EXPECT_NEAR(positions->extent, 1, 1e-3);
  // The bits of all attributes and streams add up to the payload.
  double bits = 0;
  for (const StreamReport& stream : payload.streams) bits += stream.bits;
  for (const AttributeReport& attribute : payload.attributes) {
    EXPECT_GT(attribute.coded_bits, 0) << attribute.name;
    bits += attribute.coded_bits;
  }
  EXPECT_NEAR(bits, 8 * static_cast<double>(payload.payload_bytes), 1);
}

/// Notes are for what a user may want to change; remarks only tell what was found.
TEST(ConvertReport, WhatAsksNothingIsARemark) {
  Builder builder;
  const Sheet sheet(20);
  Json first = sheet.addTo(builder);
  Json second = sheet.addTo(builder);
  second["indices"] = first["indices"];
  Sheet tiny(1);
  builder.addMesh({first});
  builder.addMesh({second});
  builder.addMesh({tiny.addTo(builder)});
  const RoundTrip trip = roundTrip(builder);
  ASSERT_EQ(trip.error, "");
  EXPECT_EQ(trip.report.notes, std::vector<std::string>{});
  EXPECT_TRUE(hasNote(trip.report, "shares accessor"));
  EXPECT_TRUE(hasNote(trip.report, "would not become smaller"));
}

}  // namespace
}  // namespace mcc::gltf::test
