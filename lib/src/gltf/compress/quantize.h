// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Lattices for the float attributes of a plan: what every chooser of their accuracy needs, and the
// choice by ConvertOptions' bits, errors and lattices. quality.h has the one by its quality.
#ifndef MCC_GLTF_COMPRESS_QUANTIZE_H_
#define MCC_GLTF_COMPRESS_QUANTIZE_H_

#include <functional>
#include <string>
#include <vector>

#include "gltf/compress/plan.h"
#include "values/enc_extent.h"

namespace mcc::gltf {

/// Returns a component of a float attribute.
float floatAt(const AttributePlan& attribute, uint64_t element, uint32_t component);

/// Adds all values of a float attribute; false when one is NaN or infinite.
bool addTo(Extent& extent, const AttributePlan& attribute);

/// Finds the lattice with the largest step that keeps every component within `error` of its source.
/// Rounding to the lattice and the two float32 roundings of decoding move a component by at most
/// step / 2 + 2^-24 (|scaled| + |decoded|). Returns false when float32 or 24 bits allow no such
/// lattice.
bool fitError(const Extent& extent, double error, Lattice& lattice, uint8_t& bits);

/// Fits a lattice of a given step through 0, so that unmoved vertices of a morph target stay
/// unmoved. `bits` becomes what its larger side needs. Returns false when that is too much.
bool fitAroundZero(const Extent& extent, float step, Lattice& lattice, uint8_t& bits);

/// Fits a lattice for tangents whose step is a power of two, starting at -1, so that 0 and the
/// signs in w do not change. Returns false when they are not of unit length.
bool fitTangents(const Extent& extent, uint8_t bits, Lattice& lattice);

bool isFloat(const AttributePlan& attribute);

/// Returns "/meshes/0/primitives/1: POSITION".
std::string whereIs(const PiecePlan& piece, const AttributePlan& attribute);
/// Puts an attribute on a lattice, or notes why it stays exact: a text that follows whereIs(). It
/// is empty if there is no reason.
void useLattice(const PiecePlan& piece, AttributePlan& attribute, const Lattice& lattice,
                uint8_t bits, const std::string& why_exact, std::vector<std::string>& notes);
inline constexpr char kNotFinite[] = " has NaN or infinite values and stays exact";
inline constexpr char kNotUnit[] = " is not of unit length and stays exact";
inline constexpr char kTooManySteps[] = " spans too many steps and stays exact";

struct PlannedAttribute {
  PiecePlan* piece;
  AttributePlan* attribute;
};

/// Positions that share a lattice, and the box around those of them that are finite.
struct PositionGroup {
  Extent extent{3};
  std::vector<PlannedAttribute> finite;

  /// Puts all of them on a lattice.
  /// max_distance  between source and decoded points, if one is promised
  void use(const Lattice& lattice, uint8_t bits, double max_distance = 0);
  std::string where() const { return whereIs(*finite[0].piece, *finite[0].attribute); }
};

/// Visits the float positions of a plan by the lattice they share. Those that have NaN or infinite
/// values stay exact, with a note, and are in no group; no group is empty.
void visitPositionGroups(Grid grid, std::vector<PayloadPlan>& payloads,
                         std::vector<std::string>& notes,
                         const std::function<void(PositionGroup&)>& visit);

/// Says which weights the writer rounds together: those of a vertex, if all of them are on one
/// lattice from 0 to 1.
void noteRoundedWeights(PiecePlan& piece);

/// Chooses the bits of every float attribute and, except for unit vectors, its lattice. Attributes
/// for which a lattice would be too coarse or impossible (outliers, NaN, infinity) get none and
/// stay exact, with a note.
void planQuantization(const ConvertOptions& options, std::vector<PayloadPlan>& payloads,
                      std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_QUANTIZE_H_
