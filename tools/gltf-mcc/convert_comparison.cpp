// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "convert_comparison.h"

#if defined(MCC_HAS_FOREIGN)

#include <fmt/format.h>

#include <set>

#include "bench/emit_draco.h"
#include "compare_command.h"
#include "comparison_report.h"
#include "gltf/file_io.h"

namespace mcc::tool {
namespace {

/// Above this many triangles a comparison has to be asked for.
constexpr uint64_t kComparedTriangles = 2'000'000;
constexpr uint32_t kRuns = 3;

}  // namespace

void ConvertComparison::addOptions(CLI::App& command) {
  command
      .add_option("--compare", mode,
                  "Show what Draco makes of it [draco, none above 2 million triangles]")
      ->check(CLI::IsMember({"draco", "none"}).description(""))
      ->type_name("draco|none");
  command
      .add_option("--emit-draco", draco_output,
                  "Write IN with KHR_draco_mesh_compression, speed 0, to this .glb too")
      ->type_name("OUT2");
}

gltf::Result ConvertComparison::begin(const std::string& input,
                                      const gltf::ConvertOptions& convert) {
  if (mode == "none" && draco_output.empty()) return {};
  gltf::Result result = gltf::readFile(input, source);
  if (!result.ok() || draco_output.empty()) return result;
  result = gltf::ReplacementFile(draco_output).check();
  std::vector<std::string> notes;
  if (result.ok()) result = bench::emitDraco(input, source, convert, draco, notes);
  for (const std::string& note : notes) text += "note: " + draco_output + ": " + note + "\n";
  return result;
}

gltf::Result ConvertComparison::finish(const std::string& input,
                                       const gltf::ConvertOptions& convert,
                                       const gltf::ConvertReport& report,
                                       const CommonOptions& common, bool is_reported) {
  if (!draco_output.empty()) {
    gltf::Result written = writeBytes(draco_output, draco);
    if (!written.ok()) return written;
  }
  std::set<std::pair<uint32_t, uint32_t>> compressed;
  uint64_t triangle_count = 0;
  for (const gltf::PrimitiveReport& primitive : report.primitives) {
    if (!primitive.compressed) continue;
    compressed.insert({primitive.mesh, primitive.primitive});
    triangle_count += primitive.triangle_count;
  }
  // CSV is one table, and `compare` prints the other.
  const bool is_seen = is_reported || (!common.is_quiet && common.format != Format::kCsv);
  if (mode == "none" || !is_seen || compressed.empty()) return {};
  if (mode.empty() && triangle_count > kComparedTriangles) {
    text += fmt::format("note: not compared with Draco above {} triangles; --compare draco does\n",
                        grouped(kComparedTriangles));
    return {};
  }
  const auto is_compressed = [&](uint32_t mesh, uint32_t primitive) {
    return compressed.count({mesh, primitive}) != 0;
  };
  bench::FileFigures figures;
  const gltf::Result compared = compareWithDraco(input, std::move(source), convert, is_compressed,
                                                 kRuns, common.is_quiet, figures);
  if (!compared.ok()) {
    text += "note: not compared with Draco: " + compared.message() + "\n";
    return {};
  }
  json = comparisonJson(figures);
  text += comparisonText(figures, common.format);
  return {};
}

}  // namespace mcc::tool

#else

namespace mcc::tool {

void ConvertComparison::addOptions(CLI::App&) {}

gltf::Result ConvertComparison::begin(const std::string&, const gltf::ConvertOptions&) {
  return {};
}

gltf::Result ConvertComparison::finish(const std::string&, const gltf::ConvertOptions&,
                                       const gltf::ConvertReport&, const CommonOptions&, bool) {
  return {};
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
