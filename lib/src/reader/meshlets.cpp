// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "mcc/meshlets.h"

#include <algorithm>

#include "base/caller_memory.h"
#include "base/memory.h"
#include "base/status.h"

namespace mcc {
namespace {

constexpr uint32_t kMaxTriangles = uint32_t{1} << 28;  // as the format: offsets then fit 32 bits

bool areValid(const MeshletOptions& options) {
  return options.max_vertices >= 3 && options.max_vertices <= 256 && options.max_triangles >= 1 &&
         options.max_triangles <= 512 && options.shape <= MeshletShape::kInOrder;
}

/// The fewest triangles of a meshlet that can be closed before the list ends. One that is closed
/// because a triangle's vertices have no room has at least max_vertices - 2 vertices.
uint32_t leastTriangles(const MeshletOptions& options) {
  return std::min((options.max_triangles + 1) / 2, std::max(options.max_vertices / 3, 1u));
}

/// Grows one meshlet after another. The corners of each vertex that are in no meshlet yet are a
/// list, in which taken ones are only unlinked when the list is walked.
template <class Index>
class Builder {
 public:
  Builder(const Index* indices, const MeshletTarget& target, const MeshletOptions& options)
      : indices_(indices),
        target_(target),
        options_(options),
        place_(options.allocator),
        first_corner_(options.allocator),
        next_corner_(options.allocator),
        is_taken_(options.allocator) {}

  Status build(const TriangleList& list, MeshletSizes& used) {
    const bool is_round = options_.shape == MeshletShape::kRound;
    if (!place_.assign(list.vertex_count, 0) || (is_round && !takeMemory(list))) {
      return fail(Error::kOutOfMemory, "no memory for meshlets");
    }
    if (!(is_round ? linkCorners(list) : buildInOrder(list)))
      return fail(Error::kBadArgument, "an index is not below the number of vertices");
    if (is_round) buildRound(list.triangle_count);
    close();
    used = {meshlet_count_, now_.vertex_offset, now_.triangle_offset};
    return {};
  }

 private:
  bool takeMemory(const TriangleList& list) {
    return first_corner_.assign(list.vertex_count, kNone) &&
           next_corner_.resize(size_t{3} * list.triangle_count) &&
           is_taken_.assign(list.triangle_count, 0);
  }

  /// Returns false at an index that is no vertex.
  bool linkCorners(const TriangleList& list) {
    for (uint32_t corner = 3 * list.triangle_count; corner-- > 0;) {
      if (indices_[corner] >= list.vertex_count) return false;
      next_corner_[corner] = first_corner_[indices_[corner]];
      first_corner_[indices_[corner]] = corner;
    }
    return true;
  }

  /// Takes the triangles as they come. Returns false at an index that is no vertex. What changes
  /// with every triangle is in variables, which become registers: for all a compiler knows, the
  /// bytes that are stored might be those of a member.
  bool buildInOrder(const TriangleList& list) {
    const uint32_t vertex_count = list.vertex_count;
    uint32_t* const place = place_.data();
    uint32_t* const vertices = target_.vertices.data();
    uint8_t* const triangles = target_.triangles.data();
    const Index* corners = indices_;
    const Index* const end = corners + size_t{3} * list.triangle_count;
    uint32_t first = 0;                          // vertex of the meshlet
    uint32_t last = 0;                           // vertex, plus 1
    uint32_t roomy = options_.max_vertices - 3;  // up to here, whatever comes has room
    uint8_t* local = triangles;
    const uint8_t* full = local + 3 * options_.max_triangles;
    const auto settle = [&]() {
      now_.vertex_count = last - first;
      now_.triangle_count = static_cast<uint32_t>(local - (triangles + now_.triangle_offset)) / 3;
    };
    for (; corners != end; corners += 3) {
      if (std::max({corners[0], corners[1], corners[2]}) >= vertex_count) return false;
      if (local == full || last > roomy) {
        settle();
        if (!fits(static_cast<uint32_t>((corners - indices_) / 3))) {
          close();
          first = last;
          roomy = first + options_.max_vertices - 3;
          local = triangles + now_.triangle_offset;
          full = local + 3 * options_.max_triangles;
        }
      }
      MCC_UNROLL
      for (int i = 0; i < 3; ++i) {
        uint32_t number = place[corners[i]];
        if (number <= first) {
          vertices[last] = corners[i];
          number = ++last;
          place[corners[i]] = number;
        }
        *local++ = static_cast<uint8_t>(number - 1 - first);
      }
    }
    settle();
    return true;
  }

  void buildRound(uint32_t triangle_count) {
    for (uint32_t triangle = 0; triangle < triangle_count; ++triangle) {
      if (is_taken_[triangle] != 0) continue;
      // A meshlet that has nothing around it goes on elsewhere while it is small. One that is at
      // least half full is better closed: its sphere stays small.
      if (!fits(triangle) || 2 * now_.triangle_count >= options_.max_triangles) close();
      const uint32_t first_vertex = now_.vertex_count;
      take(triangle);
      is_taken_[triangle] = 1;
      grow(first_vertex);
    }
  }

