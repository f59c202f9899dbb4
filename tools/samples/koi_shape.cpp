// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "koi_shape.h"

#include <algorithm>
#include <array>
#include <vector>

namespace mcc::samples {
namespace {

constexpr double kBodyLength = 1.7;
constexpr double kNose = 0.95;  // its z

/// Half heights and half widths at every tenth of the body.
using Profile = std::array<double, 11>;
constexpr Profile kTop = {.085, .168, .225, .262, .275, .266, .240, .200, .152, .112, .100};
constexpr Profile kBottom = {.080, .150, .195, .224, .232, .220, .193, .158, .122, .098, .095};
constexpr Profile kWidth = {.105, .165, .200, .214, .208, .188, .158, .122, .086, .054, .034};

/// Catmull and Rom's curve through the values.
double valueAt(const Profile& profile, double along) {
  constexpr size_t kLast = std::tuple_size_v<Profile> - 1;
  const double place = std::clamp(along, 0.0, 1.0) * double{kLast};
  const size_t i = std::min(static_cast<size_t>(place), kLast - 1);
  const double t = place - static_cast<double>(i);
  const double p0 = profile[i == 0 ? 0 : i - 1];
  const double p1 = profile[i];
  const double p2 = profile[i + 1];
  const double p3 = profile[std::min(i + 2, kLast)];
  return p1 +
         t / 2 * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
}

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Rounds both ends: 0 at the end, 1 from `length` on.
double rounded(double distance, double length) {
  const double q = 1 - std::min(distance / length, 1.0);
  return std::sqrt(1 - q * q);
}

Vec3 blended(const Vec3& a, const Vec3& b, double t) { return a * (1 - t) + b * t; }

KoiFin mirrored(KoiFin fin) {
  fin.joint = fin.joint == KoiFin::Joint::kLeft ? KoiFin::Joint::kRight : fin.joint;
  for (Vec3* v : {&fin.front, &fin.back, &fin.front_direction, &fin.back_direction, &fin.bend}) {
    v->x = -v->x;
  }
  return fin;
}

KoiFin finBetween(const Vec3& front, const Vec3& back, const Vec3& front_direction,
                  const Vec3& back_direction, const std::array<double, 3>& lengths,
                  const Vec3& bend) {
  return {KoiFin::Joint::kSpine,
          front,
          back,
          unit(front_direction),
          unit(back_direction),
          lengths[0],
          lengths[1],
          lengths[2],
          bend};
}

std::vector<KoiFin> makeFins() {
  // Lines at the body lie a little inside of it.
  const auto inside = [](double along, double around, double depth) {
    return koiPoint(along, around) - koiNormal(along, around) * depth;
  };
  std::vector<KoiFin> fins;
  fins.push_back(finBetween(inside(0.33, 0.5, 0.02), inside(0.72, 0.5, 0.02), {0, 1, -0.35},
                            {0, 0.75, -1}, {0.20, 0.17, 0.14}, {0.012, 0, -0.03}));
  fins.push_back(finBetween({0, 0.085, -0.72}, {0, -0.085, -0.72}, {0, 0.72, -1}, {0, -0.66, -1},
                            {0.50, 0.25, 0.46}, {0.03, 0, 0}));
  fins.push_back(finBetween(inside(0.74, 0.0, 0.02), inside(0.85, 0.0, 0.02), {0, -1, -0.45},
                            {0, -0.5, -1}, {0.15, 0.15, 0.10}, {0.01, 0, -0.02}));
  fins.push_back(finBetween(inside(0.47, 0.10, 0.03), inside(0.53, 0.06, 0.03), {0.75, -0.7, -0.4},
                            {0.1, -0.7, -1}, {0.17, 0.18, 0.13}, {0, 0.015, -0.03}));
  fins.push_back(mirrored(fins.back()));
  fins.push_back(finBetween(inside(0.245, 0.17, 0.03), inside(0.275, 0.115, 0.03),
                            {1, -0.25, -0.05}, {0.35, -0.5, -1}, {0.25, 0.27, 0.17},
                            {0.01, 0.03, -0.05}));
  fins.back().joint = KoiFin::Joint::kLeft;
  fins.push_back(mirrored(fins.back()));
  return fins;
}

}  // namespace

double gillEdge(double around) {
  const double up = 2 * std::abs(around - 0.5) - 0.5;  // 0 in the middle of a side
  return 0.225 - 0.16 * up * up;
}

Vec3 koiPoint(double along, double around, const KoiPose& pose) {
  const test::CosSin angle = test::turn(around);
  const double sides = angle.sin * angle.sin;
  const double edge = gillEdge(around);
  // The covers of the gills rise slowly and end in a step.
  const double cover =
      smooth(edge - 0.12, edge - 0.012, along) * (1 - smooth(edge - 0.008, edge + 0.006, along));
  const double lips = smooth(0, 0.012, along) * (1 - smooth(0.012, 0.045, along));
  double radius = rounded(along, 0.17) * rounded(1 - along, 0.03);
  radius *= 1 + (0.05 + 0.12 * pose.gills) * cover * sides + 0.10 * lips;
  const double front = 1 - smooth(0, 0.07, along);
  const double hole = 1 - smooth(0.004, 0.018, along);
  radius *= 1 + 0.35 * pose.mouth * front * (1 - hole);
  const double height = angle.cos > 0 ? valueAt(kBottom, along) : valueAt(kTop, along);
  const double arch = -0.03 * (1 - smooth(0, 0.35, along));  // the mouth is low
  const double forward = pose.mouth * (0.035 * front - 0.10 * hole);
  return {valueAt(kWidth, along) * radius * angle.sin, arch - height * radius * angle.cos,
          kNose - kBodyLength * along + forward};
}

Vec3 koiNormal(double along, double around, const KoiPose& pose) {
  constexpr double kStep = 1.0 / 4096;
  if (along <= 0) return {0, 0, 1};
  if (along >= 1) return {0, 0, -1};
  const double before = std::max(along - kStep, 0.0);
  const double after = std::min(along + kStep, 1.0);
  const Vec3 u = koiPoint(after, around, pose) - koiPoint(before, around, pose);
  const Vec3 v = koiPoint(along, around + kStep, pose) - koiPoint(along, around - kStep, pose);
  return unit(cross(u, v));
}

Vec3 KoiFin::point(double across, double outward) const {
  const double a = (1 - across) * (1 - 2 * across);  // the parabola through three lengths
  const double b = 4 * across * (1 - across);
  const double c = across * (2 * across - 1);
  const double side = 2 * across - 1;
  const double rim = std::sqrt(std::sqrt(1 - 0.6 * side * side * side * side));
  const double length = (a * front_length + b * middle_length + c * back_length) * rim;
  const double waves = test::turn(2.5 * across).sin * outward * outward;
  return blended(front, back, across) +
         unit(blended(front_direction, back_direction, across)) * (length * outward) +
         bend * (outward * outward) + Vec3{0.35 * bend.x, 0.35 * bend.y, 0} * waves;
}

Vec3 KoiFin::normal(double across, double outward) const {
  constexpr double kStep = 1.0 / 4096;
  const double low = std::max(across - kStep, 0.0);
  const double high = std::min(across + kStep, 1.0);
  const Vec3 u = point(high, outward) - point(low, outward);
  const Vec3 v = point(across, outward + kStep) - point(across, outward);
  return unit(cross(u, v));
}

std::span<const KoiFin> koiFins() {
  static const std::vector<KoiFin> kFins = makeFins();
  return kFins;
}

Vec3 pectoralRoot(double side) {
  const Vec3 root = koiPoint(0.26, 0.145);
  return {root.x * side, root.y, root.z};
}

}  // namespace mcc::samples
