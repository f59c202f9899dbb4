// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_WITHOUT_REPORT_H_
#define MCC_TOOL_WITHOUT_REPORT_H_

#if defined(MCC_HAS_FOREIGN)

#include <string>
#include <vector>

#include "bench/measure_without.h"
#include "table.h"

namespace mcc::tool {

/// Returns what `bench --without` prints: a row per ablation, or as CSV and JSON a row per file and
/// ablation.
///
/// growth    geometric mean over all files of the bytes without / with, as an increase in percent
/// seen in   number of files whose bytes differ
/// decode    geometric mean over those files of the time without / with, as an increase in percent
std::string withoutReport(const std::vector<bench::Ablation>& ablations,
                          const std::vector<bench::WithoutFigures>& files, Format format);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_WITHOUT_REPORT_H_
