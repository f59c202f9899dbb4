// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the codecs of other projects have in common here: decoded meshes and their errors.
#ifndef MCC_TOOLS_FOREIGN_FOREIGN_MESH_H_
#define MCC_TOOLS_FOREIGN_FOREIGN_MESH_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mcc/types.h"
#include "mcc/writer.h"

namespace mcc::foreign {

/// Result of a call into another project's codec: no message = done, else its own words if any.
struct [[nodiscard]] Outcome {
  std::string message;

  bool ok() const { return message.empty(); }
};

inline Outcome failure(std::string message) {
  return Outcome{message.empty() ? std::string("unknown error") : std::move(message)};
}

/// Runs `body`, an Outcome-returning callable, and turns what a codec or the allocator throws into
/// a message.
template <typename Body>
Outcome guarded(const Body& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return failure("out of memory");
  } catch (const std::exception& error) {
    return failure(error.what());
  } catch (...) {
    return failure("unknown exception");
  }
}

/// Milliseconds since construction, on the monotonic clock.
class Stopwatch {
 public:
  double elapsedMs() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// One decoded attribute: vertex_count elements of component_count components, tightly packed.
struct DecodedAttribute {
  /// Draco: unique id of the attribute; meshoptimizer: index in PieceView::attributes.
  uint32_t id = 0;
  ComponentType component_type = ComponentType::kFloat32;
  uint8_t component_count = 0;
  std::unique_ptr<std::byte[]> values;

  size_t elementBytes() const { return size_t{componentBytes(component_type)} * component_count; }
  /// Only for kFloat32.
  const float* floats() const { return reinterpret_cast<const float*>(values.get()); }
};

/// A decoded mesh in arrays allocated by the call that filled it.
struct DecodedMesh {
  uint32_t vertex_count = 0;  ///< as the codec counts: distinct attribute tuples, more or less
  uint32_t triangle_count = 0;
  std::unique_ptr<uint32_t[]> indices;  ///< 3 per triangle
  std::vector<DecodedAttribute> attributes;
  double decode_ms = 0;   ///< from bytes in memory to these arrays, extract_ms included
  double extract_ms = 0;  ///< the part spent on copying the codec's result into these arrays

  std::span<const uint32_t> indexSpan() const {
    return {indices.get(), size_t{triangle_count} * 3};
  }
  const DecodedAttribute* find(uint32_t id) const {
    for (const DecodedAttribute& attribute : attributes) {
      if (attribute.id == id) return &attribute;
    }
    return nullptr;
  }
};

/// Error of one decoded attribute against its source.
struct AttributeError {
  bool is_angle = false;  ///< NORMAL, TANGENT of the base mesh: maximum and median are degrees
  /// Per element: the angle, else the largest difference of a component in accessor units.
  double maximum = 0;
  double median = 0;
  double maximum_component = 0;  ///< largest difference of a component, also for angles
  uint32_t measured_count = 0;
  uint32_t sign_flip_count = 0;  ///< TANGENT: w has the other sign
  /// No angle: a vector of length zero on either side; or NaN on one side only.
  uint32_t undefined_count = 0;
};

/// Compares a decoded attribute with its source, element by element.
/// source_wedge  per decoded vertex the wedge of the source it carries; kNone: skip.
/// decoded       packed elements of source.format, or float32 ones of equal component count.
/// Fails when the shapes differ or an id is beyond source_wedge_count. Works for every codec.
Outcome measureError(const AttributeView& source, uint32_t source_wedge_count,
                     ComponentType decoded_type, const void* decoded,
                     std::span<const uint32_t> source_wedge, AttributeError& error);

/// The lattice that an attribute with quantization_bits > 0 is coded on: the caller's, or
/// the box of its values with step = longest side / (2^bits - 1). A flat box gets range 1.
/// False when it has to stay exact: integers, zero bits, NaN, infinity, more than 4 components.
bool effectiveLattice(const AttributeView& view, uint32_t wedge_count, Lattice& lattice);

/// Component of an element as stored (normalized integers are not divided).
double readComponent(const AttributeView& view, uint32_t wedge, uint32_t component);

/// Whether there is neither NaN nor infinity among the values.
bool allFinite(const AttributeView& view, uint32_t wedge_count);

}  // namespace mcc::foreign

#endif  // MCC_TOOLS_FOREIGN_FOREIGN_MESH_H_
