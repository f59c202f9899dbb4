// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "convert_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "convert_summary.h"
#include "gltf/inspect/report.h"
#include "host/text.h"
#include "notes.h"

namespace mcc::tool {
namespace {

using gltf::Json;

/// Sums over all payloads of a file.
struct Totals {
  uint64_t payload_bytes = 0;
  uint64_t wedge_count = 0;
  uint64_t vertex_count = 0;
  std::vector<gltf::StreamReport> streams;
  std::vector<gltf::AttributeReport> attributes;
};

void addStream(const gltf::StreamReport& stream, Totals& totals) {
  for (gltf::StreamReport& total : totals.streams) {
    if (total.name != stream.name) continue;
    total.bits += stream.bits;
    return;
  }
  totals.streams.push_back(stream);
}

void addAttribute(const gltf::AttributeReport& attribute, Totals& totals) {
  for (gltf::AttributeReport& total : totals.attributes) {
    const bool is_same = total.name == attribute.name && total.is_angle == attribute.is_angle &&
                         total.coding == attribute.coding && total.bits == attribute.bits;
    if (!is_same) continue;
    total.primitives.insert(total.primitives.end(), attribute.primitives.begin(),
                            attribute.primitives.end());
    total.coded_bits += attribute.coded_bits;
    total.vertex_count += attribute.vertex_count;
    total.max_error = std::max(total.max_error, attribute.max_error);
    total.promised_error = std::max(total.promised_error, attribute.promised_error);
    total.median_error = std::max(total.median_error, attribute.median_error);
    total.promised_distance = std::max(total.promised_distance, attribute.promised_distance);
    total.max_distance = std::max(total.max_distance, attribute.max_distance);
    return;
  }
  totals.attributes.push_back(attribute);
}

Totals totalsOf(const gltf::ConvertReport& report) {
  Totals totals;
  for (const gltf::PayloadReport& payload : report.payloads) {
    totals.payload_bytes += payload.payload_bytes;
    totals.wedge_count += payload.wedge_count;
    totals.vertex_count += payload.vertex_count;
    for (const auto& stream : payload.streams) addStream(stream, totals);
    for (const auto& attribute : payload.attributes) addAttribute(attribute, totals);
  }
  return totals;
}

std::string perVertex(double bits, uint64_t vertices) {
  return vertices == 0 ? "" : fmt::format("{:.3f}", bits / static_cast<double>(vertices));
}

std::string errorText(const gltf::AttributeReport& attribute, double error) {
  if (attribute.bits == 0) return "exact";
  return fmt::format("{:.3g}{}", error, attribute.is_angle ? " deg" : "");
}

/// Returns "all", or a few as "0/1 2/0" (mesh/primitive), or how many there are.
std::string primitivesText(const gltf::AttributeReport& attribute, size_t compressed_count) {
  constexpr size_t kMostNamed = 4;
  constexpr std::string_view kMeshes = "/meshes/";
  constexpr std::string_view kPrimitives = "/primitives";
  const std::set<std::string> paths(attribute.primitives.begin(), attribute.primitives.end());
  if (paths.size() == compressed_count) return "all";
  if (paths.size() > kMostNamed) return fmt::format("{} of {}", paths.size(), compressed_count);
  std::string text;
  for (std::string path : paths) {
    path.replace(path.find(kPrimitives), kPrimitives.size(), "");
    text += (text.empty() ? "" : " ") + path.substr(kMeshes.size());
  }
  return text;
}

Table streamTable(const gltf::ConvertReport& report, const Totals& totals, Format format) {
  std::vector<std::string> columns = {"stream", "bytes",     "bits/vertex", "bits/position",
                                      "coding", "max error", "promised"};
  const bool names_primitives = format != Format::kCsv;
  if (names_primitives) columns.push_back("mesh/primitive");
  const auto compressed_count = static_cast<size_t>(
      std::count_if(report.primitives.begin(), report.primitives.end(),
                    [](const gltf::PrimitiveReport& primitive) { return primitive.compressed; }));
  Table table(columns, {4, 7});
  const auto bytes = [&](double bits) {
    return count(static_cast<uint64_t>(bits / 8 + 0.5), format);
  };
  for (const auto& stream : totals.streams) {
    const bool is_rare =
        stream.name == "order" || stream.name == "leftovers" || stream.name == "stitching";
    if (is_rare && stream.bits == 0) continue;
    table.addRow({stream.name, bytes(stream.bits), perVertex(stream.bits, totals.wedge_count),
                  perVertex(stream.bits, totals.vertex_count)});
  }
  for (const auto& attribute : totals.attributes) {
    std::vector<std::string> row = {attribute.name,
                                    bytes(attribute.coded_bits),
                                    perVertex(attribute.coded_bits, attribute.vertex_count),
                                    perVertex(attribute.coded_bits, totals.vertex_count),
                                    gltf::codingName(attribute.coding, attribute.bits),
                                    errorText(attribute, attribute.max_error),
                                    errorText(attribute, attribute.promised_error)};
    if (names_primitives) row.push_back(primitivesText(attribute, compressed_count));
    table.addRow(std::move(row));
  }
  table.addRule();
  const double all_bits = 8 * static_cast<double>(totals.payload_bytes);
  table.addRow({"all", count(totals.payload_bytes, format), perVertex(all_bits, totals.wedge_count),
                perVertex(all_bits, totals.vertex_count)});
  return table;
}

Table primitiveTable(const gltf::ConvertReport& report, Format format) {
  Table table({"primitive", "triangles", "vertices", "payload", "note"}, {4});
  for (const auto& primitive : report.primitives) {
    table.addRow({fmt::format("/meshes/{}/primitives/{}", primitive.mesh, primitive.primitive),
                  primitive.compressed ? count(primitive.triangle_count, format) : "",
                  primitive.compressed ? count(primitive.wedge_count, format) : "",
                  primitive.compressed ? std::to_string(primitive.payload) : "-", primitive.note});
  }
  return table;
}

std::string tablesText(const Converted& converted, const Totals& totals, Format format) {
  const gltf::ConvertReport& report = converted.report;
  std::string text;
  if (!report.payloads.empty()) text += "\n" + streamTable(report, totals, format).print(format);
  if (!report.primitives.empty()) text += "\n" + primitiveTable(report, format).print(format);
  if (!converted.sizes.empty()) text += "\n" + wholeSizesText(converted.sizes, format);
  if (report.checked && !report.copied) {
    text += fmt::format("\nencoded in {:.0f} ms, decoded in {:.0f} ms, checked in {:.0f} ms\n",
                        1000 * report.encode_seconds, 1000 * report.decode_seconds,
                        1000 * report.check_seconds);
  }
  for (const auto& attribute : totals.attributes) {
    if (attribute.promised_distance == 0) continue;
    text += fmt::format("no {} is farther than {:.6g} from its source (promised {:.6g})\n",
                        gltf::printable(attribute.name), attribute.max_distance,
                        attribute.promised_distance);
  }
  return text;
}

}  // namespace

std::string sizeChange(uint64_t input_bytes, uint64_t output_bytes) {
  const double percent =
      input_bytes == 0 ? 0
                       : 100 * static_cast<double>(output_bytes) / static_cast<double>(input_bytes);
  return fmt::format("{} -> {} bytes ({:.1f} %)", grouped(input_bytes), grouped(output_bytes),
                     percent);
}

std::string reportText(const Converted& converted, const CommonOptions& options) {
  const gltf::ConvertReport& report = converted.report;
  const Totals totals = totalsOf(report);
  if (options.format == Format::kCsv) {
    Table table = streamTable(report, totals, options.format);
    for (const WholeSize& size : converted.sizes) {
      table.addRow({size.name + " file", std::to_string(size.bytes)});
      table.addRow({size.name + " file after brotli", std::to_string(size.brotli_bytes)});
    }
    return table.print(Format::kCsv);
  }
  std::string text = titleText(converted) + summaryText(converted);
  if (!options.hasTables()) {
    text += notesText(report.notes, kSomeNotes);
    // Where nothing was compressed, these say why.
    return report.copied ? text + notesText(report.remarks, kSomeNotes) : text;
  }
  text += tablesText(converted, totals, options.format);
  const std::string notes =
      notesText(report.notes, kAllNotes) + notesText(report.remarks, kAllNotes);
  return notes.empty() ? text : text + "\n" + notes;
}

Json reportJson(const Converted& converted, const gltf::ConvertOptions& options,
                const Json& comparison) {
  Json json = {{"tool", std::string("gltf-mcc ") + MCC_VERSION},
               {"input", converted.input},
               {"output", converted.output}};
  json.update(gltf::reportJson(converted.report, options));
  if (!converted.sizes.empty()) json["files"] = wholeSizesJson(converted.sizes);
  if (!comparison.is_null()) json["comparison"] = comparison;
  return json;
}

}  // namespace mcc::tool
