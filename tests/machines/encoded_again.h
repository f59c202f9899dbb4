// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The contents of a decoded payload as what the writer takes.
#ifndef MCC_MACHINES_ENCODED_AGAIN_H_
#define MCC_MACHINES_ENCODED_AGAIN_H_

#include <vector>

#include "decoded_payload.h"
#include "mcc/writer.h"

namespace mcc::machines {

/// Views of the arrays of a payload, which must outlive this.
class PieceViews {
 public:
  /// `bits` of every attribute, 0 for exact values.
  PieceViews(const DecodedPayload& decoded, uint8_t bits) {
    const auto pieces = decoded.payload.info().pieces;
    attributes_.resize(pieces.size());
    parts_.resize(pieces.size());
    for (size_t p = 0; p < pieces.size(); ++p) {
      for (size_t a = 0; a < decoded.values[p].size(); ++a) {
        AttributeView view;
        view.format = pieces[p].attributes[a].format;
        view.data = decoded.values[p][a].data();
        view.stride_bytes = elementBytes(view.format);
        view.quantization_bits = bits;
        attributes_[p].push_back(view);
      }
      for (const auto& indices : decoded.indices[p]) parts_[p].push_back({indices});
      views_.push_back({pieces[p].wedge_count, attributes_[p], parts_[p]});
    }
  }
  PieceViews(const PieceViews&) = delete;
  PieceViews& operator=(const PieceViews&) = delete;

  const std::vector<PieceView>& views() const { return views_; }

 private:
  std::vector<std::vector<AttributeView>> attributes_;
  std::vector<std::vector<PartView>> parts_;
  std::vector<PieceView> views_;
};

}  // namespace mcc::machines

#endif  // MCC_MACHINES_ENCODED_AGAIN_H_
