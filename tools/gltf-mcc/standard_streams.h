// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Handles "-" in place of a file.
#ifndef MCC_TOOL_STANDARD_STREAMS_H_
#define MCC_TOOL_STANDARD_STREAMS_H_

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/api/convert.h"
#include "whole_sizes.h"

namespace mcc::tool {

inline bool isStandardStream(const std::string& name) { return name == "-"; }

/// Writes to standard output, and makes sure that it arrives. Everything that the program prints
/// there goes through this.
/// Errors: it is closed, or what it leads to is full or broken.
gltf::Result writeStandardOutput(std::span<const uint8_t> bytes);

/// Whether an output of this name is standard output: "-", /dev/stdout, or a link to it.
bool isStandardOutput(const std::string& name);

/// An input file, or standard input when its name is "-".
class StreamSource {
 public:
  /// Opens the source. Standard input and pipes are read into memory, as far as gltf::readStream()
  /// says. Errors: standard input is a terminal; those of readStream().
  gltf::Result open(const std::string& name);
  /// Reads a file, too, for those who need its bytes more than once. Errors: those of readFile().
  gltf::Result read();
  /// Valid as long as this object.
  gltf::Source source() const;

 private:
  std::string name_;
  std::optional<std::vector<uint8_t>> bytes_;
  bool is_file_ = false;  ///< that was read
};

/// An output: a file, standard output when its name is "-", or a device or pipe.
class StreamSink {
 public:
  /// Opens the sink. Errors: standard output is a terminal; a .gltf would go to something that is
  /// not a file, although it needs its buffer next to it.
  gltf::Result open(const std::string& name);
  gltf::ListedSink sink();  ///< its temporary files are removed when a signal ends the program
  /// Measures what a stream received, or else `files`.
  WholeSize measure(const std::vector<std::filesystem::path>& files) const;
  /// Writes what was received to the stream. Does nothing for a file.
  gltf::Result finish() const;
  bool isStandardOutput() const { return is_standard_output_; }

 private:
  std::string name_;
  std::vector<uint8_t> bytes_;
  bool is_standard_output_ = false;
  bool is_stream_ = false;  ///< standard output, a device or a pipe
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_STANDARD_STREAMS_H_
