// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// encode() with settings that only measurements and tests have, in addition to the caller's
// options.
#ifndef MCC_WRITER_SETTINGS_H_
#define MCC_WRITER_SETTINGS_H_

#include <span>

#include "format/features.h"
#include "mcc/writer.h"

namespace mcc {

/// The caller's options, and what measurements and tests set in addition.
struct EncodeSettings : EncodeOptions {
  EncodeSettings() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): options are settings with nothing in addition.
  EncodeSettings(const EncodeOptions& options) : EncodeOptions(options) {}

  FeatureSet without;  ///< choices that the encoder does without
  /// The half-edge (3 * triangle + corner) at which the first component's collapse starts; kNone:
  /// the encoder chooses.
  uint32_t start_half_edge = kNone;
  /// When not 0, every choice is made at random among those the format allows, with this seed,
  /// instead of for the smallest result.
  uint64_t variation = 0;
};

/// Like encode(). Features that are switched off change the bytes, but never what they decode to.
Status encodeWith(std::span<const PieceView> pieces, const EncodeSettings& settings,
                  EncodeResult& result);

}  // namespace mcc

#endif  // MCC_WRITER_SETTINGS_H_
