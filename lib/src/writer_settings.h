// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// encode() with the settings that benchmarks and tests have besides the caller's options.
#ifndef MCC_SRC_WRITER_SETTINGS_H_
#define MCC_SRC_WRITER_SETTINGS_H_

#include <span>

#include "base/enc_features.h"

namespace mcc {

/// See encode(). What is switched off changes bytes and never what they decode to.
Status encodeWith(std::span<const PieceView> pieces, const EncodeSettings& settings,
                  EncodeResult& result);

}  // namespace mcc

#endif  // MCC_SRC_WRITER_SETTINGS_H_
