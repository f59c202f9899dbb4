// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "commands.h"
#include "host/text.h"
#include "mcc/files.h"
#include "mcc/glb.h"
#include "report_file.h"
#include "standard_streams.h"
#include "suggest.h"

namespace mcc::tool {
namespace {

using gltf::Json;

constexpr const char* kSeverities[] = {"error", "warning", "info", "hint"};

struct FileReport {
  std::string file;
  gltf::ValidationReport report;
};

uint64_t countOf(const gltf::ValidationReport& report, gltf::Severity severity) {
  return report.issue_counts[static_cast<size_t>(severity)];
}

/// Returns text like "1 error, 2 warnings", without severities that did not occur.
std::string countsText(const gltf::ValidationReport& report) {
  std::string text;
  for (size_t i = 0; i < std::size(kSeverities); ++i) {
    const uint64_t number = report.issue_counts[i];
    if (number == 0) continue;
    const bool is_plural = number != 1 && std::string(kSeverities[i]) != "info";
    text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", grouped(number), kSeverities[i],
                        is_plural ? "s" : "");
  }
  return text.empty() ? "valid" : text;
}

bool usesExtension(const gltf::ValidationReport& report) {
  const std::vector<std::string>& used = report.extensions_used;
  return report.compressed_primitive_count != 0 || report.payload_count != 0 ||
         std::find(used.begin(), used.end(), gltf::kExtensionName) != used.end();
}

/// Returns a report in the format of Khronos' glTF validator.
Json reportJson(const FileReport& file) {
  const gltf::ValidationReport& report = file.report;
  Json messages = Json::array();
  for (const gltf::ValidationIssue& issue : report.issues) {
    Json message = {{"code", issue.code},
                    {"message", issue.message},
                    {"severity", static_cast<uint32_t>(issue.severity)}};
    if (!issue.pointer.empty()) message["pointer"] = issue.pointer;
    messages.push_back(std::move(message));
  }
  Json info = {{"version", report.version}};
  if (!report.generator.empty()) info["generator"] = report.generator;
  if (!report.extensions_used.empty()) info["extensionsUsed"] = report.extensions_used;
  if (!report.extensions_required.empty()) info["extensionsRequired"] = report.extensions_required;
  info["primitiveCount"] = report.primitive_count;
  info["compressedPrimitiveCount"] = report.compressed_primitive_count;
  info["payloadCount"] = report.payload_count;
  info["payloadVertexCount"] = report.wedge_count;
  info["payloadTriangleCount"] = report.triangle_count;
  return {{"uri", file.file},
          {"mimeType", report.is_glb ? "model/gltf-binary" : "model/gltf+json"},
          {"validatorVersion", MCC_VERSION},
          {"issues",
           {{"numErrors", countOf(report, gltf::Severity::kError)},
            {"numWarnings", countOf(report, gltf::Severity::kWarning)},
            {"numInfos", countOf(report, gltf::Severity::kInfo)},
            {"numHints", countOf(report, gltf::Severity::kHint)},
            {"messages", messages},
            {"truncated", report.is_truncated}}},
          {"info", info}};
}

struct ValidateCommand {
  CommonOptions common;
  std::vector<std::string> files;
  gltf::ValidateOptions options;

  int run() const {
    std::vector<FileReport> reports;
    int status = kDone;
    for (const std::string& file : files) {
      FileReport report{file, {}};
      StreamSource source;
      gltf::Result outcome = source.open(file);
      if (outcome.ok()) outcome = gltf::validate(source.source(), options, report.report);
      if (!outcome.ok()) status = reportFailure(outcome, file, "");
      const bool is_invalid = outcome.ok() && !report.report.isValid();
      if (is_invalid) status = kFailed;
      if (is_invalid && isOtherFormat(file))
        reportFailure({file, "is no glTF file" + howToReadOther(file)});
      if (outcome.ok()) reports.push_back(std::move(report));
    }
    const int printed = printOut(textOf(reports));
    return printed == kDone ? status : printed;
  }

