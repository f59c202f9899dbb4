// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Proves a conversion: the bytes that were written are decoded and compared with the source. What
// the reader has already decoded from the same bytes is not decoded again. The check takes nothing
// from the encoder except its claim which decoded vertex is which source vertex, and it verifies
// that claim.
#ifndef MCC_GLTF_CHECK_CHECK_H_
#define MCC_GLTF_CHECK_CHECK_H_

#include <cstdint>
#include <span>
#include <vector>

#include "gltf/compress/compress.h"
#include "mcc/glb.h"

namespace mcc::gltf {

struct CheckResult {
  /// Per payload: what was measured; attributes with the same name, coding and bits share a row.
  std::vector<std::vector<AttributeReport>> attributes;
  /// Per payload: the row of each attribute of each piece, in the order of the plan.
  std::vector<std::vector<size_t>> rows;
  uint64_t decoded_bytes = 0;  ///< sum over all payloads
  Contents contents;           ///< of the written document
};

/// Checks that `written` holds the document `source`:
/// - each compressed primitive has the source's vertices in a permuted order, and the same multiset
///   of triangles, up to rotation;
/// - every attribute value is within the promised distance of its source; exact ones are bit-equal;
/// - accessors, images and JSON that are not compressed geometry are equal.
/// payloads      what was encoded. Takes their decoded pieces: a payload whose bytes in `written`
///               are those that were encoded is not decoded again.
/// decoders      decodes attributes next to payloads that another codec holds, before and after.
/// read_file     fetches the files next to the written one; null: there are none.
/// thread_count  the number of payloads decoded at the same time.
/// Errors name the first difference.
Result checkConversion(const Document& source, std::vector<EncodedPayload>& payloads,
                       const ForeignDecoders& decoders, std::span<const uint8_t> written,
                       const FileReader& read_file, uint32_t thread_count, CheckResult& result);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CHECK_CHECK_H_
