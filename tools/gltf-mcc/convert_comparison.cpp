// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "convert_comparison.h"

#if defined(MCC_HAS_FOREIGN)

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <set>

#include "bench/codecs.h"
#include "bench/emit_draco.h"
#include "bench/geometry.h"
#include "comparison_report.h"
#include "gltf/document/glb.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"
#include "host/text.h"
#include "interrupt.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;

/// Files with more triangles than this are compared only when the user asks for it: that takes time
/// and memory.
constexpr uint64_t kComparedTriangles = 2'000'000;
constexpr uint32_t kRuns = 3;

using Primitives = std::set<std::pair<uint32_t, uint32_t>>;

struct Compressed {
  Primitives primitives;
  uint64_t triangle_count = 0;
};

Compressed compressedOf(const gltf::ConvertReport& report) {
  Compressed compressed;
  for (const gltf::PrimitiveReport& primitive : report.primitives) {
    if (!primitive.compressed) continue;
    compressed.primitives.insert({primitive.mesh, primitive.primitive});
    compressed.triangle_count += primitive.triangle_count;
  }
  return compressed;
}

bench::PrimitiveFilter filterOf(const Primitives& primitives) {
  return [&primitives](uint32_t mesh, uint32_t primitive) {
    return primitives.count({mesh, primitive}) != 0;
  };
}

/// Returns 0 where Draco fails.
uint64_t dracoBytes(const bench::Geometry& geometry, bench::Codec codec) {
  bench::EncodedFile encoded;
  return bench::encodeFile(geometry, codec, encoded).ok() ? encoded.bytes() : 0;
}

DracoSize measureSize(const gltf::Source& input, const gltf::ConvertOptions& convert,
                      const Primitives& primitives) {
  DracoSize size;
  const gltf::Result done = gltf::guarded([&]() -> gltf::Result {
    bench::Geometry geometry;
    MCC_GLTF_TRY(bench::loadGeometry(input.path, *input.bytes, convert, filterOf(primitives),
                                     geometry, bench::OurPayloads::kLeftOut));
    size.has_left_out = geometry.has_left_out;
    auto fast = std::async(std::launch::async,
                           [&]() { return dracoBytes(geometry, bench::Codec::kDraco5); });
    const uint64_t small_bytes = dracoBytes(geometry, bench::Codec::kDraco0);
    const uint64_t fast_bytes = fast.get();
    size.bytes = small_bytes == 0 || fast_bytes == 0 ? std::max(small_bytes, fast_bytes)
                                                     : std::min(small_bytes, fast_bytes);
    return {};
  });
  return done.ok() ? size : DracoSize{};
}

/// Returns our bytes without what Draco cannot code, see bench::isLeftOut().
uint64_t comparableBytes(const gltf::ConvertReport& report) {
  double bits = 0;
  for (const gltf::PayloadReport& payload : report.payloads) {
    bits += 8 * static_cast<double>(payload.payload_bytes);
    for (const gltf::AttributeReport& attribute : payload.attributes) {
      const bool is_left_out =
          attribute.name.starts_with("target ") || attribute.component_count > 4;
      if (is_left_out) bits -= attribute.coded_bits;
    }
  }
  return static_cast<uint64_t>(bits / 8 + 0.5);
}

/// Returns "52,311 bytes …", the line about Draco.
std::string lineOf(const DracoSize& size, uint64_t ours) {
  if (size.bytes == 0) return "cannot code this geometry";
  const double ratio =
      static_cast<double>(size.bytes) / static_cast<double>(std::max<uint64_t>(ours, 1));
  const char* const without =
      size.has_left_out ? ", without what it cannot code, such as morph targets" : "";
  return fmt::format(
      "{} bytes for the same geometry at the better of speeds 0 and 5{}: {:.2f} times our {}",
      grouped(size.bytes), without, ratio, grouped(ours));
}

}  // namespace

void ConvertComparison::beginSize(const gltf::Source& input, const gltf::ConvertOptions& convert,
                                  const gltf::ConvertReport& report) {
  Compressed compressed = compressedOf(report);
  const bool is_too_large = mode.empty() && compressed.triangle_count > kComparedTriangles;
  // Draco has no way to code the triangles alone, so there would be nothing like to compare with.
  if (convert.indices_only || mode == "none" || is_too_large || compressed.primitives.empty() ||
      size_.valid())
    return;
  gltf::ConvertOptions options = convert;
  options.thread_count = 1;
  options.progress = nullptr;
  size_ =
      std::async(std::launch::async, [input, options, held = std::move(compressed.primitives)]() {
        return measureSize(input, options, held);
      });
}

