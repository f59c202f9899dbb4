// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "positions/isometry.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

using Place = std::array<uint32_t, 3>;
Place placeOf(const Lanes<uint32_t>& q) { return {q[0], q[1], q[2]}; }

/// Also with coordinates whose images wrap.
TEST(Isometries, LeadAndComeBack) {
  Random random(1);
  for (Turn turn = 0; turn < kTurnCount; ++turn) {
    Isometry isometry(turn);
    const auto any = [&] {
      const auto x = [&] { return static_cast<uint32_t>(random.next()); };
      return Lanes<uint32_t>{x(), x(), x(), 0};
    };
    const Lanes<uint32_t> from = any();
    const Lanes<uint32_t> to = any();
    isometry.lead(from, to);
    EXPECT_EQ(placeOf(isometry(from)), placeOf(to));
    const Lanes<uint32_t> q = any();
    EXPECT_EQ(placeOf(isometry.source(isometry(q))), placeOf(q));
    EXPECT_EQ(placeOf(isometry(isometry.source(q))), placeOf(q));
  }
}

TEST(Isometries, TurnsAreAllThatThereAre) {
  std::set<Place> images;
  for (Turn turn = 0; turn < kTurnCount; ++turn)
    images.insert(placeOf(Isometry(turn)(Lanes<uint32_t>{1, 2, 3, 0})));
  EXPECT_EQ(images.size(), size_t{kTurnCount});
  EXPECT_EQ(placeOf(Isometry(0)(Lanes<uint32_t>{1, 2, 3, 0})), (Place{1, 2, 3}));
  // The axes change their places first.
  EXPECT_EQ(placeOf(Isometry(8 * 3 + 1)(Lanes<uint32_t>{1, 2, 3, 0})), (Place{~0u - 1, 3, 1}));
}

}  // namespace
}  // namespace mcc::test
