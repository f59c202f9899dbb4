// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Positions: traversal, prediction, scale and tokens. Reader and writer run the same code.   [A.6, B.2]
//
// Traversal: grows a region of known vertices. A vertex is coded when most of its faces have both other corners
// known: three FIFO queues of half-edges by that number. Prediction: from the fan of known neighbours
// n0, n1, .. around v and the vertices o0, o1, .. opposite to v across the fan's edges:
//
//          o0 --- n1 --- o1      tips t0 = n0 + n1 - o0, t1 = n1 + n2 - o1 (parallelograms),
//           \    /  \    /       averaged, plus weighted features of the fan and of ya, yb beyond it
//    ya --   n0      n2  -- yb   fixed point: 8 fraction bits (Q8)
//              \    /
//                v
//
// Scale: a linear function of the neighbours' residuals and of the disagreement of the tips selects the row of token
// frequencies, one row set per component. The components of a vertex do not depend on each other.
#ifndef MCC_ATTRIBUTES_POSITIONS_H_
#define MCC_ATTRIBUTES_POSITIONS_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "attributes/position_tables.h"
#include "base/memory.h"
#include "entropy/models.h"
#include "mesh/face_mesh.h"
#include "mesh/groups.h"

namespace mcc {

/// State of one vertex (group): half a cache line.
struct VertexRecord {
  int32_t q[4];           ///< lattice coordinates; [3] is unused
  uint16_t magnitude[4];  ///< |residual| per component, saturating
  uint16_t known;
  uint16_t degree;  ///< faces; for boundary vertices min(12, 2 * faces)
  uint16_t score;   ///< faces whose other two corners are known
  uint16_t boundary;
};
static_assert(sizeof(VertexRecord) == 32);

/// Choices of the encoder, kept in the piece header.
struct PositionParameters {
  bool weighted = false;  ///< else the plain average of the tips
  bool own_weights = false;
  bool own_scale = false;
  bool shear = false;
  uint8_t bits = 14;  ///< of the lattice; seeds start from its middle
  PredictorWeights weights = kAverageWeights;
  ScaleCoefficients scale[2][3] = {};  ///< [fan of three][component]
};

inline void setUniversalScale(PositionParameters& p) {
  for (int fan = 0; fan < 2; ++fan) {
    for (int s = 0; s < 3; ++s) {
      p.scale[fan][s] = kUniversalScale[p.weighted ? 1 : 0][p.shear ? 1 : 0][fan][s];
    }
  }
}

struct PositionModels {
  TokenRow row[3][kScaleBuckets];

  PositionModels() {
    for (auto& component : row) {
      for (uint32_t b = 0; b < kScaleBuckets; ++b) initialTokenRow(b, component[b]);
    }
  }
};

/// Growing ring buffer of half-edges.
class HalfEdgeQueue {
 public:
  explicit HalfEdgeQueue(const Allocator& allocator) : ring_(allocator) {}

  [[nodiscard]] bool init() { return ring_.resize(1024); }
  bool empty() const { return head_ == tail_; }
  uint32_t pop() { return ring_[head_++ & (ring_.size() - 1)]; }
  [[nodiscard]] bool push(uint32_t half_edge) {
    if (tail_ - head_ == ring_.size() && !grow()) return false;
    ring_[tail_++ & (ring_.size() - 1)] = half_edge;
    return true;
  }

 private:
  bool grow() {
    const uint32_t old_size = static_cast<uint32_t>(ring_.size());
    if (!ring_.resize(size_t{old_size} * 2)) return false;
    // Entries keep their index modulo the new size: those whose bit old_size is set move up.
    for (uint32_t i = head_; i != tail_; ++i) {
      if ((i & old_size) != 0) ring_[i & (2 * old_size - 1)] = ring_[i & (old_size - 1)];
    }
    return true;
  }

