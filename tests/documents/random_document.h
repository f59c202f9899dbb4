// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Random glTF documents with everything that users' files have: all containers, layouts, types and
// kinds of geometry, and odd JSON.
#ifndef MCC_TESTS_DOCUMENTS_RANDOM_DOCUMENT_H_
#define MCC_TESTS_DOCUMENTS_RANDOM_DOCUMENT_H_

#include <cstdint>
#include <string>

#include "mcc/glb.h"
#include "support/document_compare.h"

namespace mcc::gltf::test {

/// A document and how to convert it.
struct RandomDocument {
  Files files;
  std::string main;  ///< the name of the .glb or .gltf in `files`
  /// Something in it may be refused with a message: it contradicts itself, in a way that users'
  /// files do.
  bool may_be_refused = false;
  KeptNumbers kept;  ///< unknown extensions name them
  ConvertOptions options;
  bool writes_gltf = false;  ///< the output is a .gltf, else a .glb
  bool to_memory = false;    ///< the output is a GLB in memory; else a file
};

/// The same seed makes the same document. Deterministic on every machine.
RandomDocument randomDocument(uint64_t seed);

/// Damages a file as transport or tools may: a byte changes, bytes are lost, a number of the JSON
/// is replaced, and the like. Deterministic in its arguments.
void damage(uint64_t seed, RandomDocument& document);
void damageGlb(uint64_t seed, Bytes& glb);

/// Describes the options for messages.
std::string describe(const ConvertOptions& options);

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_DOCUMENTS_RANDOM_DOCUMENT_H_
