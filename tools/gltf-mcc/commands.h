// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_COMMANDS_H_
#define MCC_TOOL_COMMANDS_H_

#include <string>

#include "mcc/glb.h"
#include "options.h"
#include "table.h"

namespace mcc::tool {

/// Exit statuses of the tool.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;  ///< the input is bad or the check failed; nothing was written
inline constexpr int kUsage = 2;

/// Options that all commands have in common.
struct CommonOptions {
  Format format = Format::kPretty;
  bool is_quiet = false;
  bool is_verbose = false;

  /// Whether tables are printed, and not only what everybody wants to know.
  bool hasTables() const { return is_verbose || format == Format::kMarkdown; }
};

/// Each of these adds a command.
void addConvert(Program& program);
void addDecode(Program& program);
void addInspect(Program& program);
void addValidate(Program& program);

/// Adds --color, which colorModeOf() reads.
void addColorOption(Command& command);

/// These add the options that set CommonOptions.
void addFormatOption(Command& command, CommonOptions& options);
void addVerbosityOptions(Command& command, CommonOptions& options);

/// Adds -j.
void addThreadCount(Command& command, uint32_t& count, const char* help);

/// Adds the option for the bits of each attribute.
void addAttributeBits(Command& command, gltf::ConvertOptions& options);

/// Adds --prefer.
void addPreference(Command& command, gltf::ConvertOptions& options);

/// Adds the options for bits, --lossless, --grid and --prefer.
void addQuantization(Command& command, gltf::ConvertOptions& options);

/// Adds --glb-version.
void addGlbVersionOption(Command& command, gltf::GlbVersion& version);

/// Adds --max-decoded-bytes, see decodedLimit().
void addDecodedLimitOption(Command& command, uint64_t& max_decoded_bytes);

/// Prints "gltf-mcc: FILE: where: what" on standard error; returns kFailed.
int reportFailure(const gltf::Result& result);

/// Like the above, for work on one file. Adds advice where there is some: similar names of files
/// when the input does not exist, and how to write into a folder.
int reportFailure(const gltf::Result& result, const std::string& input, const std::string& output);

/// Prints on standard output; returns kFailed when that does not work.
int printOut(const std::string& text);

}  // namespace mcc::tool

#endif  // MCC_TOOL_COMMANDS_H_
