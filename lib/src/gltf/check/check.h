// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks the file that a conversion wrote: it has the payloads that were proved, each primitive
// reads what belongs to it, and everything else is as in the source.
#ifndef MCC_GLTF_CHECK_CHECK_H_
#define MCC_GLTF_CHECK_CHECK_H_

#include <cstdint>
#include <span>

#include "gltf/compress/compress.h"
#include "mcc/glb.h"

namespace mcc::gltf {

struct CheckResult {
  uint64_t decoded_bytes = 0;  ///< sum over all payloads
  Contents contents;           ///< of the written document
};

/// Checks that `written` holds the document `source`:
/// - the bytes of each payload are those that provePayloads() has decoded and compared;
/// - each compressed primitive names its payload, piece, part and attributes, and the counts, types
///   and bounds of its accessors are those of the payload; others are not compressed, or were so in
///   the source and have the same bytes;
/// - elements next to payloads that moved with the vertices belong to the same ones;
/// - accessors, images and JSON that are not compressed geometry are equal;
/// - a fallback holds what the payloads do;
/// - the previews are those of `compressed`, and their bytes those that were proved.
/// compressed    what became of the source. Its JSON and layout are not read.
/// decoders      decodes attributes next to payloads that another codec holds, before and after.
/// read_file     fetches the files next to the written one; null: there are none.
/// thread_count  the number of payloads decoded at the same time.
/// Errors name the first difference.
Result checkConversion(const Document& source, const Compressed& compressed,
                       const ForeignDecoders& decoders, std::span<const uint8_t> written,
                       const FileReader& read_file, uint32_t thread_count, CheckResult& result);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CHECK_CHECK_H_
