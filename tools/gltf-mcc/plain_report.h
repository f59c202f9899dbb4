// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_PLAIN_REPORT_H_
#define MCC_TOOL_PLAIN_REPORT_H_

#include <string>

#include "gltf/document/document.h"
#include "gltf/document/package.h"
#include "mcc/files.h"
#include "table.h"

namespace mcc::tool {

/// Loads a file that has no payloads and says what is in it: a table of its bytes by what they are
/// for, and what `convert` would do. `name` is what the user called it.
gltf::Result plainReport(const std::string& name, const gltf::Source& source, Format format,
                         std::string& text);

}  // namespace mcc::tool

#endif  // MCC_TOOL_PLAIN_REPORT_H_
