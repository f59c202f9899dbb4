// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Prediction of a vertex from its fan. [A.6.4]
//
//          xa      xb           The tips t0 = n0 + n1 - o0 and t1 = n1 + n2 - o1 complete
//          /\      /\           parallelograms; the prediction is their average. Weights by
//        o0 --- n1 --- o1       class add features of the fan, of the degrees around it and
//  ya   /  \   /  \   /  \  yb  of ya, yb. With tip selection, xa, xb, ya, yb tell how well
//         n0        n2          each kind of parallelogram did one step back.
//            \    /
//               v
//
// Sums and differences of coordinates are integers that wrap, and weighted values are floats. This
// way the result is defined, and the same everywhere, for coordinates of any width and for whatever
// a payload claims.
#ifndef MCC_POSITIONS_PREDICT_H_
#define MCC_POSITIONS_PREDICT_H_

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/host.h"
#include "format/predictors.h"
#include "positions/growth.h"
#include "positions/parameters.h"
#include "positions/record.h"

namespace mcc {

/// Coordinates, their differences and sums are i32 that wrap; in lanes they are unsigned.
MCC_INLINE Lanes<float> floatsOf(const Lanes<uint32_t>& x) {
  return convertLanes<float>(lanesAs<int32_t>(x));
}
MCC_INLINE Lanes<float> absoluteFloats(const Lanes<float>& x) {
  return lanesAs<float>(lanesAs<uint32_t>(x) & 0x7fffffffu);
}

/// A point that may lie between those of the lattice: step + fraction / 256. The fraction may be
/// more than one step.
struct FinePoint {
  Lanes<uint32_t> step;
  Lanes<uint32_t> fraction;

  /// Returns the fraction in steps.
  MCC_INLINE Lanes<float> rest() const { return floatsOf(fraction) * (1.0f / 256); }
};

/// The largest movement, in 1/256 of a step. It is bounded so that the sum of two movements fits in
/// a fraction.
inline constexpr float kFarthestMove = 1 << 29;
MCC_INLINE float boundMove(float x) {
  const float below = x < kFarthestMove ? x : kFarthestMove;
  return below > -kFarthestMove ? below : -kFarthestMove;
}
MCC_INLINE Lanes<uint32_t> fractionOf(const Lanes<float>& x) {
  const Lanes<float> most = {kFarthestMove, kFarthestMove, kFarthestMove, kFarthestMove};
  const Lanes<float> below = chooseLanes<float>(x < most, x, most);
  return lanesAs<uint32_t>(convertLanes<int32_t>(chooseLanes<float>(below > -most, below, -most)));
}

/// What the coder needs to know about a vertex before its residuals, by component.
struct Prediction {
  FinePoint at;
  Lanes<float> spread;      ///< disagreement of the first two tips
  Lanes<float> third;       ///< twice what a plain fan's parallelogram n0 n1 n2 differs from them
  Lanes<float> magnitudes;  ///< of three neighbours' residuals, by component as coded
  Lanes<float> normal;      ///< sum over the tips; only with shear or planes
};

/// The vertices beyond the plain fan. A missing vertex points to some other vertex; the flag masks
/// it out.
struct Beyond {
  const VertexRecord* ya;
  const VertexRecord* yb;
  const VertexRecord* xa;
  const VertexRecord* xb;
  bool has_ya;
  bool has_yb;
  bool has_x;  ///< both xa and xb are known, and the ring around n1 has room for them
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

/// The result of comparing the kinds of parallelograms one step back: a class, and which of the
/// tips did better.
struct TipSelection {
  uint32_t predictor_class;
  int32_t better;  ///< +1: t0, -1: t1, 0: a tie
};

/// Returns the sums of the components of up to four vectors, one in each lane.
MCC_INLINE Lanes<float> sumsOfComponents(const Lanes<float>& a, const Lanes<float>& b,
                                         const Lanes<float>& c, const Lanes<float>& d) {
  const Lanes<float> xy_of_ab = shuffleLanes<float, 0, 4, 1, 5>(a, b);
  const Lanes<float> xy_of_cd = shuffleLanes<float, 0, 4, 1, 5>(c, d);
  const Lanes<float> x = shuffleLanes<float, 0, 1, 4, 5>(xy_of_ab, xy_of_cd);
  const Lanes<float> y = shuffleLanes<float, 2, 3, 6, 7>(xy_of_ab, xy_of_cd);
  const Lanes<float> z = shuffleLanes<float, 0, 1, 4, 5>(shuffleLanes<float, 2, 6, 3, 7>(a, b),
                                                         shuffleLanes<float, 2, 6, 3, 7>(c, d));
  return x + y + z;
}

/// Returns the difference of ya or yb from the parallelogram next to it.
MCC_INLINE Lanes<uint32_t> stepBeyond(const VertexRecord* y, const VertexRecord* n,
                                      const VertexRecord* o, const Lanes<uint32_t>& n1, bool has) {
  return (coordinates(y) - coordinates(n) - coordinates(o) + n1) & (0u - uint32_t{has});
}

MCC_INLINE TipSelection selectTip(const PlainFan& f, const Beyond& b) {
  const Lanes<uint32_t> n1 = coordinates(f.n1);
  const auto sizeOf = [](const Lanes<uint32_t>& x)
                          MCC_INLINE_LAMBDA { return absoluteFloats(floatsOf(x)); };
  const Lanes<float> of_xa = sizeOf(n1 + coordinates(f.o0) - coordinates(b.xa) - coordinates(f.n0));
  const Lanes<float> of_xb = sizeOf(n1 + coordinates(f.o1) - coordinates(b.xb) - coordinates(f.n2));
  const Lanes<float> of_y = sizeOf(stepBeyond(b.ya, f.n0, f.o0, n1, b.has_ya)) +
                            sizeOf(stepBeyond(b.yb, f.n2, f.o1, n1, b.has_yb));
  const Lanes<float> errors = sumsOfComponents(of_xa, of_xb, of_y, of_y);
  const float error1 = errors[0];
  const float error0 = errors[1];
  const float error2 = (b.has_ya & b.has_yb) ? errors[2] * 0.5f : errors[2];
  const float low = std::min(error0, error1);
  const float high = std::max(error0, error1);
  const uint32_t preference = uint32_t{2 * high > 3 * low + 2} + uint32_t{high > 3 * low + 2};
  const uint32_t has_third = (b.has_ya | b.has_yb) ? 1 : 0;
  const uint32_t third = has_third * (uint32_t{error2 <= 2 * low} + uint32_t{2 * error2 <= low});
  return {kClassSelect + 3 * preference + third,
          static_cast<int32_t>(error0 < error1) - static_cast<int32_t>(error0 > error1)};
}

/// The class of a plain fan, and what scales its weights in addition to the features of a
/// component.
struct PlainClass {
  uint32_t predictor_class;
  int32_t degree_sum;
  int32_t degree_skew;
  int32_t better;  ///< see TipSelection
};

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
    const TipSelection selection = selectTip(f, b);
    c.predictor_class = selection.predictor_class;
    c.better = selection.better;
  }
  return c;
}

