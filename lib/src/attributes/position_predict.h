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

namespace mcc {

/// What the coder needs to know about a vertex before its residuals.
template <class Wide>
struct Prediction {
  std::make_unsigned_t<Wide> q8[3];
  uint32_t spread[3];      ///< disagreement of the first two tips, saturating
  uint64_t normal[3];      ///< sum over the tips, wrapping; only with shear
  uint64_t magnitudes[3];  ///< of three neighbours' residuals, by component as coded
};

inline constexpr uint32_t kSpreadLimit = 1u << 19;

template <class UWide>
uint32_t saturatedAbsolute(UWide difference) {
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

inline const VertexRecord* lookAcross(const FaceView& faces, const VertexRecord* records,
                                      uint32_t half_edge, bool& known) {
  const uint32_t t = faces.twin(half_edge);
  const VertexRecord& r =
      records[faces.vertex(t != kNone ? prevHalfEdge(t) : prevHalfEdge(half_edge))];
  known = (t != kNone) & (r.known != 0);
  return &r;
}

inline Beyond lookBeyond(const FaceView& faces, const VertexRecord* records, const PlainFan& fan,
                         bool select) {
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
TipSelection selectTip(const PlainFan& f, const Beyond& b) {
  using UWide = std::make_unsigned_t<Wide>;
  uint32_t error0 = 0;
  uint32_t error1 = 0;
  uint32_t error2 = 0;
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

/// Weighted features of a plain fan, added to the average of the tips.
template <class Wide>
void addPlainFeatures(const PositionParameters& p, const PlainFan& f, const Beyond& b,
                      uint32_t degree, bool select, std::make_unsigned_t<Wide>* q8) {
  using UWide = std::make_unsigned_t<Wide>;
  uint32_t predictor_class = kClassFan + std::clamp<uint32_t>(degree, 3, 9);
  int32_t better = 0;
  if (select) {
    if (b.has_x & ((degree == 6) | (p.predictor == PositionPredictor::kSelecting))) {
      const TipSelection selection = selectTip<Wide>(f, b);
      predictor_class = selection.predictor_class;
      better = selection.better;
    }
  }
  const int16_t* w = p.weights.w[predictor_class];
  const int32_t sum = std::clamp(int32_t{f.n0->degree} + f.n2->degree - 12, -12, 12);
  const int32_t skew = std::clamp(int32_t{f.n0->degree} - f.n2->degree, -12, 12);
  const UWide w0 = static_cast<UWide>(w[0] + w[4] * sum);
  const UWide w1 = static_cast<UWide>(w[1]);
  const UWide wy = static_cast<UWide>(2 * w[2]);
  const UWide wd = static_cast<UWide>(2 * w[3] * skew);
  const UWide mask_a = UWide{0} - static_cast<UWide>(b.has_ya);
  const UWide mask_b = UWide{0} - static_cast<UWide>(b.has_yb);
  for (int s = 0; s < 3; ++s) {
    const UWide n0 = static_cast<UWide>(f.n0->q[s]);
    const UWide n1 = static_cast<UWide>(f.n1->q[s]);
    const UWide n2 = static_cast<UWide>(f.n2->q[s]);
    const UWide o0 = static_cast<UWide>(f.o0->q[s]);
    const UWide o1 = static_cast<UWide>(f.o1->q[s]);
    const UWide ya = (static_cast<UWide>(b.ya->q[s]) - n0 - o0 + n1) & mask_a;
    const UWide yb = (static_cast<UWide>(b.yb->q[s]) - n2 - o1 + n1) & mask_b;
    q8[s] += w0 * (n0 + n2 + o0 + o1 - 4 * n1) + w1 * (n0 + n2 - 2 * n1) + wy * (ya + yb) +
             wd * (n0 - n2);
    if (!select || !b.has_x) continue;
    const UWide xa = n1 + o0 - static_cast<UWide>(b.xa->q[s]) - n0;
    const UWide xb = n1 + o1 - static_cast<UWide>(b.xb->q[s]) - n2;
    q8[s] += static_cast<UWide>(better * w[5]) * (n0 - n2 + o1 - o0) +
             static_cast<UWide>(better * w[6]) * (xa - xb) +
             static_cast<UWide>(better * w[7]) * (ya - yb);
  }
}

/// Adds the normal of a tip's triangle (a, b, o).                                             [B.2.3]
inline void addNormal(const VertexRecord& a, const VertexRecord& b, const VertexRecord& o,
                      uint64_t* normal) {
  uint64_t u[3];
  uint64_t w[3];
  for (int s = 0; s < 3; ++s) {
    u[s] = static_cast<uint64_t>(int64_t{a.q[s]} - b.q[s]);
    w[s] = static_cast<uint64_t>(int64_t{o.q[s]} - b.q[s]);
  }
  normal[0] += u[1] * w[2] - u[2] * w[1];
  normal[1] += u[2] * w[0] - u[0] * w[2];
  normal[2] += u[0] * w[1] - u[1] * w[0];
}

template <class Wide>
void predictPlain(const PositionParameters& p, const PlainFan& f, const Beyond& b, uint32_t degree,
                  uint32_t modes, Prediction<Wide>& out) {
  using UWide = std::make_unsigned_t<Wide>;
  for (int s = 0; s < 3; ++s) {
    const UWide e = static_cast<UWide>(f.n0->q[s]) + static_cast<UWide>(f.n2->q[s]);
    const UWide o = static_cast<UWide>(f.o0->q[s]) + static_cast<UWide>(f.o1->q[s]);
    out.q8[s] = 128 * (e + 2 * static_cast<UWide>(f.n1->q[s]) - o);
    out.spread[s] =
        saturatedAbsolute<UWide>(static_cast<UWide>(f.n0->q[s]) - static_cast<UWide>(f.o0->q[s]) -
                                 static_cast<UWide>(f.n2->q[s]) + static_cast<UWide>(f.o1->q[s]));
    out.magnitudes[s] = uint64_t{unpackMagnitude<Wide>(f.n0->magnitude[s])} +
                        unpackMagnitude<Wide>(f.n1->magnitude[s]) +
                        unpackMagnitude<Wide>(f.n2->magnitude[s]);
  }
  if ((modes & position_mode::kWeights) != 0) {
    addPlainFeatures<Wide>(p, f, b, degree, (modes & position_mode::kSelect) != 0, out.q8);
  }
  if ((modes & position_mode::kShear) == 0) return;
  out.normal[0] = out.normal[1] = out.normal[2] = 0;
  addNormal(*f.n0, *f.n1, *f.o0, out.normal);
  addNormal(*f.n1, *f.n2, *f.o1, out.normal);
}

/// Everything but the plain fan: the mean of the tips, or of the neighbours without any.      [B.2.4]
template <class Wide>
void predictAny(const PositionParameters& p, const AnyFan& fan, uint32_t degree,
                Prediction<Wide>& out) {
  using UWide = std::make_unsigned_t<Wide>;
  out = Prediction<Wide>{};
  UWide neighbour_sum[3] = {};
  UWide tip_sum[3] = {};
  UWide tip[2][3] = {};
  uint32_t tip_count = 0;
  uint32_t last_tip = 0;
  for (uint32_t i = 0; i < fan.neighbour_count; ++i) {
    for (int s = 0; s < 3; ++s) {
      neighbour_sum[s] += static_cast<UWide>(fan.n[i]->q[s]);
      out.magnitudes[s] += unpackMagnitude<Wide>(fan.n[i]->magnitude[s]);
    }
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
    addNormal(*fan.n[i], *fan.n[i + 1], *fan.o[i], out.normal);
    ++tip_count;
  }
  uint32_t predictor_class = std::min(tip_count, 4u);
  if (fan.closed && tip_count != 0) {
    predictor_class = tip_count < 4 ? kClassClosedFewTips : kClassClosedManyTips;
  }
  const int16_t* w = p.weights.w[predictor_class];
  const VertexRecord& a = *fan.n[last_tip];
  const VertexRecord& b = *fan.n[last_tip + 1];
  UWide w_tip = 0;
  UWide w_skew = 0;
  if (predictor_class == kClassOneTip) {
    const int32_t sum = std::clamp(int32_t{a.degree} + b.degree - 12, -12, 12);
    const int32_t skew = std::clamp(int32_t{a.degree} - b.degree, -12, 12);
    w_tip = static_cast<UWide>(
        w[0] + w[2] * (std::min<int32_t>(12, static_cast<int32_t>(degree)) - 6) + w[4] * sum);
    w_skew = static_cast<UWide>(2 * w[3] * skew);
  }
  for (int s = 0; s < 3; ++s) {
    if (fan.neighbour_count != 3) out.magnitudes[s] = out.magnitudes[s] * 3 / fan.neighbour_count;
    const Wide mean =
        static_cast<Wide>(256 * neighbour_sum[s]) / static_cast<Wide>(fan.neighbour_count);
    out.q8[s] = static_cast<UWide>(mean);
    if (tip_count == 0) continue;
    out.q8[s] =
        static_cast<UWide>(static_cast<Wide>(256 * tip_sum[s]) / static_cast<Wide>(tip_count));
    if (tip_count >= 2) out.spread[s] = saturatedAbsolute<UWide>(tip[0][s] - tip[1][s]);
    const Wide f1 = static_cast<Wide>(static_cast<UWide>(mean) - out.q8[s]) >> 7;
    out.q8[s] += static_cast<UWide>(w[1]) * static_cast<UWide>(f1);
    if (predictor_class != kClassOneTip) continue;
    out.q8[s] += w_tip * (static_cast<UWide>(a.q[s]) + static_cast<UWide>(b.q[s]) -
                          2 * static_cast<UWide>(fan.o[last_tip]->q[s])) +
                 w_skew * (static_cast<UWide>(a.q[s]) - static_cast<UWide>(b.q[s]));
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

inline Shear makeShear(const uint64_t* wrapped) {
  int64_t n[3];
  uint64_t size[3];
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