void ConvertComparison::addOptions(Command& command) {
  command.addWords("--compare", mode, {"draco", "none"},
                   "Compare with Draco [draco, but not above 2M triangles]");
  command.add("--emit-draco", "OUT2", &draco_output,
              "Also write IN with Draco, speed 0, to this .glb");
}

gltf::Result ConvertComparison::begin(const gltf::Source& input, const std::string& output,
                                      const gltf::ConvertOptions& convert, bool is_shown) {
  if ((mode == "none" || !is_shown) && draco_output.empty()) return {};
  std::error_code ignored;
  if (!gltf::isGlb(*input.bytes) && fs::equivalent(input.path, output, ignored)) {
    mode = "none";  // the buffer of the input may be replaced, too
    notes += "note: not compared with Draco: the input is replaced\n";
  }
  if (draco_output.empty()) return {};
  gltf::Result result = gltf::checkWritable(draco_output);
  std::vector<std::string> left_out;
  if (result.ok()) result = bench::emitDraco(input.path, *input.bytes, convert, draco, left_out);
  for (const std::string& note : left_out)
    notes += "note: " + gltf::printable(draco_output + ": " + note) + "\n";
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
  if (size_.valid() && !report.payloads.empty()) {
    line = lineOf(size_.get(), comparableBytes(report));
  }
  const Compressed compressed = compressedOf(report);
  const bool is_seen = is_reported || !common.is_quiet;
  if (mode == "none" || !is_seen || compressed.primitives.empty()) return {};
  if (mode.empty() && compressed.triangle_count > kComparedTriangles) {
    notes += fmt::format("note: not compared with Draco above {} triangles; use --compare draco\n",
                         grouped(kComparedTriangles));
    return {};
  }
  if (!is_full) return {};
  auto size = std::async(launchPolicy(convert.thread_count), [&]() -> std::optional<WholeSize> {
    std::vector<std::string> ignored;
    const bool is_made =
        !draco.empty() || bench::emitDraco(input.path, *input.bytes, convert, draco, ignored).ok();
    if (!is_made) return std::nullopt;
    WholeSize whole = {"draco"};
    whole.add(std::exchange(draco, {}));
    return whole;
  });
  // With --format csv only one table is printed; `compare` prints the other one.
  const bool is_csv = common.format == Format::kCsv && !is_reported;
  const gltf::Result result = is_csv ? gltf::Result{} : compare(input, convert, common, report);
  draco_size = size.get();
  return result;
}

gltf::Result ConvertComparison::compare(const gltf::Source& input,
                                        const gltf::ConvertOptions& convert,
                                        const CommonOptions& common,
                                        const gltf::ConvertReport& report) {
  const Compressed compressed = compressedOf(report);
  bench::FileFigures figures;
  const gltf::Result compared =
      compareWithDraco(gltf::textOf(input.path), *input.bytes, convert,
                       filterOf(compressed.primitives), kRuns, common.is_quiet, figures);
  if (!compared.ok()) {
    notes += "note: not compared with Draco: " + gltf::printable(compared.message()) + "\n";
    return {};
  }
  json = comparisonJson(figures);
  tables = comparisonText(figures, common.format);
  const bench::Codec best = bench::bestDraco(figures);
  if (best != bench::Codec::kMcc && !convert.indices_only) {
    line = lineOf({figures.of(best).bytes, figures.has_left_out}, comparableBytes(report));
  }
  return {};
}

}  // namespace mcc::tool

#else

namespace mcc::tool {

void ConvertComparison::addOptions(Command&) {}

gltf::Result ConvertComparison::begin(const gltf::Source&, const std::string&,
                                      const gltf::ConvertOptions&, bool) {
  return {};
}

gltf::Result ConvertComparison::finish(const gltf::Source&, const gltf::ConvertOptions&,
                                       const gltf::ConvertReport&, const CommonOptions&, bool) {
  return {};
}

void ConvertComparison::beginSize(const gltf::Source&, const gltf::ConvertOptions&,
                                  const gltf::ConvertReport&) {}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
