// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "bars.h"
#include "commands.h"
#include "gltf/files/file_io.h"
#include "gltf/inspect/report.h"
#include "host/text.h"
#include "plain_report.h"
#include "progress_line.h"
#include "report_file.h"
#include "standard_streams.h"

namespace mcc::tool {
namespace {

struct Counts {
  uint64_t wedges = 0;
  uint64_t vertices = 0;
  uint64_t triangles = 0;
};

Counts countsOf(const gltf::InspectPayload& payload) {
  Counts counts;
  for (const gltf::InspectPiece& piece : payload.pieces) {
    counts.wedges += piece.wedge_count;
    counts.vertices += piece.vertex_count;
    counts.triangles += piece.triangle_count;
  }
  return counts;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : " ") + text;
  return all;
}

Table payloadTable(const gltf::InspectReport& report, Format format) {
  Table table({"bufferView", "bytes", "bits/vertex", "version", "pieces", "triangles", "vertices",
               "positions", "header", "codes", "tokens", "raw bits", "coders", "used by"},
              {14});
  for (const auto& payload : report.payloads) {
    const Counts counts = countsOf(payload);
    std::string users = payload.primitives[0];
    if (payload.primitives.size() > 1) {
      users += fmt::format(" and {} more", payload.primitives.size() - 1);
    }
    const double bits = 8 * static_cast<double>(payload.payload_bytes);
    table.addRow(
        {std::to_string(payload.buffer_view), count(payload.payload_bytes, format),
         counts.wedges == 0 ? "" : fmt::format("{:.3f}", bits / static_cast<double>(counts.wedges)),
         fmt::format("{}.{}", payload.version_major, payload.version_minor),
         std::to_string(payload.pieces.size()), count(counts.triangles, format),
         count(counts.wedges, format), count(counts.vertices, format),
         count(payload.header_bytes, format), count(payload.codes_bytes, format),
         count(payload.tokens_bytes, format), count(payload.raw_bits_bytes, format),
         payload.single_coder ? "1" : "3", users});
  }
  return table;
}

/// Sums up the streams and attributes of all payloads by name, in bits.
std::vector<gltf::StreamReport> streamsOf(const gltf::InspectReport& report) {
  std::vector<gltf::StreamReport> streams;
  const auto add = [&](const std::string& name, double bits) {
    for (gltf::StreamReport& stream : streams) {
      if (stream.name != name) continue;
      stream.bits += bits;
      return;
    }
    streams.push_back({name, bits});
  };
  for (const auto& payload : report.payloads) {
    for (const gltf::StreamReport& stream : payload.streams) add(stream.name, stream.bits);
  }
  for (const auto& payload : report.payloads) {
    for (const gltf::InspectPiece& piece : payload.pieces) {
      for (const gltf::InspectAttribute& details : piece.details) {
        add(details.name, details.coded_bits);
      }
    }
  }
  return streams;
}

Table streamTable(const gltf::InspectReport& report, Format format) {
  const std::vector<gltf::StreamReport> streams = streamsOf(report);
  uint64_t vertices = 0;
  double all = 0;
  double most = 0;
  for (const auto& payload : report.payloads) vertices += countsOf(payload).wedges;
  for (const gltf::StreamReport& stream : streams) {
    all += stream.bits;
    most = std::max(most, stream.bits);
  }
  const bool has_bars = format == Format::kPretty;
  Table table(has_bars ? std::vector<std::string>{"stream", "bytes", "share", "bits/vertex", ""}
                       : std::vector<std::string>{"stream", "bytes", "share", "bits/vertex"},
              {4});
  const auto add = [&](const std::string& name, double bits, const std::string& bar) {
    table.addRow({name, count(static_cast<uint64_t>(bits / 8 + 0.5), format),
                  all == 0 ? "" : fmt::format("{:.1f} %", 100 * bits / all),
                  vertices == 0 ? "" : fmt::format("{:.3f}", bits / static_cast<double>(vertices))},
                 bar);
  };
  for (const gltf::StreamReport& stream : streams) {
    add(stream.name, stream.bits, has_bars ? barOf(most == 0 ? 0 : stream.bits / most) : "");
  }
  table.addRule();
  add("all", all, "");
  return table;
}

std::string boundText(const gltf::InspectAttribute& details) {
  if (details.error_bound == 0) return "exact";
  return fmt::format("{:.3g}{}", details.error_bound, details.is_angle ? " deg" : "");
}

std::string originText(const AttributeInfo& info) {
  std::string text;
  for (uint32_t c = 0; c < std::min<uint32_t>(info.format.component_count, 4); ++c) {
    text += fmt::format("{}{:.6g}", c == 0 ? "" : ", ", info.lattice.origin[c]);
  }
  return text;
}

Table attributeTable(const gltf::InspectReport& report, Format format) {
  Table table({"bufferView", "piece", "triangles", "vertices", "parts", "surface", "attribute",
               "type", "coding", "step", "error bound", "origin", "predictor"},
              {5, 6, 7, 8, 11, 12});
  for (const auto& payload : report.payloads) {
    for (size_t i = 0; i < payload.pieces.size(); ++i) {
      const gltf::InspectPiece& piece = payload.pieces[i];
      for (size_t k = 0; k < piece.attributes.size(); ++k) {
        const AttributeInfo& attribute = piece.attributes[k];
        const bool has_lattice = attribute.coding == AttributeCoding::kLattice;
        const std::string coding = attribute.coding == AttributeCoding::kAlias
                                       ? "as " + piece.details[attribute.alias_of].name
                                       : gltf::codingName(attribute.coding, attribute.bits);
        table.addRow({std::to_string(payload.buffer_view), std::to_string(i),
                      count(piece.triangle_count, format), count(piece.wedge_count, format),
                      std::to_string(piece.part_count), gltf::surfaceName(piece.surface),
                      piece.details[k].name, gltf::typeText(attribute), coding,
                      has_lattice ? fmt::format("{:.6g}", attribute.lattice.step) : "",
                      boundText(piece.details[k]), has_lattice ? originText(attribute) : "",
                      piece.details[k].predictor});
      }
    }
  }
  return table;
}

std::string pointText(const float* point) {
  return fmt::format("{:.6g}, {:.6g}, {:.6g}", point[0], point[1], point[2]);
}

/// Lists the blocks of the pieces that are cut into some.
Table blockTable(const gltf::InspectReport& report, Format format) {
  Table table({"bufferView", "block", "bytes", "triangles", "vertices", "repeated", "from", "to"},
              {6, 7});
  for (const auto& payload : report.payloads) {
    for (const gltf::InspectPiece& piece : payload.pieces) {
      for (size_t i = 0; i < piece.blocks.size(); ++i) {
        const gltf::InspectBlock& block = piece.blocks[i];
        table.addRow({std::to_string(payload.buffer_view), std::to_string(i),
                      count(block.stream_bytes, format), count(block.triangle_count, format),
                      count(block.wedge_count, format), count(block.repeated_count, format),
                      pointText(block.low), pointText(block.high)});
      }
    }
  }
  return table;
}

bool hasBlocks(const gltf::InspectReport& report) {
  const auto isCut = [](const gltf::InspectPiece& piece) { return !piece.blocks.empty(); };
  return std::any_of(report.payloads.begin(), report.payloads.end(), [&](const auto& payload) {
    return std::any_of(payload.pieces.begin(), payload.pieces.end(), isCut);
  });
}

/// Says of each large piece without blocks why it has none.
std::string wholePieces(const gltf::InspectReport& report) {
  std::string lines;
  for (const auto& payload : report.payloads) {
    for (const gltf::InspectPiece& piece : payload.pieces) {
      if (piece.whole_because.empty()) continue;
      lines += fmt::format("\nbufferView {}: {} triangles without blocks: {}\n",
                           payload.buffer_view, grouped(piece.triangle_count), piece.whole_because);
    }
  }
  return lines;
}

/// Says which payloads are shown only while the others are on their way.
std::string previews(const gltf::InspectReport& report) {
  std::string lines;
  for (const auto& payload : report.payloads) {
    if (!payload.is_preview) continue;
    lines += fmt::format("\nbufferView {}: a preview of {}\n", payload.buffer_view,
                         joined(payload.primitives));
  }
  return lines;
}

/// Counts how often each code occurs, in the columns of the paper's table 1.
Table codeTable(const gltf::InspectReport& report, Format format) {
  uint32_t last_degree = 8;
  for (const auto& payload : report.payloads) {
    for (uint32_t d = last_degree; d < 256; ++d) {
      if (payload.codes.degree[d] != 0) last_degree = d;
    }
  }
  last_degree = std::min(last_degree, 12u);  // higher degrees share one column
  std::vector<std::string> header = {"bufferView", "vertices", "triangles", "S", "E", "M", "holes"};
  for (uint32_t d = 2; d <= last_degree; ++d) header.push_back(std::to_string(d));
  header.push_back(fmt::format(">{}", last_degree));
  header.push_back("bits/vertex");
  Table table(header);
  for (const auto& payload : report.payloads) {
    const Counts counts = countsOf(payload);
    const CodeHistogram& codes = payload.codes;
    std::vector<std::string> row = {std::to_string(payload.buffer_view),
                                    count(counts.vertices, format),
                                    count(counts.triangles, format),
                                    count(codes.start, format),
                                    count(codes.end, format),
                                    count(codes.handle, format),
                                    count(codes.dummy, format)};
    uint64_t above = 0;
    for (uint32_t d = 2; d < 256; ++d) {
      if (d <= last_degree) row.push_back(count(codes.degree[d], format));
      if (d > last_degree) above += codes.degree[d];
    }
    row.push_back(count(above, format));
    const double bits = 8 * static_cast<double>(payload.codes_bytes);
    row.push_back(counts.vertices == 0
                      ? ""
                      : fmt::format("{:.3f}", bits / static_cast<double>(counts.vertices)));
    table.addRow(row);
  }
  return table;
}

struct InspectCommand {
  CommonOptions common;
  std::string input;
  bool show_codes = false;

