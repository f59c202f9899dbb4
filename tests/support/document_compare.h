// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks that decoded documents equal their sources. Shares nothing with the library's own check.
#ifndef MCC_TESTS_SUPPORT_DOCUMENT_COMPARE_H_
#define MCC_TESTS_SUPPORT_DOCUMENT_COMPARE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "mcc/glb.h"
#include "support/plain_reader.h"

namespace mcc::gltf::test {

/// Buffer views and accessors that keep their numbers and bytes.
struct KeptNumbers {
  std::vector<uint32_t> views;
  std::vector<uint32_t> accessors;
};

/// Compares a decoded document with its source. Geometry that was compressed is compared as
/// multisets of triangles over vertices whose values are within what `report` promised and within
/// what `options` asked for; exact values must be bit-equal, and everything else unchanged.
/// `converted` tells which primitives were compressed. Returns the first difference, or an empty
/// string.
std::string differenceOf(const PlainDocument& source, const PlainDocument& converted,
                         const PlainDocument& decoded, const ConvertOptions& options,
                         const KeptNumbers& kept, const ConvertReport& report);

/// Compares the primitives of two GLBs: triangles as multisets over vertices with bit-equal
/// attributes or, with `keeps_order`, both in their order; of points and lines every element.
/// Returns the first difference, or an empty string.
std::string differenceOfPrimitives(const Bytes& source, const Bytes& decoded, bool keeps_order);

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_SUPPORT_DOCUMENT_COMPARE_H_
