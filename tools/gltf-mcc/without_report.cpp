// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "without_report.h"

#include <fmt/format.h>

#include <cmath>

#include "json/json.h"

namespace mcc::tool {
namespace {

using bench::Ablation;
using bench::AblationFigures;
using bench::WithoutFigures;
using gltf::Json;

/// Accumulates a geometric mean of quotients.
struct Mean {
  double logarithms = 0;
  uint64_t count = 0;

  void add(double quotient) {
    logarithms += std::log(quotient);
    ++count;
  }
  std::string percent() const {
    if (count == 0) return "-";
    return fmt::format("{:+.2f}", 100 * std::expm1(logarithms / static_cast<double>(count)));
  }
};

double growthOf(const WithoutFigures& file, const AblationFigures& row) {
  return static_cast<double>(row.bytes) / static_cast<double>(file.full_bytes);
}

bool isSeen(const AblationFigures& row) { return row.decode_seconds > 0; }

Table meansTable(const std::vector<Ablation>& ablations, const std::vector<WithoutFigures>& files) {
  Table table({"without", "seen in", "growth %", "most, %", "in", "decode %"}, {4});
  for (size_t i = 0; i < ablations.size(); ++i) {
    Mean growth;
    Mean decode;
    uint64_t seen = 0;
    const WithoutFigures* worst = nullptr;
    for (const WithoutFigures& file : files) {
      const AblationFigures& row = file.ablations[i];
      growth.add(growthOf(file, row));
      if (!isSeen(row)) continue;
      ++seen;
      decode.add(row.decode_seconds / row.full_decode_seconds);
      if (worst == nullptr || growthOf(file, row) > growthOf(*worst, worst->ablations[i]))
        worst = &file;
    }
    const double most = worst == nullptr ? 1 : growthOf(*worst, worst->ablations[i]);
    table.addRow({ablations[i].name, std::to_string(seen), growth.percent(),
                  worst == nullptr ? "-" : fmt::format("{:+.2f}", 100 * (most - 1)),
                  worst == nullptr ? "" : worst->name, decode.percent()});
  }
  return table;
}

std::string rowsCsv(const std::vector<Ablation>& ablations,
                    const std::vector<WithoutFigures>& files) {
  Table table({"file", "triangles", "without", "bytes_with", "bytes_without", "decode_seconds_with",
               "decode_seconds_without"});
  for (const WithoutFigures& file : files) {
    for (size_t i = 0; i < ablations.size(); ++i) {
      const AblationFigures& row = file.ablations[i];
      const auto seconds = [&](double s) { return isSeen(row) ? fmt::format("{:.6f}", s) : ""; };
      table.addRow({file.name, std::to_string(file.triangle_count), ablations[i].name,
                    std::to_string(file.full_bytes), std::to_string(row.bytes),
                    seconds(row.full_decode_seconds), seconds(row.decode_seconds)});
    }
  }
  return table.print(Format::kCsv);
}

std::string rowsJson(const std::vector<Ablation>& ablations,
                     const std::vector<WithoutFigures>& files) {
  Json all = Json::array();
  for (const WithoutFigures& file : files) {
    Json rows = Json::array();
    for (size_t i = 0; i < ablations.size(); ++i) {
      const AblationFigures& row = file.ablations[i];
      rows.push_back({{"without", ablations[i].name}, {"bytes", row.bytes}});
      if (!isSeen(row)) continue;
      rows.back()["decode_seconds"] = row.decode_seconds;
      rows.back()["decode_seconds_with"] = row.full_decode_seconds;
    }
    all.push_back({{"file", file.name},
                   {"triangles", file.triangle_count},
                   {"bytes", file.full_bytes},
                   {"ablations", std::move(rows)}});
  }
  return all.dump(2) + "\n";
}

}  // namespace

std::string withoutReport(const std::vector<Ablation>& ablations,
                          const std::vector<WithoutFigures>& files, Format format) {
  switch (format) {
    case Format::kCsv: return rowsCsv(ablations, files);
    case Format::kJson: return rowsJson(ablations, files);
    default: return meansTable(ablations, files).print(format);
  }
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
