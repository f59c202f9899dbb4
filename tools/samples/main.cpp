// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// generate-samples --bench DIR writes the second set of models for `gltf-mcc bench DIR/*.glb`,
// which nothing in the codec was fitted on, and prints a table of them; with --soups, meshes whose
// edges have many faces; with --large, a surface of 20 million triangles; with --city, the tileset
// of samples/city; with --city-large, one of about 1,000 tiles.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <span>
#include <string_view>

#include "city.h"
#include "models.h"

namespace mcc::samples {
namespace {

struct Counts {
  uint64_t vertices = 0;
  uint64_t triangles = 0;
};

/// Counts the vertices of all meshes (each POSITION accessor once) and the triangles of all
/// primitives.
Counts countOf(const Json& json) {
  constexpr uint32_t kTriangles = 4;
  Counts counts;
  std::set<uint64_t> seen;
  for (const Json& mesh : json["meshes"]) {
    for (const Json& primitive : mesh["primitives"]) {
      const uint64_t position = primitive["attributes"]["POSITION"].get<uint64_t>();
      const uint64_t vertices = json["accessors"][position]["count"].get<uint64_t>();
      if (seen.insert(position).second) counts.vertices += vertices;
      uint64_t corners = vertices;
      if (primitive.contains("indices")) {
        corners = json["accessors"][primitive["indices"].get<uint64_t>()]["count"].get<uint64_t>();
      }
      const bool separate = primitive.value("mode", kTriangles) == kTriangles;
      counts.triangles += separate ? corners / 3 : corners - 2;
    }
  }
  return counts;
}

int run(const std::filesystem::path& folder, std::span<const Model> models) {
  std::cout << "| file | shows | vertices | triangles | bytes |\n|---|---|---:|---:|---:|\n";
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  for (const Model& model : models) {
    GlbBuilder glb = model.build();
    const std::vector<uint8_t> bytes = glb.finish();
    const std::filesystem::path path = folder / model.file;
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) {
      std::cerr << "generate-samples: cannot write " << path.string() << '\n';
      return 1;
    }
    const Counts counts = countOf(glb.json);
    std::cout << "| `" << model.file << "` | " << model.shows << " | " << counts.vertices << " | "
              << counts.triangles << " | " << bytes.size() << " |\n";
  }
  return 0;
}

}  // namespace
}  // namespace mcc::samples

int main(int argc, char** argv) {
  using namespace mcc::samples;
  using Models = std::span<const Model> (*)();
  const std::map<std::string_view, Models> kinds = {
      {"--bench", benchModels}, {"--soups", soupModels}, {"--large", largeModels}};
  const std::string_view option = argc == 3 ? argv[1] : "";
  const char* const folder = argc == 3 ? argv[2] : "-";
  const bool is_city = option == "--city" || option == "--city-large";
  if (argc != 3 || (!is_city && !kinds.contains(option)) || folder[0] == '-') {
    std::fputs("usage: generate-samples --bench|--soups|--large|--city|--city-large DIR\n", stderr);
    return 2;
  }
  try {
    if (!is_city) return run(folder, kinds.at(option)());
    writeCity(folder, option == "--city" ? smallCity() : largeCity());
    return 0;
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "generate-samples: %s\n", exception.what());
    return 1;
  }
}
