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
};

using FileContents = std::vector<std::vector<uint8_t>>;

/// Reads the files of a document: the main one, its buffers and, if `with_images`, its images.
/// What does not exist, or is not a regular file, is left out.
FileContents readDocumentFiles(const std::filesystem::path& main, bool with_images);
FileContents readFiles(const std::vector<std::filesystem::path>& paths);

/// Whether whole files can be measured, which a build without other codecs cannot do.
bool canMeasureWhole();

/// With several threads, measures at the same time as other work; else when the result is needed.
inline std::launch launchPolicy(uint32_t thread_count) {
  return thread_count > 1 ? std::launch::async : std::launch::deferred;
}

/// Measures the size of the files, as they are and each compressed on its own.
WholeSize measureWhole(std::string name, const FileContents& files);

/// Returns a table for kPretty and kMarkdown.
std::string wholeSizesText(const std::vector<WholeSize>& sizes, Format format);

/// Returns {"brotli_quality", "input": {"bytes", "brotli_bytes"}, …}.
gltf::Json wholeSizesJson(const std::vector<WholeSize>& sizes);

}  // namespace mcc::tool

#endif  // MCC_TOOL_WHOLE_SIZES_H_
