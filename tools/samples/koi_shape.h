// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The surfaces of the koi. `along` runs from the nose (0) to the root of the tail (1), `around`
// from the belly (0) over the left side and the back (.5) and down again (1).
#ifndef MCC_TOOLS_SAMPLES_KOI_SHAPE_H_
#define MCC_TOOLS_SAMPLES_KOI_SHAPE_H_

#include <span>

#include "scene.h"

namespace mcc::samples {

/// How far the morph targets are applied; 1 is all of one.
struct KoiPose {
  double mouth = 0;  ///< open
  double gills = 0;  ///< lifted
};

/// Where the covers of the gills end.
double gillEdge(double around);

Vec3 koiPoint(double along, double around, const KoiPose& pose = {});
Vec3 koiNormal(double along, double around, const KoiPose& pose = {});

/// A sheet between a line at the body and a rim. Between its two ends, directions are blended.
struct KoiFin {
  enum class Joint { kSpine, kLeft, kRight };

  Joint joint = Joint::kSpine;
  Vec3 front;  ///< the ends of the line at the body
  Vec3 back;
  Vec3 front_direction;  ///< of the rays, unit vectors
  Vec3 back_direction;
  double front_length = 0;  ///< of the rays
  double middle_length = 0;
  double back_length = 0;
  Vec3 bend;  ///< of the rim

  /// across: 0 .. 1 from the front to the back; outward: 0 at the body, 1 at the rim.
  Vec3 point(double across, double outward) const;
  Vec3 normal(double across, double outward) const;
};

/// All fins: of the back, the belly and the tail, and two pairs. The texture has the same place
/// for all.
std::span<const KoiFin> koiFins();

/// Where the joints of a pair of fins are, by side: -1 or 1.
Vec3 pectoralRoot(double side);

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_KOI_SHAPE_H_
