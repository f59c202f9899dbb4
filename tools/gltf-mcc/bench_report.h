// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_BENCH_REPORT_H_
#define MCC_TOOL_BENCH_REPORT_H_

#if defined(MCC_HAS_FOREIGN)

#include <string>
#include <vector>

#include "bench/measure.h"
#include "mcc/gltf.h"
#include "table.h"

namespace mcc::tool {

/// Tables for people: sizes, bits per vertex of each stream, decoding, encoding, memory and vertex
/// cache, geometric means. `apart` are the categories left out of the row "all".
///
/// Per vertex is per vertex of the source as glTF counts, for all codecs; triangles per second are
/// those of the source, too.
/// mcc/best     our bytes / those of Draco's best, the smaller of its speeds 0 and 5 for that file
/// draco 0/mcc  its time / ours
/// peak         most memory in use above the final arrays, see MemoryCount
/// acmr         vertex cache misses per triangle of the decoded order, FIFO of 16
std::string benchText(const std::vector<bench::FileFigures>& files, const std::string& apart,
                      Format format);

/// One row per file and codec; bytes per stream. Cells without a figure are empty, so the columns are always the same.
std::string benchCsv(const std::vector<bench::FileFigures>& files);

/// Everything.
std::string benchJson(const std::vector<bench::FileFigures>& files, const std::string& apart);

/// "gltf-mcc 0.1.0, draco 1.5.5, …" and how this program was compiled.
std::string versionsText();

/// What is before the first '_' of a file's name when that is one letter, else "all".
std::string categoryOf(const std::string& name);

/// Bytes of each stream as tests/results/sizes.csv has them.
std::string sizesCsv(const std::vector<bench::FileFigures>& files);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_BENCH_REPORT_H_