/// The features of a plain fan.
struct PlainFeatures {
  Lanes<float> f0;    ///< fan against tips
  Lanes<float> f1;    ///< ends of the fan against its middle
  Lanes<float> fy;    ///< ya, yb against their parallelograms
  Lanes<float> fd;    ///< from one end to the other
  Lanes<float> tips;  ///< t0 - t1; this and the next two are set only where a tip was selected
  Lanes<float> x;
  Lanes<float> y;
};

MCC_INLINE PlainFeatures plainFeatures(const PlainFan& f, const Beyond& b, bool select) {
  PlainFeatures r{};
  const Lanes<uint32_t> n0 = coordinates(f.n0);
  const Lanes<uint32_t> n1 = coordinates(f.n1);
  const Lanes<uint32_t> n2 = coordinates(f.n2);
  const Lanes<uint32_t> o0 = coordinates(f.o0);
  const Lanes<uint32_t> o1 = coordinates(f.o1);
  const Lanes<uint32_t> ya = stepBeyond(b.ya, f.n0, f.o0, n1, b.has_ya);
  const Lanes<uint32_t> yb = stepBeyond(b.yb, f.n2, f.o1, n1, b.has_yb);
  const Lanes<uint32_t> ends = n0 + n2 - 2 * n1;
  r.f0 = floatsOf(ends + o0 + o1 - 2 * n1);
  r.f1 = floatsOf(ends);
  r.fy = floatsOf(2 * (ya + yb));
  r.fd = floatsOf(2 * (n0 - n2));
  if (!select) return r;
  r.tips = floatsOf(n0 - n2 + o1 - o0);
  r.x = floatsOf((o0 - coordinates(b.xa) - n0) - (o1 - coordinates(b.xb) - n2));
  r.y = floatsOf(ya - yb);
  return r;
}

