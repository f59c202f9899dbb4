// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Which primitives are compressed, and what of them goes into which payload.
#ifndef MCC_GLTF_PLAN_H_
#define MCC_GLTF_PLAN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/accessors.h"
#include "gltf/document.h"
#include "gltf/primitives.h"
#include "mcc/gltf.h"
#include "mcc/writer.h"

namespace mcc::gltf {

/// One attribute of a piece: an entry of a primitive's `attributes` or of one of its `targets`.
struct AttributePlan {
  std::string name;         ///< "POSITION"
  uint32_t target = kNone;  ///< morph target it belongs to
  uint32_t accessor = 0;    ///< of the source
  AttributeFormat format;
  AccessorData source;
  uint8_t bits = 0;          ///< 0: exact
  bool has_lattice = false;  ///< of float attributes with bits; the codec may prefer a finer grid
  Lattice lattice;
  double max_distance = 0;  ///< between source and decoded positions, where promised
  /// Weights of a vertex that must add up to one: each may move by a step instead of half of one.
  bool is_rounded_with_others = false;

  /// "POSITION" or "target 2 POSITION".
  std::string label() const;
};

/// One triangle list; primitives that share attributes, indices and mode share it.
struct PartPlan {
  uint32_t indices_accessor = kNone;  ///< of the source
  uint64_t mode = 4;                  ///< of the source
  std::vector<uint32_t> triangles;    ///< expanded to mode 4
  std::vector<PrimitiveRef> users;
};

/// Primitives with identical attributes and targets.
struct PiecePlan {
  uint32_t wedge_count = 0;
  std::vector<uint32_t> kept;  ///< vertices of the source, if others were dropped
  uint32_t target_count = 0;
  /// In payload order; none with indices_only.
  std::vector<AttributePlan> attributes;
  /// Those that stay accessors beside the payload, in the same order: all with indices_only, else what is more than a payload
  /// can hold.
  std::vector<AttributePlan> ordinary;
  std::vector<PartPlan> parts;
};

/// What one mesh puts into one buffer view. A piece that several meshes use belongs to the first. A mesh has one payload until
/// splitPayloads() makes several of it, which follow each other.
struct PayloadPlan {
  uint32_t mesh = 0;
  bool keep_vertex_order = false;
  bool keep_triangle_order = false;
  bool indices_only = false;

  /// Accessors of attributes get their elements in another order.
  bool reorders() const { return indices_only && !keep_vertex_order; }
  std::vector<PiecePlan> pieces;
};

/// Why a primitive stays as it was.
struct LeftAlone {
  PrimitiveRef primitive;
  std::string note;
};

/// Format of an attribute as the payload describes it. Semantics whose accessor has not the type
/// glTF 2.0 gives them are custom ones.
AttributeFormat formatOf(const std::string& name, uint32_t target, const Accessor& accessor);

/// Semantic order of payload attributes: what others are predicted from comes first.
bool comesBefore(const AttributePlan& a, const AttributePlan& b);

/// Collects the triangle primitives of all meshes. Points and lines are left alone without a note.
/// Errors: the document contradicts itself (an index out of range, an accessor that does not
/// exist). Takes time in proportion to the document and what its pieces and parts hold.
Result planPayloads(const Document& document, std::vector<PayloadPlan>& payloads,
                    std::vector<LeftAlone>& left_alone);

/// Divides the payloads that hold more than all readers accept, by their default Limits. What the pieces of a mesh have in
/// common, as their lattice, must have been chosen before.
void splitPayloads(std::vector<PayloadPlan>& payloads);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_PLAN_H_
