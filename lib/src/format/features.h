// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The encoder's choices by name, so that each can be switched off and its gain measured (`gltf-mcc
// bench --without`).
#ifndef MCC_FORMAT_FEATURES_H_
#define MCC_FORMAT_FEATURES_H_

#include <cstdint>
#include <string_view>

namespace mcc {

/// A choice of the format that the encoder can do without.
enum class Feature : uint8_t {
  kPivots,
  kSingleCoder,
  kPalette,
  kPlanes,
  kShear,
  kFold,
  kSplit,
  kOwnScale,
  kWeights,
  kTipSelection,
  kBeyondWeights,
  kDegreeWeights,
  kCreases,
  kEqualities,
  kNormalWeights,
  kNormalBlend,
  kTexcoordHinge,
  kTangentAngle,
  kPerpendicular,
  kValueFlags,
  kSkin,
  kAliases,
  kExactNormals,
  kExactGrids,
  kMemory,
  kMirrors,
  kAnchors,
  kMates,
  kTangentRepeats,
  kTangentFaces,
  kStarts,
};

struct FeatureInfo {
  Feature feature;
  std::string_view name;
  std::string_view section;  ///< section of the specification
  std::string_view without;  ///< what the encoder does instead
};

inline constexpr FeatureInfo kFeatures[] = {
    {Feature::kPivots, "pivots", "A.4.7", "all surfaces are cut to manifolds and stitched"},
    {Feature::kSingleCoder, "single-coder", "A.3.7", "three streams always"},
    {Feature::kPalette, "palette", "A.6", "coordinates, not ranks among the distinct ones"},
    {Feature::kPlanes, "planes", "A.6.12", "coordinates, not numbers of planes"},
    {Feature::kShear, "shear", "A.6", "components in file order"},
    {Feature::kFold, "fold", "A.6", "residuals keep the sign"},
    {Feature::kSplit, "split", "A.6", "one table of rows"},
    {Feature::kOwnScale, "own-scale", "A.6", "the specification's coefficients of scale"},
    {Feature::kWeights, "weights", "A.6", "the mean of the tips"},
    {Feature::kTipSelection, "tip-selection", "A.6", "no classes by how parallelograms did"},
    {Feature::kBeyondWeights, "beyond", "A.6", "no vertices beyond the fan"},
    {Feature::kDegreeWeights, "degrees", "A.6", "no weights of degrees"},
    {Feature::kCreases, "creases", "A.7", "seams without regard to angles"},
    {Feature::kEqualities, "equalities", "A.10", "every wedge has a value of its own"},
    {Feature::kNormalWeights, "normal-weights", "A.10.6", "faces weigh by their angles"},
    {Feature::kNormalBlend, "normal-blend", "A.10.6", "no mean with the neighbours' normals"},
    {Feature::kTexcoordHinge, "texcoord-hinge", "A.10.11", "parallelograms over the longest edge"},
    {Feature::kTangentAngle, "tangent-angle", "A.10", "tangents as points of the octahedron"},
    {Feature::kPerpendicular, "perpendicular", "A.10.17", "exact tangents by two components"},
    {Feature::kValueFlags, "value-flags", "A.10.4", "no flags for values of 0 or a neighbour's"},
    {Feature::kSkin, "skin", "A.10.14", "joints and weights as any other values"},
    {Feature::kAliases, "aliases", "A.2.4", "equal attributes coded each by itself"},
    {Feature::kExactNormals, "exact-normals", "A.10", "exact normals as values on a grid"},
    {Feature::kExactGrids, "exact-grids", "A.10.5", "exact floats as ordered integers"},
    {Feature::kMemory, "memory", "A.10.10", "charts and exact normals remember nothing"},
    {Feature::kMirrors, "mirrors", "A.6.14", "mirrored halves are coded twice"},
    {Feature::kAnchors, "anchors", "A.6.15", "repeated components are coded anew"},
    {Feature::kMates, "mates", "A.10.20", "no flags for values that a mate has"},
    {Feature::kTangentRepeats, "tangent-repeats", "A.10.19", "no flags for repeated tangents"},
    {Feature::kTangentFaces, "tangent-faces", "A.10.19", "tangents beside normals, not in faces"},
    {Feature::kStarts, "starts", "A.3.9", "models that have seen nothing"},
};

/// A set of features.
class FeatureSet {
 public:
  constexpr FeatureSet() = default;
  constexpr void add(Feature feature) { bits_ |= bitOf(feature); }
  constexpr bool has(Feature feature) const { return (bits_ & bitOf(feature)) != 0; }

 private:
  static constexpr uint64_t bitOf(Feature feature) {
    return uint64_t{1} << static_cast<uint32_t>(feature);
  }
  uint64_t bits_ = 0;
};

}  // namespace mcc

#endif  // MCC_FORMAT_FEATURES_H_
