// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// [A.4.1] [A.4.4] The stack of waiting digons against a plain list.
#include "connectivity/digon_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/mesh_generators.h"
#include "unit/failing_allocator.h"

namespace mcc::test {
namespace {

/// Pushes, pops and inserts at random; `growth` in percent of the steps that add a digon.
void compareWithList(uint64_t seed, uint32_t steps, uint32_t growth) {
  Random random(seed);
  DigonStack stack{Allocator{}};
  std::vector<uint32_t> list;
  for (uint32_t i = 0; i < steps; ++i) {
    if (list.empty() || random.below(100) < growth) {
      const uint32_t deepest = std::min(static_cast<uint32_t>(list.size()), kMaxHandleDepth);
      const uint32_t depth = random.chance(50) ? 0 : random.below(deepest + 1);
      ASSERT_TRUE(stack.insertBelow(depth, i));
      list.insert(list.end() - depth, i);
    } else {
      ASSERT_EQ(stack.top(), list.back());
      stack.pop();
      list.pop_back();
    }
    ASSERT_EQ(stack.size(), list.size());
    ASSERT_EQ(stack.empty(), list.empty());
  }
  for (; !list.empty(); list.pop_back(), stack.pop()) ASSERT_EQ(stack.top(), list.back());
  EXPECT_TRUE(stack.empty());
}

TEST(DigonStack, IsAList) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    compareWithList(seed, 20000, 50);
    compareWithList(seed, 20000, 70);
    compareWithList(seed, 3000, 100);
  }
}

TEST(DigonStack, WithoutMemory) {
  for (uint64_t allowed = 0; allowed < 12; ++allowed) {
    FailingAllocator memory(allowed);
    {
      DigonStack stack(memory.allocator());
      uint32_t count = 0;
      while (count < 5000 && stack.insertBelow(std::min(count / 2, kMaxHandleDepth), count))
        ++count;
      EXPECT_EQ(stack.size(), count);
      for (; !stack.empty(); stack.pop()) --count;
      EXPECT_EQ(count, 0u);
    }
    EXPECT_EQ(memory.liveBlocks(), 0u);
  }
}

}  // namespace
}  // namespace mcc::test
