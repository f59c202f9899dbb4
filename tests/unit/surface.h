// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs a mesh through the stages of piece.h, one stage at a time. The test that uses it makes up
// what each stage needs to know.
#ifndef MCC_TESTS_UNIT_SURFACE_H_
#define MCC_TESTS_UNIT_SURFACE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mcc/types.h"

#include "connectivity/enc_collapse.h"
#include "entropy/decoder_io.h"
#include "entropy/enc_coder.h"
#include "prepare/enc_cut.h"
#include "support/mesh_generators.h"
#include "writer/instances.h"

namespace mcc::test {

/// A collapsed mesh. Vertices are welded by index, not by position.
class Surface {
 public:
  explicit Surface(const TestMesh& mesh, uint32_t start_half_edge = kNone);

  /// Flags of connectivity alone.
  PieceHeader header() const;
  /// Returns the truth for the machine, which writes into this object. Borrows it.
  McTruth truth();

  const CutResult& cut() const { return cut_; }
  const McRecord& record() const { return record_; }
  const std::vector<uint32_t>& sourceOfVertex() const { return source_of_vertex_; }
  /// Source half-edge (3 * triangle + corner) that became half-edge 1 of a face.
  const std::vector<uint32_t>& sourceGate() const { return source_gate_; }
  /// Class (index in the mesh) of each decoded vertex.
  std::vector<uint32_t> classOfVertex() const;
  bool hasCopies() const;

 private:
  uint32_t class_count_;
  CutResult cut_;
  McRecord record_;
  std::vector<uint32_t> node_map_;
  std::vector<uint32_t> source_of_vertex_;
  std::vector<uint32_t> source_gate_;
};

/// Models, header and stages of one piece on one coder.
template <class Io>
struct Stages {
  Stages(Io& io, const PieceHeader& piece_header, std::vector<AttributeInfo> infos)
      : header(withAttributes(piece_header, infos.size())),
        attributes(std::move(infos)),
        models(std::make_unique<PayloadModels>()),
        piece(io, *models, header, attributes, {}) {}
  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;

  static PieceHeader withAttributes(PieceHeader piece_header, size_t count) {
    piece_header.attribute_count = static_cast<uint32_t>(count);
    return piece_header;
  }

  PieceHeader header;  ///< may be changed between stages
  std::vector<AttributeInfo> attributes;
  std::unique_ptr<PayloadModels> models;
  PieceCoder<Io> piece;
};

/// POSITION on a lattice of `bits` bits.
AttributeInfo positionInfo(uint8_t bits);

/// Checks that twins are mutual and have each other's ends, and that vertices are below
/// `vertex_count`. Returns "" if so.
std::string checkFaceMesh(const FaceMesh& mesh, uint32_t vertex_count);

}  // namespace mcc::test

#endif  // MCC_TESTS_UNIT_SURFACE_H_