  Array<uint32_t> ring_;
  uint32_t head_ = 0;
  uint32_t tail_ = 0;
};

/// Saturating magnitude for contexts.
inline uint16_t magnitudeOf(uint32_t absolute) {
  return static_cast<uint16_t>(std::min(absolute, 0xffffu));
}

/// Half-octave bucket of a scale, 0 .. kScaleBuckets-1.
inline uint32_t scaleBucket(uint32_t scale) {
  const uint32_t y = scale + 1;
  const uint32_t k = static_cast<uint32_t>(std::bit_width(y)) - 1;
  const uint32_t bucket = 2 * k + (((uint64_t{2} * y) >> k) & 1);
  return std::min(bucket, kScaleBuckets - 1);
}

inline constexpr uint8_t kTokenExtraBits[kTokenCount] = {0, 0, 0, 0, 0, 0, 0, 0,
                                                         2, 2, 3, 3, 4, 4, 6, 0};
inline constexpr uint8_t kTokenBase[kTokenCount] = {0, 1,  2,  3,  4,  5,  6,  7,
                                                    8, 12, 16, 24, 32, 48, 64, 128};
inline constexpr uint32_t kTokenEscape = 15;

/// One residual: its magnitude above h low bits as a token, then raw bits, then the sign.   [B.2.5]
template <uint32_t kState, class Io>
int32_t codeResidual(Io& io, TokenRow& row, uint32_t low_bits, int32_t truth) {
  uint32_t a = 0;
  uint32_t token = 0;
  uint32_t bits = 0;
  if constexpr (Io::kEncoding) {
    a = truth < 0 ? 0u - static_cast<uint32_t>(truth) : static_cast<uint32_t>(truth);
    const uint32_t z = a >> low_bits;
    token = z < 8 ? z : kTokenEscape;
    if (z >= 8 && z < 128) {
      token = 8;
      while (kTokenBase[token + 1] <= z) ++token;
    }
  }
  token = io.template token<kState>(row, kPositionSchedule, token);
  if (token == kTokenEscape) [[unlikely]] {
    const uint32_t above = (a >> low_bits) - 127;
    const uint32_t k =
        io.raw(5, Io::kEncoding ? static_cast<uint32_t>(std::bit_width(above)) - 1 : 0);
    const uint32_t mask = (uint32_t{1} << k) - 1;
    const uint32_t z = ((mask + 1) | io.raw(k, above & mask)) + 127;
    a = z << low_bits | io.raw(low_bits, a & ((1u << low_bits) - 1));
  } else {
    bits = kTokenExtraBits[token] + low_bits;
    const uint32_t base = uint32_t{kTokenBase[token]} << low_bits;
    a = base + io.raw(bits, a - base);
  }
  const uint32_t negative = io.raw(a != 0 ? 1 : 0, truth < 0 ? 1 : 0);
  const uint32_t mask = ~negative + 1;
  return static_cast<int32_t>((a ^ mask) - mask);
}

/// `Wide` holds Q8 predictions: int32_t up to 17 bits, int64_t above. Arithmetic wraps.
template <class Io, class Wide>
class PositionCoder {
 public:
  PositionCoder(Io& io, PositionModels& models, const PositionParameters& parameters,
                FaceMesh& mesh, const Groups& groups, VertexRecord* records,
                const Allocator& allocator, const int32_t* truth)
      : io_(io),
        models_(models),
        p_(parameters),
        faces_(mesh.view()),
        face_count_(mesh.face_count),
        groups_(groups),
        records_(records),
        truth_(truth),
        queue_{HalfEdgeQueue(allocator), HalfEdgeQueue(allocator), HalfEdgeQueue(allocator)} {}

  /// Codes all groups of vertices, then the isolated ones. `records` has an entry for each; `order`, if given, receives
  /// the half-edge each group was entered by, in coding order. `truth` has 3 coordinates per record (encoder).
  Status run(Array<uint32_t>* order, uint32_t isolated_count);

 private:
  static constexpr uint32_t kFanLimit = 8;  ///< faces of a fan looked at on each side of the entry

  using UWide = std::make_unsigned_t<Wide>;

  struct Stencil {
    uint32_t half_edge[2 * kFanLimit + 1];  ///< faces of the fan, clockwise-most first
    uint32_t first = 0;
    uint32_t face_count = 0;
    bool closed = false;
  };

