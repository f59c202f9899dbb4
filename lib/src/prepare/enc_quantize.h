// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_PREPARE_ENC_QUANTIZE_H_
#define MCC_PREPARE_ENC_QUANTIZE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "format/features.h"
#include "mcc/reader.h"
#include "mcc/writer.h"

namespace mcc {

/// An attribute as integers, `components` per source wedge, and how the reader turns them back.
struct QuantizedAttribute {
  AttributeInfo info;
  uint32_t components = 0;
  std::vector<int32_t> values;
};

/// Chooses the coding of every attribute of a piece and converts all wedges. An attribute that the
/// requested bits would ruin is kept exact, with a line in `notes`. The values of an alias are
/// empty. `without`: see features.h.
std::vector<QuantizedAttribute> quantizeAttributes(const PieceView& piece,
                                                   const FeatureSet& without,
                                                   std::vector<std::string>& notes);

}  // namespace mcc

#endif  // MCC_PREPARE_ENC_QUANTIZE_H_
