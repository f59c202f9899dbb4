// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_WEB_CODED_VIEWS_H_
#define MCC_WEB_CODED_VIEWS_H_

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "gltf/document/document.h"
#include "mcc/glb.h"

namespace mcc::web {

/// The buffer views of a source that meshoptimizer compressed and that its triangles need. This
/// module has no decoder for them: it lists them, JavaScript fills in their elements, and
/// elementsOf() then stands for a decoder.
class CodedViews {
 public:
  /// Loads `file`, which must outlive this object, and makes room for the elements. Safe for
  /// untrusted bytes. Errors, with JSON paths: the document is damaged; an extension object names
  /// bytes that are not there, states another size than its view has, or claims far more elements
  /// than its bytes can hold; all elements together exceed decodedLimit().
  gltf::Result find(std::span<const uint8_t> file);

  /// Returns an array with an object for each view: `path` of its extension object, `address` and
  /// `length` of its bytes in this module's memory, `elements`, the address for its count * stride
  /// bytes of elements, `count`, `stride` in bytes, `mode` and `filter`.
  gltf::Json list() const;

  /// Has the form of ForeignDecoders::view. Finds the elements of a view by its bytes and the way
  /// they are coded. Fails for a view that find() has not met.
  gltf::Result elementsOf(const gltf::CodedView& view, std::vector<uint8_t>& elements) const;

 private:
  /// What the elements of a view depend on: count, stride, mode, filter and the bytes.
  using Key = std::tuple<uint64_t, uint32_t, std::string, std::string, std::string_view>;
  static Key keyOf(const gltf::CodedView& view);

  gltf::Document document_;          ///< owns the elements, see ViewCoding::decoded
  std::vector<uint32_t> views_;      ///< numbers of buffer views, those alike once
  std::map<Key, uint32_t> numbers_;  ///< the same by their keys
};

}  // namespace mcc::web

#endif  // MCC_WEB_CODED_VIEWS_H_
