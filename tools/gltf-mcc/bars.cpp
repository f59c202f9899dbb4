// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bars.h"

#include <algorithm>
#include <cstddef>

#include "console.h"
#include "terminal.h"

namespace mcc::tool {

std::string barOf(double share) {
  constexpr size_t kColumns = 32;  // length of the longest bar
  constexpr size_t kParts = 8;
  constexpr const char* kEighths[kParts] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const bool has_blocks = hasUtf8();
  const size_t parts = has_blocks ? kParts : 1;
  const double whole = std::clamp(share, 0., 1.) * static_cast<double>(kColumns * parts);
  size_t length = static_cast<size_t>(whole + 0.5);
  if (length == 0 && share > 0) length = has_blocks ? 1 : 0;  // a small share stays visible
  std::string bar;
  for (size_t i = 0; i < length / parts; ++i) bar += has_blocks ? "█" : "#";
  if (has_blocks) bar += kEighths[length % parts];
  return styleOfOutput().bar(bar);
}

}  // namespace mcc::tool
