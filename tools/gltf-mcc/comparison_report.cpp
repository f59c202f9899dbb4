// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "comparison_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/text.h"
#include "mcc/glb.h"
#include "progress_line.h"

namespace mcc::tool {
namespace {

using bench::Codec;
using bench::CodecFigures;
using bench::FileFigures;
using gltf::Json;

constexpr Codec kColumns[] = {Codec::kMcc, Codec::kDraco0, Codec::kDraco3, Codec::kDraco5};

/// One row of a comparison, before it is formatted.
struct Row {
  std::string name;
  std::string unit;
  double values[std::size(kColumns)] = {};
  bool is_known[std::size(kColumns)] = {};
  double ratio = 0;  ///< ours / Draco's best; 0: not shown
};

double bytesOf(double bits) { return bits / 8; }

/// Returns the streams of all codecs, without those that are empty everywhere.
std::vector<std::string> streamNames(const FileFigures& figures) {
  std::vector<std::string> names;
  for (const Codec codec : kColumns) {
    for (const bench::Stream& stream : figures.of(codec).streams) {
      const bool is_known = std::find(names.begin(), names.end(), stream.name) != names.end();
      if (!is_known && stream.bits != 0) names.push_back(stream.name);
    }
  }
  std::stable_sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return streamRank(a) < streamRank(b);
  });
  return names;
}

template <typename Get>
Row makeRow(const FileFigures& figures, std::string name, std::string unit, const Get& get) {
  Row row;
  row.name = std::move(name);
  row.unit = std::move(unit);
  for (size_t i = 0; i < std::size(kColumns); ++i) {
    const CodecFigures& codec = figures.of(kColumns[i]);
    row.is_known[i] = codec.ok();
    if (codec.ok()) row.values[i] = get(codec);
  }
  const Codec best = bench::bestDraco(figures);
  if (best == Codec::kMcc || !row.is_known[0]) return row;
  const double other = get(figures.of(best));
  if (other > 0) row.ratio = row.values[0] / other;
  return row;
}

std::vector<Row> streamRows(const FileFigures& figures) {
  std::vector<Row> rows;
  for (const std::string& name : streamNames(figures)) {
    rows.push_back(makeRow(figures, name, "bytes", [&](const CodecFigures& codec) {
      return bytesOf(bench::streamBits(codec.streams, name));
    }));
  }
  return rows;
}

Row totalRow(const FileFigures& figures) {
  return makeRow(figures, "all", "bytes",
                 [](const CodecFigures& codec) { return static_cast<double>(codec.bytes); });
}

std::vector<Row> otherRows(const FileFigures& figures) {
  const auto count = [](uint64_t number) { return static_cast<double>(number); };
  std::vector<Row> rows = {
      makeRow(figures, "triangles kept", "",
              [&](const CodecFigures& codec) { return count(codec.triangle_count); }),
      makeRow(figures, "vertices decoded", "",
              [&](const CodecFigures& codec) { return count(codec.vertex_count); })};
  const Row lost = makeRow(figures, "vertices lost", "",
                           [&](const CodecFigures& codec) { return count(codec.lost_wedges); });
  const bool is_any_lost = std::any_of(std::begin(lost.values), std::end(lost.values),
                                       [](double value) { return value > 0; });
  if (is_any_lost) rows.push_back(lost);
  for (Row& row : rows) row.ratio = 0;
  rows.push_back(makeRow(figures, "encode", "ms",
                         [](const CodecFigures& codec) { return 1e3 * codec.encode_seconds; }));
  rows.push_back(makeRow(figures, "decode", "ms",
                         [](const CodecFigures& codec) { return 1e3 * codec.decode_seconds; }));
  return rows;
}

std::string valueText(const Row& row, size_t column, Format format) {
  if (!row.is_known[column]) return "-";
  const double value = row.values[column];
  if (row.unit == "ms") return fmt::format("{:.3f}", value);
  if (value < 0) return fmt::format("{:.0f}", value);
  return count(static_cast<uint64_t>(value + .5), format);
}

std::string ratioText(double ratio) { return ratio == 0 ? "" : fmt::format("{:.3f}", ratio); }

void addRow(const Row& row, Format format, Table& table) {
  const bool has_unit = !row.unit.empty() && row.unit != "bytes";
  std::vector<std::string> cells = {has_unit ? row.name + ", " + row.unit : row.name};
  for (size_t i = 0; i < std::size(kColumns); ++i) cells.push_back(valueText(row, i, format));
  cells.push_back(ratioText(row.ratio));
  table.addRow(std::move(cells));
}