  gltf::Result inspect(const gltf::Source& source, gltf::InspectReport& report) const {
    if (!source.bytes) return gltf::inspectFile(gltf::pathOf(input), true, report);
    return gltf::inFile(source.path, gltf::inspectGlb(*source.bytes, true, report));
  }

  int run() const {
    gltf::InspectReport report;
    StreamSource stream;
    gltf::Result outcome;
    {
      const WorkProgress progress(false, "reading " + input);
      outcome = stream.open(input);  // may have to wait for a pipe
      if (outcome.ok()) outcome = inspect(stream.source(), report);
    }
    std::string contents;
    const bool is_read = common.format == Format::kPretty || common.format == Format::kMarkdown;
    if (outcome.ok() && is_read && report.payloads.empty()) {
      outcome = plainReport(input, stream.source(), common.format, contents);
    }
    if (!outcome.ok()) return reportFailure(outcome, input, "");
    if (common.format == Format::kJson)
      return printOut(printReport(gltf::inspectJson(input, report)));
    if (common.format == Format::kCsv) {
      const Table table =
          show_codes ? codeTable(report, common.format) : payloadTable(report, common.format);
      return printOut(table.print(common.format));
    }
    return printOut(text(report, contents));
  }

  std::string text(const gltf::InspectReport& report, const std::string& contents) const {
    std::string out = fmt::format(
        "{}: {} bytes, {}, {}; extensions: {}\n", gltf::printable(input),
        grouped(report.input_bytes), counted(report.mesh_count, "mesh", "meshes"),
        counted(report.primitive_count, "primitive", "primitives"),
        report.extensions_used.empty() ? "none" : gltf::printable(joined(report.extensions_used)));
    if (report.payloads.empty()) {
      return out + "nothing in it is compressed with " + gltf::kExtensionName + "\n\n" + contents;
    }
    out += "\n" + payloadTable(report, common.format).print(common.format);
    if (show_codes) return out + "\n" + codeTable(report, common.format).print(common.format);
    out += "\n" + streamTable(report, common.format).print(common.format);
    out += "\n" + attributeTable(report, common.format).print(common.format);
    out += previews(report);
    out += wholePieces(report);
    if (!hasBlocks(report)) return out;
    return out + "\n" + blockTable(report, common.format).print(common.format);
  }
};

}  // namespace

void addInspect(Program& program) {
  Command& command = program.commands.emplace_back();
  auto state = std::make_shared<InspectCommand>();
  command.name = "inspect";
  command.summary = "List what a file and its payloads hold";
  command.add("-i,--input,IN", "FILE", &state->input, "Same as IN").is_required = true;
  command.addFlag("--codes", state->show_codes,
                  "Count the codes: S, E, M and the degrees of vertices");
  addFormatOption(command, state->common);
  addColorOption(command);
  command.usage = "inspect [OPTIONS] IN";
  command.text =
      "IN is a .glb or .gltf file, or - for standard input. For each payload, its streams are\n"
      "listed with their bytes, and its attributes: how each is coded, the step of its lattice,\n"
      "how far a value may be from the source, and how the writer chose to predict it, in the\n"
      "words of the specification. Of a file without payloads the contents are listed.";
  command.examples =
      "inspect small.glb\n"
      "inspect small.glb --codes --format md";
  command.run = [state]() { return state->run(); };
}

}  // namespace mcc::tool
