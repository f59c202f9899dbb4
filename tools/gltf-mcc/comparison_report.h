// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_COMPARISON_REPORT_H_
#define MCC_TOOL_COMPARISON_REPORT_H_

#if defined(MCC_HAS_FOREIGN)

#include <span>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "json/json.h"
#include "table.h"

namespace mcc::tool {

/// Measures our codec and Draco at speeds 0, 3 and 5 on a file, with errors. Errors: those of
/// loadGeometry(); there is nothing to compare; our codec failed.
gltf::Result compareWithDraco(const std::string& input, std::span<const uint8_t> file,
                              const gltf::ConvertOptions& convert,
                              const bench::PrimitiveFilter& wanted, uint32_t run_count,
                              bool is_quiet, bench::FileFigures& figures);

/// Returns the tables of a comparison with Draco: bytes per stream and in total, counts, times,
/// errors.
std::string comparisonText(const bench::FileFigures& figures, Format format);

/// Returns one row per file and the geometric mean of the ratios; empty for a single file.
std::string comparisonSummary(const std::vector<bench::FileFigures>& files, Format format);

/// Returns one CSV table for all files: file, row, unit, a column per codec, mcc/best.
std::string comparisonCsv(const std::vector<bench::FileFigures>& files);

/// Returns the comparison as JSON, which is also "comparison" in the report of `convert`:
///   triangles, vertices, positions, primitives: of the source. `vertices` are glTF's.
///   best           "draco_0" or "draco_5", the smaller for the file; absent when Draco failed
///   ratio_to_best  our bytes divided by those of the best
///   streams        [{name, mcc, draco_0, draco_3, draco_5, ratio_to_best}], bytes. Draco's
///                  "connectivity" is measured on its own, on the mesh welded by position; "seams"
///                  is what its triangles take beyond that in the file. They add up to `bytes`.
///   codecs         {mcc, draco_0, draco_3, draco_5}: {failure} or {bytes, triangles, vertices,
///                  lost_vertices, encode_seconds, decode_seconds, errors: [{name, unit, max,
///                  median}]}
///     triangles, vertices  after decoding, as the codec counts
///     lost_vertices        used by triangles of the source, but not by any decoded triangle
///     encode_seconds       CPU time from accessors to payloads in memory
///     decode_seconds       CPU time from payloads to final float and index arrays; both times are
///                          the least of several runs in one process
///     errors               against the source; unit "degrees" or "accessor units"
///   left_out       only when the file has morph targets, which Draco does not support:
///                  {bytes_with, streams: [{name, mcc}]}. `codecs` leaves them out on both sides.
///   versions       {draco}
///   notes          what was not compared, and why
gltf::Json comparisonJson(const bench::FileFigures& figures);

/// Returns the order of streams in tables: triangles first, attributes in their order, header last.
int streamRank(const std::string& name);

/// Returns the geometric mean, or 0 for no values.
double geometricMean(const std::vector<double>& values);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_COMPARISON_REPORT_H_
