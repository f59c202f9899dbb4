// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "whole_sizes.h"

#include <fmt/format.h>

#if defined(MCC_HAS_FOREIGN)
#include "foreign/brotli_codec.h"
#endif
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "host/text.h"
#include "json/json.h"

namespace mcc::tool {
bool canMeasureWhole() {
#if defined(MCC_HAS_FOREIGN)
  return true;
#else
  return false;
#endif
}

void WholeSize::add(std::span<const uint8_t> file) {
  bytes += file.size();
#if defined(MCC_HAS_FOREIGN)
  brotli_bytes += foreign::brotliBytes(file, kBrotliQuality);
#endif
}

void WholeSize::addFiles(std::span<const std::filesystem::path> paths) {
  for (const std::filesystem::path& path : paths) {
    std::vector<uint8_t> file;
    if (gltf::readFile(path, file).ok()) add(file);
  }
}

std::vector<std::vector<uint8_t>> readFilesBeside(const std::filesystem::path& main,
                                                  std::span<const uint8_t> main_bytes,
                                                  bool with_images) {
  std::vector<std::vector<uint8_t>> files;
  gltf::Json json;
  if (!gltf::readJson(main_bytes, json).ok()) return files;
  // The document chooses these names, which may be those of pipes and devices.
  const gltf::FileReader reader = gltf::readerOf(gltf::folderOf(main));
  for (const std::string& path :
       with_images ? gltf::filesBeside(json) : gltf::filesOf(json, "buffers")) {
    std::vector<uint8_t> bytes;
    if (reader(path, "", bytes).ok()) files.push_back(std::move(bytes));
  }
  return files;
}

std::string wholeSizesText(const std::vector<WholeSize>& sizes, Format format) {
  Table table({"whole file", "bytes", fmt::format("after brotli {}", kBrotliQuality)});
  for (const WholeSize& size : sizes) {
    table.addRow({size.name, count(size.bytes, format), count(size.brotli_bytes, format)});
  }
  return table.print(format);
}

gltf::Json wholeSizesJson(const std::vector<WholeSize>& sizes) {
  gltf::Json json = {{"brotli_quality", kBrotliQuality}};
  for (const WholeSize& size : sizes) {
    json[size.name] = {{"bytes", size.bytes}, {"brotli_bytes", size.brotli_bytes}};
  }
  return json;
}

}  // namespace mcc::tool