Table streamTable(const FileFigures& figures, Format format) {
  std::vector<std::string> header = {"bytes of"};
  for (const Codec codec : kColumns) header.push_back(bench::codecName(codec));
  header.push_back("mcc/best");
  Table table(std::move(header));
  for (const Row& row : streamRows(figures)) addRow(row, format, table);
  table.addRule();
  addRow(totalRow(figures), format, table);
  table.addRule();
  for (const Row& row : otherRows(figures)) addRow(row, format, table);
  if (!figures.has_left_out) return table;
  table.addRule();
  for (const bench::Stream& stream : figures.left_out) {
    const auto bytes = static_cast<uint64_t>(bytesOf(stream.bits) + .5);
    table.addRow({stream.name, count(bytes, format)});
  }
  table.addRow({"all with these", count(figures.full_bytes, format)});
  return table;
}

const bench::NamedError* findError(const CodecFigures& codec, const std::string& name) {
  for (const bench::NamedError& error : codec.errors) {
    if (error.name == name) return &error;
  }
  return nullptr;
}

/// Shows the errors of one Draco speed, since they do not depend on the speed.
Table errorTable(const FileFigures& figures) {
  Table table({"error of", "mcc max", "mcc median", "draco max", "draco median", "unit"}, {5});
  const CodecFigures& draco = figures.of(bench::bestDraco(figures));
  for (const bench::NamedError& ours : figures.of(Codec::kMcc).errors) {
    const bench::NamedError* other =
        &draco == &figures.of(Codec::kMcc) ? nullptr : findError(draco, ours.name);
    const auto text = [](double value) { return value == 0 ? "0" : fmt::format("{:.4g}", value); };
    table.addRow({ours.name, text(ours.maximum), text(ours.median),
                  other == nullptr ? "-" : text(other->maximum),
                  other == nullptr ? "-" : text(other->median),
                  ours.is_angle ? "degrees" : "accessor units"});
  }
  return table;
}

std::string failureText(const FileFigures& figures) {
  std::string text;
  for (const Codec codec : kColumns) {
    const CodecFigures& codec_figures = figures.of(codec);
    if (codec_figures.is_asked && !codec_figures.failure.empty()) {
      text += fmt::format("{} failed: {}\n", bench::codecName(codec), codec_figures.failure);
    }
  }
  return text;
}

Json errorsJson(const CodecFigures& codec) {
  Json errors = Json::array();
  for (const bench::NamedError& error : codec.errors) {
    errors.push_back({{"name", error.name},
                      {"unit", error.is_angle ? "degrees" : "accessor units"},
                      {"max", error.maximum},
                      {"median", error.median}});
  }
  return errors;
}

Json codecJson(const CodecFigures& codec) {
  if (!codec.ok()) return {{"failure", codec.failure}};
  return {{"bytes", codec.bytes},
          {"triangles", codec.triangle_count},
          {"vertices", codec.vertex_count},
          {"lost_vertices", codec.lost_wedges},
          {"encode_seconds", codec.encode_seconds},
          {"decode_seconds", codec.decode_seconds},
          {"errors", errorsJson(codec)}};
}

Json leftOutJson(const FileFigures& figures) {
  Json streams = Json::array();
  for (const bench::Stream& stream : figures.left_out) {
    streams.push_back({{"name", stream.name}, {"mcc", bytesOf(stream.bits)}});
  }
  return {{"bytes_with", figures.full_bytes}, {"streams", std::move(streams)}};
}

}  // namespace

int streamRank(const std::string& name) {
  static const std::vector<std::string> kFirst = {"connectivity", "stitching", "leftovers",
                                                  "seams"};
  const auto found = std::find(kFirst.begin(), kFirst.end(), name);
  if (found != kFirst.end()) return static_cast<int>(found - kFirst.begin());
  return name == "order" ? 11 : name == "header" ? 12 : 10;
}

double geometricMean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

std::string comparisonText(const FileFigures& figures, Format format) {
  std::string text = streamTable(figures, format).print(format);
  const Table errors = errorTable(figures);
  if (!errors.empty()) text += "\n" + errors.print(format);
  const std::string failures = failureText(figures);
  return failures.empty() ? text : text + "\n" + failures;
}

