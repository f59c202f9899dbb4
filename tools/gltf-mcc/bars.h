// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_BARS_H_
#define MCC_TOOL_BARS_H_

#include <string>

namespace mcc::tool {

/// Returns a bar for standard output, in blocks of eighths of a column, or in ASCII where the
/// locale has no such characters.
/// share  length of the bar, as a fraction from 0 to 1 of the longest one.
std::string barOf(double share);

}  // namespace mcc::tool

#endif  // MCC_TOOL_BARS_H_
