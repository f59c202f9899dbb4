// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_PROGRESS_LINE_H_
#define MCC_TOOL_PROGRESS_LINE_H_

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace mcc::tool {

/// One line of progress on standard error. Does nothing where that is not a terminal.
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
  mutable bool has_text_ = false;  ///< whether the terminal shows text
};

/// Shows a ProgressLine for one task after its first second: the time it has taken and, when known,
/// its share of the work.
class WorkProgress {
 public:
  WorkProgress(bool is_quiet, std::string task);
  ~WorkProgress();  ///< clears the line
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// Sets what is shown. May be called from any thread. `share` is 0 to 1, or less than 0 when it
  /// is not known.
  void tell(const std::string& stage, double share);

 private:
  void watch();

  const ProgressLine line_;
  const std::string task_;
  std::mutex mutex_;  ///< guards all members below
  std::condition_variable ending_;
  std::string stage_;
  double share_ = -1;
  bool is_ending_ = false;
  std::thread watcher_;  ///< started only when the line is shown
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_PROGRESS_LINE_H_
