// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// "-" in the place of a file.
#ifndef MCC_TOOL_STANDARD_STREAMS_H_
#define MCC_TOOL_STANDARD_STREAMS_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mcc/gltf.h"
#include "whole_sizes.h"

namespace mcc::tool {

inline bool isStandardStream(const std::string& name) { return name == "-"; }

/// Whether an output of this name is standard output: "-", /dev/stdout, or a link to that.
bool isStandardOutput(const std::string& name);

/// A file, or standard input when it is called "-".
class StreamSource {
 public:
  /// Reads standard input, or a pipe, if it is that, as far as gltf::readStream() says. Errors: it is a terminal; those
  /// of readStream().
  gltf::Result open(const std::string& name);
  /// Valid as long as this object.
  gltf::Source source() const;
  /// What was read, or the contents of these files when it is no stream.
  FileContents contents(const std::vector<std::filesystem::path>& files) const;

 private:
  std::string name_;
  std::optional<std::vector<uint8_t>> bytes_;
};

/// A file, standard output when it is called "-", or a device or a pipe.
class StreamSink {
 public:
  /// Errors: standard output is a terminal; what is no file is to become a .gltf, which has its buffer beside it.
  gltf::Result open(const std::string& name);
  gltf::Sink sink();  ///< its temporary files are cleared away on interrupts
  /// What was received, or the contents of these files when it is no stream.
  FileContents contents(const std::vector<std::filesystem::path>& files) const;
  /// Sends what was received on, if it is no file.
  gltf::Result finish() const;
  bool isStandardOutput() const { return is_standard_output_; }

 private:
  std::string name_;
  std::vector<uint8_t> bytes_;
  bool is_standard_output_ = false;
  bool is_stream_ = false;  ///< standard output or another
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_STANDARD_STREAMS_H_
