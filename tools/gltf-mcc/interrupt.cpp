// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

namespace mcc::tool {

gltf::TemporaryFiles& temporaryFiles() {
  // Never destroyed, because what handles the end of the process may still be waiting for it after
  // main() has returned.
  static auto* const files = new gltf::TemporaryFiles();
  return *files;
}

}  // namespace mcc::tool
