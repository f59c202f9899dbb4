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
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "attributes/position_growth.h"
#include "attributes/position_parameters.h"
#include "attributes/position_record.h"
#include "base/host.h"

namespace mcc {

/// What the coder needs to know about a vertex before its residuals, by component.
template <class Wide>
struct Prediction {
  using Coordinate = Wide;
  using UWide = std::make_unsigned_t<Wide>;
  Lanes<UWide> q8;
  Lanes<UWide> spread;      ///< disagreement of the first two tips
  Lanes<UWide> magnitudes;  ///< of three neighbours' residuals, by component as coded
  Lanes<float> normal;      ///< sum over the tips; only with shear and planes
  float disagreement;       ///< of the first two tips along the normal; only with planes
};

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
  known = (t != kNone) & r.known();
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
  b.has_x = has_xa & has_xb & (fan.n1->degree() >= 6);
  return b;
}

/// How the kinds of parallelograms compare one step back: the class, and which of the tips did better.
struct TipSelection {
  uint32_t predictor_class;
  int32_t better;  ///< +1: t0, -1: t1, 0: a tie
};

template <class UWide>
MCC_INLINE UWide sumOfComponents(const Lanes<UWide>& x) {
  return x[0] + x[1] + x[2];
}

/// ya or yb against the parallelogram next to it.
template <class UWide>
MCC_INLINE Lanes<UWide> stepBeyond(const VertexRecord* y, const VertexRecord* n,
                                   const VertexRecord* o, const Lanes<UWide>& n1, bool has) {
  return (coordinates<UWide>(y) - coordinates<UWide>(n) - coordinates<UWide>(o) + n1) &
         (UWide{0} - static_cast<UWide>(has));
}

