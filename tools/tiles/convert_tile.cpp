// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/convert_tile.h"

#include <algorithm>
#include <cmath>

#include "host/result.h"

namespace mcc::tiles {

using gltf::Result;

void TileFigures::add(const gltf::ConvertReport& report, const Accuracy& accuracy) {
  TileFigures of_model;
  of_model.promised_error = accuracy.promised_error;
  of_model.largest_promise = accuracy.promised_error;
  for (const gltf::PayloadReport& payload : report.payloads) {
    for (const gltf::AttributeReport& attribute : payload.attributes) {
      if (attribute.name != "POSITION") continue;
      TileFigures one;
      one.bits_low = attribute.bits;
      one.bits_high = attribute.bits;
      one.has_positions = true;
      // Without a promised distance the library measures each axis alone.
      const double distance = attribute.promised_distance > 0
                                  ? attribute.max_distance
                                  : attribute.max_error * std::sqrt(3.0);
      if (attribute.bits != 0) one.measured_error = distance * accuracy.scale;
      of_model.add(one);
    }
  }
  add(of_model);
}

void TileFigures::add(const TileFigures& other) {
  if (other.has_positions) {
    bits_low = has_positions ? std::min(bits_low, other.bits_low) : other.bits_low;
    bits_high = std::max(bits_high, other.bits_high);
    has_positions = true;
  }
  const double promised = other.promised_error;
  if (promised != 0 && (promised_error == 0 || promised < promised_error)) {
    promised_error = promised;
  }
  largest_promise = std::max(largest_promise, other.largest_promise);
  measured_error = std::max(measured_error, other.measured_error);
}

Result convertTile(std::span<const uint8_t> file, const AccuracyChooser& choose,
                   const gltf::ConvertOptions& options, std::vector<uint8_t>& output,
                   TileFigures& figures, std::vector<std::string>& notes) {
  output.clear();
  TileFile tile;
  MCC_GLTF_TRY(tile.read(file));
  if (tile.hasUri()) notes.push_back("its model is another file, which is only copied");
  std::vector<std::vector<uint8_t>> models(tile.models().size());
  bool is_smaller = false;
  for (size_t i = 0; i < models.size(); ++i) {
    const TileModel& model = tile.models()[i];
    const std::span<const uint8_t> glb = file.subspan(model.begin, model.end - model.begin);
    Accuracy accuracy;
    gltf::ConvertReport report;
    Result done = choose(glb, model, accuracy);
    if (done.ok()) {
      gltf::ConvertOptions of_model = options;
      accuracy.applyTo(of_model);
      done = gltf::convertGlb(glb, of_model, models[i], report);
    }
    if (!done.ok()) {
      if (model.begin == 0) return done;
      return gltf::error("the GLB at byte " + std::to_string(model.begin), done.message());
    }
    figures.add(report, accuracy);
    if (!accuracy.note.empty()) notes.push_back(accuracy.note);
    notes.insert(notes.end(), report.notes.begin(), report.notes.end());
    if (report.copied) models[i].clear();
    is_smaller = is_smaller || !report.copied;
  }
  if (!is_smaller) return {};
  MCC_GLTF_TRY(tile.rebuild(models, output));
  if (output.size() >= file.size()) output.clear();
  return {};
}

}  // namespace mcc::tiles
