// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compares a written document with its source, apart from what was compressed: the JSON side by
// side, and the bytes, each once, however many ranges it belongs to.
#ifndef MCC_GLTF_CHECK_COMPARE_H_
#define MCC_GLTF_CHECK_COMPARE_H_

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "gltf/document/document.h"
#include "gltf/document/extension_uses.h"
#include "gltf/document/layout.h"

namespace mcc::gltf {

/// Pairs of ranges that should have the same bytes. The documents must outlive it.
class SameBytes {
 public:
  SameBytes(const Document& source, const Document& result) : source_(source), result_(result) {}

  /// Adds a pair, of a part of the documents that has this number. Ranges of different lengths
  /// differ.
  void add(const ByteRange& in_source, const ByteRange& in_result, size_t number);
  /// Returns the smallest number of a pair that differs, or kNothing. Takes time proportional to
  /// the bytes of the documents and the number of pairs, up to a logarithm.
  size_t firstDifference();

  static constexpr size_t kNothing = ~size_t{0};

 private:
  struct Pair {
    ByteRange in_source;
    uint32_t result_buffer = 0;
    uint64_t result_begin = 0;
    size_t number = 0;
  };

  const Document& source_;
  const Document& result_;
  std::vector<Pair> pairs_;
  size_t first_ = kNothing;
};

/// Returns the JSON path of the first difference, or an empty string. The root itself is "/".
/// Members of objects may come in any order.
std::string firstDifference(const Json& a, const Json& b);

/// Compares everything that does not belong to the compressed primitives in `uses`: the JSON, the
/// bytes of the other accessors and of the images, and, where no views were renumbered, all views.
/// The documents are walked side by side and nothing is copied. The bytes of `reordered` accessors
/// are compared elsewhere.
Result compareRest(const Document& source, const Document& written,
                   const std::vector<ExtensionUse>& uses, const std::set<uint32_t>& reordered);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_CHECK_COMPARE_H_
