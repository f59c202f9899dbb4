// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Records what a walk over a piece saw around each vertex. The walk does not depend on positions or
// choices, so the writer walks once and tries the choices on the record.
#ifndef MCC_POSITIONS_ENC_RECORDING_H_
#define MCC_POSITIONS_ENC_RECORDING_H_

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "positions/growth.h"
#include "positions/predict.h"

namespace mcc {

class PositionRecording {
 public:
  enum class Kind : uint8_t { kPlain, kAny, kSeed };
  struct Visit {
    uint32_t vertex;
    uint32_t at : 30;  ///< index into plain_ or any_; for a seed, the neighbour or kNoNeighbour
    uint32_t kind : 2;
  };
  static constexpr uint32_t kNoNeighbour = (1u << 30) - 1;

  /// Walks the mesh and writes the `truth` positions (3 per record) into `records`, which are
  /// borrowed. `order`: see RegionGrowth.
  Status record(FaceMesh& mesh, const Groups& groups, VertexRecord* records, const int32_t* truth,
                uint32_t* order = nullptr) {
    records_ = records;
    visits_.clear();
    visits_.reserve(groups.count);
    plain_.clear();
    any_.clear();
    RegionGrowth growth(mesh, groups, records, true, Allocator{});
    faces_ = growth.faces();
    MCC_TRY(growth.run(*this, order));
    for (const Visit& visit : visits_) {
      const int32_t* q = truth + 3 * size_t{visit.vertex};
      std::copy(q, q + 3, records_[visit.vertex].q);
    }
    return {};
  }

  const std::vector<Visit>& visits() const { return visits_; }
  /// The records as the walk left them; trials write to copies.
  const VertexRecord* records() const { return records_; }

  /// Restores what was around the vertex of a visit; `records` are records() or a copy of them.
  void plain(const VertexRecord* records, const Visit& visit, PlainFan& fan, Beyond& beyond) const {
    const RecordedPlain& r = plain_[visit.at];
    fan = {records + r.n[0],
           records + r.n[1],
           records + r.n[2],
           records + r.o[0],
           records + r.o[1],
           kNone,
           kNone};
    beyond.has_ya = r.y[0] != kNone;
    beyond.has_yb = r.y[1] != kNone;
    beyond.has_x = r.x[0] != kNone;
    beyond.ya = records + (beyond.has_ya ? r.y[0] : 0);
    beyond.yb = records + (beyond.has_yb ? r.y[1] : 0);
    beyond.xa = records + (beyond.has_x ? r.x[0] : 0);
    beyond.xb = records + (beyond.has_x ? r.x[1] : 0);
  }
  void any(const VertexRecord* records, const Visit& visit, AnyFan& fan) const {
    const uint32_t* from = any_.data() + visit.at;
    fan.closed = (*from & 1) != 0;
    fan.face_count = *from++ >> 1;
    fan.neighbour_count = fan.face_count + (fan.closed ? 0 : 1);
    for (uint32_t i = 0; i <= fan.face_count; ++i) fan.n[i] = records + *from++;
    for (uint32_t i = 0; i < fan.face_count; ++i, ++from) {
      fan.o[i] = *from != kNone ? records + *from : nullptr;
    }
  }
  static bool beginsComponent(const Visit& visit) {
    return visit.kind == static_cast<uint32_t>(Kind::kSeed) && visit.at == kNoNeighbour;
  }
  const VertexRecord* seedNeighbour(const VertexRecord* records, const Visit& visit) const {
    return visit.at != kNoNeighbour ? records + visit.at : nullptr;
  }

