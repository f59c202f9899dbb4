// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/convert_tile.h"

#include <algorithm>
#include <cmath>

#include "gltf/base/result.h"

namespace mcc::tiles {

using gltf::Result;

void TileFigures::add(const gltf::ConvertReport& report, const Accuracy& accuracy) {
  if (!accuracy.note.empty()) notes.push_back(accuracy.note);
  notes.insert(notes.end(), report.notes.begin(), report.notes.end());
  const double promised = accuracy.promised_error;
  if (promised != 0 && (promised_error == 0 || promised < promised_error)) {
    promised_error = promised;
  }
  for (const gltf::PayloadReport& payload : report.payloads) {
    for (const gltf::AttributeReport& attribute : payload.attributes) {
      if (attribute.name != "POSITION") continue;
      bits_low = has_positions ? std::min(bits_low, attribute.bits) : attribute.bits;
      bits_high = std::max(bits_high, attribute.bits);
      has_positions = true;
      if (attribute.bits == 0) continue;
      // Without a promised distance the library measures each axis alone.
      const double distance = attribute.promised_distance > 0
                                  ? attribute.max_distance
                                  : attribute.max_error * std::sqrt(3.0);
      measured_error = std::max(measured_error, distance * accuracy.scale);
    }
  }
}

Result convertTile(std::span<const uint8_t> file, const std::vector<Accuracy>& accuracies,
                   const gltf::ConvertOptions& options, std::vector<uint8_t>& output,
                   TileFigures& figures) {
  output.clear();
  TileFile tile;
  MCC_GLTF_TRY(tile.read(file));
  if (tile.hasUri()) figures.notes.push_back("its model is another file, which is only copied");
  if (tile.models().size() != accuracies.size()) {
    return gltf::error("", "the file changes while it is converted");
  }
  std::vector<std::vector<uint8_t>> models(accuracies.size());
  bool is_smaller = false;
  for (size_t i = 0; i < models.size(); ++i) {
    const TileModel& model = tile.models()[i];
    gltf::ConvertOptions of_model = options;
    accuracies[i].applyTo(of_model);
    gltf::ConvertReport report;
    Result done = gltf::convertGlb(file.subspan(model.begin, model.end - model.begin), of_model,
                                   models[i], report);
    if (!done.ok()) {
      if (model.begin == 0) return done;
      return gltf::error("the GLB at byte " + std::to_string(model.begin), done.message());
    }
    figures.add(report, accuracies[i]);
    if (report.copied) models[i].clear();
    is_smaller = is_smaller || !report.copied;
  }
  if (!is_smaller) return {};
  MCC_GLTF_TRY(tile.rebuild(models, output));
  if (output.size() >= file.size()) output.clear();
  return {};
}

}  // namespace mcc::tiles
