// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "convert_report.h"
#include "host/text.h"
#include "json/json.h"

namespace mcc::tool {
namespace {

using gltf::Json;

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
    figures.add(file.figures);
  }
};

struct Sums {
  std::vector<LevelSum> levels;
  LevelSum others;
  LevelSum all;
};

Sums sumsOf(const TilesRunResult& result) {
  Sums sums;
  const std::vector<uint64_t>& tile_counts = result.walk.levelTiles();
  sums.levels.resize(tile_counts.size());
  for (size_t i = 0; i < tile_counts.size(); ++i) {
    sums.levels[i].tile_count = tile_counts[i];
    sums.all.tile_count += tile_counts[i];
  }
  for (uint32_t i = 0; i < result.files.size(); ++i) {
    const TilesFile& file = result.files[i];
    if (file.outcome == TilesOutcome::kNotMade) continue;
    sums.all.add(file);
    const tiles::TileDemand* demand = result.walk.demandOf(i);
    (demand == nullptr ? sums.others : sums.levels[demand->level]).add(file);
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

/// The models of a level may have several promises; the largest error is below the largest.
std::string promiseText(const tiles::TileFigures& figures) {
  const std::string low = errorText(figures.promised_error);
  const std::string high = errorText(figures.largest_promise);
  return low == high ? low : low + "-" + high;
}

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
          promiseText(sum.figures),
          errorText(sum.figures.measured_error)};
}

/// Returns the notes of all files, each text once with the number of files that it is about.
std::vector<std::string> notesOf(const TilesRunResult& result) {
  std::vector<std::string> notes = result.notes;
  for (const auto& [text, files] : result.file_notes) {
    const std::string first(result.table.name(*std::min_element(files.begin(), files.end())));
    notes.push_back(files.size() == 1 ? first + ": " + text
                                      : fmt::format("{} and {} more: {}", first,
                                                    grouped(files.size() - 1), text));
  }
  return notes;
}

Json figuresJson(const tiles::TileFigures& figures) {
  Json json = Json::object();
  if (figures.has_positions) {
    json["position_bits"] = {figures.bits_low, figures.bits_high};
    json["largest_error"] = figures.measured_error;
  }
  if (figures.promised_error != 0) {
    json["promised_error"] = figures.promised_error;
    json["largest_promised_error"] = figures.largest_promise;
  }
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

Json fileJson(const TilesRunResult& result, uint32_t number) {
  static constexpr const char* kOutcomes[] = {"converted", "copied", "failed"};
  const TilesFile& file = result.files[number];
  Json json = {{"file", result.table.name(number)},
               {"outcome", kOutcomes[static_cast<size_t>(file.outcome)]}};
  json["up_to_date"] = file.is_up_to_date;
  if (const tiles::TileDemand* demand = result.walk.demandOf(number)) {
    json["level"] = demand->level;
  }
  json["input_bytes"] = file.input_bytes;
  json["output_bytes"] = file.output_bytes;
  json.update(figuresJson(file.figures));
  const auto failure = result.failures.find(number);
  if (failure != result.failures.end()) {
    json["message"] = gltf::printable(failure->second.message());
  }
  return json;
}

/// Prints JSON in one line; names of files may be any bytes.
std::string lineOf(const Json& json) { return json.dump(-1, true); }

/// Returns a line of JSON for each file, with its notes.
std::string fileLines(const TilesRunResult& result) {
  std::vector<std::pair<uint32_t, const std::string*>> notes;
  for (const auto& [text, files] : result.file_notes) {
    for (const uint32_t file : files) notes.emplace_back(file, &text);
  }
  std::stable_sort(notes.begin(), notes.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string lines;
  size_t next = 0;
  for (uint32_t i = 0; i < result.files.size(); ++i) {
    if (result.files[i].outcome == TilesOutcome::kNotMade) continue;
    Json json = fileJson(result, i);
    for (; next < notes.size() && notes[next].first <= i; ++next) {
      if (notes[next].first == i) json["notes"].push_back(*notes[next].second);
    }
    lines += (lines.empty() ? "\n    " : ",\n    ") + lineOf(json);
  }
  return lines + "\n  ";
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
  all.figures.largest_promise = 0;
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

std::string tilesReportJson(const TilesRunResult& result) {
  const Sums sums = sumsOf(result);
  Json levels = Json::array();
  for (size_t i = 0; i < sums.levels.size(); ++i) {
    Json level = {{"level", i}};
    level.update(sumJson(sums.levels[i]));
    levels.push_back(std::move(level));
  }
  Json failures = Json::array();
  for (const gltf::Result& failure : result.walk.failures()) {
    failures.push_back(gltf::printable(failure.message()));
  }
  Json all = sumJson(sums.all);
  all.erase("promised_error");  // they are those of different levels
  all.erase("largest_promised_error");
  all.erase("largest_error");
  const Json json = {{"tool", std::string("gltf-mcc ") + MCC_VERSION},
                     {"input", result.input},
                     {"output", result.output},
                     {"part", result.part},
                     {"options", result.settings},
                     {"levels", std::move(levels)},
                     {"other_files", sumJson(sums.others)},
                     {"all", std::move(all)},
                     {"failures", std::move(failures)},
                     {"notes", result.notes}};
  // The list of the files, which may be millions, is never a tree of JSON.
  std::string text = printReport(json);
  const size_t end = text.rfind("\n}");
  return text.substr(0, end) + ",\n  \"files\": [" + fileLines(result) + "]\n}\n";
}

}  // namespace mcc::tool
