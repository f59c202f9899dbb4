// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads the elements of accessors, however they are stored, and stores them; their bounds.
#ifndef MCC_GLTF_DOCUMENT_ACCESSORS_H_
#define MCC_GLTF_DOCUMENT_ACCESSORS_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/document/document.h"
#include "json/json.h"

namespace mcc::gltf {

/// Elements without padding inside them; `data` points into the document or into `owned`.
struct AccessorData {
  const uint8_t* data = nullptr;
  size_t stride_bytes = 0;
  uint64_t count = 0;
  uint32_t element_bytes = 0;
  std::vector<uint8_t> owned;

  /// Returns elements that follow each other without gaps. Borrows them.
  static AccessorData packed(std::span<const uint8_t> bytes, uint32_t element_bytes) {
    return {bytes.data(), element_bytes, bytes.size() / element_bytes, element_bytes, {}};
  }
  std::span<const uint8_t> element(uint64_t index) const {
    return {data + index * stride_bytes, element_bytes};
  }
  /// Returns the number of the first element that differs from the one of `other`, which has as
  /// many; `count` if none does.
  uint64_t firstDifference(const AccessorData& other) const;
};

/// Returns why the elements of an accessor cannot be read: its type is unknown, or its bytes are
/// coded by an extension and were not decoded. Empty when they can be read.
std::string whyUnreadable(const Document& document, const Accessor& accessor);

/// Reads an accessor: strided, interleaved, sparse, without a view, or a matrix with padded
/// columns. Does not copy when the bytes can be used where they are. Errors carry the path
/// /accessors/N. It is an error when the elements have no bytes in the file and claim more than
/// document.decoded.zeroLimit().
Result readAccessor(const Document& document, uint32_t index, AccessorData& elements);

/// Reads elements that begin at `bytes`, as a buffer view of this stride has them; 0: without gaps
/// between them. Does not copy when they can be used where they are.
void readElements(const Accessor& accessor, const uint8_t* bytes, uint64_t stride_bytes,
                  AccessorData& elements);

/// Reads an accessor of indices. Errors: it is not SCALAR of an unsigned integer type.
Result readIndices(const Document& document, uint32_t index, std::vector<uint32_t>& indices);

/// Expands the vertices of a primitive of mode 4 (triangles), 5 (strip) or 6 (fan) to triangles as
/// glTF 2.0, 3.7.2.1 says. Returns false when `mode` is none of these, or the count does not fit
/// triangles.
bool expandTriangles(uint64_t mode, std::vector<uint32_t>& vertices);

/// Returns the type and the component type of an accessor in glTF's words: "VEC3 of FLOAT".
std::string describeType(const Accessor& accessor);

/// Whether an accessor has the type of indices: SCALAR of unsigned integers.
bool isOfIndices(const Accessor& accessor);

/// Whether indices of a type can name this many vertices. The largest value of 8 or 16 bits is
/// none: it restarts strips.
bool holdsIndices(ComponentType type, uint64_t vertex_count);

/// Returns one component as a number.
double componentValue(const uint8_t* bytes, ComponentType type);

/// Returns the bytes between elements of a vertex attribute, which start at multiples of four.
inline uint32_t attributeStride(const Accessor& accessor) {
  return (accessor.elementBytes() + 3) & ~3u;
}

/// Stores elements that follow each other without gaps as a buffer has them: columns of matrices
/// are padded, and elements of vertex attributes start at multiples of four. `out` has room for
/// accessor.count times the stride, and has zeros.
void packElements(std::span<const uint8_t> tight, const Accessor& accessor, uint8_t* out);

/// The same. `stride_bytes` becomes 0 when elements follow each other without gaps. Padding inside
/// a matrix counts as a gap, because not all programs pad the last column.
std::vector<uint8_t> packAttribute(std::span<const uint8_t> tight, const Accessor& accessor,
                                   uint32_t& stride_bytes);

/// Stores indices of 32 bits, in the host's order, as ones of `index_bytes`.
void narrowIndices(std::span<const uint8_t> indices, uint32_t index_bytes, uint8_t* out);
std::vector<uint8_t> narrowIndices(std::span<const uint32_t> indices, uint32_t index_bytes);

/// Returns the format of an attribute as the payload describes it. A semantic whose accessor does
/// not have the type glTF 2.0 gives it becomes a custom one.
AttributeFormat formatOf(const std::string& name, uint32_t target, const Accessor& accessor);

/// Smallest and largest value of each component. NaN is ignored; for a component without numbers
/// they are infinite.
struct Bounds {
  std::vector<double> min;
  std::vector<double> max;
  bool is_finite = true;  ///< all values are finite, so that JSON can represent the bounds

  /// Extends these bounds by others, of as many components; none are extended to any.
  void add(const Bounds& other);
  /// Returns the largest difference between the two bounds of a component.
  double longestSide() const;
};

Bounds boundsOf(const AccessorData& elements, ComponentType type);
/// The same for elements without padding between them.
Bounds boundsOf(std::span<const uint8_t> tight, ComponentType type, uint32_t component_count);
/// The same for indices, of which there must be at least one.
Bounds boundsOf(std::span<const uint32_t> indices);

/// Returns finite bounds as `min` and `max` of an accessor hold them: integers have no fraction,
/// and floats the fewest digits that read back as the same float.
Json boundNumbers(const std::vector<double>& values, ComponentType type);

/// Writes finite bounds into an accessor: both when `is_required`, else only those it already has.
void setBounds(const Bounds& bounds, ComponentType type, bool is_required, Json& accessor);

/// Compares the member `key` of the accessor at `path`, which is "min" or "max" and may be missing,
/// with that bound of the decoded elements. One that JSON cannot represent may be anything.
Result checkBound(const Json& accessor, const char* key, const std::vector<double>& decoded,
                  ComponentType type, const std::string& path);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_ACCESSORS_H_