  void prepareRecords();
  Status grow(Array<uint32_t>* order);
  Status plantSeed(Array<uint32_t>* order, uint32_t& cursor);
  Status visit(uint32_t half_edge);
  Status push(uint32_t half_edge);
  Status walkFan(uint32_t half_edge, Stencil& fan);
  Status pushOtherUmbrellas(uint32_t v, uint32_t entry);
  Status pushRing(uint32_t start);
  bool ringContains(uint32_t start, uint32_t half_edge) const;
  Status become(uint32_t v, Array<uint32_t>* order, uint32_t half_edge);
  void codeFromFan(uint32_t v, const Stencil& fan);
  void addFanFeatures(const VertexRecord& r, const uint32_t* h, const VertexRecord& n0,
                      const VertexRecord& n1, const VertexRecord& n2, const VertexRecord& o0,
                      const VertexRecord& o1, UWide* base) const;
  void predictOther(const VertexRecord& r, const Stencil& fan, UWide* base, uint32_t* magnitude_sum,
                    uint32_t* spread) const;
  static uint32_t clampSpread(UWide difference) {
    const Wide d = static_cast<Wide>(difference);
    const UWide absolute = d < 0 ? UWide{0} - difference : difference;
    return static_cast<uint32_t>(std::min<UWide>(absolute, 1u << 20));
  }
  void codeSeed(uint32_t v, const VertexRecord* neighbour);
  template <uint32_t kState>
  void codeComponent(uint32_t v, VertexRecord& r, int32_t prediction, uint32_t scale);

  bool known(uint32_t v) const { return records_[v].known != 0; }
  const VertexRecord& recordAt(uint32_t half_edge) const {
    return records_[faces_.vertex(half_edge)];
  }
  /// Vertex opposite to half-edge h in the neighbouring face, if there is one and it is known.
  const VertexRecord* across(uint32_t h) const {
    const uint32_t t = faces_.twin(h);
    if (t == kNone) return nullptr;
    const VertexRecord& r = recordAt(prevHalfEdge(t));
    return r.known != 0 ? &r : nullptr;
  }

