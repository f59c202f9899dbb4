// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/measure_load.h"

#include <algorithm>

#include "bench/emit_draco.h"
#include "foreign/tinygltf_loader.h"
#include "mcc/files.h"

namespace mcc::bench {
namespace {

using foreign::Outcome;

void keepLeast(double seconds, double& least) {
  least = least == 0 ? seconds : std::min(least, seconds);
}

Outcome toOutcome(const gltf::Result& result) { return {result.ok() ? "" : result.message()}; }

}  // namespace

Outcome measureLoad(const std::filesystem::path& path, std::span<const uint8_t> file,
                    const gltf::ConvertOptions& options, uint32_t run_count, LoadFigures& figures) {
  std::vector<uint8_t> ours;
  gltf::ConvertReport report;
  gltf::Source source;
  source.path = path;
  source.bytes = file;
  gltf::Sink sink;
  sink.bytes = &ours;
  Outcome outcome = toOutcome(gltf::convert(source, sink, options, report));
  if (!outcome.ok()) return outcome;
  figures.payload_count = report.payloads.size();
  std::vector<std::string> notes;
  std::vector<uint8_t> draco_0;
  std::vector<uint8_t> draco_5;
  outcome = toOutcome(emitDraco(path, file, options, draco_0, notes, 0));
  if (!outcome.ok()) return outcome;
  outcome = toOutcome(emitDraco(path, file, options, draco_5, notes, 5));
  if (!outcome.ok()) return outcome;
  double ignored = 0;
  const struct {
    std::span<const uint8_t> glb;
    uint32_t thread_count;
    double& seconds;
    double& decode_seconds;
  } loads[] = {{ours, 1, figures.mcc, figures.decode_1},
               {ours, 2, ignored, figures.decode_2},
               {draco_0, 1, figures.draco_0, ignored},
               {draco_5, 1, figures.draco_5, ignored}};
  for (uint32_t run = 0; run < run_count; ++run) {
    for (const auto& load : loads) {
      // Twice, since the first pays for the memory that the one before gave back.
      for (int repeat = 0; repeat < 2; ++repeat) {
        foreign::TinygltfLoad loaded;
        outcome = foreign::loadWithTinygltf(load.glb, load.thread_count, loaded);
        if (!outcome.ok()) return outcome;
        keepLeast(loaded.cpu_seconds, load.seconds);
        keepLeast(loaded.decode_seconds, load.decode_seconds);
      }
    }
  }
  figures.is_measured = true;
  return {};
}

}  // namespace mcc::bench
