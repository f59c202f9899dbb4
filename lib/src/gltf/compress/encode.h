// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Encodes the payloads of a plan.
#ifndef MCC_GLTF_COMPRESS_ENCODE_H_
#define MCC_GLTF_COMPRESS_ENCODE_H_

#include <cstdint>
#include <vector>

#include "gltf/compress/plan.h"
#include "gltf/document/accessors.h"
#include "mcc/glb.h"
#include "mcc/writer.h"

namespace mcc::gltf {

/// The bounds of what the reader decodes.
struct PieceBounds {
  std::vector<Bounds> attributes;
  std::vector<Bounds> parts;
};

/// A payload plan and the payload it became.
struct EncodedPayload {
  PayloadPlan plan;
  EncodeResult result;
  std::vector<PieceBounds> bounds;  ///< one for each piece, from provePayloads()
  /// An earlier payload with the same bytes, whose view it shares; kNone: there is none.
  uint32_t same_as = kNone;
  uint64_t freed_bytes = 0;
};

/// Returns the plans of payloads.
std::vector<const PayloadPlan*> plansOf(const std::vector<EncodedPayload>& payloads);

/// Encodes the planned payloads. Pieces that the codec or its readers refuse go to `left_alone`.
Result encodePayloads(const ConvertOptions& options, std::vector<PayloadPlan> plans,
                      std::vector<EncodedPayload>& payloads, std::vector<LeftAlone>& left_alone);

/// Returns the bytes of a payload that holds only one piece of a plan, or 0 when the codec refuses
/// it.
uint64_t bytesAlone(const ConvertOptions& options, const PayloadPlan& plan, const PiecePlan& piece);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_ENCODE_H_
