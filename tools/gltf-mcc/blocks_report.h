// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_BLOCKS_REPORT_H_
#define MCC_TOOL_BLOCKS_REPORT_H_

#if defined(MCC_HAS_FOREIGN)

#include <string>
#include <vector>

#include "bench/measure_blocks.h"
#include "table.h"

namespace mcc::tool {

/// Returns what `bench --blocks` prints: a row per file and size of blocks. Times are milliseconds
/// on the clock, with one and with two threads.
std::string blocksReport(const std::vector<bench::BlocksOfFile>& files, Format format);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_BLOCKS_REPORT_H_
