// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs a fuzz target over files, without a fuzzer: FILE or FOLDER...
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/byte_feed.h"

namespace {

void replay(const std::filesystem::path& path) {
  std::fprintf(stderr, "%s\n", path.string().c_str());  // the last one is the find
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  const std::vector<uint8_t> input(bytes.begin(), bytes.end());
  LLVMFuzzerTestOneInput(input.data(), input.size());
}

}  // namespace

int main(int argc, char** argv) {
  size_t count = 0;
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path path(argv[i]);
    if (!std::filesystem::is_directory(path)) {
      if (std::filesystem::exists(path)) replay(path), ++count;
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
      if (entry.is_regular_file()) replay(entry.path()), ++count;
    }
  }
  std::printf("%zu inputs, nothing found\n", count);
  return count == 0 ? 1 : 0;
}
