// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Codes the positions of a piece with mirrors or anchors: as positions/positions.h does, but first
// says of each vertex whether it is the image of one that is known. Compact code has only this
// coder, for pieces without mirrors, too. [A.6.14, A.6.15]
#ifndef MCC_POSITIONS_MIRRORED_H_
#define MCC_POSITIONS_MIRRORED_H_

#include <cstdint>

#include "positions/mirrors.h"
#include "positions/positions.h"

namespace mcc {

/// The mirrors of a piece, and whether its components may have anchors.
struct Repetition {
  Mirrors mirrors;
  bool has_anchors = false;
  const Anchor* anchors = nullptr;  ///< by vertex, for those that begin components (encoder)
};

template <class Io>
class MirroredPositionCoder {
 public:
  /// `mirror_models` is null in pieces with neither mirrors nor anchors.
  MirroredPositionCoder(Io& io, PositionModels& models, MirrorModels* mirror_models,
                        const PositionParameters& parameters, const Repetition& repetition,
                        VertexMates& mates, FaceMesh& mesh, const GroupPositions& vertices)
      : io_(io),
        models_(mirror_models),
        parameters_(parameters),
        truth_(vertices.truth),
        records_(vertices.records),
        vertex_count_(vertices.groups.count),
        vertex_(models.rows, parameters, vertices.records, vertices.truth),
        growth_(mesh, vertices.groups, vertices.records, parameters.has(position_mode::kWeights),
                mesh.allocator()),
        repetition_(repetition),
        anchors_(io, mirror_models != nullptr ? &mirror_models->anchors : nullptr, vertices.records,
                 vertex_count_),
        mates_(growth_.faces(), vertices.records, repetition.mirrors, mates, mesh.allocator()) {}

  Status run(uint32_t* order) {
    if (hasMirrors() && !mates_.init(vertex_count_, repetition_.has_anchors))
      return fail(Error::kOutOfMemory, "no memory for the mates");
    MCC_TRY(growth_.run(*this, order));
    return check();
  }

  // --- visitor of RegionGrowth ---

  /// Nothing is gained from an inner loop on copies: plain() codes all plain fans.
  struct Plain {
    explicit Plain(MirroredPositionCoder& all) : coder(all) {}
    MCC_INLINE bool visit(uint32_t v, const PlainFan& fan) const {
      if (kCompact) coder.plain(v, fan);
      return kCompact;
    }
    void close(MirroredPositionCoder&) const {}
    void reopen(MirroredPositionCoder&) const {}
    MirroredPositionCoder& coder;
  };
  void plain(uint32_t v, const PlainFan& fan) {
    Prediction prediction;
    vertex_.predict(v, growth_.faces(), fan, prediction);
    const VertexRecord* const around[3] = {fan.n1, fan.n0, fan.n2};
    if (!codeImage(v, prediction, around)) vertex_.codePredicted(io_, v, fan, prediction);
    add(v, prevHalfEdge(growth_.faces().twin(fan.beyond0)));
  }
  void fan(uint32_t v, const AnyFan& fan) {
    Prediction prediction;
    predictAny(parameters_, fan, prediction);
    const uint32_t last = fan.neighbour_count - 1;
    const VertexRecord* const around[3] = {fan.n[(last + 1) / 2], fan.n[0], fan.n[last]};
    if (!codeImage(v, prediction, around)) vertex_.codePredicted(io_, v, fan, prediction);
    add(v, fan.first);
  }
  void seed(uint32_t v, const VertexRecord* neighbour, uint32_t half_edge) {
    Lanes<uint32_t> from{};
    if (neighbour != nullptr) from = coordinates(neighbour);
    const std::span around(&neighbour, neighbour != nullptr ? 1u : 0u);
    if (!codeImage(v, from, around, nullptr)) vertex_.codeSeed(io_, v, neighbour);
    if (repetition_.has_anchors && neighbour == nullptr) beginComponent(v);
    add(v, half_edge);
  }
  Status check() const {
    MCC_TRY(anchor_status_);
    if (names_none_) return fail(Error::kBadAttribute, "a vertex is the image of none");
    if (io_.overrun()) return fail(Error::kTruncated, "the token stream ends inside the positions");
    return {};
  }

 private:
  using Neighbours = std::span<const VertexRecord* const>;

