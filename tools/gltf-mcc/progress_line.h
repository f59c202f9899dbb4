// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_PROGRESS_LINE_H_
#define MCC_TOOL_PROGRESS_LINE_H_

#include <unistd.h>

#include <cstdio>
#include <string>

namespace mcc::tool {

/// One line on standard error that says what is going on; nothing where that is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_quiet) : is_shown_(!is_quiet && isatty(STDERR_FILENO) == 1) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& text) const {
    if (is_shown_) std::fprintf(stderr, "\r\033[K%.78s", text.c_str());
  }
  void clear() const {
    if (is_shown_) std::fputs("\r\033[K", stderr);
  }

 private:
  bool is_shown_;
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_PROGRESS_LINE_H_
