// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TESTS_SUPPORT_MADE_FILES_H_
#define MCC_TESTS_SUPPORT_MADE_FILES_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace mcc::test {

/// Returns the name of the buffer of x.gltf (`end` is ".bin") or of a fallback (".fallback.bin"),
/// which is x.0123456789abcdef.bin with other digits. Expects that there is one.
inline std::string madeBeside(const std::filesystem::path& folder, const std::string& stem,
                              const std::string& end = ".bin") {
  constexpr size_t kDigits = 16;
  std::string found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_made =
        name.size() == stem.size() + 1 + kDigits + end.size() && name.starts_with(stem + ".") &&
        name.ends_with(end) &&
        name.substr(stem.size() + 1, kDigits).find_first_not_of("0123456789abcdef") ==
            std::string::npos;
    if (!is_made) continue;
    EXPECT_EQ(found, "") << "beside " << name;
    found = name;
  }
  EXPECT_NE(found, "") << "no " << stem << ".*" << end << " in " << folder;
  return found;
}

}  // namespace mcc::test

#endif  // MCC_TESTS_SUPPORT_MADE_FILES_H_
