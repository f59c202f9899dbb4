// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_COMPARE_COMMAND_H_
#define MCC_TOOL_COMPARE_COMMAND_H_

#if defined(MCC_HAS_FOREIGN)

#include "bench/measure.h"
#include "commands.h"

namespace mcc::tool {

/// Measures our codec and Draco at speeds 0, 3 and 5 on a file, with errors. Errors: those of
/// loadGeometry(); there is nothing to compare; our codec failed.
gltf::Result compareWithDraco(const std::string& input, std::vector<uint8_t> file,
                              const gltf::ConvertOptions& convert,
                              const bench::PrimitiveFilter& wanted, uint32_t run_count,
                              bool is_quiet, bench::FileFigures& figures);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_COMPARE_COMMAND_H_
