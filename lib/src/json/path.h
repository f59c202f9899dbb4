// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_JSON_PATH_H_
#define MCC_JSON_PATH_H_

#include <cstdint>
#include <string>

namespace mcc::gltf {

/// Returns the JSON pointer to an element: at("/accessors", 3) is "/accessors/3".
inline std::string at(const std::string& path, uint64_t index) {
  return path + "/" + std::to_string(index);
}
inline std::string at(const std::string& path, const std::string& key) {
  std::string escaped;  // RFC 6901
  for (const char c : key) {
    if (c == '~' || c == '/') {
      escaped += c == '~' ? "~0" : "~1";
    } else {
      escaped += c;
    }
  }
  return path + "/" + escaped;
}

}  // namespace mcc::gltf

#endif  // MCC_JSON_PATH_H_
