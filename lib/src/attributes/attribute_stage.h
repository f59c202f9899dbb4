// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// All attributes of a piece but its positions: what they share, and which coder each goes through. [A.8]
#ifndef MCC_ATTRIBUTES_ATTRIBUTE_STAGE_H_
#define MCC_ATTRIBUTES_ATTRIBUTE_STAGE_H_

#include <cstdint>

#include "attributes/equality.h"
#include "attributes/normals.h"
#include "attributes/texcoords.h"
#include "attributes/values.h"
#include "attributes/wedges.h"
#include "mesh/attribute_method.h"

namespace mcc {

/// Adaptive models of all attributes of a payload. Plain data: the encoder's trials copy it. [A.3.6]
struct AttributeModels {
  EqualityModels equalities[8];  ///< [semantic]
  NormalModels normals;
  TexcoordModels texcoords[2];  ///< [further set]
  ValueModels values[8][2][2];  ///< [semantic][further set][morph target]

  EqualityModels& equalitiesOf(const AttributeInfo& a) {
    return equalities[static_cast<uint32_t>(a.format.semantic)];
  }
  ValueModels& valuesOf(const AttributeInfo& a) {
    return values[static_cast<uint32_t>(a.format.semantic)][a.format.set_index != 0 ? 1 : 0]
                 [a.format.morph_target != 0 ? 1 : 0];
  }
};

/// Integers per wedge that an attribute is coded as.
inline uint32_t codedComponents(const AttributeInfo& info) {
  return info.coding == AttributeCoding::kOctahedral ? 2 : info.format.component_count;
}

template <class Io>
class AttributeStage {
 public:
  AttributeStage(Io& io, AttributeModels& models, const Allocator& allocator)
      : wedges(allocator),
        positions(allocator),
        io_(io),
        models_(models),
        groups_(allocator),
        floats_(allocator),
        memory_(allocator),
        lengths_(allocator) {}

  /// Codes one attribute into `values`, codedComponents() per wedge; the encoder gives them. `sequence` is the order
  /// for attributes/values.h.
  Status code(const AttributeInfo& info, const WedgeSequence& sequence, Array<int32_t>& values) {
    const uint32_t components = codedComponents(info);
    if (!values.resize(size_t{wedges.count} * components) || !lengths_.resize(wedges.count)) {
      return noMemory();
    }
    groups_.clear();
    if ((info.predictor & kHasEqualities) != 0 && wedges.hasSeams()) {
      MCC_TRY(EqualityCoder<Io>(io_, models_.equalitiesOf(info), wedges, values.data(), components)
                  .run(groups_));
    }
    switch (methodOf(info)) {
      case AttributeMethod::kNormal:
        if (!floats_.resize(3 * size_t{wedges.count})) return noMemory();
        NormalCoder<Io>(io_, models_.normals, wedges, groups_, info, values.data(), floats_.data(),
                        lengths_.data())
            .run(positions.data());
        break;
      case AttributeMethod::kTexcoord: {
        const bool repeats = (info.predictor & texcoord_method::kRepeats) != 0;
        if (repeats && !memory_.assign(ResidualMemory::kEntries, {})) return noMemory();
        TexcoordCoder<Io>(io_, models_.texcoords[info.format.set_index != 0 ? 1 : 0], wedges,
                          groups_, info, positions.data(), values.data(), lengths_.data(),
                          repeats ? memory_.data() : nullptr)
            .run();
        break;
      }
      case AttributeMethod::kValues:
        ValueCoder<Io>(io_, models_.valuesOf(info), wedges.faces, sequence, components,
                       static_cast<ValuePredictor>(info.predictor & 1), values.data(),
                       lengths_.data())
            .run();
        break;
    }
    if (io_.overrun()) return fail(Error::kTruncated, "the token stream ends inside an attribute");
    return {};
  }

  WedgeMesh wedges;
  Array<float>
      positions;  ///< 4 per wedge, see wedges.h; only when an attribute is predicted from them

 private:
  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for attributes"); }

  Io& io_;
  AttributeModels& models_;
  EqualGroups groups_;
  Array<float> floats_;
  Array<ResidualMemory::Entry> memory_;
  Array<uint8_t> lengths_;
};

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_ATTRIBUTE_STAGE_H_
