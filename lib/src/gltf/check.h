// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The proof of a conversion: the bytes that were written are decoded and compared with the source.
// Uses nothing of the encoder but its claim which decoded vertex is which source vertex, and checks
// that.
#ifndef MCC_GLTF_CHECK_H_
#define MCC_GLTF_CHECK_H_

#include <cstdint>
#include <span>
#include <vector>

#include "gltf/compress.h"
#include "mcc/gltf.h"

namespace mcc::gltf {

struct CheckResult {
  /// Per payload: what was measured, merged where name, coding and bits are the same.
  std::vector<std::vector<AttributeReport>> attributes;
  /// Per payload: which of these each attribute of each piece went into, in the order of the plan.
  std::vector<std::vector<size_t>> rows;
  uint64_t decoded_bytes = 0;  ///< of all payloads
  double decode_seconds = 0;
};

/// Checks that `written` holds the document `source`:
/// - each compressed primitive has the source's vertices in a permuted order and the same multiset
/// of
///   triangles, up to rotation;
/// - every attribute value is within the promised distance of its source, exact ones are bit-equal;
/// - accessors, images and JSON that are not compressed geometry are equal.
/// decoders      for attributes beside payloads that another codec holds, before and after.
/// read_file     fetches the files beside the written one; null: there are none.
/// thread_count  payloads decoded at the same time.
/// Errors name the first difference.
Result checkConversion(const Document& source, const std::vector<EncodedPayload>& payloads,
                       const ForeignDecoders& decoders, std::span<const uint8_t> written,
                       const FileReader& read_file, uint32_t thread_count, CheckResult& result);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CHECK_H_
