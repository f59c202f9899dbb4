// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Khronos' glTF validator, which npm brings.
#ifndef MCC_TESTS_SUPPORT_VALIDATOR_H_
#define MCC_TESTS_SUPPORT_VALIDATOR_H_

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace mcc::test {

inline bool hasNode() { return std::system("node --version >/dev/null 2>&1") == 0; }

/// Collects files and has the validator look at all of them at once.
class Validator {
 public:
  explicit Validator(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Why there is no validator; empty when there is.
  static std::string whyNot() {
    if (!std::filesystem::exists(module())) return "no gltf-validator in tests/web/node_modules";
    return hasNode() ? "" : "no node";
  }

  void add(const std::filesystem::path& source, const std::filesystem::path& converted,
           const std::filesystem::path& decoded) {
    std::ofstream(folder_ / "list", std::ios::app) << source.string() << "\n"
                                                   << converted.string() << "\n"
                                                   << decoded.string() << "\n";
  }

  /// The same with files in memory; `name` is unique.
  void add(const std::string& name, const std::vector<uint8_t>& source,
           const std::vector<uint8_t>& converted, const std::vector<uint8_t>& decoded) {
    add(write(name + "_source", source), write(name + "_converted", converted),
        write(name + "_decoded", decoded));
  }

  /// Returns true when no file has an error, warning, info or hint that its source does not have,
  /// except for those the extension is expected to cause; prints all others. Sources that are full
  /// of errors are `odd`: then more of the same are expected.
  bool run(bool odd = false) const {
    const std::string command = std::string("node '") + MCC_SOURCE_DIR +
                                "/tests/support/validate.mjs' '" + module().string() + "' '" +
                                (folder_ / "list").string() + (odd ? "' --odd" : "'");
    return std::system(command.c_str()) == 0;
  }

 private:
  static std::filesystem::path module() {
    return std::filesystem::path(MCC_SOURCE_DIR) / "tests/web/node_modules/gltf-validator";
  }

  std::filesystem::path write(const std::string& name, const std::vector<uint8_t>& bytes) const {
    const std::filesystem::path path = folder_ / (name + ".glb");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return path;
  }

  std::filesystem::path folder_;
};

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_VALIDATOR_H_
