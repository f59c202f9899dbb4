// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The options that say in words how accurate attributes are.
#ifndef MCC_TOOL_PRECISION_OPTIONS_H_
#define MCC_TOOL_PRECISION_OPTIONS_H_

#include "mcc/glb.h"
#include "options.h"

namespace mcc::tool {

/// Adds --step, which takes "2^-10". The command has the options of addQuantization().
void addStep(Command& command, gltf::ConvertOptions& options);

/// Adds --quality, which takes "2048px", "1/2048", "0.0005" or nothing. The command has addStep().
void addQuality(Command& command, gltf::ConvertOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_PRECISION_OPTIONS_H_
