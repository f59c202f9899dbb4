// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "progress_line.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <system_error>

#include "console.h"
#include "host/text.h"
#include "terminal.h"

namespace mcc::tool {

ProgressLine::ProgressLine(bool is_quiet) : is_shown_(!is_quiet && isTerminal(kStandardErrors)) {}

void ProgressLine::show(const std::string& text) const {
  if (!is_shown_) return;
  const std::string clean = gltf::printable(text);
  const std::string_view fitting = cutToWidth(clean, columnsOfErrors() - 1);
  fmt::print(stderr, "\r\033[K{}", fitting);
  has_text_ = true;
}

void ProgressLine::clear() const {
  if (has_text_) std::fputs("\r\033[K", stderr);
  has_text_ = false;
}

WorkProgress::WorkProgress(bool is_quiet, std::string task)
    : line_(is_quiet), task_(std::move(task)) {
  if (!line_.isShown()) return;
  try {
    watcher_ = std::thread([this]() { watch(); });
  } catch (const std::system_error&) {  // without the thread, no progress is shown
  }
}

WorkProgress::~WorkProgress() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ending_.notify_all();
  if (watcher_.joinable()) watcher_.join();
}

void WorkProgress::tell(const std::string& stage, double share) {
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  share_ = share;
}

void WorkProgress::watch() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kSilence(1000);
  constexpr std::chrono::milliseconds kInterval(250);
  const Clock::time_point begin = Clock::now();
  std::unique_lock lock(mutex_);
  std::chrono::milliseconds wait = kSilence;
  while (!ending_.wait_for(lock, wait, [this]() { return is_ending_; })) {
    wait = kInterval;
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - begin);
    std::string text = task_ + (stage_.empty() ? "" : ": " + stage_);
    if (share_ >= 0) text += fmt::format(", {:.0f} %", 100 * share_);
    line_.show(fmt::format("{}, {} s", text, seconds.count()));
  }
}

}  // namespace mcc::tool
