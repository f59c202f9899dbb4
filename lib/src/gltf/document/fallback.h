// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// Adds uncompressed data next to the payloads, for loaders that do not know the extension: the
// compressed accessors refer to buffer views of a second buffer, which loaders that know the
// extension never read.
#ifndef MCC_GLTF_DOCUMENT_FALLBACK_H_
#define MCC_GLTF_DOCUMENT_FALLBACK_H_

#include <cstddef>

#include "json/json.h"

namespace mcc::gltf {

/// Removes a fallback from a document whose buffer `number` does not exist. Returns false, and
/// changes nothing, when anything but compressed accessors may need that buffer.
bool removeFallback(size_t number, Json& json);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_FALLBACK_H_