  /// Calls `use` with every vertex that the visit looks at, including its own; some vertices may
  /// occur more than once.
  template <class Use>
  void forAll(const Visit& visit, Use use) const {
    use(visit.vertex);
    if (visit.kind == static_cast<uint32_t>(Kind::kPlain)) {
      const RecordedPlain& r = plain_[visit.at];
      const std::span<const uint32_t> lists[] = {r.n, r.o, r.y, r.x};
      for (const std::span<const uint32_t> list : lists) {
        for (const uint32_t v : list) {
          if (v != kNone) use(v);
        }
      }
    } else if (visit.kind == static_cast<uint32_t>(Kind::kAny)) {
      const uint32_t faces = any_[visit.at] >> 1;
      for (uint32_t i = 0; i <= 2 * faces; ++i) {
        const uint32_t v = any_[visit.at + 1 + i];
        if (v != kNone) use(v);
      }
    } else if (visit.at != kNoNeighbour) {
      use(visit.at);
    }
  }

  /// Calls `use` with every vertex whose residuals the scale of this visit depends on.
  template <class Use>
  void forNeighbours(const Visit& visit, Use use) const {
    if (visit.kind == static_cast<uint32_t>(Kind::kPlain)) {
      for (const uint32_t n : plain_[visit.at].n) use(n);
    } else if (visit.kind == static_cast<uint32_t>(Kind::kAny)) {
      const uint32_t faces = any_[visit.at] >> 1;
      for (uint32_t i = 0; i <= faces; ++i) use(any_[visit.at + 1 + i]);
    }
  }

  // --- visitor of RegionGrowth ---

  class Plain {
   public:
    explicit Plain(PositionRecording& recording) : recording_(recording) {}
    bool visit(uint32_t v, const PlainFan& fan) {
      recording_.plain(v, fan);
      return true;
    }
    void close(PositionRecording&) {}
    void reopen(PositionRecording&) {}

   private:
    PositionRecording& recording_;
  };

  void plain(uint32_t v, const PlainFan& fan) {
    const Beyond b = lookBeyond(faces_, records_, fan, true);
    addVisit(v, plain_.size(), Kind::kPlain);
    plain_.push_back({{indexOf(fan.n0), indexOf(fan.n1), indexOf(fan.n2)},
                      {indexOf(fan.o0), indexOf(fan.o1)},
                      {b.has_ya ? indexOf(b.ya) : kNone, b.has_yb ? indexOf(b.yb) : kNone},
                      {b.has_x ? indexOf(b.xa) : kNone, b.has_x ? indexOf(b.xb) : kNone}});
  }
  void fan(uint32_t v, const AnyFan& fan) {
    addVisit(v, any_.size(), Kind::kAny);
    any_.push_back(fan.face_count << 1 | (fan.closed ? 1u : 0u));
    for (uint32_t i = 0; i <= fan.face_count; ++i) any_.push_back(indexOf(fan.n[i]));
    for (uint32_t i = 0; i < fan.face_count; ++i) {
      any_.push_back(fan.o[i] != nullptr ? indexOf(fan.o[i]) : kNone);
    }
  }
  void seed(uint32_t v, const VertexRecord* neighbour, uint32_t) {
    addVisit(v, neighbour != nullptr ? indexOf(neighbour) : kNoNeighbour, Kind::kSeed);
  }
  Status check() const { return {}; }

 private:
  struct RecordedPlain {
    uint32_t n[3];
    uint32_t o[2];
    uint32_t y[2];
    uint32_t x[2];
  };

  void addVisit(uint32_t v, size_t at, Kind kind) {
    records_[v].q[3] = kKnown;
    visits_.push_back(
        {v, static_cast<uint32_t>(at) & ((1u << 30) - 1), static_cast<uint32_t>(kind) & 3});
  }
  uint32_t indexOf(const VertexRecord* r) const { return static_cast<uint32_t>(r - records_); }

  FaceView faces_{nullptr};
  VertexRecord* records_ = nullptr;
  std::vector<Visit> visits_;
  std::vector<RecordedPlain> plain_;
  std::vector<uint32_t> any_;
};

}  // namespace mcc

#endif  // MCC_POSITIONS_ENC_RECORDING_H_
