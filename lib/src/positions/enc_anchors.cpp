// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "positions/enc_anchors.h"

#include <algorithm>
#include <array>
#include <map>

#include "positions/enc_point.h"

namespace mcc {
namespace {

struct Component {
  std::vector<uint32_t> vertices;  ///< in coding order
  Point low;
  std::array<int64_t, 3> extent;
  PointMap at;  ///< empty before the component is compared with
};

constexpr size_t kLeastVertices = 4;
/// Components with as many vertices that are kept to be compared with.
constexpr size_t kMostKept = 64;
/// Of vertices with those of other components, per vertex of the piece.
constexpr uint64_t kComparisonsPerVertex = 100;

/// Coordinates wrap, as those of exact floats may.
int32_t wrapped(int64_t x) { return static_cast<int32_t>(static_cast<uint32_t>(x)); }

/// Returns a + by * b.
Point plus(const Point& a, const Point& b, int32_t by) {
  Point p;
  for (size_t s = 0; s < 3; ++s) p[s] = wrapped(a[s] + int64_t{by} * b[s]);
  return p;
}
/// The point that the turn makes q.
Point unturned(const Point& q, Turn turn) {
  Point p;
  for (uint32_t s = 0; s < 3; ++s) {
    const uint32_t x = static_cast<uint32_t>(q[s]);
    p[kAxisOrder[turn >> 3][s]] = static_cast<int32_t>((turn >> s & 1) != 0 ? 0u - x : x);
  }
  return p;
}

uint32_t findNear(const PointMap& at, const Point& p) {
  const auto exact = at.find(p);
  if (exact != at.end()) return exact->second;
  for (int i = 0; i < 27; ++i) {
    const auto near = at.find(plus(p, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, 1));
    if (near != at.end()) return near->second;
  }
  return kNone;
}

class Finder {
 public:
  Finder(std::span<const int32_t> positions, const PositionRecording& recording,
         const Mirrors& mirrors)
      : positions_(positions), mirrors_(mirrors) {
    anchors_.anchor.resize(positions.size() / 3);
    anchors_.mates.assign(positions.size() / 3, kNone);
    anchors_.turns.assign(positions.size() / 3, 0);
    comparisons_left_ = kComparisonsPerVertex * anchors_.anchor.size();
    Component component;
    for (const PositionRecording::Visit& visit : recording.visits()) {
      if (PositionRecording::beginsComponent(visit)) {
        finish(component);
        remember(component);
        component = {};
      }
      component.vertices.push_back(visit.vertex);
    }
    finish(component);
  }
  Anchors take() { return std::move(anchors_); }

 private:
  Point pointOf(uint32_t v) const {
    return {positions_[3 * size_t{v}], positions_[3 * size_t{v} + 1],
            positions_[3 * size_t{v} + 2]};
  }

  /// Finds the anchor of a component whose vertices are known.
  void finish(Component& c) {
    if (c.vertices.empty()) return;
    Point high;
    c.low = high = pointOf(c.vertices[0]);
    for (const uint32_t v : c.vertices) {
      const Point p = pointOf(v);
      for (size_t s = 0; s < 3; ++s) {
        c.low[s] = std::min(c.low[s], p[s]);
        high[s] = std::max(high[s], p[s]);
      }
    }
    for (size_t s = 0; s < 3; ++s) c.extent[s] = int64_t{high[s]} - c.low[s];
    if (c.vertices.size() >= kLeastVertices) find(c);
  }
  void remember(const Component& c) {
    if (mirrors_.count == 0) return;
    for (const uint32_t v : c.vertices) all_[pointOf(v)] = v;
  }