template <class Wide>
MCC_INLINE TipSelection selectTip(const PlainFan& f, const Beyond& b) {
  using UWide = std::make_unsigned_t<Wide>;
  const Lanes<UWide> n1 = coordinates<UWide>(f.n1);
  const Lanes<UWide> behind_t1 =
      n1 + coordinates<UWide>(f.o0) - coordinates<UWide>(b.xa) - coordinates<UWide>(f.n0);
  const Lanes<UWide> behind_t0 =
      n1 + coordinates<UWide>(f.o1) - coordinates<UWide>(b.xb) - coordinates<UWide>(f.n2);
  const UWide error1 = sumOfComponents<UWide>(absoluteLanes<UWide>(behind_t1));
  const UWide error0 = sumOfComponents<UWide>(absoluteLanes<UWide>(behind_t0));
  UWide error2 = sumOfComponents<UWide>(
      absoluteLanes<UWide>(stepBeyond<UWide>(b.ya, f.n0, f.o0, n1, b.has_ya)) +
      absoluteLanes<UWide>(stepBeyond<UWide>(b.yb, f.n2, f.o1, n1, b.has_yb)));
  const uint32_t both = (b.has_ya & b.has_yb) ? 1 : 0;
  error2 = (error2 + both) >> both;
  const UWide low = std::min(error0, error1);
  const UWide high = std::max(error0, error1);
  const uint32_t preference = uint32_t{2 * high > 3 * low + 2} + uint32_t{high > 3 * low + 2};
  const uint32_t has_third = (b.has_ya | b.has_yb) ? 1 : 0;
  const uint32_t third = has_third * (uint32_t{error2 <= 2 * low} + uint32_t{2 * error2 <= low});
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
MCC_INLINE PlainClass classifyPlain(bool select, const PlainFan& f, const Beyond& b,
                                    uint32_t degree) {
  PlainClass c;
  c.predictor_class = kClassPlain - kLeastDegree + std::clamp(degree, kLeastDegree, kMostDegree);
  const int32_t degree0 = static_cast<int32_t>(f.n0->degree());
  const int32_t degree2 = static_cast<int32_t>(f.n2->degree());
  c.degree_sum = std::clamp(degree0 + degree2 - 12, -12, 12);
  c.degree_skew = std::clamp(degree0 - degree2, -12, 12);
  c.better = 0;
  if (!select) return c;
  if (b.has_x & (degree == 6)) {
    const TipSelection selection = selectTip<Wide>(f, b);
    c.predictor_class = selection.predictor_class;
    c.better = selection.better;
  }
  return c;
}

/// Features of a plain fan.
template <class UWide>
struct PlainFeatures {
  Lanes<UWide> f0;    ///< fan against tips
  Lanes<UWide> f1;    ///< ends of the fan against its middle
  Lanes<UWide> fy;    ///< ya, yb against their parallelograms
  Lanes<UWide> fd;    ///< from one end to the other
  Lanes<UWide> tips;  ///< t0 - t1; this and the next two only where a tip was selected
  Lanes<UWide> x;
  Lanes<UWide> y;
};

template <class UWide>
MCC_INLINE PlainFeatures<UWide> plainFeatures(const PlainFan& f, const Beyond& b, bool select) {
  PlainFeatures<UWide> r{};
  const Lanes<UWide> n0 = coordinates<UWide>(f.n0);
  const Lanes<UWide> n1 = coordinates<UWide>(f.n1);
  const Lanes<UWide> n2 = coordinates<UWide>(f.n2);
  const Lanes<UWide> o0 = coordinates<UWide>(f.o0);
  const Lanes<UWide> o1 = coordinates<UWide>(f.o1);
  const Lanes<UWide> ya = stepBeyond<UWide>(b.ya, f.n0, f.o0, n1, b.has_ya);
  const Lanes<UWide> yb = stepBeyond<UWide>(b.yb, f.n2, f.o1, n1, b.has_yb);
  r.f1 = n0 + n2 - 2 * n1;
  r.f0 = r.f1 + o0 + o1 - 2 * n1;
  r.fy = 2 * (ya + yb);
  r.fd = 2 * (n0 - n2);
  if (!select) return r;
  r.tips = n0 - n2 + o1 - o0;
  r.x = (o0 - coordinates<UWide>(b.xa) - n0) - (o1 - coordinates<UWide>(b.xb) - n2);
  r.y = ya - yb;
  return r;
}

/// A weight, or a product of one, as a factor of features: with its sign.
template <class Wide>
MCC_INLINE std::make_unsigned_t<Wide> weightOf(int32_t weight) {
  return static_cast<std::make_unsigned_t<Wide>>(static_cast<Wide>(weight));
}

/// Weighted features of a plain fan, to be added to the average of the tips.
template <class Wide>
MCC_INLINE Lanes<std::make_unsigned_t<Wide>> weightPlainFeatures(const PositionParameters& p,
                                                                 const PlainFan& f, const Beyond& b,
                                                                 uint32_t degree, bool select) {
  using UWide = std::make_unsigned_t<Wide>;
  const PlainClass c = classifyPlain<Wide>(select, f, b, degree);
  const int16_t* w = p.weights.w[c.predictor_class];
  const PlainFeatures<UWide> v = plainFeatures<UWide>(f, b, select);
  Lanes<UWide> sum = v.f0 * weightOf<Wide>(w[0] + w[4] * c.degree_sum) +
                     v.f1 * weightOf<Wide>(w[1]) + v.fy * weightOf<Wide>(w[2]) +
                     v.fd * weightOf<Wide>(w[3] * c.degree_skew);
  if (select) {
    sum += v.tips * weightOf<Wide>(c.better * w[5]) + v.x * weightOf<Wide>(c.better * w[6]) +
           v.y * weightOf<Wide>(c.better * w[7]);
  }
  return sum;
}

MCC_INLINE Lanes<float> rotateComponents(const Lanes<float>& x) {  // y z x
#if defined(__clang__)
  return __builtin_shufflevector(x, x, 1, 2, 0, 3);
#else
  return __builtin_shuffle(x, Lanes<int32_t>{1, 2, 0, 3});
#endif
}

/// Normal of a tip's triangle (a, b, o), its components in the order z x y.                     [B.2.3]
template <class Wide>
MCC_INLINE Lanes<float> tipNormal(const VertexRecord* a, const VertexRecord* b,
                                  const VertexRecord* o) {
  using UWide = std::make_unsigned_t<Wide>;
  const auto edge = [&](const VertexRecord* to) MCC_INLINE_LAMBDA {
    return convertLanes<float>((Lanes<Wide>)(coordinates<UWide>(to) - coordinates<UWide>(b)));
  };
  const Lanes<float> u = edge(a);
  const Lanes<float> w = edge(o);
  return u * rotateComponents(w) - rotateComponents(u) * w;
}

/// `beyond` may be null without weights.
template <class Wide>
MCC_INLINE void predictPlain(const PositionParameters& p, const PlainFan& f, const Beyond* beyond,
                             uint32_t degree, uint32_t modes, Prediction<Wide>& out) {
  using UWide = std::make_unsigned_t<Wide>;
  const Lanes<UWide> n0 = coordinates<UWide>(f.n0);
  const Lanes<UWide> n1 = coordinates<UWide>(f.n1);
  const Lanes<UWide> n2 = coordinates<UWide>(f.n2);
  const Lanes<UWide> o0 = coordinates<UWide>(f.o0);
  const Lanes<UWide> o1 = coordinates<UWide>(f.o1);
  const Lanes<UWide> d0 = n0 - o0;
  const Lanes<UWide> d1 = n2 - o1;
  out.q8 = (d0 + d1 + n1 + n1) << 7;
  out.spread = absoluteLanes<UWide>(d0 - d1);
  out.magnitudes = magnitudes<UWide>(f.n0) + magnitudes<UWide>(f.n1) + magnitudes<UWide>(f.n2);
  if ((modes & position_mode::kWeights) != 0) {
    out.q8 +=
        weightPlainFeatures<Wide>(p, f, *beyond, degree, (modes & position_mode::kSelect) != 0);
  }
  if ((modes & position_mode::kShear) == 0) return;
  out.normal =
      rotateComponents(tipNormal<Wide>(f.n0, f.n1, f.o0) + tipNormal<Wide>(f.n1, f.n2, f.o1));
}

/// What planes need besides.
MCC_INLINE void findNormal(const PlainFan& f, Prediction<int32_t>& out) {
  out.normal =
      rotateComponents(tipNormal<int32_t>(f.n0, f.n1, f.o0) + tipNormal<int32_t>(f.n1, f.n2, f.o1));
  const Lanes<uint32_t> between_tips = coordinates<uint32_t>(f.n0) - coordinates<uint32_t>(f.o0) -
                                       coordinates<uint32_t>(f.n2) + coordinates<uint32_t>(f.o1);
  const Lanes<float> d = convertLanes<float>((Lanes<int32_t>)between_tips) * out.normal;
  out.disagreement = std::fabs(d[0] + d[1] + d[2]);
}

/// Mean of `count` positions whose sum this is, in Q8.
template <class Wide>
MCC_INLINE Lanes<std::make_unsigned_t<Wide>> meanOf(const Lanes<std::make_unsigned_t<Wide>>& sum,
                                                    uint32_t count) {
  Lanes<std::make_unsigned_t<Wide>> mean{};
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) {
    mean[s] = static_cast<std::make_unsigned_t<Wide>>(static_cast<Wide>(256 * sum[s]) /
                                                      static_cast<Wide>(count));
  }
  return mean;
}

