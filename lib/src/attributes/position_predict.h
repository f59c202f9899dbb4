// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Prediction of a vertex from its fan, in fixed point with 8 fraction bits (Q8).             [B.2.2]
//
//          xa      xb           tips t0 = n0 + n1 - o0 and t1 = n1 + n2 - o1 (parallelograms) are averaged;
//          /\      /\           weights by class add features of the fan, of the degrees around it and of
//        o0 --- n1 --- o1       ya, yb. With tip selection xa, xb, ya, yb tell how well each kind of
//  ya   /  \   /  \   /  \  yb  parallelogram did one step back.
//         n0        n2
//            \    /
//               v
//
// `Wide` is int32_t up to 17 bits of the lattice, int64_t above; arithmetic wraps.
#ifndef MCC_ATTRIBUTES_POSITION_PREDICT_H_
#define MCC_ATTRIBUTES_POSITION_PREDICT_H_

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "attributes/position_growth.h"
#include "attributes/position_parameters.h"
#include "base/host.h"

namespace mcc {

/// What the coder needs to know about a vertex before its residuals.
template <class Wide>
struct Prediction {
  using Coordinate = Wide;
  std::make_unsigned_t<Wide> q8[3];
  uint32_t spread[3];  ///< disagreement of the first two tips, saturating
  uint64_t normal[3];  ///< sum over the tips, wrapping; only with shear
  std::make_unsigned_t<Wide>
      magnitudes[3];  ///< of three neighbours' residuals, by component as coded
};

inline constexpr uint32_t kSpreadLimit = 1u << 19;

template <class UWide>
MCC_INLINE uint32_t saturatedAbsolute(UWide difference) {
  const auto d = static_cast<std::make_signed_t<UWide>>(difference);
  const UWide absolute = d < 0 ? UWide{0} - difference : difference;
  return static_cast<uint32_t>(std::min<UWide>(absolute, kSpreadLimit));
}

/// Vertices behind the plain fan; missing ones point to some other vertex and have a zero mask.
struct Beyond {
  const VertexRecord* ya;
  const VertexRecord* yb;
  const VertexRecord* xa;
  const VertexRecord* xb;
  bool has_ya;
  bool has_yb;
  bool has_x;  ///< both, and the ring around n1 has room for them
};

MCC_INLINE const VertexRecord* lookAcross(const FaceView& faces, const VertexRecord* records,
                                          uint32_t half_edge, bool& known) {
  const uint32_t t = faces.twin(half_edge);
  const VertexRecord& r =
      records[faces.vertex(t != kNone ? prevHalfEdge(t) : prevHalfEdge(half_edge))];
  known = (t != kNone) & (r.known != 0);
  return &r;
}

MCC_INLINE Beyond lookBeyond(const FaceView& faces, const VertexRecord* records,
                             const PlainFan& fan, bool select) {
  Beyond b;
  b.ya = lookAcross(faces, records, nextHalfEdge(fan.beyond0), b.has_ya);
  b.yb = lookAcross(faces, records, prevHalfEdge(fan.beyond1), b.has_yb);
  b.has_x = false;
  if (!select) return b;
  bool has_xa = false;
  bool has_xb = false;
  b.xa = lookAcross(faces, records, prevHalfEdge(fan.beyond0), has_xa);
  b.xb = lookAcross(faces, records, nextHalfEdge(fan.beyond1), has_xb);
  b.has_x = has_xa & has_xb & (fan.n1->degree >= 6);
  return b;
}

/// How the kinds of parallelograms compare one step back: the class, and which of the tips did better.
struct TipSelection {
  uint32_t predictor_class;
  int32_t better;  ///< +1: t0, -1: t1, 0: a tie
};

template <class Wide>
MCC_INLINE TipSelection selectTip(const PlainFan& f, const Beyond& b) {
  using UWide = std::make_unsigned_t<Wide>;
  uint32_t error0 = 0;
  uint32_t error1 = 0;
  uint32_t error2 = 0;
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    const UWide n0 = static_cast<UWide>(f.n0->q[s]);
    const UWide n1 = static_cast<UWide>(f.n1->q[s]);
    const UWide n2 = static_cast<UWide>(f.n2->q[s]);
    const UWide o0 = static_cast<UWide>(f.o0->q[s]);
    const UWide o1 = static_cast<UWide>(f.o1->q[s]);
    const UWide mask_a = UWide{0} - static_cast<UWide>(b.has_ya);
    const UWide mask_b = UWide{0} - static_cast<UWide>(b.has_yb);
    error1 += saturatedAbsolute<UWide>(n1 + o0 - static_cast<UWide>(b.xa->q[s]) - n0);
    error0 += saturatedAbsolute<UWide>(n1 + o1 - static_cast<UWide>(b.xb->q[s]) - n2);
    error2 += saturatedAbsolute<UWide>((static_cast<UWide>(b.ya->q[s]) - n0 - o0 + n1) & mask_a);
    error2 += saturatedAbsolute<UWide>((static_cast<UWide>(b.yb->q[s]) - n2 - o1 + n1) & mask_b);
  }
  const uint32_t both = b.has_ya && b.has_yb ? 1 : 0;
  error2 = (error2 + both) >> both;
  if (!b.has_ya & !b.has_yb) error2 = 1u << 28;
  const uint32_t low = std::min(error0, error1);
  const uint32_t high = std::max(error0, error1);
  const uint32_t preference = uint32_t{2 * high > 3 * low + 2} + uint32_t{high > 3 * low + 2};
  const uint32_t third = uint32_t{error2 <= 2 * low} + uint32_t{2 * error2 <= low};
  return {kClassSelect + 3 * preference + third,
          static_cast<int32_t>(error0 < error1) - static_cast<int32_t>(error0 > error1)};
}

