// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Ctrl-C and other signals that end the program.
#ifndef MCC_TOOL_INTERRUPT_H_
#define MCC_TOOL_INTERRUPT_H_

#include "gltf/temporary_files.h"

namespace mcc::tool {

/// Those of this process: removed when a signal ends it.
gltf::TemporaryFiles& temporaryFiles();

/// From here on every signal that ends a program and can be caught removes the temporary files before it ends the process,
/// which still ends by that signal: those from outside (SIGINT, SIGTERM, SIGUSR1 …) and those that the program causes
/// (SIGPIPE, SIGXFSZ, SIGSEGV …). Called once, before there are other threads. A signal that the program was started to
/// ignore stays ignored.
void removeTemporariesOnSignals();

}  // namespace mcc::tool

#endif  // MCC_TOOL_INTERRUPT_H_