/// Everything but the plain fan: the mean of the tips, or of the neighbours without any, and a feature. [B.2.4]
template <class UWide>
struct AnyFeatures {
  uint32_t predictor_class;
  Lanes<UWide> base;
  Lanes<UWide> mean;  ///< of the neighbours minus base, in 1/2; 0 without tips, whatever the class
};

template <class Wide>
AnyFeatures<std::make_unsigned_t<Wide>> anyFeatures(const AnyFan& fan,
                                                    Lanes<std::make_unsigned_t<Wide>>& spread,
                                                    Lanes<float>& normal) {
  using UWide = std::make_unsigned_t<Wide>;
  AnyFeatures<UWide> r{};
  Lanes<UWide> neighbour_sum{};
  Lanes<UWide> tip_sum{};
  Lanes<UWide> tip[2] = {};
  uint32_t tip_count = 0;
  for (uint32_t i = 0; i < fan.neighbour_count; ++i) neighbour_sum += coordinates<UWide>(fan.n[i]);
  for (uint32_t i = 0; i < fan.face_count; ++i) {
    if (fan.o[i] == nullptr) continue;
    const Lanes<UWide> t = coordinates<UWide>(fan.n[i]) + coordinates<UWide>(fan.n[i + 1]) -
                           coordinates<UWide>(fan.o[i]);
    tip_sum += t;
    if (tip_count < 2) tip[tip_count] = t;
    normal += tipNormal<Wide>(fan.n[i], fan.n[i + 1], fan.o[i]);
    ++tip_count;
  }
  r.base = meanOf<Wide>(neighbour_sum, fan.neighbour_count);
  if (tip_count == 0) return r;
  r.predictor_class = !fan.closed     ? std::min(tip_count, 4u) - 1
                      : tip_count < 4 ? kClassClosedFewTips
                                      : kClassClosedManyTips;
  const Lanes<UWide> mean = r.base;
  r.base = meanOf<Wide>(tip_sum, tip_count);
  r.mean = (Lanes<UWide>)((Lanes<Wide>)(mean - r.base) >> 7);
  if (tip_count >= 2) spread = absoluteLanes<UWide>(tip[0] - tip[1]);
  return r;
}

