// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_CHECK_CHECK_JSON_H_
#define MCC_GLTF_CHECK_CHECK_JSON_H_

#include <set>
#include <string>
#include <vector>

#include "gltf/document/document.h"
#include "gltf/document/extension_json.h"

namespace mcc::gltf {

/// Whether two values are equal. Members of objects may come in any order.
bool equalJson(const Json& a, const Json& b);

/// Returns the JSON path of the first difference, or an empty string. The root itself is "/".
std::string firstDifference(const Json& a, const Json& b);

/// Compares everything that does not belong to the compressed primitives in `uses`: the JSON, the
/// bytes of the other accessors and of the images, and, where no views were renumbered, all views.
/// The documents are walked side by side and nothing is copied. The bytes of `reordered` accessors
/// are compared elsewhere.
Result compareRest(const Document& source, const Document& written,
                   const std::vector<ExtensionUse>& uses, const std::set<uint32_t>& reordered);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CHECK_CHECK_JSON_H_
