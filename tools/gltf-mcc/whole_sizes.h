// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures whole files, also as a web server sends them: compressed with brotli.
#ifndef MCC_TOOL_WHOLE_SIZES_H_
#define MCC_TOOL_WHOLE_SIZES_H_

#include <cstdint>
#include <filesystem>
#include <future>
#include <span>
#include <string>
#include <vector>

#include "json/json.h"
#include "table.h"

namespace mcc::tool {

/// The level that servers use when they compress on the fly; higher levels take longer than the
/// conversion.
inline constexpr int kBrotliQuality = 5;

struct WholeSize {
  std::string name;  ///< "input", "output", "draco"
  uint64_t bytes = 0;
  uint64_t brotli_bytes = 0;  ///< sum over the files, each compressed on its own

  void add(std::span<const uint8_t> file);
  /// Adds files, of which it holds one at a time. What does not exist is left out.
  void addFiles(std::span<const std::filesystem::path> paths);
};

/// Reads what is next to the main file of a document: its buffers and, if `with_images`, its
/// images. What does not exist, or is not a regular file, is left out.
std::vector<std::vector<uint8_t>> readFilesBeside(const std::filesystem::path& main,
                                                  std::span<const uint8_t> main_bytes,
                                                  bool with_images);

/// Whether whole files can be measured, which a build without other codecs cannot do.
bool canMeasureWhole();

/// With several threads, measures at the same time as other work; else when the result is needed.
inline std::launch launchPolicy(uint32_t thread_count) {
  return thread_count > 1 ? std::launch::async : std::launch::deferred;
}

/// Returns a table for kPretty and kMarkdown.
std::string wholeSizesText(const std::vector<WholeSize>& sizes, Format format);

/// Returns {"brotli_quality", "input": {"bytes", "brotli_bytes"}, …}.
gltf::Json wholeSizesJson(const std::vector<WholeSize>& sizes);

}  // namespace mcc::tool

#endif  // MCC_TOOL_WHOLE_SIZES_H_
