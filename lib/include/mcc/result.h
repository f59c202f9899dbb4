// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_RESULT_H_
#define MCC_RESULT_H_

#include <string>

namespace mcc::gltf {

/// Result of every fallible call of mcc/glb.h and mcc/files.h: `what` is empty on success.
struct [[nodiscard]] Result {
  std::string where;  ///< JSON path ("/meshes/0/primitives/2"), "byte 20", a file name, or empty
  std::string what;   ///< what is wrong and, where that helps, what to do; one line, no full stop

  /// Whether the call succeeded.
  bool ok() const { return what.empty(); }
  /// "where: what", or only one of them when the other is empty.
  std::string message() const {
    if (where.empty()) return what;
    return what.empty() ? where : where + ": " + what;
  }
};

}  // namespace mcc::gltf

#endif  // MCC_RESULT_H_
