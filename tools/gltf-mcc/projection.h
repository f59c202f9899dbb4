// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Projects a mesh as it is seen from far away: places on a page, and what hides what.
#ifndef MCC_TOOL_PROJECTION_H_
#define MCC_TOOL_PROJECTION_H_

#include <cstdint>
#include <span>
#include <vector>

namespace mcc::tool {

/// A point on the page: x to the right, y down, in pixels; z towards the eye.
struct PagePoint {
  double x = 0;
  double y = 0;
  double z = 0;
  bool is_finite = true;
};

struct Page {
  std::vector<PagePoint> points;
  double width = 0;
  double height = 0;
};

/// Projects the points that triangles use so that they fit into `width` pixels, or into as many
/// pixels of height, with a margin.
Page projectMesh(std::span<const float> positions, std::span<const uint32_t> indices,
                 const double* view, double width, double margin);

/// How much light a triangle gets, 0 to 1, and whether its front side is visible.
struct Lighting {
  double shade = 0;
  bool is_front = true;
};
Lighting lightingOf(const PagePoint& a, const PagePoint& b, const PagePoint& c);

/// Which triangle is visible at each place of a page, in half pixels.
class DepthBuffer {
 public:
  DepthBuffer(const Page& page, std::span<const uint32_t> indices);

  /// Whether any part of a triangle is visible.
  bool sees(uint32_t triangle) const { return is_seen_[triangle]; }
  /// Whether a point of the surface is visible: nothing is clearly in front of it.
  bool sees(double x, double y, double z) const;

 private:
  void draw(const Page& page, const uint32_t* corners, uint32_t triangle);
  float at(int64_t column, int64_t row) const;

  static constexpr double kScale = 2;  ///< places per pixel
  int64_t columns_;
  int64_t rows_;
  double tolerance_;
  std::vector<float> depth_;
  std::vector<uint32_t> triangle_;
  std::vector<bool> is_seen_;
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_PROJECTION_H_
