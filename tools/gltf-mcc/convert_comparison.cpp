// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "convert_comparison.h"

#if defined(MCC_HAS_FOREIGN)

#include <fmt/format.h>

#include <future>
#include <set>

#include "bench/emit_draco.h"
#include "compare_command.h"
#include "comparison_report.h"
#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "gltf/document/glb.h"
#include "gltf/files/file_io.h"
#include "interrupt.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;

/// Files with more triangles than this are compared only when the user asks for it.
constexpr uint64_t kComparedTriangles = 2'000'000;
constexpr uint32_t kRuns = 3;

}  // namespace

void ConvertComparison::addOptions(CLI::App& command) {
  command.add_option("--compare", mode, "Compare with Draco [draco, but none above 2M triangles]")
      ->check(CLI::IsMember({"draco", "none"}).description(""))
      ->type_name("draco|none");
  command
      .add_option("--emit-draco", draco_output, "Also write IN with Draco, speed 0, to this .glb")
      ->type_name("OUT2");
}

gltf::Result ConvertComparison::begin(const gltf::Source& input, const std::string& output,
                                      const gltf::ConvertOptions& convert) {
  if (mode == "none" && draco_output.empty()) return {};
  gltf::Result result;
  if (input.bytes) {
    source.assign(input.bytes->begin(), input.bytes->end());
  } else {
    result = gltf::readFile(input.path, source);
  }
  std::error_code ignored;
  if (result.ok() && !gltf::isGlb(source) && fs::equivalent(input.path, output, ignored)) {
    mode = "none";  // the buffer of the input may be replaced, too
    text += "note: not compared with Draco: the input is replaced\n";
  }
  if (!result.ok() || draco_output.empty()) return result;
  result = gltf::checkWritable(draco_output);
  std::vector<std::string> notes;
  if (result.ok()) result = bench::emitDraco(input.path, source, convert, draco, notes);
  for (const std::string& note : notes)
    text += "note: " + gltf::printable(draco_output + ": " + note) + "\n";
  return result;
}

gltf::Result ConvertComparison::finish(const gltf::Source& input,
                                       const gltf::ConvertOptions& convert,
                                       const gltf::ConvertReport& report,
                                       const CommonOptions& common, bool is_reported) {
  if (!draco_output.empty()) {
    gltf::Result written = gltf::writeFile(draco_output, draco, &temporaryFiles());
    if (!written.ok()) return written;
  }
  std::set<std::pair<uint32_t, uint32_t>> compressed;
  uint64_t triangle_count = 0;
  for (const gltf::PrimitiveReport& primitive : report.primitives) {
    if (!primitive.compressed) continue;
    compressed.insert({primitive.mesh, primitive.primitive});
    triangle_count += primitive.triangle_count;
  }
  const bool is_seen = is_reported || !common.is_quiet;
  if (mode == "none" || !is_seen || compressed.empty()) return {};
  if (mode.empty() && triangle_count > kComparedTriangles) {
    text += fmt::format("note: not compared with Draco above {} triangles; use --compare draco\n",
                        grouped(kComparedTriangles));
    return {};
  }
  auto size = std::async(launchPolicy(convert.thread_count), [&]() -> std::optional<WholeSize> {
    std::vector<std::string> ignored;
    const bool is_made =
        !draco.empty() || bench::emitDraco(input.path, source, convert, draco, ignored).ok();
    if (!is_made) return std::nullopt;
    return measureWhole("draco", {std::move(draco)});
  });
  // With --format csv only one table is printed; `compare` prints the other one.
  const bool is_csv = common.format == Format::kCsv && !is_reported;
  const gltf::Result result = is_csv ? gltf::Result{} : compare(input, convert, common, compressed);
  draco_size = size.get();
  return result;
}

gltf::Result ConvertComparison::compare(const gltf::Source& input,
                                        const gltf::ConvertOptions& convert,
                                        const CommonOptions& common,
                                        const std::set<std::pair<uint32_t, uint32_t>>& compressed) {
  const auto is_compressed = [&](uint32_t mesh, uint32_t primitive) {
    return compressed.count({mesh, primitive}) != 0;
  };
  bench::FileFigures figures;
  const gltf::Result compared = compareWithDraco(gltf::textOf(input.path), source, convert,
                                                 is_compressed, kRuns, common.is_quiet, figures);
  if (!compared.ok()) {
    text += "note: not compared with Draco: " + gltf::printable(compared.message()) + "\n";
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

gltf::Result ConvertComparison::begin(const gltf::Source&, const std::string&,
                                      const gltf::ConvertOptions&) {
  return {};
}

gltf::Result ConvertComparison::finish(const gltf::Source&, const gltf::ConvertOptions&,
                                       const gltf::ConvertReport&, const CommonOptions&, bool) {
  return {};
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
