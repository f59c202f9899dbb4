// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_BASE_PRINTABLE_H_
#define MCC_GLTF_BASE_PRINTABLE_H_

#include <string>
#include <string_view>

#include "mcc/result.h"

namespace mcc::gltf {

/// Makes a text that may come from a file, or from a file's name, safe for one line of a terminal:
/// control characters (C0, DEL, C1), line and paragraph separators, marks that change the direction
/// of writing, and bytes that are not UTF-8 become '?'. Other characters stay. Linear in the
/// length.
std::string printable(std::string_view text);

/// Does the same for both parts of a result.
Result printable(Result result);

/// Whether every byte of a text belongs to a character of UTF-8. Linear in the length.
bool isUtf8(std::string_view text);

/// Returns at most `max_bytes` bytes of a text, cut between two characters and marked with "…".
std::string shortened(const std::string& text, size_t max_bytes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_BASE_PRINTABLE_H_
