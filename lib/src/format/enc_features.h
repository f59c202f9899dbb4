// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the writer's stages are told besides the caller's options.
#ifndef MCC_FORMAT_ENC_FEATURES_H_
#define MCC_FORMAT_ENC_FEATURES_H_

#include "format/features.h"
#include "mcc/writer.h"

namespace mcc {

/// The settings of the writer: the caller's options, and the features that measurements and tests
/// switch off.
struct EncodeSettings : EncodeOptions {
  FeatureSet without;
};

}  // namespace mcc

#endif  // MCC_FORMAT_ENC_FEATURES_H_