  void beginComponent(uint32_t first) {
    Anchor anchor;
    const Anchor truth = Io::kEncoding ? repetition_.anchors[first] : Anchor{};
    const Status status = anchors_.code(first, truth, anchor);
    if (!status.ok() && anchor_status_.ok()) anchor_status_ = status;
    mates_.begin(first, anchor);
  }
  bool hasMirrors() const { return !kCompact || models_ != nullptr; }
  void add(uint32_t v, uint32_t half_edge) {
    if (hasMirrors()) mates_.add(v, half_edge);
  }
  bool codeImage(uint32_t v, const Prediction& prediction, Neighbours neighbours) {
    if (!hasMirrors()) return false;
    const FinePoint& at = prediction.at;
    const Lanes<uint32_t> from =
        at.step + lanesAs<uint32_t>(lanesAs<int32_t>(at.fraction + 128) >> 8);
    return codeImage(v, from, neighbours, &prediction);
  }

  /// Returns whether the vertex is the image of a candidate; then it is coded. Seeds have no
  /// prediction.
  MCC_OUT_OF_LINE bool codeImage(uint32_t v, const Lanes<uint32_t>& from, Neighbours neighbours,
                                 const Prediction* prediction) {
    if (!hasMirrors()) return false;
    mates_.findCandidates(neighbours, from);
    if (mates_.count() == 0) return false;
    uint32_t choice = Io::kEncoding ? choose(v, from) : 0;
    choice = io_.template token<0>(models_->candidate[mates_.context()], kPositionSchedule, choice);
    if (choice == 0) return false;
    const bool is_near = choice >= kNearCandidate;
    const uint32_t candidate = choice - (is_near ? kNearCandidate : 1);
    if (candidate >= mates_.count()) {
      names_none_ = true;
      return false;
    }
    mates_.name(candidate);
    Lanes<uint32_t> q = mates_.imageOf(candidate);
    if (is_near) q += residualFrom(v, q);
    const bool shears = prediction != nullptr && parameters_.has(position_mode::kShear);
    vertex_.storeAt(v, q, from, (shears ? makeShear(prediction->normal) : kNoShear).axis);
    return true;
  }
  Lanes<uint32_t> residualFrom(uint32_t v, const Lanes<uint32_t>& image) {
    const auto code = [&](auto state, uint32_t s) {
      constexpr uint32_t kState = decltype(state)::value;
      const int32_t truth = Io::kEncoding ? static_cast<int32_t>(truthOf(v)[s] - image[s]) : 0;
      return static_cast<uint32_t>(
          codeResidual<kState>(io_, models_->residual[s], 0, 0, 0, truth, std::false_type{}));
    };
    const uint32_t x = code(std::integral_constant<uint32_t, 0>{}, 0);
    const uint32_t y = code(std::integral_constant<uint32_t, 1>{}, 1);
    const uint32_t z = code(std::integral_constant<uint32_t, 2>{}, 2);
    return Lanes<uint32_t>{x, y, z, 0};
  }

  Lanes<uint32_t> truthOf(uint32_t v) const {
    const int32_t* q = truth_ + 3 * size_t{v};
    return Lanes<uint32_t>{static_cast<uint32_t>(q[0]), static_cast<uint32_t>(q[1]),
                           static_cast<uint32_t>(q[2]), 0};
  }
  /// The encoder's choice: an image that is the vertex, else the nearest one if it is a step away
  /// or far nearer than what is expected.
  uint32_t choose(uint32_t v, const Lanes<uint32_t>& from) const {
    const Lanes<uint32_t> q = truthOf(v);
    const auto distance = [&](const Lanes<uint32_t>& to) {
      const Lanes<uint32_t> d = absoluteLanes(to - q);
      return uint64_t{d[0]} + d[1] + d[2];
    };
    uint32_t nearest = 0;
    uint64_t least = ~uint64_t{0};
    for (uint32_t i = 0; i < mates_.count(); ++i) {
      const uint64_t d = distance(mates_.imageOf(i));
      if (d == 0) return 1 + i;
      if (d >= least) continue;
      least = d;
      nearest = i;
    }
    const uint64_t expected = distance(from);
    const bool pays = least <= 3 ? least < expected : 8 * least < expected;
    return pays ? kNearCandidate + nearest : 0;
  }

  Io& io_;
  MirrorModels* const models_;
  const PositionParameters& parameters_;
  const int32_t* const truth_;
  VertexRecord* const records_;
  const uint32_t vertex_count_;
  VertexCoder<Io, kAnyModes> vertex_;
  RegionGrowth growth_;
  const Repetition& repetition_;
  AnchorCoder<Io> anchors_;
  Status anchor_status_;
  MirrorMates mates_;
  bool names_none_ = false;  ///< a vertex is said to be the image of a candidate that there is not
};

}  // namespace mcc

#endif  // MCC_POSITIONS_MIRRORED_H_
