// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(_WIN32)
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include "console.h"
#include "interrupt.h"

namespace mcc::tool {
namespace {

/// Called by a thread of the system when the user presses Ctrl-C, closes the console, logs off or
/// shuts down.
BOOL WINAPI removeAndEnd(DWORD) {
  // Held until the process ends, so that no other file appears. Never destroyed, for that reason.
  static const auto* const held = new gltf::TemporaryFiles::Lock(temporaryFiles().removeAll());
  static_cast<void>(held);
  restoreConsole();
  ::ExitProcess(STATUS_CONTROL_C_EXIT);
}

}  // namespace

void removeTemporariesOnSignals() {
  (void)temporaryFiles();
  ::SetConsoleCtrlHandler(removeAndEnd, TRUE);
}

}  // namespace mcc::tool
#endif
