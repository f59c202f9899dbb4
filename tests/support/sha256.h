// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TESTS_SUPPORT_SHA256_H_
#define MCC_TESTS_SUPPORT_SHA256_H_

#include <cstdint>
#include <span>
#include <string>

namespace mcc::test {

/// SHA-256 (FIPS 180-4) of the bytes, as 64 hexadecimal digits in lower case.
std::string sha256(std::span<const uint8_t> bytes);

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_SHA256_H_
