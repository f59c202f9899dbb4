// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// encode() with settings that only benchmarks and tests have, in addition to the caller's options.
#ifndef MCC_WRITER_SETTINGS_H_
#define MCC_WRITER_SETTINGS_H_

#include <span>

#include "format/enc_features.h"

namespace mcc {

/// Like encode(). Features that are switched off change the bytes, but never what they decode to.
Status encodeWith(std::span<const PieceView> pieces, const EncodeSettings& settings,
                  EncodeResult& result);

}  // namespace mcc

#endif  // MCC_WRITER_SETTINGS_H_
