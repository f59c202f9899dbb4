// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decoded float accessors that may become integers.
#ifndef MCC_GLTF_INTEGER_ACCESSORS_H_
#define MCC_GLTF_INTEGER_ACCESSORS_H_

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gltf/rebuild.h"
#include "mcc/reader.h"

namespace mcc::gltf {

/// How the accessors that were decoded had been coded, by accessor number; no aliases.
using CodedAttributes = std::map<uint32_t, AttributeInfo>;

/// Reads and replaces the elements of decoded accessors in a document that is not yet rebuilt.
class IntegerAccessors {
 public:
  /// json, views   as rebuildBuffers() takes them; both must outlive the object.
  IntegerAccessors(const Document& source, const ForeignReferences& foreign,
                   const CodedAttributes& coded, Json& json, std::vector<NewView>& views);

  /// How an accessor was coded when it still holds floats of a grid and all who use it mean the same attribute; else null.
  const AttributeInfo* coding(uint32_t accessor) const;

  /// "/accessors/3: target POSITION"; of one that has a coding.
  std::string label(uint32_t accessor) const;
  uint64_t count(uint32_t accessor) const { return source_.accessors[accessor].count; }
  /// Component `index` of all components of all elements.
  double value(uint32_t accessor, uint64_t index) const;

  /// Stores other values, three of VEC3 per element and so on; bounds follow. May be done once per accessor.
  void replace(uint32_t accessor, ComponentType type, bool normalized,
               const std::vector<int32_t>& values);

 private:
  void noteUser(const Json& map, bool is_target);

  const Document& source_;
  const CodedAttributes& coded_;
  Json& json_;
  std::vector<NewView>& views_;
  std::map<uint32_t, std::set<std::string>> meanings_;  ///< what primitives use an accessor as
  std::vector<bool> is_used_otherwise_;
  std::set<uint32_t> replaced_;
};

/// Attributes but positions: normals and tangents become signed, texture coordinates, colours and weights unsigned
/// normalised integers, where their range allows and no step becomes coarser. True when KHR_mesh_quantization is needed.
bool storeIntegerValues(const CodedAttributes& coded, const Json& meshes,
                        IntegerAccessors& accessors, std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_INTEGER_ACCESSORS_H_
