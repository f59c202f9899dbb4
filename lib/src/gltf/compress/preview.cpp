// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "gltf/compress/vertices.h"
#include "gltf/document/accessors.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kTrianglesPerPreviewed = 50;  ///< of kPreviewsByShare

/// Returns how many triangles the preview of a part shall have; 0: it gets none.
uint64_t wantedTriangles(const ConvertOptions& options, const PartPlan& part) {
  const uint64_t count = part.triangles.size() / 3;
  if (count < kMinPreviewedTriangles) return 0;
  const uint64_t wanted = options.preview_triangles == kPreviewsByShare
                              ? count / kTrianglesPerPreviewed
                              : options.preview_triangles;
  return wanted < count ? wanted : 0;
}

/// The triangles of a part with the vertices they use, without the others of the piece.
struct CompactPart {
  std::vector<uint32_t> vertices;  ///< of the piece, in the order of their first use
  std::vector<uint32_t> triangles;
};

/// Moves the positions of vertices into a cube from 0 to 1, for which floats suffice wherever the
/// mesh is. Returns false if they are not finite.
bool readPositions(const AttributePlan& attribute, const std::vector<uint32_t>& vertices,
                   std::vector<float>& positions) {
  const ComponentType type = attribute.format.component_type;
  const uint32_t bytes = componentBytes(type);
  std::vector<double> values;
  values.reserve(3 * vertices.size());
  for (const uint32_t vertex : vertices) {
    const std::span<const uint8_t> element = attribute.source.element(vertex);
    for (size_t i = 0; i < 3; ++i) {
      values.push_back(componentValue(element.data() + i * bytes, type));
      if (!std::isfinite(values.back())) return false;
    }
  }
  double low[3];
  double extent = 0;
  for (size_t i = 0; i < 3; ++i) {
    double high = low[i] = values[i];
    for (size_t k = i; k < values.size(); k += 3) {
      low[i] = std::min(low[i], values[k]);
      high = std::max(high, values[k]);
    }
    extent = std::max(extent, high - low[i]);
  }
  if (extent == 0) extent = 1;
  positions.clear();
  for (size_t k = 0; k < values.size(); ++k) {
    positions.push_back(static_cast<float>((values[k] - low[k % 3]) / extent));
  }
  return true;
}

/// Merges the vertices of a list that lie in one cell of a grid; what is left of the triangles has
/// corners in three cells. Deterministic: products of floats and sums in a fixed order.
class Clusters {
 public:
  explicit Clusters(const TriangleList& list) : list_(list), cell_of_(list.positions.size() / 3) {}

  /// Returns the triangles that the finest grid leaves which leaves at most so many.
  std::vector<uint32_t> simplify(uint64_t triangle_count) {
    uint32_t fitting = 1;  // cells along an edge of the cube around all: one cell leaves nothing
    uint32_t excessive = kMostCells + 1;
    while (excessive - fitting > 1) {
      const uint32_t middle = (fitting + excessive) / 2;
      putIntoCells(middle);
      (leftTriangles() <= triangle_count ? fitting : excessive) = middle;
    }
    putIntoCells(fitting);
    return triangles(representatives());
  }

 private:
  static constexpr uint32_t kMostCells = 1024;  // 10 bits for each coordinate of a cell

  void putIntoCells(uint32_t cells) {
    for (size_t vertex = 0; vertex < cell_of_.size(); ++vertex) {
      uint32_t cell = 0;
      for (size_t i = 0; i < 3; ++i) {
        const float place = list_.positions[3 * vertex + i] * static_cast<float>(cells);
        cell = cell << 10 | std::min(static_cast<uint32_t>(place), cells - 1);
      }
      cell_of_[vertex] = cell;
    }
  }

  bool isLeft(const uint32_t* corners) const {
    const uint32_t a = cell_of_[corners[0]];
    const uint32_t b = cell_of_[corners[1]];
    const uint32_t c = cell_of_[corners[2]];
    return a != b && b != c && c != a;
  }

  uint64_t leftTriangles() const {
    uint64_t count = 0;
    for (size_t i = 0; i < list_.triangles.size(); i += 3) {
      count += isLeft(&list_.triangles[i]) ? 1 : 0;
    }
    return count;
  }

  /// Returns for each vertex the one of its cell that is closest to the mean of all there.
  std::vector<uint32_t> representatives() const {
    std::vector<uint32_t> order(cell_of_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [this](uint32_t a, uint32_t b) {
      return std::pair(cell_of_[a], a) < std::pair(cell_of_[b], b);
    });
    std::vector<uint32_t> chosen(order.size());
    for (size_t begin = 0; begin < order.size();) {
      size_t end = begin;
      double sums[3] = {};
      for (; end < order.size() && cell_of_[order[end]] == cell_of_[order[begin]]; ++end) {
        for (size_t i = 0; i < 3; ++i) sums[i] += double{at(order[end], i)};
      }
      const auto fromMean = [&](uint32_t vertex) {
        double square = 0;
        for (size_t i = 0; i < 3; ++i) {
          const double away = double{at(vertex, i)} - sums[i] / static_cast<double>(end - begin);
          square += away * away;
        }
        return square;
      };
      uint32_t best = order[begin];
      double least = fromMean(best);
      for (size_t k = begin + 1; k < end; ++k) {
        const double square = fromMean(order[k]);
        if (square < least) best = order[k];
        least = std::min(least, square);
      }
      for (; begin < end; ++begin) chosen[order[begin]] = best;
    }
    return chosen;
  }

