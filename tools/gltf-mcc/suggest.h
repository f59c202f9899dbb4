// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// "Did you mean …?"
#ifndef MCC_TOOL_SUGGEST_H_
#define MCC_TOOL_SUGGEST_H_

#include <string>
#include <string_view>
#include <vector>

namespace mcc::tool {

/// What a mistyped word may have been meant to be: the candidate that differs by the fewest letters (changed, missing,
/// too many, or two of them exchanged), if those are few, or begins with the word; or empty.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// "; did you mean WORD?", or empty when nothing is near.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// The same for a file that does not exist: among the files of its folder, above all one of the same name with an
/// extension of glTF.
std::string didYouMeanFile(const std::string& path);

}  // namespace mcc::tool

#endif  // MCC_TOOL_SUGGEST_H_