  Io& io_;
  PositionModels& models_;
  const PositionParameters& p_;
  const FaceView faces_;
  const uint32_t face_count_;
  const Groups& groups_;
  VertexRecord* const records_;
  const int32_t* const truth_;
  HalfEdgeQueue queue_[3];
  uint32_t known_count_ = 0;
  int32_t last_seed_[3] = {};
  uint32_t seed_scale_[2][3] = {};
};

template <class Io, class Wide>
void PositionCoder<Io, Wide>::prepareRecords() {
  for (uint32_t v = 0; v < groups_.count; ++v) records_[v] = VertexRecord{};
  for (uint32_t f = 0; f < face_count_; ++f) {
    const uint32_t h = f * kFaceWords;
    for (uint32_t k = 0; k < 3; ++k) {
      VertexRecord& r = records_[faces_.vertex(h + k)];
      r.degree = static_cast<uint16_t>(r.degree + (r.degree != 0xffff ? 1 : 0));
      if (faces_.twin(h + k) == kNone) {
        r.boundary = 1;
        records_[faces_.vertex(nextHalfEdge(h + k))].boundary = 1;
      }
    }
  }
  for (uint32_t v = 0; v < groups_.count; ++v) {
    VertexRecord& r = records_[v];
    if (r.boundary != 0) r.degree = static_cast<uint16_t>(std::min(12, 2 * r.degree));
  }
}

template <class Io, class Wide>
Status PositionCoder<Io, Wide>::run(Array<uint32_t>* order, uint32_t isolated_count) {
  for (HalfEdgeQueue& queue : queue_) {
    if (!queue.init()) return fail(Error::kOutOfMemory, "no memory for the position decoder");
  }
  prepareRecords();
  for (int s = 0; s < 3; ++s) {
    last_seed_[s] = static_cast<int32_t>((uint32_t{1} << p_.bits) / 2);
    seed_scale_[0][s] = 8u << p_.bits;
    seed_scale_[1][s] = 64;
  }
  uint32_t cursor = 0;
  while (known_count_ < groups_.count) {
    if (io_.overrun()) return fail(Error::kTruncated, "the token stream ends inside the positions");
    MCC_TRY(plantSeed(order, cursor));
    MCC_TRY(grow(order));
  }
  for (uint32_t i = 0; i < isolated_count; ++i) {
    records_[groups_.count + i] = VertexRecord{};
    codeSeed(groups_.count + i, nullptr);
    if ((i & 0xfff) == 0 && io_.overrun()) {
      return fail(Error::kTruncated, "the token stream ends inside the positions");
    }
  }
  return {};
}

/// Codes vertices of the next face that is not known yet until two of its corners are; that queues the third.
template <class Io, class Wide>
Status PositionCoder<Io, Wide>::plantSeed(Array<uint32_t>* order, uint32_t& cursor) {
  for (; cursor < face_count_; ++cursor) {
    const uint32_t base = cursor * kFaceWords;
    uint32_t known_corners = 0;
    for (uint32_t k = 0; k < 3; ++k) known_corners += known(faces_.vertex(base + k)) ? 1 : 0;
    if (known_corners == 3) continue;
    if (known_corners == 2) {  // between two fans: nobody queued it
      for (uint32_t k = 0; k < 3; ++k) {
        if (!known(faces_.vertex(base + k))) return push(base + k);
      }
    }
    for (uint32_t k = 0; k < 3 && known_corners < 2; ++k) {
      const uint32_t h = base + k;
      const uint32_t v = faces_.vertex(h);
      if (known(v)) continue;
      const VertexRecord* neighbour = nullptr;
      if (known(faces_.vertex(nextHalfEdge(h)))) neighbour = &recordAt(nextHalfEdge(h));
      if (known(faces_.vertex(prevHalfEdge(h)))) neighbour = &recordAt(prevHalfEdge(h));
      codeSeed(v, neighbour);
      MCC_TRY(become(v, order, h));
      MCC_TRY(pushRing(h));
      MCC_TRY(pushOtherUmbrellas(v, h));
      ++known_corners;
    }
    return {};
  }
  return fail(Error::kBadConnectivity, "a vertex has no triangle");
}

template <class Io, class Wide>
Status PositionCoder<Io, Wide>::grow(Array<uint32_t>* order) {
  for (;;) {
    uint32_t level = 2;
    while (queue_[level].empty()) {
      if (level-- == 0) return {};
    }
    const uint32_t h = queue_[level].pop();
    const VertexRecord& r = recordAt(h);
    if (r.known != 0 || std::min<uint32_t>(r.score, 3) != level + 1) continue;  // stale
    const uint32_t v = faces_.vertex(h);
    Stencil fan;
    MCC_TRY(walkFan(h, fan));
    codeFromFan(v, fan);
    MCC_TRY(become(v, order, h));
    if (groups_.hasCopies()) MCC_TRY(pushOtherUmbrellas(v, h));
  }
}

template <class Io, class Wide>
Status PositionCoder<Io, Wide>::become(uint32_t v, Array<uint32_t>* order, uint32_t half_edge) {
  records_[v].known = 1;
  ++known_count_;
  if (order != nullptr && !order->push_back(half_edge)) {
    return fail(Error::kOutOfMemory, "no memory for the traversal");
  }
  if ((known_count_ & 0xfff) == 0 && io_.overrun()) {
    return fail(Error::kTruncated, "the token stream ends inside the positions");
  }
  return {};
}

template <class Io, class Wide>
Status PositionCoder<Io, Wide>::push(uint32_t half_edge) {
  VertexRecord& r = records_[faces_.vertex(half_edge)];
  r.score = static_cast<uint16_t>(r.score + (r.score != 0xffff ? 1 : 0));
  if (!queue_[std::min<uint32_t>(r.score, 3) - 1].push(half_edge)) {
    return fail(Error::kOutOfMemory, "no memory for the traversal");
  }
  return {};
}

/// The contiguous fan of known neighbours on both sides of the entry face; queues the vertices behind its ends.
template <class Io, class Wide>
Status PositionCoder<Io, Wide>::walkFan(uint32_t half_edge, Stencil& fan) {
  uint32_t first = kFanLimit;
  uint32_t end = kFanLimit;
  fan.half_edge[end++] = half_edge;
  while (end - kFanLimit <= kFanLimit) {
    const uint32_t h = faces_.rotateCcw(fan.half_edge[end - 1]);
    if (h == kNone) break;
    if (h == half_edge) {
      fan.closed = true;
      break;
    }
    const uint32_t third = prevHalfEdge(h);
    if (!known(faces_.vertex(third))) {
      MCC_TRY(push(third));
      break;
    }
    fan.half_edge[end++] = h;
  }
  while (first != 0 && !fan.closed) {
    const uint32_t t = faces_.twin(fan.half_edge[first]);
    if (t == kNone) break;
    const uint32_t third = prevHalfEdge(t);
    if (!known(faces_.vertex(third))) {
      MCC_TRY(push(third));
      break;
    }
    const uint32_t h = nextHalfEdge(t);
    if (h == fan.half_edge[end - 1]) break;  // met the other side beyond its limit
    fan.half_edge[--first] = h;
  }
  fan.first = first;
  fan.face_count = end - first;
  return {};
}

/// Queues every face around `start` with one unknown corner.
template <class Io, class Wide>
Status PositionCoder<Io, Wide>::pushRing(uint32_t start) {
  uint32_t h = start;
  bool ccw = true;
  for (;;) {
    const uint32_t a = nextHalfEdge(h);
    const uint32_t b = prevHalfEdge(h);
    const bool a_known = known(faces_.vertex(a));
    const bool b_known = known(faces_.vertex(b));
    if (a_known != b_known) MCC_TRY(push(a_known ? b : a));
    h = ccw ? faces_.rotateCcw(h) : faces_.rotateCw(h);
    if (h == start) return {};
    if (h == kNone) {
      if (!ccw) return {};
      ccw = false;
      h = faces_.rotateCw(start);
      if (h == kNone) return {};
    }
  }
}

/// Faces of a group's other umbrellas: whatever is known through one piece of the surface is known to all.
template <class Io, class Wide>
Status PositionCoder<Io, Wide>::pushOtherUmbrellas(uint32_t v, uint32_t entry) {
  if (!groups_.hasCopies()) return {};
  const uint32_t begin = groups_.umbrella_begin[v];
  const uint32_t end = groups_.umbrella_begin[v + 1];
  if (end - begin < 2) return {};
  for (uint32_t i = begin; i < end; ++i) {
    if (!ringContains(groups_.umbrellas[i], entry)) MCC_TRY(pushRing(groups_.umbrellas[i]));
  }
  return {};
}

template <class Io, class Wide>
bool PositionCoder<Io, Wide>::ringContains(uint32_t start, uint32_t half_edge) const {
  uint32_t h = start;
  do {
    if (h == half_edge) return true;
    h = faces_.rotateCcw(h);
  } while (h != kNone && h != start);
  if (h == start) return false;
  for (h = faces_.rotateCw(start); h != kNone; h = faces_.rotateCw(h)) {
    if (h == half_edge) return true;
  }
  return false;
}

/// Prediction from the fan: base and features in Q8, see position_tables.h.                  [B.2.2]
template <class Io, class Wide>
void PositionCoder<Io, Wide>::codeFromFan(uint32_t v, const Stencil& fan) {
  const uint32_t* h = fan.half_edge + fan.first;
  const uint32_t faces = fan.face_count;
  VertexRecord& r = records_[v];
  const VertexRecord* n0 = &recordAt(nextHalfEdge(h[0]));
  const VertexRecord* n1 = &recordAt(prevHalfEdge(h[0]));
  UWide base[3];
  uint32_t magnitude_sum[3];
  uint32_t spread[3] = {};
  uint32_t fan3 = 0;
  const VertexRecord* o0 = across(nextHalfEdge(h[0]));
  const VertexRecord* o1 = faces == 2 && !fan.closed ? across(nextHalfEdge(h[1])) : nullptr;
  if (o0 != nullptr && o1 != nullptr) [[likely]] {
    fan3 = 1;
    const VertexRecord* n2 = &recordAt(prevHalfEdge(h[1]));
    for (int s = 0; s < 3; ++s) {
      const UWide e = static_cast<UWide>(n0->q[s]) + static_cast<UWide>(n2->q[s]);
      const UWide o = static_cast<UWide>(o0->q[s]) + static_cast<UWide>(o1->q[s]);
      const UWide m = static_cast<UWide>(n1->q[s]);
      base[s] = 128 * (e + 2 * m - o);
      spread[s] = clampSpread(static_cast<UWide>(n0->q[s]) - static_cast<UWide>(o0->q[s]) -
                              static_cast<UWide>(n2->q[s]) + static_cast<UWide>(o1->q[s]));
      magnitude_sum[s] = uint32_t{n0->magnitude[s]} + n1->magnitude[s] + n2->magnitude[s];
    }
    if (p_.weighted) addFanFeatures(r, h, *n0, *n1, *n2, *o0, *o1, base);
  } else {
    predictOther(r, fan, base, magnitude_sum, spread);
  }
  const ScaleCoefficients* c = p_.scale[fan3];
  uint32_t scale[3];
  int32_t prediction[3];
  for (int s = 0; s < 3; ++s) {
    scale[s] = (c[s].c[0] * magnitude_sum[s] + c[s].c[1] * spread[s] + c[s].c[2]) >> 6;
    prediction[s] = static_cast<int32_t>(static_cast<Wide>(base[s] + 128) >> 8);
  }
  codeComponent<0>(v, r, prediction[0], scale[0]);
  codeComponent<1>(v, r, prediction[1], scale[1]);
  codeComponent<2>(v, r, prediction[2], scale[2]);
}

template <class Io, class Wide>
void PositionCoder<Io, Wide>::addFanFeatures(const VertexRecord& r, const uint32_t* h,
                                             const VertexRecord& n0, const VertexRecord& n1,
                                             const VertexRecord& n2, const VertexRecord& o0,
                                             const VertexRecord& o1, UWide* base) const {
  const uint32_t degree_class = kClassFan + std::clamp<uint32_t>(r.degree, 3, 9);
  const int16_t* w = p_.weights.w[degree_class];
  const int32_t sum = std::clamp(int32_t{n0.degree} + n2.degree - 12, -12, 12);
  const int32_t skew = std::clamp(int32_t{n0.degree} - n2.degree, -12, 12);
  const VertexRecord* ya = across(nextHalfEdge(faces_.twin(nextHalfEdge(h[0]))));
  const VertexRecord* yb = across(prevHalfEdge(faces_.twin(nextHalfEdge(h[1]))));
  const UWide w0 = static_cast<UWide>(w[0] + w[4] * sum);
  const UWide w1 = static_cast<UWide>(w[1]);
  const UWide w2 = static_cast<UWide>(2 * w[2]);
  const UWide w3 = static_cast<UWide>(2 * w[3] * skew);
  for (int s = 0; s < 3; ++s) {
    const UWide a = static_cast<UWide>(n0.q[s]);
    const UWide m = static_cast<UWide>(n1.q[s]);
    const UWide b = static_cast<UWide>(n2.q[s]);
    const UWide oa = static_cast<UWide>(o0.q[s]);
    const UWide ob = static_cast<UWide>(o1.q[s]);
    UWide beyond = 0;
    if (ya != nullptr) beyond += static_cast<UWide>(ya->q[s]) - a - oa + m;
    if (yb != nullptr) beyond += static_cast<UWide>(yb->q[s]) - b - ob + m;
    base[s] += w0 * (a + b + oa + ob - 4 * m) + w1 * (a + b - 2 * m) + w2 * beyond + w3 * (a - b);
  }
}

/// Everything but the plain fan of three with two tips.                                      [B.2.3]
template <class Io, class Wide>
void PositionCoder<Io, Wide>::predictOther(const VertexRecord& r, const Stencil& fan, UWide* base,
                                           uint32_t* magnitude_sum, uint32_t* spread) const {
  const uint32_t* h = fan.half_edge + fan.first;
  const uint32_t neighbours = fan.closed ? fan.face_count : fan.face_count + 1;
  UWide neighbour_sum[3] = {};
  UWide tip_sum[3] = {};
  UWide tip[2][3] = {};
  uint32_t tip_count = 0;
  const VertexRecord* tip_a = nullptr;
  const VertexRecord* tip_b = nullptr;
  const VertexRecord* tip_o = nullptr;
  for (int s = 0; s < 3; ++s) magnitude_sum[s] = 0;
  for (uint32_t i = 0; i < neighbours; ++i) {
    const VertexRecord& n =
        i < fan.face_count ? recordAt(nextHalfEdge(h[i])) : recordAt(prevHalfEdge(h[i - 1]));
    for (int s = 0; s < 3; ++s) {
      neighbour_sum[s] += static_cast<UWide>(n.q[s]);
      magnitude_sum[s] += n.magnitude[s];
    }
  }
  for (uint32_t i = 0; i < fan.face_count; ++i) {
    const VertexRecord* o = across(nextHalfEdge(h[i]));
    if (o == nullptr) continue;
    tip_a = &recordAt(nextHalfEdge(h[i]));
    tip_b = &recordAt(prevHalfEdge(h[i]));
    tip_o = o;
    for (int s = 0; s < 3; ++s) {
      const UWide t = static_cast<UWide>(tip_a->q[s]) + static_cast<UWide>(tip_b->q[s]) -
                      static_cast<UWide>(o->q[s]);
      tip_sum[s] += t;
      if (tip_count < 2) tip[tip_count][s] = t;
    }
    ++tip_count;
  }
  uint32_t predictor_class = std::min(tip_count, 4u);
  if (fan.closed && tip_count != 0) {
    predictor_class = tip_count < 4 ? kClassClosedFewTips : kClassClosedManyTips;
  }
  const int16_t* w = p_.weights.w[predictor_class];
  UWide w_tip = 0;
  UWide w_skew = 0;
  if (p_.weighted && predictor_class == kClassOneTip) {
    const int32_t sum = std::clamp(int32_t{tip_a->degree} + tip_b->degree - 12, -12, 12);
    const int32_t skew = std::clamp(int32_t{tip_a->degree} - tip_b->degree, -12, 12);
    w_tip = static_cast<UWide>(w[0] + w[2] * (std::min<int32_t>(12, r.degree) - 6) + w[4] * sum);
    w_skew = static_cast<UWide>(2 * w[3] * skew);
  }
  for (int s = 0; s < 3; ++s) {
    magnitude_sum[s] = neighbours == 3 ? magnitude_sum[s] : magnitude_sum[s] * 3 / neighbours;
    const Wide mean = static_cast<Wide>(256 * neighbour_sum[s]) / static_cast<Wide>(neighbours);
    base[s] = static_cast<UWide>(mean);
    if (tip_count == 0) continue;
    base[s] =
        static_cast<UWide>(static_cast<Wide>(256 * tip_sum[s]) / static_cast<Wide>(tip_count));
    if (tip_count >= 2) spread[s] = clampSpread(tip[0][s] - tip[1][s]);
    if (!p_.weighted) continue;
    const Wide f1 = static_cast<Wide>(static_cast<UWide>(mean) - base[s]) >> 7;
    base[s] += static_cast<UWide>(w[1]) * static_cast<UWide>(f1);
    if (predictor_class != kClassOneTip) continue;
    const UWide a = static_cast<UWide>(tip_a->q[s]);
    const UWide b = static_cast<UWide>(tip_b->q[s]);
    base[s] += w_tip * (a + b - 2 * static_cast<UWide>(tip_o->q[s])) + w_skew * (a - b);
  }
}

/// First or second vertex of a component: a neighbour's position or the last seed's, scale by earlier seeds. [B.2.6]
template <class Io, class Wide>
void PositionCoder<Io, Wide>::codeSeed(uint32_t v, const VertexRecord* neighbour) {
  VertexRecord& r = records_[v];
  uint32_t* scale = seed_scale_[neighbour != nullptr ? 1 : 0];
  const int32_t* from = neighbour != nullptr ? neighbour->q : last_seed_;
  const int32_t prediction[3] = {from[0], from[1], from[2]};
  codeComponent<0>(v, r, prediction[0], scale[0]);
  codeComponent<1>(v, r, prediction[1], scale[1]);
  codeComponent<2>(v, r, prediction[2], scale[2]);
  for (int s = 0; s < 3; ++s) {
    scale[s] = (scale[s] + 16 * uint32_t{r.magnitude[s]}) / 2;
    if (neighbour == nullptr) {
      last_seed_[s] = r.q[s];
      // The distance between components says nothing about the residuals around this vertex.
      r.magnitude[s] = magnitudeOf(seed_scale_[1][s] / 16);
    }
  }
}

template <class Io, class Wide>
template <uint32_t kState>
void PositionCoder<Io, Wide>::codeComponent(uint32_t v, VertexRecord& r, int32_t prediction,
                                            uint32_t scale) {
  const uint32_t bucket = scaleBucket(scale);
  const uint32_t low_bits = bucket >= 10 ? bucket / 2 - 5 : 0;
  int32_t residual = 0;
  if constexpr (Io::kEncoding) {
    residual = static_cast<int32_t>(static_cast<uint32_t>(truth_[3 * size_t{v} + kState]) -
                                    static_cast<uint32_t>(prediction));
  }
  residual = codeResidual<kState>(io_, models_.row[kState][bucket], low_bits, residual);
  const uint32_t bits = static_cast<uint32_t>(residual);
  r.magnitude[kState] = magnitudeOf(residual < 0 ? 0u - bits : bits);
  r.q[kState] = static_cast<int32_t>(static_cast<uint32_t>(prediction) + bits);
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITIONS_H_
