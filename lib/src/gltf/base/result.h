// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_BASE_RESULT_H_
#define MCC_GLTF_BASE_RESULT_H_

#include <string>
#include <utility>

#include "mcc/gltf.h"

namespace mcc::gltf {

inline Result error(std::string where, std::string what) {
  return Result{std::move(where), std::move(what)};
}

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

/// Returns the JSON path of a primitive.
inline std::string primitivePath(uint64_t mesh, uint64_t primitive) {
  return at(at("/meshes", mesh) + "/primitives", primitive);
}

}  // namespace mcc::gltf

/// Returns early with the result of `expression` unless it is ok.
#define MCC_GLTF_TRY(expression)                    \
  do {                                              \
    ::mcc::gltf::Result mcc_result_ = (expression); \
    if (!mcc_result_.ok()) return mcc_result_;      \
  } while (false)

#endif  // MCC_GLTF_BASE_RESULT_H_