/// Class, and what scales the weights of a plain fan besides the features of a component.
struct PlainClass {
  uint32_t predictor_class;
  int32_t degree_sum;
  int32_t degree_skew;
  int32_t better;  ///< see TipSelection
};

template <class Wide>
MCC_INLINE PlainClass classifyPlain(PositionPredictor predictor, bool select, const PlainFan& f,
                                    const Beyond& b, uint32_t degree) {
  PlainClass c;
  c.predictor_class = kClassFan + std::clamp<uint32_t>(degree, 3, 9);
  c.degree_sum = std::clamp(int32_t{f.n0->degree} + f.n2->degree - 12, -12, 12);
  c.degree_skew = std::clamp(int32_t{f.n0->degree} - f.n2->degree, -12, 12);
  c.better = 0;
  if (!select) return c;
  if (b.has_x & ((degree == 6) | (predictor == PositionPredictor::kSelecting))) {
    const TipSelection selection = selectTip<Wide>(f, b);
    c.predictor_class = selection.predictor_class;
    c.better = selection.better;
  }
  return c;
}

/// Features of one component.
template <class UWide>
struct PlainFeatures {
  UWide f0;    ///< fan against tips
  UWide f1;    ///< ends of the fan against its middle
  UWide fy;    ///< ya, yb against their parallelograms
  UWide fd;    ///< from one end to the other
  UWide tips;  ///< t0 - t1; this and the next two only where a tip was selected
  UWide x;
  UWide y;
};