std::string comparisonSummary(const std::vector<FileFigures>& files, Format format) {
  if (files.size() < 2) return "";
  Table table({"file", "mcc bytes", "best draco", "bytes", "mcc/best", "mcc decode ms",
               "draco decode ms", "times as fast"},
              {2});
  std::vector<double> sizes;
  std::vector<double> speeds;
  for (const FileFigures& figures : files) {
    const Codec best = bench::bestDraco(figures);
    const CodecFigures& ours = figures.of(Codec::kMcc);
    const CodecFigures& other = figures.of(best);
    const auto ms = [](const CodecFigures& codec) {
      return fmt::format("{:.3f}", 1e3 * codec.decode_seconds);
    };
    if (best == Codec::kMcc) {
      table.addRow({figures.name, count(ours.bytes, format), "-", "-", "", ms(ours)});
      continue;
    }
    sizes.push_back(static_cast<double>(ours.bytes) / static_cast<double>(other.bytes));
    speeds.push_back(other.decode_seconds / std::max(ours.decode_seconds, 1e-9));
    table.addRow({figures.name, count(ours.bytes, format), bench::codecName(best),
                  count(other.bytes, format), ratioText(sizes.back()), ms(ours), ms(other),
                  fmt::format("{:.2f}", speeds.back())});
  }
  table.addRule();
  table.addRow({"geometric mean", "", "", "", ratioText(geometricMean(sizes)), "", "",
                fmt::format("{:.2f}", geometricMean(speeds))});
  return table.print(format);
}

std::string comparisonCsv(const std::vector<FileFigures>& files) {
  std::vector<std::string> header = {"file", "row", "unit"};
  for (const Codec codec : kColumns) header.push_back(bench::codecKey(codec));
  header.push_back("mcc_to_best");
  Table table(std::move(header));
  for (const FileFigures& figures : files) {
    std::vector<Row> rows = streamRows(figures);
    rows.push_back(totalRow(figures));
    for (Row& row : otherRows(figures)) rows.push_back(std::move(row));
    for (const Row& row : rows) {
      std::vector<std::string> cells = {figures.name, row.name, row.unit};
      for (size_t i = 0; i < std::size(kColumns); ++i) {
        cells.push_back(row.is_known[i] ? fmt::format("{}", row.values[i]) : "");
      }
      cells.push_back(ratioText(row.ratio));
      table.addRow(std::move(cells));
    }
    for (const bench::Stream& stream : figures.left_out) {
      table.addRow({figures.name, stream.name, "bytes", fmt::format("{}", bytesOf(stream.bits))});
    }
    if (figures.has_left_out) {
      table.addRow({figures.name, "all with these", "bytes", std::to_string(figures.full_bytes)});
    }
  }
  return table.print(Format::kCsv);
}

Json comparisonJson(const FileFigures& figures) {
  Json json = {{"triangles", figures.triangle_count},
               {"vertices", figures.wedge_count},
               {"positions", figures.vertex_count},
               {"primitives", figures.primitive_count}};
  const Codec best = bench::bestDraco(figures);
  if (best != Codec::kMcc) {
    json["best"] = bench::codecKey(best);
    json["ratio_to_best"] = totalRow(figures).ratio;
  }
  json["streams"] = Json::array();
  for (const Row& row : streamRows(figures)) {
    Json stream = {{"name", row.name}};
    for (size_t i = 0; i < std::size(kColumns); ++i) {
      if (row.is_known[i]) stream[bench::codecKey(kColumns[i])] = row.values[i];
    }
    if (row.ratio != 0) stream["ratio_to_best"] = row.ratio;
    json["streams"].push_back(std::move(stream));
  }
  json["codecs"] = Json::object();
  for (const Codec codec : kColumns) {
    if (figures.of(codec).is_asked)
      json["codecs"][bench::codecKey(codec)] = codecJson(figures.of(codec));
  }
  if (figures.has_left_out) json["left_out"] = leftOutJson(figures);
  json["versions"] = {{"draco", foreign::dracoVersion()}};
  json["notes"] = Json::array();
  for (const std::string& note : figures.notes) json["notes"].push_back(gltf::printable(note));
  return json;
}

gltf::Result compareWithDraco(const std::string& input, std::span<const uint8_t> file,
                              const gltf::ConvertOptions& convert,
                              const bench::PrimitiveFilter& wanted, uint32_t run_count,
                              bool is_quiet, bench::FileFigures& figures) {
  const ProgressLine line(is_quiet);
  bench::Geometry geometry;
  const gltf::Result loaded = bench::loadGeometry(input, file, convert, wanted, geometry);
  if (!loaded.ok()) return loaded;
  if (geometry.inputs.empty()) return {input, "has no triangles to compare"};
  bench::MeasureOptions options;
  options.codecs = {bench::Codec::kMcc, bench::Codec::kDraco0, bench::Codec::kDraco3,
                    bench::Codec::kDraco5};
  options.run_count = run_count;
  options.thread_count = convert.thread_count;
  options.with_errors = true;
  options.progress = [&](const std::string& text) { line.show(text); };
  const std::string name = gltf::textOf(gltf::pathOf(input).stem());
  const bench::Outcome measured = bench::measureFile(name, geometry, options, figures);
  return measured.ok() ? gltf::Result{} : gltf::Result{input, measured.message};
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
