// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_PROGRESS_LINE_H_
#define MCC_TOOL_PROGRESS_LINE_H_

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace mcc::tool {

/// One line on standard error that says what is going on; nothing where that is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_quiet);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool isShown() const { return is_shown_; }
  void show(const std::string& text) const;
  void clear() const;

 private:
  const bool is_shown_;
  mutable bool has_text_ = false;  ///< on the terminal
};

/// A ProgressLine for one task, from its second second on: how long it takes and, when told, how far it is.
class WorkProgress {
 public:
  WorkProgress(bool is_quiet, std::string task);
  ~WorkProgress();  ///< the line goes
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// From any thread. share: 0 to 1 of the whole; less than 0: not known.
  void tell(const std::string& stage, double share);

 private:
  void watch();

  const ProgressLine line_;
  const std::string task_;
  std::mutex mutex_;  ///< over all below
  std::condition_variable ending_;
  std::string stage_;
  double share_ = -1;
  bool is_ending_ = false;
  std::thread watcher_;  ///< only where the line is shown
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_PROGRESS_LINE_H_
