// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "blocks_report.h"

#include <fmt/format.h>

#include "convert_report.h"
#include "json/json.h"

namespace mcc::tool {
namespace {

using bench::BlocksFigures;
using bench::BlocksOfFile;
using gltf::Json;

std::string milliseconds(double seconds) { return fmt::format("{:.1f}", 1000 * seconds); }

std::string megabytes(uint64_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / 1e6);
}

Table blocksTable(const std::vector<BlocksOfFile>& files, Format format) {
  Table table({"file", "triangles", "blocks of", "blocks", "bytes", "growth", "encode, ms",
               "2 threads", "faster", "decode, ms", "2 threads", "faster", "draco 5", "memory, MB",
               "2 threads", "arrays"});
  for (const BlocksOfFile& file : files) {
    for (const BlocksFigures& row : file.sizes) {
      const double growth =
          static_cast<double>(row.bytes) / static_cast<double>(file.sizes[0].bytes) - 1;
      table.addRow({file.name, count(file.triangle_count, format),
                    row.block_triangles == 0 ? "none" : count(row.block_triangles, format),
                    count(row.block_count, format), count(row.bytes, format),
                    fmt::format("{:+.2f} %", 100 * growth), milliseconds(row.encode_seconds[0]),
                    milliseconds(row.encode_seconds[1]),
                    fmt::format("{:.2f}", row.encode_seconds[0] / row.encode_seconds[1]),
                    milliseconds(row.decode_seconds[0]), milliseconds(row.decode_seconds[1]),
                    fmt::format("{:.2f}", row.decode_seconds[0] / row.decode_seconds[1]),
                    milliseconds(file.draco_decode_seconds), megabytes(row.peak_bytes[0]),
                    megabytes(row.peak_bytes[1]), megabytes(file.array_bytes)});
    }
  }
  return table;
}

std::string blocksJson(const std::vector<BlocksOfFile>& files) {
  Json all = Json::array();
  for (const BlocksOfFile& file : files) {
    Json rows = Json::array();
    for (const BlocksFigures& row : file.sizes) {
      rows.push_back({{"block_triangles", row.block_triangles},
                      {"blocks", row.block_count},
                      {"bytes", row.bytes},
                      {"encode_seconds", row.encode_seconds},
                      {"decode_seconds", row.decode_seconds},
                      {"peak_bytes", row.peak_bytes}});
    }
    all.push_back({{"file", file.name},
                   {"triangles", file.triangle_count},
                   {"array_bytes", file.array_bytes},
                   {"draco_5_decode_seconds", file.draco_decode_seconds},
                   {"sizes", std::move(rows)}});
  }
  return all.dump(2) + "\n";
}

}  // namespace

std::string blocksReport(const std::vector<BlocksOfFile>& files, Format format) {
  return format == Format::kJson ? blocksJson(files) : blocksTable(files, format).print(format);
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