  float at(uint32_t vertex, size_t i) const { return list_.positions[size_t{3} * vertex + i]; }

  /// Returns what is left of the triangles, each once.
  std::vector<uint32_t> triangles(const std::vector<uint32_t>& chosen) const {
    std::vector<std::array<uint32_t, 3>> all;
    for (size_t i = 0; i < list_.triangles.size(); i += 3) {
      const uint32_t* const corners = &list_.triangles[i];
      if (!isLeft(corners)) continue;
      auto& triangle = all.emplace_back();
      for (size_t k = 0; k < 3; ++k) triangle[k] = chosen[corners[k]];
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                  triangle.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::vector<uint32_t> corners;
    for (const auto& triangle : all)
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    return corners;
  }

  const TriangleList& list_;
  std::vector<uint32_t> cell_of_;  ///< of each vertex
};

/// Simplifies the parts of one piece.
class PieceSimplifier {
 public:
  PieceSimplifier(const ConvertOptions& options, const PiecePlan& piece,
                  std::vector<std::string>& remarks)
      : options_(options), piece_(piece), remarks_(remarks), numbers_(piece.wedge_count, kNone) {}

  /// Plans a piece of a preview. It has no parts if no primitive gets a preview.
  Result run(PiecePlan& preview) {
    for (const PartPlan& part : piece_.parts) {
      const uint64_t wanted = wantedTriangles(options_, part);
      if (wanted == 0) continue;
      std::vector<uint32_t> triangles;
      MCC_GLTF_TRY(simplify(part, wanted, triangles));
      if (triangles.empty()) continue;
      PartPlan& coarse = preview.parts.emplace_back();
      coarse.triangles = std::move(triangles);
      coarse.users = part.users;
    }
    if (preview.parts.empty()) return {};
    preview.wedge_count = piece_.wedge_count;
    preview.kept = piece_.kept;
    preview.target_count = piece_.target_count;
    preview.attributes = piece_.attributes;
    keepVertices(usedVertices(preview), preview);
    return {};
  }

 private:
  CompactPart compact(const PartPlan& part) {
    CompactPart result;
    for (const uint32_t vertex : part.triangles) {
      uint32_t& number = numbers_[vertex];
      if (number == kNone) {
        number = static_cast<uint32_t>(result.vertices.size());
        result.vertices.push_back(vertex);
      }
      result.triangles.push_back(number);
    }
    for (const uint32_t vertex : result.vertices) numbers_[vertex] = kNone;
    return result;
  }

  Result simplify(const PartPlan& part, uint64_t wanted, std::vector<uint32_t>& triangles) {
    const CompactPart whole = compact(part);
    std::vector<float> positions;
    if (!readPositions(piece_.attributes[0], whole.vertices, positions)) {
      leaveOut(part, "its positions are not finite");
      return {};
    }
    const TriangleList list = {positions, whole.triangles};
    Result result;
    if (options_.simplify) {
      result = options_.simplify(list, wanted, triangles);
    } else {
      triangles = Clusters(list).simplify(wanted);
    }
    if (!result.ok()) {
      triangles.clear();
      leaveOut(part, result.what);
      return {};
    }
    const auto exists = [&](uint32_t vertex) { return vertex < whole.vertices.size(); };
    if (triangles.size() % 3 != 0 || triangles.size() > whole.triangles.size() ||
        !std::all_of(triangles.begin(), triangles.end(), exists)) {
      return error(part.users[0].path(), "`simplify` returns triangles that are none of the mesh");
    }
    // Otherwise, showing the preview would delay what it is to be shown for.
    if (triangles.empty() || triangles.size() > whole.triangles.size() / 2) {
      triangles.clear();
      leaveOut(part, "its surface cannot be simplified");
    }
    for (uint32_t& vertex : triangles) vertex = whole.vertices[vertex];
    return {};
  }

  void leaveOut(const PartPlan& part, const std::string& why) {
    remarks_.push_back(part.users[0].path() + ": gets no preview: " + why);
  }

  const ConvertOptions& options_;
  const PiecePlan& piece_;
  std::vector<std::string>& remarks_;
  std::vector<uint32_t> numbers_;  ///< by vertex of the piece; kNone between two parts
};

}  // namespace

Result makePreviews(const ConvertOptions& options, const std::vector<EncodedPayload>& payloads,
                    std::vector<EncodedPayload>& previews, std::vector<std::string>& remarks) {
  if (options.preview_triangles == kNoPreviews) return {};
  std::vector<PayloadPlan> plans;
  for (const EncodedPayload& payload : payloads) {
    PayloadPlan plan;
    plan.mesh = payload.plan.mesh;
    plan.is_preview = true;
    for (const PiecePlan& piece : payload.plan.pieces) {
      PiecePlan preview;
      MCC_GLTF_TRY(PieceSimplifier(options, piece, remarks).run(preview));
      if (!preview.parts.empty()) plan.pieces.push_back(std::move(preview));
    }
    if (!plan.pieces.empty()) plans.push_back(std::move(plan));
  }
  ConvertOptions own = options;
  own.block_triangles = 0;  // it is shown when all of it is there
  own.keep_vertex_order = own.keep_triangle_order = false;
  own.progress = nullptr;
  std::vector<LeftAlone> refused;
  MCC_GLTF_TRY(encodePayloads(own, std::move(plans), previews, refused));
  for (const LeftAlone& left : refused) {
    remarks.push_back(left.primitive.path() + ": gets no preview: the codec refuses it");
  }
  return {};
}

}  // namespace mcc::gltf