  /// Returns how many vertices have images under a mirror, if the first has and thus leads to them.
  size_t countMirrored(const Component& c) const {
    size_t most = 0;
    for (uint32_t m = 0; m < mirrors_.count; ++m) {
      const Mirror& mirror = mirrors_.mirror[m];
      size_t count = 0;
      for (size_t i = 0; i < c.vertices.size(); ++i) {
        Point p = pointOf(c.vertices[i]);
        p[mirror.axis] = static_cast<int32_t>(static_cast<uint32_t>(mirror.sum) -
                                              static_cast<uint32_t>(p[mirror.axis]));
        if (i == 0 && all_.find(p) == all_.end()) break;
        if (findNear(all_, p) != kNone) ++count;
      }
      most = std::max(most, count);
    }
    return most;
  }

  void find(const Component& c) {
    std::vector<Component>& known = known_[c.vertices.size()];
    size_t best = 0;
    const Component* of = nullptr;
    Anchor anchor;
    for (size_t k = 0; k < known.size() && best < c.vertices.size(); ++k) {
      for (Turn turn = 0; turn < kTurnCount; ++turn) {
        uint32_t first = kNone;
        const size_t hits = match(c, known[k], turn, first);
        if (hits <= best) continue;
        best = hits;
        of = &known[k];
        anchor = {first, turn};
      }
    }
    if (of == nullptr || 5 * best < 3 * c.vertices.size()) {
      if (known.size() < kMostKept) known.push_back(c);
      return;
    }
    if (countMirrored(c) >= best) return;
    anchors_.anchor[c.vertices[0]] = anchor;
    ++anchors_.count;
    for (const uint32_t v : c.vertices) {
      anchors_.mates[v] = mateOf(c, *of, anchor, v);
      anchors_.turns[v] = anchor.turn;
    }
  }
  uint32_t mateOf(const Component& c, const Component& of, const Anchor& anchor, uint32_t v) const {
    const Point from = plus(pointOf(v), pointOf(c.vertices[0]), -1);
    return findNear(of.at, plus(unturned(from, anchor.turn), pointOf(anchor.vertex), 1));
  }

  /// Returns how many vertices of c have mates if `of` is turned and moved so that the boxes agree.
  size_t match(const Component& c, Component& of, Turn turn, uint32_t& first) {
    const uint8_t* from = kAxisOrder[turn >> 3];
    Point base;  // the corner of the box of `of` that becomes the lowest of c
    for (size_t s = 0; s < 3; ++s) {
      if (std::abs(of.extent[from[s]] - c.extent[s]) > 2) return 0;
      base[from[s]] = wrapped(of.low[from[s]] + ((turn >> s & 1) != 0 ? of.extent[from[s]] : 0));
    }
    if (comparisons_left_ == 0) return 0;
    --comparisons_left_;
    if (of.at.empty()) {
      for (const uint32_t v : of.vertices) of.at[pointOf(v)] = v;
    }
    const auto mateAt = [&](uint32_t v) {
      return findNear(of.at, plus(unturned(plus(pointOf(v), c.low, -1), turn), base, 1));
    };
    first = mateAt(c.vertices[0]);
    if (first == kNone) return 0;
    const Anchor anchor{first, turn};
    size_t hits = 0;
    size_t tried = 0;
    for (const uint32_t v : c.vertices) {
      if (comparisons_left_ == 0) return 0;
      --comparisons_left_;
      hits += mateOf(c, of, anchor, v) != kNone ? 1 : 0;
      if (++tried == 8 && hits < 4) return 0;
      if (tried == 64 && 2 * hits < tried) return 0;
    }
    return hits;
  }

  const std::span<const int32_t> positions_;
  const Mirrors& mirrors_;
  Anchors anchors_;
  std::map<size_t, std::vector<Component>> known_;  ///< by the number of vertices
  PointMap all_;                                    ///< only with mirrors
  uint64_t comparisons_left_ = 0;
};

}  // namespace

Anchors findAnchors(std::span<const int32_t> positions, const PositionRecording& recording,
                    const Mirrors& mirrors) {
  return Finder(positions, recording, mirrors).take();
}

}  // namespace mcc
