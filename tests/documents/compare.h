// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// Checks that decoded documents equal their sources. Shares nothing with the library's own check.
// What came back is what went in. Nothing of the library's own check is used.
#ifndef MCC_TESTS_DOCUMENTS_COMPARE_H_
#define MCC_TESTS_DOCUMENTS_COMPARE_H_

#include <string>

#include "documents/plain_reader.h"

namespace mcc::gltf::test {

/// Compares a decoded document with its source. Geometry that was compressed is compared as
/// multisets of triangles over vertices whose values are within what `report` promised and within
/// what `options` asked for; exact values must be bit-equal, and everything else unchanged.
/// `converted` tells which primitives were compressed. Returns the first difference, or an empty
/// string.
std::string differenceOf(const PlainDocument& source, const PlainDocument& converted,
                         const PlainDocument& decoded, const RandomDocument& document,
                         const ConvertReport& report);

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_DOCUMENTS_COMPARE_H_
