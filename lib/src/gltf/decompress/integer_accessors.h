// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Turns decoded float accessors into integers.
#ifndef MCC_GLTF_DECOMPRESS_INTEGER_ACCESSORS_H_
#define MCC_GLTF_DECOMPRESS_INTEGER_ACCESSORS_H_

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gltf/document/layout.h"
#include "mcc/reader.h"

namespace mcc::gltf {

/// How each decoded accessor was coded, by accessor number. Contains no aliases.
using CodedAttributes = std::map<uint32_t, AttributeInfo>;

/// Reads and replaces the elements of decoded accessors in a document that is not laid out yet.
class IntegerAccessors {
 public:
  /// json and views are those of layOut(); both must outlive the object.
  IntegerAccessors(const Document& source, const CodedAttributes& coded, Json& json,
                   std::vector<NewView>& views);

  /// Returns how an accessor was coded if it still holds floats on a grid and all its users mean
  /// the same attribute by it; else null.
  const AttributeInfo* coding(uint32_t accessor) const;

  /// Returns a label such as "/accessors/3: target POSITION". The accessor must have a coding.
  std::string label(uint32_t accessor) const;
  uint64_t count(uint32_t accessor) const { return source_.accessors[accessor].count; }
  /// Returns component `index`, counted over all components of all elements.
  double value(uint32_t accessor, uint64_t index) const;

  /// Replaces the values, three per element for a VEC3 and so on, and updates the bounds. Must be
  /// called at most once per accessor.
  void replace(uint32_t accessor, ComponentType type, bool normalized,
               const std::vector<int32_t>& values);

 private:
  void noteUser(const Json& map, bool is_target);

  const Document& source_;
  const CodedAttributes& coded_;
  Json& json_;
  std::vector<NewView>& views_;
  std::map<uint32_t, std::set<std::string>> meanings_;  ///< the attributes it is used as
  std::set<uint32_t> replaced_;
};

/// Stores attributes other than positions as normalised integers, where their range allows it and
/// no step becomes coarser. Normals and tangents become signed; texture coordinates, colours and
/// weights become unsigned. Returns true when KHR_mesh_quantization is needed.
bool storeIntegerValues(const CodedAttributes& coded, const Json& meshes,
                        IntegerAccessors& accessors, std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_INTEGER_ACCESSORS_H_
