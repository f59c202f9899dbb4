// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Codes positions. Reader and writer run the same code. [A.6]
//
//   positions/growth.h      order of the vertices, and what is known around each
//   positions/predict.h     prediction from the fan, normal shear
//   positions/residual.h    scale of the residual -> row of token frequencies -> residual
//   positions/vertex.h      the three steps above for one vertex
//   positions/parameters.h  the encoder's choices
//
// The scale is a linear function of the neighbours' residuals and of the disagreement of the tips.
#ifndef MCC_POSITIONS_POSITIONS_H_
#define MCC_POSITIONS_POSITIONS_H_

#include <cstdint>
#include <type_traits>

#include "format/predictors.h"
#include "positions/growth.h"
#include "positions/parameters.h"
#include "positions/vertex.h"

namespace mcc {

struct PositionModels {
  PositionRows rows;
  PositionTables tables;
};

/// The vertices whose positions are coded.
struct GroupPositions {
  const Groups& groups;
  VertexRecord* records;  ///< by group
  const int32_t* truth;   ///< 3 coordinates per group (encoder)
};

template <class Io, uint32_t kModes>
class PositionCoder {
 public:
  PositionCoder(Io& io, PositionModels& models, const PositionParameters& parameters,
                FaceMesh& mesh, const GroupPositions& vertices)
      : io_(io),
        rows_(models.rows),
        parameters_(parameters),
        truth_(vertices.truth),
        vertex_(models.rows, parameters, vertices.records, vertices.truth),
        growth_(mesh, vertices.groups, vertices.records, parameters.has(position_mode::kWeights),
                mesh.allocator()),
        records_(vertices.records) {}

  /// Codes all groups of vertices. `order`, if not null, has room for the groups, see RegionGrowth.
  Status run(uint32_t* order) { return growth_.run(*this, order); }

  // --- visitor of RegionGrowth ---

  /// The inner loop works on copies of the decoder's state and of the vertex coder, which no other
  /// pointer can alias.
  class Plain {
   public:
    explicit Plain(PositionCoder& coder)
        : io_(coder.io_),
          vertex_(coder.rows_, coder.parameters_, coder.records_, coder.truth_),
          faces_(coder.growth_.faces()),
          records_(coder.records_) {}
    /// Codes the vertex, or returns false if the streams may not have room for it.
    MCC_INLINE bool visit(uint32_t v, const PlainFan& fan) {
      if (!io_.hasRoom(vertex_.has(position_mode::kPlanes) ? kTokensWithPlanes : kTokensOfVertex))
          [[unlikely]]
        return false;
      codePlain(vertex_, io_, faces_, records_, v, fan);
      return true;
    }
    void close(PositionCoder& coder) { io_.giveBack(coder.io_); }
    void reopen(PositionCoder& coder) { io_.take(coder.io_); }

   private:
    typename Io::Burst io_;
    const VertexCoder<std::remove_reference_t<typename Io::Burst>, kModes> vertex_;
    const FaceView faces_;
    const VertexRecord* const records_;
  };

  MCC_OUT_OF_LINE void plain(uint32_t v, const PlainFan& fan) {
    codePlain(vertex_, io_, growth_.faces(), records_, v, fan);
  }
  MCC_OUT_OF_LINE void fan(uint32_t v, const AnyFan& fan) {
    Prediction prediction;
    vertex_.codeAny(io_, v, fan, prediction);
  }
  void seed(uint32_t v, const VertexRecord* neighbour, uint32_t) {
    vertex_.codeSeed(io_, v, neighbour);
  }
  Status check() const {
    if (!io_.overrun()) return {};
    return fail(Error::kTruncated, "the token stream ends inside the positions");
  }

 private:
  template <class AnyIo, uint32_t kFixed>
  MCC_INLINE static void codePlain(const VertexCoder<AnyIo, kFixed>& vertex, AnyIo& io,
                                   const FaceView& faces, const VertexRecord* records, uint32_t v,
                                   const PlainFan& fan) {
    Prediction prediction;
    if (!vertex.has(position_mode::kWeights)) {
      return vertex.codePlain(io, v, fan, nullptr, prediction);
    }
    const Beyond beyond = lookBeyond(faces, records, fan, vertex.has(position_mode::kSelect));
    vertex.codePlain(io, v, fan, &beyond, prediction);
  }

  Io& io_;
  PositionRows& rows_;
  const PositionParameters& parameters_;
  const int32_t* const truth_;
  VertexCoder<Io, fixedKind(kModes)> vertex_;  ///< for what the inner loop does not code
  RegionGrowth growth_;
  VertexRecord* const records_;
};

}  // namespace mcc

#endif  // MCC_POSITIONS_POSITIONS_H_