template <class UWide>
MCC_INLINE PlainFeatures<UWide> plainFeatures(const PlainFan& f, const Beyond& b, int s,
                                              bool select) {
  PlainFeatures<UWide> r{};
  const UWide n0 = static_cast<UWide>(f.n0->q[s]);
  const UWide n1 = static_cast<UWide>(f.n1->q[s]);
  const UWide n2 = static_cast<UWide>(f.n2->q[s]);
  const UWide o0 = static_cast<UWide>(f.o0->q[s]);
  const UWide o1 = static_cast<UWide>(f.o1->q[s]);
  const UWide ya =
      (static_cast<UWide>(b.ya->q[s]) - n0 - o0 + n1) & (UWide{0} - static_cast<UWide>(b.has_ya));
  const UWide yb =
      (static_cast<UWide>(b.yb->q[s]) - n2 - o1 + n1) & (UWide{0} - static_cast<UWide>(b.has_yb));
  r.f0 = n0 + n2 + o0 + o1 - 4 * n1;
  r.f1 = n0 + n2 - 2 * n1;
  r.fy = 2 * (ya + yb);
  r.fd = 2 * (n0 - n2);
  if (!select) return r;
  r.tips = n0 - n2 + o1 - o0;
  r.x = (n1 + o0 - static_cast<UWide>(b.xa->q[s]) - n0) -
        (n1 + o1 - static_cast<UWide>(b.xb->q[s]) - n2);
  r.y = ya - yb;
  return r;
}

/// Weighted features of a plain fan, added to the average of the tips.
template <class Wide>
MCC_INLINE void addPlainFeatures(const PositionParameters& p, const PlainFan& f, const Beyond& b,
                                 uint32_t degree, bool select, std::make_unsigned_t<Wide>* q8) {
  using UWide = std::make_unsigned_t<Wide>;
  const PlainClass c = classifyPlain<Wide>(p.predictor, select, f, b, degree);
  const int16_t* w = p.weights.w[c.predictor_class];
  const UWide w0 = static_cast<UWide>(w[0] + w[4] * c.degree_sum);
  const UWide w1 = static_cast<UWide>(w[1]);
  const UWide wy = static_cast<UWide>(w[2]);
  const UWide wd = static_cast<UWide>(w[3] * c.degree_skew);
  const UWide w_tips = static_cast<UWide>(c.better * w[5]);
  const UWide wx = static_cast<UWide>(c.better * w[6]);
  const UWide w_y = static_cast<UWide>(c.better * w[7]);
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    const PlainFeatures<UWide> v = plainFeatures<UWide>(f, b, s, select);
    q8[s] += w0 * v.f0 + w1 * v.f1 + wy * v.fy + wd * v.fd;
    if (select) q8[s] += w_tips * v.tips + wx * v.x + w_y * v.y;
  }
}

/// Adds the normal of a tip's triangle (a, b, o).                                             [B.2.3]
MCC_INLINE void addNormal(const VertexRecord& a, const VertexRecord& b, const VertexRecord& o,
                          uint64_t* normal) {
  uint64_t u[3];
  uint64_t w[3];
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    u[s] = static_cast<uint64_t>(int64_t{a.q[s]} - b.q[s]);
    w[s] = static_cast<uint64_t>(int64_t{o.q[s]} - b.q[s]);
  }
  normal[0] += u[1] * w[2] - u[2] * w[1];
  normal[1] += u[2] * w[0] - u[0] * w[2];
  normal[2] += u[0] * w[1] - u[1] * w[0];
}

/// `beyond` may be null without weights.
template <class Wide>
MCC_INLINE void predictPlain(const PositionParameters& p, const PlainFan& f, const Beyond* beyond,
                             uint32_t degree, uint32_t modes, Prediction<Wide>& out) {
  using UWide = std::make_unsigned_t<Wide>;
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    const UWide e = static_cast<UWide>(f.n0->q[s]) + static_cast<UWide>(f.n2->q[s]);
    const UWide o = static_cast<UWide>(f.o0->q[s]) + static_cast<UWide>(f.o1->q[s]);
    out.q8[s] = 128 * (e + 2 * static_cast<UWide>(f.n1->q[s]) - o);
    out.spread[s] =
        saturatedAbsolute<UWide>(static_cast<UWide>(f.n0->q[s]) - static_cast<UWide>(f.o0->q[s]) -
                                 static_cast<UWide>(f.n2->q[s]) + static_cast<UWide>(f.o1->q[s]));
    out.magnitudes[s] = UWide{unpackMagnitude<Wide>(f.n0->magnitude[s])} +
                        unpackMagnitude<Wide>(f.n1->magnitude[s]) +
                        unpackMagnitude<Wide>(f.n2->magnitude[s]);
  }
  if ((modes & position_mode::kWeights) != 0) {
    addPlainFeatures<Wide>(p, f, *beyond, degree, (modes & position_mode::kSelect) != 0, out.q8);
  }
  if ((modes & position_mode::kShear) == 0) return;
  out.normal[0] = out.normal[1] = out.normal[2] = 0;
  addNormal(*f.n0, *f.n1, *f.o0, out.normal);
  addNormal(*f.n1, *f.n2, *f.o1, out.normal);
}

