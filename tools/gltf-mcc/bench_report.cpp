// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "comparison_report.h"
#include "host/text.h"
#include "report_file.h"

namespace mcc::tool {
namespace {

using bench::Codec;
using bench::CodecFigures;
using bench::FileFigures;
using gltf::Json;

/// Means of times are taken over files with at least this many triangles.
constexpr uint64_t kTimedTriangles = 5000;

/// Streams that share a column in the tables.
struct StreamGroup {
  const char* name;
  std::vector<std::string> prefixes;
};
const std::vector<StreamGroup>& streamGroups() {
  static const std::vector<StreamGroup> kGroups = {
      {"connectivity", {"connectivity", "stitching", "leftovers"}},
      {"seams", {"seams"}},
      {"positions", {"POSITION"}},
      {"normals", {"NORMAL"}},
      {"tangents", {"TANGENT"}},
      {"texcoords", {"TEXCOORD_"}},
      {"colors", {"COLOR_"}},
      {"skin", {"JOINTS_", "WEIGHTS_"}},
      {"custom", {"_"}},
      {"order", {"order"}},
      {"header", {"header"}},
      {"zstd", {"zstd"}}};
  return kGroups;
}

double groupBits(const CodecFigures& codec, const StreamGroup& group) {
  double bits = 0;
  for (const bench::Stream& stream : codec.streams) {
    for (const std::string& prefix : group.prefixes) {
      if (stream.name.starts_with(prefix)) bits += stream.bits;
    }
  }
  return bits;
}

double perVertex(const FileFigures& figures, double value) {
  return figures.wedge_count == 0 ? 0 : value / static_cast<double>(figures.wedge_count);
}

double nanoseconds(const FileFigures& figures, double seconds) {
  return perVertex(figures, 1e9 * seconds);
}

/// Returns million triangles of the source per second.
double megaTriangles(const FileFigures& figures, double seconds) {
  return seconds <= 0 ? 0 : 1e-6 * static_cast<double>(figures.triangle_count) / seconds;
}

double bytesOf(const CodecFigures& codec) { return static_cast<double>(codec.bytes); }

using Cell = std::function<std::string(const CodecFigures&)>;

/// Adds one cell per codec, "-" where it has no figures.
void addCells(const FileFigures& figures, const Cell& cell, std::vector<std::string>& cells) {
  for (const Codec codec : bench::kAllCodecs) {
    cells.push_back(figures.of(codec).ok() ? cell(figures.of(codec)) : "-");
  }
}

std::vector<std::string> headerOf(const std::string& first) {
  std::vector<std::string> header = {first};
  for (const Codec codec : bench::kAllCodecs) header.push_back(bench::codecName(codec));
  return header;
}

/// Returns the other codec's time divided by ours, or "-" where one is missing.
std::string quotient(const FileFigures& figures, Codec other, bool of_decode) {
  const CodecFigures& ours = figures.of(Codec::kMcc);
  const CodecFigures& theirs = figures.of(other);
  if (!ours.ok() || !theirs.ok()) return "-";
  const double divisor = of_decode ? ours.decode_seconds : ours.encode_seconds;
  const double dividend = of_decode ? theirs.decode_seconds : theirs.encode_seconds;
  return divisor <= 0 ? "-" : fmt::format("{:.2f}", dividend / divisor);
}

double sizeRatio(const FileFigures& figures, Codec other) {
  const CodecFigures& ours = figures.of(Codec::kMcc);
  const CodecFigures& theirs = figures.of(other);
  return ours.ok() && theirs.ok() && theirs.bytes > 0 ? bytesOf(ours) / bytesOf(theirs) : 0;
}

double bestRatio(const FileFigures& figures) {
  const Codec best = bench::bestDraco(figures);
  return best == Codec::kMcc ? 0 : sizeRatio(figures, best);
}

std::string ratioText(double ratio) { return ratio == 0 ? "-" : fmt::format("{:.3f}", ratio); }

Table sizeTable(const std::vector<FileFigures>& files, Format format) {
  std::vector<std::string> header = headerOf("bytes");
  header.insert(header.begin() + 1, {"triangles", "vertices"});
  header.push_back("mcc/best");
  Table table(std::move(header));
  for (const FileFigures& figures : files) {
    std::vector<std::string> cells = {figures.name, count(figures.triangle_count, format),
                                      count(figures.wedge_count, format)};
    addCells(
        figures, [&](const CodecFigures& codec) { return count(codec.bytes, format); }, cells);
    cells.push_back(ratioText(bestRatio(figures)));
    table.addRow(std::move(cells));
  }
  return table;
}

/// One row for ours and one for Draco's best; groups that are empty in all files are left out.
Table streamTable(const std::vector<FileFigures>& files) {
  const auto codecs = [](const FileFigures& figures) {
    std::vector<Codec> list = {Codec::kMcc};
    if (bench::bestDraco(figures) != Codec::kMcc) list.push_back(bench::bestDraco(figures));
    return list;
  };
  std::vector<StreamGroup> groups;
  for (const StreamGroup& group : streamGroups()) {
    bool is_used = false;
    for (const FileFigures& figures : files) {
      for (const Codec codec : codecs(figures)) {
        is_used = is_used || groupBits(figures.of(codec), group) != 0;
      }
    }
    if (is_used) groups.push_back(group);
  }
  std::vector<std::string> header = {"bits per vertex", "codec"};
  for (const StreamGroup& group : groups) header.push_back(group.name);
  header.push_back("all");
  Table table(std::move(header), {1});
  for (const FileFigures& figures : files) {
    for (const Codec codec : codecs(figures)) {
      const CodecFigures& codec_figures = figures.of(codec);
      std::vector<std::string> cells = {figures.name, bench::codecName(codec)};
      for (const StreamGroup& group : groups) {
        cells.push_back(fmt::format("{:.3f}", perVertex(figures, groupBits(codec_figures, group))));
      }
      cells.push_back(fmt::format("{:.3f}", perVertex(figures, 8 * bytesOf(codec_figures))));
      table.addRow(std::move(cells));
    }
  }
  return table;
}

Table timeTable(const std::vector<FileFigures>& files, bool of_decode) {
  std::vector<std::string> header =
      headerOf(of_decode ? "decode, ns per vertex" : "encode, ns per vertex");
  header.insert(header.end(), {"mcc Mtri/s", "draco 0/mcc", "draco 3/mcc", "draco 5/mcc"});
  Table table(std::move(header));
  for (const FileFigures& figures : files) {
    std::vector<std::string> cells = {figures.name};
    const auto seconds = [&](const CodecFigures& codec) {
      return of_decode ? codec.decode_seconds : codec.encode_seconds;
    };
    addCells(
        figures,
        [&](const CodecFigures& codec) {
          return fmt::format("{:.1f}", nanoseconds(figures, seconds(codec)));
        },
        cells);
    cells.push_back(
        fmt::format("{:.2f}", megaTriangles(figures, seconds(figures.of(Codec::kMcc)))));
    for (const Codec codec : {Codec::kDraco0, Codec::kDraco3, Codec::kDraco5}) {
      cells.push_back(quotient(figures, codec, of_decode));
    }
    table.addRow(std::move(cells));
  }
  return table;
}

Table memoryTable(const std::vector<FileFigures>& files) {
  std::vector<std::string> header = headerOf("peak bytes per vertex");
  Table table(std::move(header));
  for (const FileFigures& figures : files) {
    std::vector<std::string> cells = {figures.name};
    addCells(
        figures,
        [&](const CodecFigures& codec) {
          return fmt::format("{:.1f}", perVertex(figures, static_cast<double>(codec.peak_bytes)));
        },
        cells);
    table.addRow(std::move(cells));
  }
  return table;
}

Table orderTable(const std::vector<FileFigures>& files) {
  Table table(headerOf("acmr"));
  for (const FileFigures& figures : files) {
    std::vector<std::string> cells = {figures.name};
    addCells(
        figures, [&](const CodecFigures& codec) { return fmt::format("{:.3f}", codec.acmr); },
        cells);
    table.addRow(std::move(cells));
  }
  return table;
}

/// Has rows only for files that were loaded.
Table loadTable(const std::vector<FileFigures>& files) {
  Table table({"load with tinygltf, ms", "mcc", "draco 0", "draco 5", "draco 0/mcc", "draco 5/mcc",
               "payloads", "decode, wall ms, 1 thread", "2 threads"});
  const auto ms = [](double seconds) { return fmt::format("{:.2f}", 1e3 * seconds); };
  for (const FileFigures& figures : files) {
    const bench::LoadFigures& load = figures.load;
    if (!load.is_measured) continue;
    table.addRow({figures.name, ms(load.mcc), ms(load.draco_0), ms(load.draco_5),
                  fmt::format("{:.2f}", load.draco_0 / load.mcc),
                  fmt::format("{:.2f}", load.draco_5 / load.mcc),
                  std::to_string(load.payload_count), ms(load.decode_1), ms(load.decode_2)});
  }
  return table;
}

/// Geometric means over the files of one category.
struct Means {
  std::string category;
  size_t file_count = 0;
  size_t timed_count = 0;
  double to_best = 0;  ///< our bytes divided by those of Draco's best
  std::array<double, bench::kCodecCount> to_codec = {};
  std::array<double, bench::kCodecCount> decode = {};  ///< time of the codec divided by ours
  std::array<double, bench::kCodecCount> encode = {};
};

void addPositive(double value, std::vector<double>& values) {
  if (value > 0) values.push_back(value);
}

Means meansOf(const std::string& category, const std::vector<const FileFigures*>& files) {
  Means means;
  means.category = category;
  means.file_count = files.size();
  std::vector<double> best;
  for (const FileFigures* figures : files) {
    addPositive(bestRatio(*figures), best);
    means.timed_count += figures->triangle_count >= kTimedTriangles ? 1 : 0;
  }
  means.to_best = geometricMean(best);
  for (const Codec codec : bench::kAllCodecs) {
    std::vector<double> size;
    std::vector<double> decode;
    std::vector<double> encode;
    for (const FileFigures* figures : files) {
      addPositive(sizeRatio(*figures, codec), size);
      const CodecFigures& ours = figures->of(Codec::kMcc);
      const CodecFigures& other = figures->of(codec);
      if (figures->triangle_count < kTimedTriangles || !ours.ok() || !other.ok()) continue;
      addPositive(other.decode_seconds / ours.decode_seconds, decode);
      addPositive(other.encode_seconds / ours.encode_seconds, encode);
    }
    means.to_codec[indexOf(codec)] = geometricMean(size);
    means.decode[indexOf(codec)] = geometricMean(decode);
    means.encode[indexOf(codec)] = geometricMean(encode);
  }
  return means;
}

std::vector<Means> allMeans(const std::vector<FileFigures>& files, const std::string& apart) {
  std::vector<std::string> categories;
  std::vector<const FileFigures*> together;
  for (const FileFigures& figures : files) {
    const std::string category = categoryOf(figures.name);
    if (category.size() != 1 || apart.find(category) == std::string::npos) {
      together.push_back(&figures);
    }
    if (std::find(categories.begin(), categories.end(), category) == categories.end()) {
      categories.push_back(category);
    }
  }
  std::sort(categories.begin(), categories.end());
  std::vector<Means> means;
  for (const std::string& category : categories) {
    if (category == "all") continue;
    std::vector<const FileFigures*> members;
    for (const FileFigures& figures : files) {
      if (categoryOf(figures.name) == category) members.push_back(&figures);
    }
    means.push_back(meansOf(category, members));
  }
  means.push_back(meansOf("all", together));
  return means;
}

Table meansTable(const std::vector<FileFigures>& files, const std::string& apart) {
  Table table({"geometric mean", "files", "mcc/best", "mcc/draco 0", "mcc/draco 5", "mcc/meshopt",
               "timed files", "decode: draco 0/mcc", "draco 3/mcc", "draco 5/mcc", "meshopt/mcc",
               "encode: draco 0/mcc"});
  const auto speed = [](double value) { return value == 0 ? "-" : fmt::format("{:.2f}", value); };
  for (const Means& means : allMeans(files, apart)) {
    if (means.category == "all" && !table.empty()) table.addRule();
    table.addRow({means.category, std::to_string(means.file_count), ratioText(means.to_best),
                  ratioText(means.to_codec[indexOf(Codec::kDraco0)]),
                  ratioText(means.to_codec[indexOf(Codec::kDraco5)]),
                  ratioText(means.to_codec[indexOf(Codec::kMeshopt)]),
                  std::to_string(means.timed_count), speed(means.decode[indexOf(Codec::kDraco0)]),
                  speed(means.decode[indexOf(Codec::kDraco3)]),
                  speed(means.decode[indexOf(Codec::kDraco5)]),
                  speed(means.decode[indexOf(Codec::kMeshopt)]),
                  speed(means.encode[indexOf(Codec::kDraco0)])});
  }
  return table;
}

std::string failureText(const std::vector<FileFigures>& files) {
  std::string text;
  for (const FileFigures& figures : files) {
    for (const Codec codec : bench::kAllCodecs) {
      const std::string& failure = figures.of(codec).failure;
      if (failure.empty()) continue;
      text += fmt::format("{}: {} failed: {}\n", figures.name, bench::codecName(codec), failure);
    }
  }
  return text;
}

Json codecJson(const FileFigures& figures, const CodecFigures& codec) {
  if (!codec.ok()) return {{"failure", codec.failure}};
  Json streams = Json::object();
  for (const bench::Stream& stream : codec.streams) streams[stream.name] = stream.bits / 8;
  return {{"bytes", codec.bytes},
          {"bits_per_vertex", perVertex(figures, 8 * bytesOf(codec))},
          {"stream_bytes", std::move(streams)},
          {"triangles", codec.triangle_count},
          {"vertices", codec.vertex_count},
          {"encode_ns_per_vertex", nanoseconds(figures, codec.encode_seconds)},
          {"encode_mtri_per_second", megaTriangles(figures, codec.encode_seconds)},
          {"encode_runs", codec.encode_runs},
          {"decode_ns_per_vertex", nanoseconds(figures, codec.decode_seconds)},
          {"decode_mtri_per_second", megaTriangles(figures, codec.decode_seconds)},
          {"decode_runs", codec.decode_runs},
          {"array_bytes", codec.array_bytes},
          {"peak_bytes_above_arrays", codec.peak_bytes},
          {"peak_bytes_per_vertex", perVertex(figures, static_cast<double>(codec.peak_bytes))},
          {"acmr", codec.acmr}};
}

Json fileJson(const FileFigures& figures) {
  Json json = {{"file", figures.name},
               {"category", categoryOf(figures.name)},
               {"triangles", figures.triangle_count},
               {"vertices", figures.wedge_count},
               {"positions", figures.vertex_count},
               {"primitives", figures.primitive_count}};
  if (const Codec best = bench::bestDraco(figures); best != Codec::kMcc) {
    json["best"] = bench::codecKey(best);
    json["mcc_to_best"] = bestRatio(figures);
  }
  json["codecs"] = Json::object();
  for (const Codec codec : bench::kAllCodecs) {
    if (!figures.of(codec).is_asked) continue;
    json["codecs"][bench::codecKey(codec)] = codecJson(figures, figures.of(codec));
  }
  if (figures.has_left_out) {
    Json streams = Json::object();
    for (const bench::Stream& stream : figures.left_out) streams[stream.name] = stream.bits / 8;
    json["left_out"] = {{"bytes_with", figures.full_bytes}, {"stream_bytes", std::move(streams)}};
  }
  if (const bench::LoadFigures& load = figures.load; load.is_measured) {
    json["load"] = {
        {"cpu_seconds", {{"mcc", load.mcc}, {"draco_0", load.draco_0}, {"draco_5", load.draco_5}}},
        {"decode_wall_seconds", {{"threads_1", load.decode_1}, {"threads_2", load.decode_2}}},
        {"payloads", load.payload_count}};
  }
  json["notes"] = Json::array();
  for (const std::string& note : figures.notes) json["notes"].push_back(gltf::printable(note));
  return json;
}

Json meansJson(const Means& means) {
  Json json = {{"category", means.category},
               {"files", means.file_count},
               {"timed_files", means.timed_count},
               {"mcc_to_best", means.to_best},
               {"mcc_to", Json::object()},
               {"decode_time_to_mcc", Json::object()},
               {"encode_time_to_mcc", Json::object()}};
  for (const Codec codec : bench::kAllCodecs) {
    if (codec == Codec::kMcc) continue;
    const char* key = bench::codecKey(codec);
    json["mcc_to"][key] = means.to_codec[indexOf(codec)];
    json["decode_time_to_mcc"][key] = means.decode[indexOf(codec)];
    json["encode_time_to_mcc"][key] = means.encode[indexOf(codec)];
  }
  return json;
}

/// Adds the cells of loading, empty where nothing was loaded; only our codec decodes with threads.
void addLoadCells(const bench::LoadFigures& load, Codec id, std::vector<std::string>& cells) {
  const auto add = [&](double seconds) { cells.push_back(fmt::format("{:.6g}", seconds)); };
  if (!load.is_measured) return;
  switch (id) {
    case Codec::kMcc:
      add(load.mcc);
      cells.push_back(std::to_string(load.payload_count));
      add(load.decode_1);
      add(load.decode_2);
      break;
    case Codec::kDraco0: add(load.draco_0); break;
    case Codec::kDraco5: add(load.draco_5); break;
    case Codec::kDraco3:
    case Codec::kMeshopt: break;
  }
}

std::vector<std::string> csvCells(const FileFigures& figures, Codec id) {
  const CodecFigures& codec = figures.of(id);
  std::vector<std::string> cells = {figures.name,
                                    categoryOf(figures.name),
                                    bench::codecKey(id),
                                    std::to_string(figures.triangle_count),
                                    std::to_string(figures.wedge_count),
                                    std::to_string(figures.vertex_count)};
  if (!codec.ok()) return cells;
  const auto number = [](double value) { return fmt::format("{:.6g}", value); };
  cells.push_back(std::to_string(codec.bytes));
  for (const StreamGroup& group : streamGroups()) {
    cells.push_back(fmt::format("{:.1f}", groupBits(codec, group) / 8));
  }
  cells.push_back(number(perVertex(figures, 8 * bytesOf(codec))));
  cells.push_back(number(nanoseconds(figures, codec.encode_seconds)));
  cells.push_back(number(nanoseconds(figures, codec.decode_seconds)));
  cells.push_back(number(megaTriangles(figures, codec.encode_seconds)));
  cells.push_back(number(megaTriangles(figures, codec.decode_seconds)));
  cells.push_back(number(perVertex(figures, static_cast<double>(codec.peak_bytes))));
  cells.push_back(number(codec.acmr));
  cells.push_back(std::to_string(codec.triangle_count));
  cells.push_back(std::to_string(codec.vertex_count));
  addLoadCells(figures.load, id, cells);
  return cells;
}

}  // namespace

std::string categoryOf(const std::string& name) {
  const bool has_letter =
      name.size() > 1 && name[1] == '_' &&
      ((name[0] >= 'a' && name[0] <= 'z') || (name[0] >= 'A' && name[0] <= 'Z'));
  return has_letter ? name.substr(0, 1) : "all";
}

std::string versionsText() {
  return fmt::format("gltf-mcc {}, draco {}, meshoptimizer {}, zstd {} (level 19)\n{}, {}\n",
                     MCC_VERSION, foreign::dracoVersion(), foreign::meshoptVersion(),
                     foreign::zstdVersion(), MCC_COMPILER, MCC_COMPILER_FLAGS);
}

std::string benchText(const std::vector<FileFigures>& files, const std::string& apart,
                      Format format) {
  std::string text = versionsText();
  for (const Table& table :
       {sizeTable(files, format), streamTable(files), timeTable(files, true),
        timeTable(files, false), memoryTable(files), orderTable(files), meansTable(files, apart)}) {
    text += "\n" + table.print(format);
  }
  if (const Table load = loadTable(files); !load.empty()) text += "\n" + load.print(format);
  const std::string failures = failureText(files);
  return failures.empty() ? text : text + "\n" + failures;
}

std::string benchCsv(const std::vector<FileFigures>& files) {
  std::vector<std::string> header = {"file",     "category",  "codec", "triangles",
                                     "vertices", "positions", "bytes"};
  for (const StreamGroup& group : streamGroups())
    header.push_back(std::string(group.name) + "_bytes");
  header.insert(header.end(),
                {"bits_per_vertex", "encode_ns_per_vertex", "decode_ns_per_vertex",
                 "encode_mtri_per_second", "decode_mtri_per_second", "peak_bytes_per_vertex",
                 "acmr", "triangles_decoded", "vertices_decoded", "load_cpu_seconds", "payloads",
                 "decode_wall_seconds_1_thread", "decode_wall_seconds_2_threads"});
  Table table(std::move(header));
  for (const FileFigures& figures : files) {
    for (const Codec codec : bench::kAllCodecs) {
      if (figures.of(codec).is_asked) table.addRow(csvCells(figures, codec));
    }
  }
  return table.print(Format::kCsv);
}

std::string benchJson(const std::vector<FileFigures>& files, const std::string& apart) {
  Json list = Json::array();
  for (const FileFigures& figures : files) list.push_back(fileJson(figures));
  Json means = Json::array();
  for (const Means& row : allMeans(files, apart)) means.push_back(meansJson(row));
  const Json json = {{"tool", std::string("gltf-mcc ") + MCC_VERSION},
                     {"versions",
                      {{"draco", foreign::dracoVersion()},
                       {"meshoptimizer", foreign::meshoptVersion()},
                       {"zstd", foreign::zstdVersion()}}},
                     {"compiler", MCC_COMPILER},
                     {"compiler_flags", MCC_COMPILER_FLAGS},
                     {"timed_from_triangles", kTimedTriangles},
                     {"files", std::move(list)},
                     {"geometric_means", std::move(means)}};
  return printReport(json);
}

std::string sizesCsv(const std::vector<FileFigures>& files) {
  Table table({"file", "stream", "bytes"});
  for (const FileFigures& figures : files) {
    std::vector<bench::Stream> streams = figures.full_streams;
    std::stable_sort(streams.begin(), streams.end(),
                     [](const bench::Stream& a, const bench::Stream& b) {
                       return streamRank(a.name) < streamRank(b.name);
                     });
    for (const bench::Stream& stream : streams) {
      if (stream.bits == 0) continue;
      table.addRow({figures.name, stream.name, fmt::format("{:.0f}", stream.bits / 8)});
    }
    table.addRow({figures.name, "all", std::to_string(figures.full_bytes)});
  }
  return table.print(Format::kCsv);
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
