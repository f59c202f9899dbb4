// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_COMPARISON_REPORT_H_
#define MCC_TOOL_COMPARISON_REPORT_H_

#if defined(MCC_HAS_FOREIGN)

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "table.h"

namespace mcc::tool {

/// The tables of a comparison with Draco: bytes per stream and in all, counts, times; errors.
std::string comparisonText(const bench::FileFigures& figures, Format format);

/// One row per file and the geometric mean of the ratios. Empty for a single file.
std::string comparisonSummary(const std::vector<bench::FileFigures>& files, Format format);

/// Header and rows of one CSV table for all files: file, row, unit, a column per codec, mcc/best.
std::string comparisonCsv(const std::vector<bench::FileFigures>& files);

/// The same as JSON, also "comparison" in the report of `convert`:
///   triangles, vertices, positions, primitives: of the source. `vertices` are glTF's.
///   best           "draco_0" or "draco_5", the smaller over the file; absent when Draco failed
///   ratio_to_best  our bytes / its bytes
///   streams        [{name, mcc, draco_0, draco_3, draco_5, ratio_to_best}], bytes. "connectivity"
///                  of Draco is measured alone, on the mesh welded by position; "seams" is what
///                  its triangles take more in the file. They add up to `bytes`.
///   codecs         {mcc, draco_0, draco_3, draco_5}: {failure} or {bytes, triangles, vertices,
///                  lost_vertices, encode_seconds, decode_seconds, errors: [{name, unit, max,
///                  median}]}
///     triangles, vertices  after decoding, as the codec counts
///     lost_vertices        in use by triangles of the source, by none of the decoded ones
///     encode_seconds       CPU time from accessors to payloads in memory
///     decode_seconds       from there to final float and index arrays; least of several runs in
///                          one process, both
///     errors               against the source; unit "degrees" or "accessor units"
///   left_out       when the file has what Draco cannot take (morph targets): {bytes_with, streams:
///                  [{name, mcc}]}. `codecs` are without on both sides.
///   versions       {draco}
///   notes          what was not compared, and why
nlohmann::ordered_json comparisonJson(const bench::FileFigures& figures);

/// Order of streams in tables: triangles first, attributes as they come, header last.
int streamRank(const std::string& name);

/// Geometric mean; 0 of nothing.
double geometricMean(const std::vector<double>& values);

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN

#endif  // MCC_TOOL_COMPARISON_REPORT_H_