/// Everything but the plain fan: the mean of the tips, or of the neighbours without any, and features. [B.2.4]
template <class Wide>
struct AnyFeatures {
  using UWide = std::make_unsigned_t<Wide>;
  uint32_t predictor_class;
  int32_t degree_term;  ///< this and the following only with one tip
  int32_t degree_sum;
  int32_t degree_skew;
  UWide base[3];
  UWide mean[3];  ///< of the neighbours minus base, in 1/2
  UWide tip[3];
  UWide edge[3];
};

template <class Wide>
AnyFeatures<Wide> anyFeatures(const AnyFan& fan, uint32_t degree, uint32_t* spread,
                              uint64_t* normal) {
  using UWide = std::make_unsigned_t<Wide>;
  AnyFeatures<Wide> r{};
  UWide neighbour_sum[3] = {};
  UWide tip_sum[3] = {};
  UWide tip[2][3] = {};
  uint32_t tip_count = 0;
  uint32_t last_tip = 0;
  for (uint32_t i = 0; i < fan.neighbour_count; ++i) {
    for (int s = 0; s < 3; ++s) neighbour_sum[s] += static_cast<UWide>(fan.n[i]->q[s]);
  }
  for (uint32_t i = 0; i < fan.face_count; ++i) {
    if (fan.o[i] == nullptr) continue;
    last_tip = i;
    for (int s = 0; s < 3; ++s) {
      const UWide t = static_cast<UWide>(fan.n[i]->q[s]) + static_cast<UWide>(fan.n[i + 1]->q[s]) -
                      static_cast<UWide>(fan.o[i]->q[s]);
      tip_sum[s] += t;
      if (tip_count < 2) tip[tip_count][s] = t;
    }
    addNormal(*fan.n[i], *fan.n[i + 1], *fan.o[i], normal);
    ++tip_count;
  }
  r.predictor_class = std::min(tip_count, 4u);
  if (fan.closed && tip_count != 0) {
    r.predictor_class = tip_count < 4 ? kClassClosedFewTips : kClassClosedManyTips;
  }
  for (int s = 0; s < 3; ++s) {
    const Wide mean =
        static_cast<Wide>(256 * neighbour_sum[s]) / static_cast<Wide>(fan.neighbour_count);
    r.base[s] = static_cast<UWide>(mean);
    if (tip_count == 0) continue;
    r.base[s] =
        static_cast<UWide>(static_cast<Wide>(256 * tip_sum[s]) / static_cast<Wide>(tip_count));
    r.mean[s] = static_cast<UWide>(static_cast<Wide>(static_cast<UWide>(mean) - r.base[s]) >> 7);
    if (tip_count >= 2) spread[s] = saturatedAbsolute<UWide>(tip[0][s] - tip[1][s]);
  }
  if (r.predictor_class != kClassOneTip) return r;
  const VertexRecord& a = *fan.n[last_tip];
  const VertexRecord& b = *fan.n[last_tip + 1];
  r.degree_term = static_cast<int32_t>(std::min(12u, degree)) - 6;
  r.degree_sum = std::clamp(int32_t{a.degree} + b.degree - 12, -12, 12);
  r.degree_skew = std::clamp(int32_t{a.degree} - b.degree, -12, 12);
  for (int s = 0; s < 3; ++s) {
    r.tip[s] = static_cast<UWide>(a.q[s]) + static_cast<UWide>(b.q[s]) -
               2 * static_cast<UWide>(fan.o[last_tip]->q[s]);
    r.edge[s] = 2 * (static_cast<UWide>(a.q[s]) - static_cast<UWide>(b.q[s]));
  }
  return r;
}

