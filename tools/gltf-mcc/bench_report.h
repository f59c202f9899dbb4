// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_BENCH_REPORT_H_
#define MCC_TOOL_BENCH_REPORT_H_

#if defined(MCC_HAS_FOREIGN)

#include <string>
#include <vector>

#include "bench/measure.h"
#include "mcc/result.h"
#include "table.h"

namespace mcc::tool {

/// Tables for people: sizes, bits per vertex of each stream, decoding, encoding, memory and vertex
/// cache, geometric means. The categories in `apart` are left out of the row "all".
///
/// "Per vertex" refers to the vertices of the source as glTF counts them, for all codecs, and
/// triangles per second to the triangles of the source.
/// mcc/best     our bytes divided by those of the smaller of Draco's speeds 0 and 5 for that file
/// draco 0/mcc  its time divided by ours
/// peak         the most memory in use beyond the final arrays, see MemoryCount
/// acmr         vertex cache misses per triangle of the decoded order, for a FIFO of 16
std::string benchText(const std::vector<bench::FileFigures>& files, const std::string& apart,
                      Format format);

/// One row per file and codec, with bytes per stream. Cells without a figure are empty, so that the
/// columns are always the same.
std::string benchCsv(const std::vector<bench::FileFigures>& files);

/// All figures as JSON.
std::string benchJson(const std::vector<bench::FileFigures>& files, const std::string& apart);

/// Returns the versions, "gltf-mcc 0.1.0, draco 1.5.5, …", and how this program was compiled.
std::string versionsText();

/// Returns what comes before the first '_' of a file's name if that is one letter, else "all".
std::string categoryOf(const std::string& name);

/// Returns the bytes of each stream in the format of tests/results/sizes.csv.
std::string sizesCsv(const std::vector<bench::FileFigures>& files);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_BENCH_REPORT_H_
