// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Handles Ctrl-C and other signals that end the program. interrupt_posix.cpp and
// interrupt_windows.cpp implement removeTemporariesOnSignals().
#ifndef MCC_TOOL_INTERRUPT_H_
#define MCC_TOOL_INTERRUPT_H_

#include "host/temporary_files.h"

namespace mcc::tool {

/// Returns the temporary files of this process, which are removed when a signal ends it.
gltf::TemporaryFiles& temporaryFiles();

/// Makes every signal that ends a program and can be caught remove the temporary files first. This
/// covers signals from outside (SIGINT, SIGTERM, SIGUSR1 …) and those that the program causes
/// itself (SIGPIPE, SIGXFSZ, SIGSEGV …). The process still ends by that signal. Must be called
/// once, before other threads are started. A signal that the program was started to ignore stays
/// ignored. On Windows this covers Ctrl-C, Ctrl-Break, and the end of the console or the session.
void removeTemporariesOnSignals();

}  // namespace mcc::tool

#endif  // MCC_TOOL_INTERRUPT_H_