/// Returns the sum of the weighted features of a plain fan, to be added to the average of the tips,
/// in 1/256 of a step.
MCC_INLINE Lanes<float> weightPlainFeatures(const PositionParameters& p, const PlainFan& f,
                                            const Beyond& b, uint32_t degree, bool select) {
  const PlainClass c = classifyPlain(select, f, b, degree);
  const int16_t* w = p.weights.w[c.predictor_class];
  const PlainFeatures v = plainFeatures(f, b, select);
  const auto weight = [](int32_t x) MCC_INLINE_LAMBDA { return static_cast<float>(x); };
  Lanes<float> sum = v.f0 * weight(w[0] + w[4] * c.degree_sum) + v.f1 * weight(w[1]) +
                     v.fy * weight(w[2]) + v.fd * weight(w[3] * c.degree_skew);
  if (select) {
    sum += v.tips * weight(c.better * w[5]);
    sum += v.x * weight(c.better * w[6]);
    sum += v.y * weight(c.better * w[7]);
  }
  return sum;
}

MCC_INLINE Lanes<float> rotateComponents(const Lanes<float>& x) {  // y z x
  return shuffleLanes<float, 1, 2, 0, 3>(x, x);
}

/// Returns the normal of a tip's triangle (a, b, o), with its components in the
/// order z x y. [A.6.10]
MCC_INLINE Lanes<float> tipNormal(const VertexRecord* a, const VertexRecord* b,
                                  const VertexRecord* o) {
  const Lanes<float> u = floatsOf(coordinates(a) - coordinates(b));
  const Lanes<float> w = floatsOf(coordinates(o) - coordinates(b));
  return u * rotateComponents(w) - rotateComponents(u) * w;
}
MCC_INLINE Lanes<float> plainNormal(const PlainFan& f) {
  return rotateComponents(tipNormal(f.n0, f.n1, f.o0) + tipNormal(f.n1, f.n2, f.o1));
}

/// Returns the vector from the first tip of a plain fan to the second.
MCC_INLINE Lanes<uint32_t> betweenTips(const PlainFan& f) {
  return coordinates(f.n2) - coordinates(f.o1) - (coordinates(f.n0) - coordinates(f.o0));
}
/// Returns the point halfway between the tips.
MCC_INLINE FinePoint middleOfTips(const PlainFan& f) {
  const Lanes<uint32_t> between = betweenTips(f);
  return {coordinates(f.n0) - coordinates(f.o0) + coordinates(f.n1) +
              lanesAs<uint32_t>(lanesAs<int32_t>(between) >> 1),
          (between & 1) << 7};
}

/// Returns twice the vector from the middle of the tips to n0 + n2 - n1.
MCC_INLINE Lanes<uint32_t> thirdFromTips(const PlainFan& f) {
  return coordinates(f.n0) + coordinates(f.n2) + coordinates(f.o0) + coordinates(f.o1) -
         4 * coordinates(f.n1);
}

/// Predicts from a plain fan. `beyond` may be null if the modes do not include weights.
MCC_INLINE void predictPlain(const PositionParameters& p, const PlainFan& f, const Beyond* beyond,
                             uint32_t degree, uint32_t modes, Prediction& out) {
  out.at = middleOfTips(f);
  out.spread = absoluteFloats(floatsOf(betweenTips(f)));
  out.third = absoluteFloats(floatsOf(thirdFromTips(f)));
  out.magnitudes = absoluteFloats(floatsOf(magnitudes(f.n0) + magnitudes(f.n1) + magnitudes(f.n2)));
  if ((modes & position_mode::kWeights) != 0) {
    const bool select = (modes & position_mode::kSelect) != 0;
    out.at.fraction += fractionOf(weightPlainFeatures(p, f, *beyond, degree, select));
  }
  if ((modes & kDecodedPositionModes & (position_mode::kShear | position_mode::kPlanes)) != 0)
    out.normal = plainNormal(f);
}

/// The features of any other fan, relative to its first tip, or to its first neighbour if it has no
/// tip. [A.6.5]
struct AnyFeatures {
  uint32_t predictor_class;
  Lanes<uint32_t> from;
  Lanes<float> tips;  ///< mean of the tips, or of the neighbours if there are no tips
  Lanes<float> mean;  ///< mean of the neighbours minus that of the tips
};

MCC_INLINE Lanes<float> meanOf(const Lanes<uint32_t>& sum, uint32_t count) {
  return floatsOf(sum) / static_cast<float>(count);
}

