// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decides which primitives are compressed, and which of their data goes into which payload.
#ifndef MCC_GLTF_COMPRESS_PLAN_H_
#define MCC_GLTF_COMPRESS_PLAN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/document/accessors.h"
#include "gltf/document/document.h"
#include "gltf/document/references.h"
#include "mcc/glb.h"
#include "mcc/writer.h"

namespace mcc::gltf {

/// One attribute of a piece: an entry of a primitive's `attributes` or of one of its `targets`.
struct AttributePlan {
  std::string name;         ///< "POSITION"
  uint32_t target = kNone;  ///< morph target it belongs to; kNone: the base mesh
  uint32_t accessor = 0;    ///< accessor of the source
  AttributeFormat format;
  AccessorData source;
  uint8_t bits = 0;          ///< 0: exact
  bool has_lattice = false;  ///< for float attributes with bits; the codec may use a finer grid
  Lattice lattice;
  double max_distance = 0;  ///< between source and decoded positions, where one was promised
  /// The weights of a vertex must add up to one, so each may move by a whole step instead of half
  /// of one.
  bool is_rounded_with_others = false;

  /// Whether it is the attribute of the base mesh with this meaning.
  bool isBase(Semantic semantic) const { return format.semantic == semantic && target == kNone; }
  std::string label() const { return attributeLabel(name, target); }
  /// Returns what the writer is given. It refers to the source and to `lattice`.
  AttributeView view() const;
};

/// One triangle list. Primitives that have the same attributes, indices and mode share it.
struct PartPlan {
  uint32_t indices_accessor = kNone;  ///< accessor of the source
  uint64_t mode = 4;                  ///< mode in the source
  std::vector<uint32_t> triangles;    ///< expanded to mode 4
  std::vector<PrimitiveRef> users;
};

/// Primitives with identical attributes and targets.
struct PiecePlan {
  uint32_t wedge_count = 0;
  std::vector<uint32_t> kept;  ///< source vertices that are kept, if others were dropped
  uint32_t target_count = 0;
  /// In payload order; empty with indices_only.
  std::vector<AttributePlan> attributes;
  /// Attributes that stay accessors next to the payload, in the same order: all of them with
  /// indices_only, else those beyond what a payload can hold.
  std::vector<AttributePlan> ordinary;
  std::vector<PartPlan> parts;
  /// Accessors that hold numbers of its vertices, and nothing else uses; see vertices.h.
  std::vector<uint32_t> vertex_numbers;

  uint64_t triangleCount() const;
  /// The mesh that uses it, or the first of them.
  uint32_t mesh() const { return parts[0].users[0].mesh; }
};

/// What one mesh puts into one buffer view. A piece that several meshes use belongs to the first of
/// them. A mesh has one payload, unless gatherPayloads() puts several meshes into that of the
/// first, or splitPayloads() divides it into several consecutive ones.
struct PayloadPlan {
  uint32_t mesh = 0;
  bool keep_vertex_order = false;
  bool keep_triangle_order = false;
  bool indices_only = false;
  /// Its parts are coarse versions of those of their users, and its vertices some of theirs.
  bool is_preview = false;

  /// Whether the accessors of attributes get their elements in another order.
  bool reorders() const { return indices_only && !keep_vertex_order; }
  uint64_t triangleCount() const;
  /// Calls visit(size_t piece, size_t part, const PrimitiveRef& user) for all that use it.
  template <typename Visit>
  void visitUsers(const Visit& visit) const {
    for (size_t i = 0; i < pieces.size(); ++i) {
      for (size_t k = 0; k < pieces[i].parts.size(); ++k) {
        for (const PrimitiveRef& user : pieces[i].parts[k].users) visit(i, k, user);
      }
    }
  }
  std::vector<PiecePlan> pieces;
};

/// Says why a primitive stays as it was.
struct LeftAlone {
  PrimitiveRef primitive;
  std::string note;
  bool is_larger = false;  ///< only because its payload would take more bytes
};

/// Leaves the primitives of a piece as they were.
void leaveAlone(const PiecePlan& piece, const std::string& note, bool is_larger,
                std::vector<LeftAlone>& left_alone);

/// What all pieces and parts hold together, counted as often as they hold it, for each byte that
/// was read. Files without shared bytes stay below it even if they consist of strips of small
/// numbers, which expand to twelve bytes for each.
inline constexpr uint64_t kMaxSharing = 16;

/// Orders the attributes of a payload: those that others are predicted from come first.
bool comesBefore(const AttributePlan& a, const AttributePlan& b);

/// Collects the triangle primitives of all meshes. Points and lines are left alone without a note,
/// and primitives that contradict themselves with one (an index out of range, an accessor that does
/// not exist). Error: a primitive is no object.
/// Takes time and memory proportional to the bytes that were read, because primitives that share
/// bytes in more than kMaxSharing ways are left alone, too.
Result planPayloads(const Document& document, std::vector<PayloadPlan>& payloads,
                    std::vector<LeftAlone>& left_alone);

/// Returns the extension object of a primitive that uses a part of a piece.
Json extensionJson(uint64_t buffer_view, size_t piece_number, const PiecePlan& piece,
                   size_t part_number);

/// Puts small meshes together into one payload, which spares headers and shares adaptive models.
/// The lattices of meshes must have been chosen before. Equal meshes stay apart: equal payloads
/// share their bytes, while shared models would make them differ.
void gatherPayloads(std::vector<PayloadPlan>& payloads);

/// Divides payloads that hold more than every reader accepts by its default Limits, and gives
/// pieces that may be cut into blocks payloads of their own. What the pieces of a mesh share, such
/// as their lattice, must have been chosen before.
void splitPayloads(const ConvertOptions& options, std::vector<PayloadPlan>& payloads);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_PLAN_H_
