// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(MCC_HAS_FOREIGN)

#include "meshlets_report.h"

#include <fmt/format.h>

#include "json/json.h"

namespace mcc::tool {
namespace {

using bench::kMeshletMakerCount;
using bench::MeshletMaker;
using bench::MeshletsMade;
using bench::MeshletsOfFile;
using gltf::Json;

constexpr const char* kMakerNames[kMeshletMakerCount] = {"round", "in order", "meshopt"};
constexpr const char* kMakerKeys[kMeshletMakerCount] = {"round", "in_order", "meshopt"};

/// Means over the meshlets of one maker.
struct MeshletMeans {
  explicit MeshletMeans(const foreign::MeshletFigures& sums) {
    const auto meshlets = static_cast<double>(sums.meshlet_count);
    const auto triangles = static_cast<double>(sums.triangle_count);
    vertices_per_triangle = static_cast<double>(sums.vertex_count) / triangles;
    triangles_per_meshlet = triangles / meshlets;
    radius = sums.radii / meshlets;
    cone = sums.cones / meshlets;
  }

  double vertices_per_triangle = 0;
  double triangles_per_meshlet = 0;
  double radius = 0;
  double cone = 0;
};

double nanosecondsPerTriangle(double seconds, const MeshletsOfFile& file) {
  return 1e9 * seconds / static_cast<double>(file.triangle_count);
}

Table meshletsTable(const std::vector<MeshletsOfFile>& files, Format format) {
  Table table(
      {"file", "triangles", "order", "meshlets", "vertices/triangle", "triangles/meshlet", "radius",
       "/meshopt", "1-cutoff", "meshlets, ns", "triangles, ns", "decode, ns", "with meshlets"},
      {2});
  const auto digits = [](double number) { return fmt::format("{:.1f}", number); };
  for (const MeshletsOfFile& file : files) {
    const MeshletMeans theirs(file.of(MeshletMaker::kMeshopt).figures);
    for (size_t i = 0; i < kMeshletMakerCount; ++i) {
      const MeshletsMade& made = file.makers[i];
      const MeshletMeans means(made.figures);
      table.addRow(
          {file.name, count(file.triangle_count, format), kMakerNames[i],
           count(made.figures.meshlet_count, format),
           fmt::format("{:.3f}", means.vertices_per_triangle), digits(means.triangles_per_meshlet),
           fmt::format("{:.4g}", means.radius), fmt::format("{:.2f}", means.radius / theirs.radius),
           fmt::format("{:.3f}", means.cone), digits(nanosecondsPerTriangle(made.seconds, file)),
           digits(nanosecondsPerTriangle(file.indices_seconds, file)),
           digits(nanosecondsPerTriangle(file.decode_seconds, file)),
           fmt::format("{:.2f}", 1 + made.seconds / file.indices_seconds)});
    }
  }
  return table;
}

std::string meshletsJson(const std::vector<MeshletsOfFile>& files) {
  Json all = Json::array();
  for (const MeshletsOfFile& file : files) {
    Json makers = Json::object();
    for (size_t i = 0; i < kMeshletMakerCount; ++i) {
      const MeshletsMade& made = file.makers[i];
      const MeshletMeans means(made.figures);
      makers[kMakerKeys[i]] = {{"meshlets", made.figures.meshlet_count},
                               {"vertices_per_triangle", means.vertices_per_triangle},
                               {"triangles_per_meshlet", means.triangles_per_meshlet},
                               {"mean_radius", means.radius},
                               {"mean_1_minus_cutoff", means.cone},
                               {"seconds", made.seconds}};
    }
    all.push_back({{"file", file.name},
                   {"triangles", file.triangle_count},
                   {"triangles_decode_seconds", file.indices_seconds},
                   {"decode_seconds", file.decode_seconds},
                   {"orders", std::move(makers)}});
  }
  return all.dump(2) + "\n";
}

}  // namespace

std::string meshletsReport(const std::vector<MeshletsOfFile>& files, Format format) {
  return format == Format::kJson ? meshletsJson(files) : meshletsTable(files, format).print(format);
}

}  // namespace mcc::tool

#endif  // MCC_HAS_FOREIGN
