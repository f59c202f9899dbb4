// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/unused.h"

#include <cstring>

namespace mcc::gltf {
namespace {

/// Returns the vertices that a triangle uses, in ascending order.
std::vector<uint32_t> usedVertices(const PiecePlan& piece) {
  std::vector<bool> is_used(piece.wedge_count, false);
  for (const PartPlan& part : piece.parts) {
    for (const uint32_t vertex : part.triangles) is_used[vertex] = true;
  }
  std::vector<uint32_t> used;
  for (uint32_t vertex = 0; vertex < piece.wedge_count; ++vertex) {
    if (is_used[vertex]) used.push_back(vertex);
  }
  return used;
}

void keepVertices(std::vector<uint32_t> kept, PiecePlan& piece) {
  std::vector<uint32_t> new_number(piece.wedge_count, kNone);
  for (uint32_t i = 0; i < kept.size(); ++i) new_number[kept[i]] = i;
  for (PartPlan& part : piece.parts) {
    for (uint32_t& vertex : part.triangles) vertex = new_number[vertex];
  }
  for (AttributePlan& attribute : piece.attributes) {
    AccessorData& source = attribute.source;
    std::vector<uint8_t> elements(kept.size() * source.element_bytes);
    for (size_t i = 0; i < kept.size(); ++i) {
      std::memcpy(elements.data() + i * source.element_bytes, source.element(kept[i]).data(),
                  source.element_bytes);
    }
    source.owned = std::move(elements);
    source.data = source.owned.data();
    source.stride_bytes = source.element_bytes;
    source.count = kept.size();
  }
  piece.wedge_count = static_cast<uint32_t>(kept.size());
  piece.kept = std::move(kept);
}

}  // namespace

void planUnused(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                std::vector<std::string>& notes) {
  for (PayloadPlan& payload : payloads) {
    uint64_t unused = 0;
    bool is_kept = !options.drop_unused;
    for (PiecePlan& piece : payload.pieces) {
      std::vector<uint32_t> used = usedVertices(piece);
      if (used.size() == piece.wedge_count) continue;
      unused += piece.wedge_count - used.size();
      // An extension may refer to vertices by number, attributes may stay next to the payload, and
      // a primitive needs at least one vertex.
      const bool must_stay = payload.keep_vertex_order || !piece.vertex_numbers.empty() ||
                             !piece.ordinary.empty() || used.empty();
      if (must_stay) is_kept = true;
      if (options.drop_unused && !must_stay) keepVertices(std::move(used), piece);
    }
    if (unused == 0) continue;
    const std::string which =
        unused == 1 ? "1 vertex is" : std::to_string(unused) + " vertices are";
    notes.push_back(at("/meshes", payload.mesh) + ": " + which + " in no triangle" +
                    (!options.drop_unused ? "; --drop-unused leaves out what nothing refers to"
                     : is_kept            ? ", and not all can be left out"
                                          : ", and left out"));
  }
}

}  // namespace mcc::gltf
