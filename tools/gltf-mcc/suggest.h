// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Suggests words: "Did you mean …?", and what to do with files of other formats.
#ifndef MCC_TOOL_SUGGEST_H_
#define MCC_TOOL_SUGGEST_H_

#include <string>
#include <string_view>
#include <vector>

namespace mcc::tool {

/// Returns what a mistyped word may have been meant to be, or an empty string. This is the
/// candidate that differs from it by the fewest letters (changed, missing, added, or two of them
/// exchanged) if those are few, or else one that begins with the word.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// Returns "; did you mean WORD?", or an empty string when no candidate is similar.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// Like didYouMean(), for a file that does not exist. Looks among the files of its folder, and
/// prefers one of the same name with an extension of glTF.
std::string didYouMeanFile(const std::string& path);

/// Returns a word as one can type it into a shell: in quotes if it needs them.
std::string shellWord(const std::string& word);

/// Whether the extension is that of glTF files.
bool isModelName(const std::string& path);

/// Whether the extension is that of models in another format.
bool isOtherFormat(const std::string& path);

/// Returns "; …" with a way to turn a file of another format into a glTF file, or an empty string
/// when the extension is that of no such format.
std::string howToReadOther(const std::string& path);

}  // namespace mcc::tool

#endif  // MCC_TOOL_SUGGEST_H_