inline AnyFeatures anyFeatures(const AnyFan& fan, Lanes<float>& spread, Lanes<float>& normal) {
  AnyFeatures r{};
  Lanes<uint32_t> neighbour_sum{};
  Lanes<uint32_t> tip_sum{};  // relative to the first tip
  Lanes<uint32_t> second{};
  uint32_t tip_count = 0;
  for (uint32_t i = 0; i < fan.neighbour_count; ++i) neighbour_sum += coordinates(fan.n[i]);
  for (uint32_t i = 0; i < fan.face_count; ++i) {
    if (fan.o[i] == nullptr) continue;
    const Lanes<uint32_t> t =
        coordinates(fan.n[i]) + coordinates(fan.n[i + 1]) - coordinates(fan.o[i]);
    if (tip_count == 0) r.from = t;
    if (tip_count == 1) second = t - r.from;
    tip_sum += t - r.from;
    normal += tipNormal(fan.n[i], fan.n[i + 1], fan.o[i]);
    ++tip_count;
  }
  if (tip_count == 0) r.from = coordinates(fan.n[0]);
  const Lanes<float> mean =
      meanOf(neighbour_sum - r.from * fan.neighbour_count, fan.neighbour_count);
  r.tips = tip_count == 0 ? mean : meanOf(tip_sum, tip_count);
  r.mean = mean - r.tips;
  r.predictor_class = !fan.closed     ? std::clamp(tip_count, 1u, 4u) - 1
                      : tip_count < 4 ? kClassClosedFewTips
                                      : kClassClosedManyTips;
  spread = absoluteFloats(floatsOf(second));
  return r;
}

inline void predictAny(const PositionParameters& p, const AnyFan& fan, Prediction& out) {
  out.spread = out.third = Lanes<float>{};
  Lanes<float> normal{};
  const AnyFeatures v = anyFeatures(fan, out.spread, normal);
  const float weight = static_cast<float>(2 * p.weights.w[v.predictor_class][0]);
  out.at = {v.from, fractionOf(256 * v.tips + v.mean * weight)};
  Lanes<uint32_t> sum{};
  for (uint32_t i = 0; i < fan.neighbour_count; ++i) sum += magnitudes(fan.n[i]);
  out.magnitudes = absoluteFloats(floatsOf(sum)) * (3.0f / static_cast<float>(fan.neighbour_count));
  out.normal = rotateComponents(normal);
}

/// Normal shear: components are coded in the order of growing |normal|. How far the first ones are
/// from their predictions moves the predictions of the later ones along the tangent plane. [A.6.10]
struct Shear {
  const uint8_t* axis;  ///< by slot; three of them
  const uint8_t* slot;  ///< by axis
  float c10;            ///< in 1/256 of a step per step
  float c20;
  float c21;
};

struct ComponentOrder {
  uint8_t axis[4];
  uint8_t slot[4];
};
/// Indexed by which of 0 > 1, 0 > 2, 1 > 2 hold (bits 0, 1, 2); two of the eight cannot occur.
inline constexpr ComponentOrder kComponentOrders[8] = {
    {{0, 1, 2}, {0, 1, 2}}, {{1, 0, 2}, {1, 0, 2}}, {{0, 1, 2}, {0, 1, 2}}, {{1, 2, 0}, {2, 0, 1}},
    {{0, 2, 1}, {0, 2, 1}}, {{0, 1, 2}, {0, 1, 2}}, {{2, 0, 1}, {1, 2, 0}}, {{2, 1, 0}, {2, 1, 0}},
};

/// Returns the index into kComponentOrders.
MCC_INLINE uint32_t normalOrder(const float* normal) {
  uint32_t size[3];  // the bits of |n|, which sort like |n|
  MCC_UNROLL
  for (int s = 0; s < 3; ++s) size[s] = std::bit_cast<uint32_t>(normal[s]) & 0x7fffffffu;
  return uint32_t{size[0] > size[1]} | uint32_t{size[0] > size[2]} << 1 |
         uint32_t{size[1] > size[2]} << 2;
}

MCC_INLINE Shear makeShear(const Lanes<float>& normal) {
  float n[4];
  storeLanes<float>(normal, n);
  const ComponentOrder& order = kComponentOrders[normalOrder(n)];
  Shear shear;
  shear.axis = order.axis;
  shear.slot = order.slot;
  // The largest component is 0 only if all are; in that case nothing is moved.
  const float largest = n[shear.axis[2]];
  const float inverse = 1.0f / (largest == 0 ? 1.0f : largest);
  const float t0 = n[shear.axis[0]] * inverse;
  const float t1 = n[shear.axis[1]] * inverse;
  shear.c20 = -256.0f * t0;
  shear.c21 = -256.0f * t1;
  shear.c10 = -256.0f * (t0 * t1 / (t1 * t1 + 1.0f));
  return shear;
}

}  // namespace mcc

#endif  // MCC_POSITIONS_PREDICT_H_
