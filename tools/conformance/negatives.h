// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Files that a decoder must refuse.
#ifndef MCC_TOOLS_CONFORMANCE_NEGATIVES_H_
#define MCC_TOOLS_CONFORMANCE_NEGATIVES_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "asset.h"

namespace mcc::conformance {

struct Negative {
  std::string name;
  std::string shows;    ///< one sentence
  std::string section;  ///< section of the specification
  uint32_t error = 0;   ///< A.1.4; 0: the document is wrong, not the payload
  std::vector<uint8_t> glb;
};

/// A document that contradicts the specification, though loaders may show it.
struct Invalid {
  std::string name;
  std::string shows;  ///< one sentence
  std::string rule;   ///< of the list "Validators also report"
  std::string code;   ///< one of those that validate() reports
  std::vector<uint8_t> glb;
};

/// Makes negative files from valid assets, and from `all` those that a search has found. Throws if
/// one of them decodes, or fails for another reason than it should.
std::vector<Negative> makeNegatives(std::span<const Asset> assets, std::span<const Asset> all);

/// The same for files that a validator reports. Throws if validate() does not.
std::vector<Invalid> makeInvalid(std::span<const Asset> assets);

}  // namespace mcc::conformance

#endif  // MCC_TOOLS_CONFORMANCE_NEGATIVES_H_
