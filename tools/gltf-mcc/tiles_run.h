// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_TILES_RUN_H_
#define MCC_TOOL_TILES_RUN_H_

#include "other_programs.h"

namespace mcc::tool {

/// Compresses a tileset. Returns an exit status: kFailed when something failed, in which case
/// everything else is still made.
int runTiles(const TilesOptions& options);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TILES_RUN_H_