template <class Wide>
void predictAny(const PositionParameters& p, const AnyFan& fan, Prediction<Wide>& out) {
  using UWide = std::make_unsigned_t<Wide>;
  out.spread = Lanes<UWide>{};
  out.magnitudes = Lanes<UWide>{};
  Lanes<float> normal{};
  const AnyFeatures<UWide> v = anyFeatures<Wide>(fan, out.spread, normal);
  out.q8 = v.base + v.mean * weightOf<Wide>(p.weights.w[v.predictor_class][0]);
  for (uint32_t i = 0; i < fan.neighbour_count; ++i) out.magnitudes += magnitudes<UWide>(fan.n[i]);
  if (fan.neighbour_count != 3) {
    MCC_UNROLL
    for (int s = 0; s < 3; ++s) out.magnitudes[s] = out.magnitudes[s] * 3 / fan.neighbour_count;
  }
  out.normal = rotateComponents(normal);
  out.disagreement = 0;
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
  const uint8_t* axis;  ///< by slot; three
  const uint8_t* slot;  ///< by axis
  int32_t c10;          ///< in 1/4096
  int32_t c20;
  int32_t c21;
};

struct ComponentOrder {
  uint8_t axis[4];
  uint8_t slot[4];
};
/// By which of 0 > 1, 0 > 2, 1 > 2 hold (bits 0, 1, 2); two of the eight cannot happen.
inline constexpr ComponentOrder kComponentOrders[8] = {
    {{0, 1, 2}, {0, 1, 2}}, {{1, 0, 2}, {1, 0, 2}}, {{0, 1, 2}, {0, 1, 2}}, {{1, 2, 0}, {2, 0, 1}},
    {{0, 2, 1}, {0, 2, 1}}, {{0, 1, 2}, {0, 1, 2}}, {{2, 0, 1}, {1, 2, 0}}, {{2, 1, 0}, {2, 1, 0}},
};

MCC_INLINE Shear makeShear(const Lanes<float>& normal) {
  float n[4];
  uint32_t size[4];  // bits of |n|, which are ordered like |n|
  storeLanes<float>(normal, n);
  storeLanes<uint32_t>((Lanes<uint32_t>)normal & 0x7fffffffu, size);
  const uint32_t order = uint32_t{size[0] > size[1]} | uint32_t{size[0] > size[2]} << 1 |
                         uint32_t{size[1] > size[2]} << 2;
  Shear shear;
  shear.axis = kComponentOrders[order].axis;
  shear.slot = kComponentOrders[order].slot;
  // The largest component is 0 only if all are: nothing is moved then.
  const float largest = n[shear.axis[2]];
  const float inverse = 1.0f / (largest == 0 ? 1.0f : largest);
  const float t0 = n[shear.axis[0]] * inverse;
  const float t1 = n[shear.axis[1]] * inverse;
  shear.c20 = -static_cast<int32_t>(t0 * 4096.0f);
  shear.c21 = -static_cast<int32_t>(t1 * 4096.0f);
  shear.c10 = -static_cast<int32_t>(t0 * t1 / (t1 * t1 + 1.0f) * 4096.0f);
  return shear;
}

}  // namespace mcc

#endif  // MCC_ATTRIBUTES_POSITION_PREDICT_H_