 private:
  std::string textOf(const std::vector<FileReport>& reports) const {
    if (common.format == Format::kCsv) return csv(reports);
    std::string text;
    if (common.format == Format::kJson) {
      Json all = Json::array();
      for (const FileReport& file : reports) all.push_back(reportJson(file));
      const Json& shown = files.size() == 1 && !all.empty() ? all[0] : all;
      return printReport(shown);
    }
    for (const FileReport& file : reports) {
      const std::string block = pretty(file);
      text += block;
    }
    return text;
  }

  bool isShown(const gltf::ValidationIssue& issue) const {
    return !common.is_quiet || issue.severity == gltf::Severity::kError;
  }

  std::string csv(const std::vector<FileReport>& reports) const {
    Table table({"file", "severity", "code", "pointer", "message"}, {1, 2, 3, 4});
    for (const FileReport& file : reports) {
      for (const gltf::ValidationIssue& issue : file.report.issues) {
        if (!isShown(issue)) continue;
        table.addRow({file.file, kSeverities[static_cast<size_t>(issue.severity)], issue.code,
                      issue.pointer, issue.message});
      }
    }
    return table.print(Format::kCsv);
  }

  std::string pretty(const FileReport& file) const {
    const gltf::ValidationReport& report = file.report;
    if (common.is_quiet && report.isValid()) return "";
    std::string text = fmt::format("{}: {}", gltf::printable(file.file), countsText(report));
    if (!common.is_quiet && report.isValid() && !usesExtension(report)) {
      text += fmt::format("; nothing in it is compressed with {}, so there was nothing to check",
                          gltf::kExtensionName);
    } else if (!common.is_quiet) {
      text += fmt::format("; {} of {} primitives compressed, in {}: {} triangles, {} vertices",
                          report.compressed_primitive_count, report.primitive_count,
                          counted(report.payload_count, "payload", "payloads"),
                          grouped(report.triangle_count), grouped(report.wedge_count));
    }
    Table table({"severity", "code", "pointer", "message"}, {1, 2, 3});
    for (const gltf::ValidationIssue& issue : report.issues) {
      if (!isShown(issue)) continue;
      table.addRow({kSeverities[static_cast<size_t>(issue.severity)], issue.code, issue.pointer,
                    issue.message});
    }
    if (table.empty()) return text + "\n";
    text += "\n\n" + table.print(common.format);
    if (report.is_truncated) text += "… and more; --max-issues 0 lists all\n";
    return text + "\n";
  }
};

}  // namespace

void addValidate(Program& program) {
  Command& command = program.commands.emplace_back();
  auto state = std::make_shared<ValidateCommand>();
  command.name = "validate";
  command.summary = "Check compressed files against all rules";
  command.add("FILE", "FILE", &state->files, "The files").is_required = true;
  command.add("--max-issues", "N", &state->options.max_issues,
              "List at most N issues of a file, 0: all [1000]");
  addDecodedLimitOption(command, state->options.max_decoded_bytes);
  command.addFlag("-q,--quiet", state->common.is_quiet, "Print errors only");
  addFormatOption(command, state->common);
  addColorOption(command);
  command.usage = "validate [OPTIONS] FILE…";
  command.text =
      "FILE is a .glb or .gltf file, or - for standard input. Everything that\n"
      "KHR_mesh_collapse_compression requires is checked: extension objects, the accessors they\n"
      "fill, lists of extensions, fallbacks, and payloads, which are decoded. For the rest of a\n"
      "file, use Khronos' glTF validator. --format json prints reports in its format: one object,\n"
      "or an array of them for several FILEs.\n"
      "Exit status: 0 no errors (warnings do not count); 1 errors; 2 wrong usage.";
  command.examples =
      "validate small.glb\n"
      "validate --format json small.glb\n"
      "validate -q out/*.glb";
  command.run = [state]() { return state->run(); };
}

}  // namespace mcc::tool