  /// Whether a vertex is in the current meshlet: places only rise.
  bool has(uint32_t vertex) const { return place_[vertex] > now_.vertex_offset; }

  bool fits(uint32_t triangle) const {
    const Index* corners = indices_ + size_t{3} * triangle;
    const uint32_t added =
        (has(corners[0]) ? 0u : 1u) + (has(corners[1]) ? 0u : 1u) + (has(corners[2]) ? 0u : 1u);
    return now_.triangle_count < options_.max_triangles &&
           now_.vertex_count + added <= options_.max_vertices;
  }

  void take(uint32_t triangle) {
    const Index* corners = indices_ + size_t{3} * triangle;
    uint8_t* local = target_.triangles.data() + now_.triangle_offset + 3 * now_.triangle_count++;
    for (int i = 0; i < 3; ++i) {
      if (!has(corners[i])) {
        const uint32_t end = now_.vertex_offset + now_.vertex_count++;
        target_.vertices[end] = corners[i];
        place_[corners[i]] = end + 1;
      }
      local[i] = static_cast<uint8_t>(place_[corners[i]] - 1 - now_.vertex_offset);
    }
  }

  /// Takes the triangles around the vertices of the meshlet, from one of them on. The number of
  /// those that are looked at in vain is limited, because a vertex may be in any number of them.
  void grow(uint32_t first_vertex) {
    uint32_t misses_left = options_.max_vertices;
    for (uint32_t i = first_vertex; i < now_.vertex_count; ++i) {
      uint32_t* link = &first_corner_[target_.vertices[now_.vertex_offset + i]];
      while (*link != kNone) {
        const uint32_t triangle = *link / 3;
        const bool was_taken = is_taken_[triangle] != 0;
        if (!was_taken && !fits(triangle)) {
          if (now_.triangle_count == options_.max_triangles || --misses_left == 0) return;
          link = &next_corner_[*link];
          continue;
        }
        if (!was_taken) {
          take(triangle);
          is_taken_[triangle] = 1;
        }
        *link = next_corner_[*link];
      }
    }
  }

  void close() {
    if (now_.triangle_count == 0) return;
    target_.meshlets[meshlet_count_++] = now_;
    uint32_t end = now_.triangle_offset + 3 * now_.triangle_count;
    while (end % 4 != 0) target_.triangles[end++] = 0;
    now_ = {now_.vertex_offset + now_.vertex_count, end, 0, 0};
  }

  const Index* indices_;
  const MeshletTarget& target_;
  const MeshletOptions& options_;
  Array<uint32_t> place_;  // of each vertex where it was last put in target_.vertices, plus 1
  Array<uint32_t> first_corner_;  // of each vertex
  Array<uint32_t> next_corner_;   // after each corner, of the same vertex
  Array<uint8_t> is_taken_;       // of each triangle
  Meshlet now_;
  size_t meshlet_count_ = 0;
};

template <class Index>
Status build(const TriangleList& list, const MeshletTarget& target, const MeshletOptions& options,
             MeshletSizes& used) {
  const size_t index_count = size_t{3} * list.triangle_count;
  if ((list.indices == nullptr && index_count != 0) ||
      !canBeInMemory(list.indices, index_count, sizeof(Index), sizeof(Index))) {
    return fail(Error::kBadArgument, "indices is null or longer than memory");
  }
  return Builder<Index>(static_cast<const Index*>(list.indices), target, options).build(list, used);
}

template <class T>
bool holds(std::span<T> array, size_t count) {
  return array.size() >= count && (array.data() != nullptr || count == 0);
}

}  // namespace

MeshletSizes meshletBound(uint32_t triangle_count, const MeshletOptions& options) {
  if (!areValid(options) || triangle_count > kMaxTriangles) return {};
  const size_t meshlets = (triangle_count + leastTriangles(options) - 1) / leastTriangles(options);
  return {meshlets, size_t{3} * triangle_count, size_t{3} * triangle_count + 3 * meshlets};
}

Status buildMeshlets(const TriangleList& list, const MeshletTarget& target, MeshletSizes& used,
                     const MeshletOptions& options) {
  used = {};
  if (!areValid(options)) {
    return fail(Error::kBadArgument,
                "meshlets have 3 to 256 vertices, 1 to 512 triangles and a known shape");
  }
  if (list.triangle_count > kMaxTriangles) return fail(Error::kLimit, "more than 2^28 triangles");
  const MeshletSizes bound = meshletBound(list.triangle_count, options);
  if (!holds(target.meshlets, bound.meshlet_count) || !holds(target.vertices, bound.vertex_count) ||
      !holds(target.triangles, bound.triangle_bytes))
    return fail(Error::kBadArgument, "the arrays for meshlets are smaller than meshletBound()");
  switch (list.index_type) {
    case IndexType::kUint8: return build<uint8_t>(list, target, options, used);
    case IndexType::kUint16: return build<uint16_t>(list, target, options, used);
    case IndexType::kUint32: return build<uint32_t>(list, target, options, used);
  }
  return fail(Error::kBadArgument, "indices have an unknown type");
}

}  // namespace mcc
