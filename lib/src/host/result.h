// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_HOST_RESULT_H_
#define MCC_HOST_RESULT_H_

#include <string>
#include <utility>

#include "json/spelling.h"
#include "mcc/result.h"

namespace mcc::gltf {

/// Returns texts and numbers one after another.
template <typename... Parts>
std::string sentence(const Parts&... parts) {
  const auto textOf = [](const auto& part) {
    if constexpr (requires { std::to_string(part); }) {
      return std::to_string(part);
    } else {
      return std::string(part);
    }
  };
  return (std::string() + ... + textOf(parts));
}

/// Returns an error at a place. What is wrong may be given in parts, see sentence().
template <typename... Parts>
Result error(std::string where, const Parts&... what) {
  return Result{std::move(where), sentence(what...)};
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

#endif  // MCC_HOST_RESULT_H_
