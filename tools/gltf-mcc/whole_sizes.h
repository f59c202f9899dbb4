// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Sizes of whole files, also as a web server sends them: compressed with brotli.
#ifndef MCC_TOOL_WHOLE_SIZES_H_
#define MCC_TOOL_WHOLE_SIZES_H_

#include <cstdint>
#include <filesystem>
#include <future>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "table.h"

namespace mcc::tool {

/// What servers use when they compress while they send; stronger levels take longer than converting.
inline constexpr int kBrotliQuality = 5;

struct WholeSize {
  std::string name;  ///< "input", "output", "draco"
  uint64_t bytes = 0;
  uint64_t brotli_bytes = 0;  ///< the files one by one
};

using FileContents = std::vector<std::vector<uint8_t>>;

/// The files of a document: the main one, its buffers and, when asked, its images. What is not there
/// is left out.
FileContents readDocumentFiles(const std::filesystem::path& main, bool with_images);
FileContents readFiles(const std::vector<std::filesystem::path>& paths);

/// False in a build without other codecs.
bool canMeasureWhole();

/// Beside other work when there is more than one thread, else when the result is asked for.
inline std::launch launchPolicy(uint32_t thread_count) {
  return thread_count > 1 ? std::launch::async : std::launch::deferred;
}

/// Size of the files, as they are and compressed one by one.
WholeSize measureWhole(std::string name, const FileContents& files);

/// A table in kPretty and kMarkdown.
std::string wholeSizesText(const std::vector<WholeSize>& sizes, Format format);

/// {"brotli_quality", "input": {"bytes", "brotli_bytes"}, …}
nlohmann::ordered_json wholeSizesJson(const std::vector<WholeSize>& sizes);

}  // namespace mcc::tool

#endif  // MCC_TOOL_WHOLE_SIZES_H_