template <class Wide>
void predictAny(const PositionParameters& p, const AnyFan& fan, uint32_t degree,
                Prediction<Wide>& out) {
  using UWide = std::make_unsigned_t<Wide>;
  out = Prediction<Wide>{};
  const AnyFeatures<Wide> v = anyFeatures<Wide>(fan, degree, out.spread, out.normal);
  const int16_t* w = p.weights.w[v.predictor_class];
  const UWide w_mean = static_cast<UWide>(w[1]);
  const UWide w_tip = static_cast<UWide>(w[0] + w[2] * v.degree_term + w[4] * v.degree_sum);
  const UWide w_edge = static_cast<UWide>(w[3] * v.degree_skew);
  for (int s = 0; s < 3; ++s) {
    out.q8[s] = v.base[s] + w_mean * v.mean[s] + w_tip * v.tip[s] + w_edge * v.edge[s];
    for (uint32_t i = 0; i < fan.neighbour_count; ++i) {
      out.magnitudes[s] += unpackMagnitude<Wide>(fan.n[i]->magnitude[s]);
    }
    if (fan.neighbour_count != 3) out.magnitudes[s] = out.magnitudes[s] * 3 / fan.neighbour_count;
  }
}

inline int64_t wrappingMultiply(int64_t a, int64_t b) {
  return static_cast<int64_t>(static_cast<uint64_t>(a) * static_cast<uint64_t>(b));
}
inline int64_t wrappingAdd(int64_t a, int64_t b) {
  return static_cast<int64_t>(static_cast<uint64_t>(a) + static_cast<uint64_t>(b));
}

/// Normal shear: components are coded in the order of growing |normal|; what the first ones turn out to be moves the
/// predictions of the later ones along the tangent plane.                                     [B.2.3]
struct Shear {
  uint32_t axis[3] = {0, 1, 2};
  int32_t c10 = 0;  ///< in 1/4096
  int32_t c20 = 0;
  int32_t c21 = 0;
};

MCC_INLINE Shear makeShear(const uint64_t* wrapped) {
  int64_t n[3];
  uint64_t size[3];
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    n[s] = static_cast<int64_t>(wrapped[s]);
    size[s] = n[s] < 0 ? 0 - wrapped[s] : wrapped[s];
  }
  Shear shear;
  uint32_t* axis = shear.axis;
  // Sorts by size; conditional moves, since any order is as likely.
  const auto order = [&](uint32_t i, uint32_t k) {
    const bool swap = size[axis[i]] > size[axis[k]];
    const uint32_t low = swap ? axis[k] : axis[i];
    axis[k] = swap ? axis[i] : axis[k];
    axis[i] = low;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  const uint32_t width = static_cast<uint32_t>(std::bit_width(size[axis[2]]));
  if (width == 0) return shear;
  int32_t v[3];
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {  // the largest gets 14 bits
    const int64_t x = n[axis[s]];
    v[s] = static_cast<int32_t>(
        width > 14 ? x >> (width - 14)
                   : static_cast<int64_t>(static_cast<uint64_t>(x) << (14 - width)));
  }
  shear.c10 = -(v[0] * v[1]) / ((v[1] * v[1] + v[2] * v[2]) >> 12);
  const int32_t inverse = (1 << 28) / v[2];
  shear.c20 = -((v[0] * inverse) >> 16);
  shear.c21 = -((v[1] * inverse) >> 16);
  return shear;
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_PREDICT_H_
