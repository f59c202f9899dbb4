// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "convert_report.h"
#include "gltf/base/printable.h"

namespace mcc::tool {
namespace {

using Json = nlohmann::ordered_json;

/// Sums over the files of a level. A file that tiles of several levels show counts for the first.
struct LevelSum {
  uint64_t tile_count = 0;
  uint64_t file_count = 0;
  uint64_t input_bytes = 0;
  uint64_t output_bytes = 0;
  tiles::TileFigures figures;

  void add(const TilesFile& file) {
    ++file_count;
    input_bytes += file.input_bytes;
    output_bytes += file.output_bytes;
    const tiles::TileFigures& of_file = file.figures;
    if (of_file.has_positions) {
      figures.bits_low =
          figures.has_positions ? std::min(figures.bits_low, of_file.bits_low) : of_file.bits_low;
      figures.bits_high = std::max(figures.bits_high, of_file.bits_high);
      figures.has_positions = true;
    }
    const double promised = of_file.promised_error;
    if (promised != 0 && (figures.promised_error == 0 || promised < figures.promised_error)) {
      figures.promised_error = promised;
    }
    figures.measured_error = std::max(figures.measured_error, of_file.measured_error);
  }
};

struct Sums {
  std::vector<LevelSum> levels;
  LevelSum others;
  LevelSum all;
};

Sums sumsOf(const TilesRunResult& result) {
  Sums sums;
  const std::vector<uint64_t>& tile_counts = result.tileset.level_tiles;
  sums.levels.resize(tile_counts.size());
  for (size_t i = 0; i < tile_counts.size(); ++i) {
    sums.levels[i].tile_count = tile_counts[i];
    sums.all.tile_count += tile_counts[i];
  }
  for (const TilesFile& file : result.files) {
    sums.all.add(file);
    if (file.content == kNone) {
      sums.others.add(file);
    } else {
      sums.levels[result.tileset.contents[file.content].uses[0].level].add(file);
    }
  }
  return sums;
}

std::string bitsText(const tiles::TileFigures& figures) {
  if (!figures.has_positions) return "";
  if (figures.bits_high == 0) return "exact";
  const std::string low = figures.bits_low == 0 ? "exact" : std::to_string(figures.bits_low);
  return figures.bits_low == figures.bits_high ? low : fmt::format("{}-{}", low, figures.bits_high);
}

std::string errorText(double error) { return error == 0 ? "" : fmt::format("{:.3g}", error); }

std::vector<std::string> cellsOf(const std::string& name, const LevelSum& sum, Format format) {
  const double ratio = sum.output_bytes == 0 ? 0
                                             : static_cast<double>(sum.input_bytes) /
                                                   static_cast<double>(sum.output_bytes);
  return {name,
          sum.tile_count == 0 ? "" : count(sum.tile_count, format),
          count(sum.file_count, format),
          count(sum.input_bytes, format),
          count(sum.output_bytes, format),
          ratio == 0 ? "" : fmt::format("{:.2f}", ratio),
          bitsText(sum.figures),
          errorText(sum.figures.promised_error),
          errorText(sum.figures.measured_error)};
}

/// Returns the notes of all files, each text once with the number of files that it is about.
std::vector<std::string> notesOf(const TilesRunResult& result) {
  struct Files {
    std::string first;
    uint64_t count = 0;
  };
  std::map<std::string, Files> by_text;
  for (const TilesFile& file : result.files) {
    for (const std::string& note : file.figures.notes) {
      Files& files = by_text[note];
      if (files.count++ == 0) files.first = file.path;
    }
  }
  std::vector<std::string> notes = result.notes;
  for (const auto& [text, files] : by_text) {
    notes.push_back(files.count == 1 ? files.first + ": " + text
                                     : fmt::format("{} and {} more: {}", files.first,
                                                   grouped(files.count - 1), text));
  }
  return notes;
}

Json figuresJson(const tiles::TileFigures& figures) {
  Json json = Json::object();
  if (figures.has_positions) {
    json["position_bits"] = {figures.bits_low, figures.bits_high};
    json["largest_error"] = figures.measured_error;
  }
  if (figures.promised_error != 0) json["promised_error"] = figures.promised_error;
  return json;
}

Json sumJson(const LevelSum& sum) {
  Json json = {{"tiles", sum.tile_count},
               {"files", sum.file_count},
               {"input_bytes", sum.input_bytes},
               {"output_bytes", sum.output_bytes}};
  json.update(figuresJson(sum.figures));
  return json;
}

Json fileJson(const TilesRunResult& result, const TilesFile& file) {
  static constexpr const char* kOutcomes[] = {"converted", "copied", "failed"};
  Json json = {{"file", file.path}, {"outcome", kOutcomes[static_cast<size_t>(file.outcome)]}};
  json["up_to_date"] = file.is_up_to_date;
  if (file.content != kNone) {
    json["level"] = result.tileset.contents[file.content].uses[0].level;
  }
  json["input_bytes"] = file.input_bytes;
  json["output_bytes"] = file.output_bytes;
  json.update(figuresJson(file.figures));
  if (!file.figures.notes.empty()) json["notes"] = file.figures.notes;
  if (!file.failure.ok()) json["message"] = gltf::printable(file.failure.message());
  return json;
}

}  // namespace

std::string tilesReportText(const TilesRunResult& result, const CommonOptions& options) {
  const Sums sums = sumsOf(result);
  const Format format = options.format;
  Table table({"level", "tiles", "files", "bytes in", "bytes out", "ratio", "bits",
               "promised error", "largest error"});
  for (size_t i = 0; i < sums.levels.size(); ++i) {
    table.addRow(cellsOf(std::to_string(i), sums.levels[i], format));
  }
  if (sums.others.file_count != 0) table.addRow(cellsOf("other files", sums.others, format));
  table.addRule();
  // The finest promise of one level next to the largest error of another would look broken.
  LevelSum all = sums.all;
  all.figures.promised_error = 0;
  all.figures.measured_error = 0;
  table.addRow(cellsOf("all", all, format));
  std::string text = table.print(format);
  if (format == Format::kCsv) return text;
  constexpr size_t kShownNotes = 12;
  const std::vector<std::string> notes = notesOf(result);
  const size_t shown = options.is_verbose ? notes.size() : std::min(notes.size(), kShownNotes);
  if (shown != 0) text += "\n";
  for (size_t i = 0; i < shown; ++i) text += "note: " + gltf::printable(notes[i]) + "\n";
  if (shown < notes.size()) {
    text += fmt::format("and {} more notes; -v or --report shows them\n", notes.size() - shown);
  }
  return text;
}

Json tilesReportJson(const TilesRunResult& result) {
  const Sums sums = sumsOf(result);
  Json levels = Json::array();
  for (size_t i = 0; i < sums.levels.size(); ++i) {
    Json level = {{"level", i}};
    level.update(sumJson(sums.levels[i]));
    levels.push_back(std::move(level));
  }
  Json files = Json::array();
  for (const TilesFile& file : result.files) files.push_back(fileJson(result, file));
  Json failures = Json::array();
  for (const gltf::Result& failure : result.tileset.failures) {
    failures.push_back(gltf::printable(failure.message()));
  }
  Json all = sumJson(sums.all);
  all.erase("promised_error");  // they are those of different levels
  all.erase("largest_error");
  return {{"tool", std::string("gltf-mcc ") + MCC_VERSION},
          {"input", result.input},
          {"output", result.output},
          {"options", result.settings},
          {"levels", std::move(levels)},
          {"other_files", sumJson(sums.others)},
          {"all", std::move(all)},
          {"files", std::move(files)},
          {"failures", std::move(failures)},
          {"notes", result.notes}};
}

}  // namespace mcc::tool
