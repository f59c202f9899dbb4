// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TESTS_UNIT_CONTAINER_PARSE_WITHOUT_MEMORY_H_
#define MCC_TESTS_UNIT_CONTAINER_PARSE_WITHOUT_MEMORY_H_

#include <gtest/gtest.h>

#include <span>

#include "container/payload_header.h"
#include "unit/failing_allocator.h"

namespace mcc::test {

/// Parses a payload with memory that ends after 0, 1, 2, … allocations until that succeeds.
inline void expectParsesOrRunsOutOfMemory(std::span<const uint8_t> payload) {
  for (uint64_t allocations = 0;; ++allocations) {
    FailingAllocator memory(allocations);
    Error error = Error::kOk;
    {
      PayloadHeader parsed(memory.allocator());
      error = parsePayload(payload, {}, parsed).error;
    }
    EXPECT_EQ(memory.liveBlocks(), 0u);
    EXPECT_TRUE(memory.booksBalance());
    if (error == Error::kOk) break;
    ASSERT_EQ(error, Error::kOutOfMemory);
    ASSERT_LT(allocations, 1000u);
  }
}

}  // namespace mcc::test

#endif  // MCC_TESTS_UNIT_CONTAINER_PARSE_WITHOUT_MEMORY_H_
