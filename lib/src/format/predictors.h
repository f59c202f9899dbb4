// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The header byte `predictor` of every method. The table in this file is the only list of its bits:
// which bytes are valid, what the encoder tries (for positions see
// positions/enc_fit.h) and what that costs the decoder, what the core of
// the web's decoder refuses, the words of `inspect`, and what the conformance suite has to show all
// follow from it. [A.2.4, A.6.2]
#ifndef MCC_FORMAT_PREDICTORS_H_
#define MCC_FORMAT_PREDICTORS_H_

#include <bit>
#include <cstdint>

#include "format/decodes.h"
#include "format/features.h"
#include "format/methods.h"

namespace mcc {

/// A bit of `predictor` in every method that codes an attribute by itself, except the position's:
/// consecutive wedges of a vertex may share a value.
inline constexpr uint8_t kHasEqualities = 0x80;

/// A bit of `predictor` for normals and texture coordinates: flags say whether a value is that of a
/// mate.
inline constexpr uint8_t kHasMates = 0x40;

/// The bits of a position select what its coder does. Modes that are off cost the coder
/// nothing. [A.6.2]
namespace position_mode {
inline constexpr uint8_t kWeights = 1u << 0;  ///< weights of features, from the payload
inline constexpr uint8_t kSelect = 1u << 1;   ///< classes of tip selection; needs kWeights
inline constexpr uint8_t kShear = 1u << 2;    ///< excludes palette and planes
inline constexpr uint8_t kPalette = 1u << 3;
inline constexpr uint8_t kPlanes = 1u << 4;  ///< excludes the modes below
inline constexpr uint8_t kFold = 1u << 5;
inline constexpr uint8_t kOwnScale = 1u << 6;
inline constexpr uint8_t kSplit = 1u << 7;
inline constexpr uint8_t kKinds = kShear | kPalette | kPlanes;
inline constexpr uint8_t kWithPlanes = kWeights | kSelect;  ///< modes that planes may have as well
inline constexpr uint8_t kMaxBitsOfPlanes = 17;             ///< most bits of the lattice

/// Whether modes may be set together.
constexpr bool goTogether(uint8_t modes) {
  const uint8_t kinds = modes & kKinds;
  if ((kinds & (kinds - 1)) != 0) return false;
  if ((modes & kSelect) != 0 && (modes & kWeights) == 0) return false;
  return kinds != kPlanes || (modes & ~uint32_t{kPlanes | kWithPlanes}) == 0;
}
}  // namespace position_mode

namespace normal_method {                     // also for exact normals
inline constexpr uint8_t kWeightMask = 0x03;  ///< NormalWeight
inline constexpr uint8_t kBlend = 0x04;  ///< corrects by the errors of the neighbours' predictions
}  // namespace normal_method

namespace exact_normal_method {
inline constexpr uint8_t kRemembers = 0x08;
}  // namespace exact_normal_method

namespace exact_tangent_method {
inline constexpr uint8_t kPerpendicular = 0x01;  ///< perpendicular to the exact normal
}  // namespace exact_tangent_method

namespace tangent_method {                 // both methods of quantised tangents
inline constexpr uint8_t kRepeats = 0x01;  ///< flags for tangents that one seen before is equal to
inline constexpr uint8_t kFaces = 0x02;    ///< of points: they lie in the faces' planes
}  // namespace tangent_method

namespace texcoord_method {
inline constexpr uint8_t kHinge = 0x01;  ///< otherwise the diagonal
inline constexpr uint8_t kRemembers = 0x02;
}  // namespace texcoord_method

namespace value_method {
inline constexpr uint8_t kFlags = 0x01;  ///< flags for values that are 0 or a neighbour's
}  // namespace value_method

namespace skin_weights_method {
inline constexpr uint8_t kSumsMask = 0x03;  ///< SkinSums
}  // namespace skin_weights_method

/// What is known about the sums of WEIGHTS that are coded with their JOINTS, see unitSum().
enum class SkinSums : uint8_t {
  kUnknown = 0,
  kUnit = 1,   ///< every tuple sums to the unit
  kUsual = 2,  ///< most tuples do
};

/// One value of a field.
struct PredictorValue {
  const char* word;      ///< of `inspect`; "" for none
  const char* sections;  ///< sections of the specification that this value alone needs
  uint8_t ns;  ///< nanoseconds per vertex that it takes the decoder, more than value 0 (Zen 4)
};

/// A field of the byte `predictor`.
struct PredictorField {
  uint8_t mask;
  uint8_t value_count;  ///< 0 .. value_count - 1 are valid
  Feature feature;      ///< without it, the encoder does not try other values than the first
  PredictorValue value[3];
  bool is_decoded = true;  ///< otherwise this decoder knows value 0 only
  uint8_t since = 0;       ///< minor version of the format that added the field

  constexpr uint8_t shift() const { return static_cast<uint8_t>(std::countr_zero(mask)); }
  constexpr uint8_t valueOf(uint8_t predictor) const {
    return static_cast<uint8_t>((predictor & mask) >> shift());
  }
  constexpr uint8_t with(uint8_t predictor, uint32_t number) const {
    return static_cast<uint8_t>((predictor & ~mask) | (number << shift()));
  }
};

struct MethodInfo {
  AttributeMethod method;
  const char* name;      ///< in the conformance suite
  const char* word;      ///< of `inspect`, for what all bytes of the method have in common
  const char* sections;  ///< sections of the specification
  uint8_t start;         ///< the byte that the encoder tries first
  uint8_t field_count;
  PredictorField field[8];  ///< in the order of the encoder's search, but for positions
  bool is_decoded = true;   ///< otherwise this decoder refuses the method

  constexpr const PredictorField* begin() const { return field; }
  constexpr const PredictorField* end() const { return field + field_count; }
};

namespace detail {

inline constexpr PredictorField kEqualities = {
    kHasEqualities, 2, Feature::kEqualities, {{"", "", 0}, {"equalities", "A.10.3", 0}}};
inline constexpr PredictorField kNormalWeight = {
    normal_method::kWeightMask,
    3,
    Feature::kNormalWeights,
    {{"area", "", 0}, {"angle", "A.10.7", 0}, {"sine", "", 0}}};
inline constexpr PredictorField kNormalBlend = {
    normal_method::kBlend, 2, Feature::kNormalBlend, {{"", "", 0}, {"blend", "", 0}}};

/// It comes after the equalities, which spare much of what repeats, too: chosen first, it would
/// hide what they gain.
inline constexpr PredictorField kTangentRepeats = {tangent_method::kRepeats,
                                                   2,
                                                   Feature::kTangentRepeats,
                                                   {{"", "", 0}, {"repeats", "A.10.19", 5}},
                                                   true,
                                                   1};

/// It is the last, so that what it gains is over the best of all other fields.
inline constexpr PredictorField kMates = {
    kHasMates, 2, Feature::kMates, {{"", "", 0}, {"mates", "A.10.20", 5}}, true, 1};

/// A mode of positions.
constexpr PredictorField modeField(uint8_t mask, Feature feature, const char* word,
                                   const char* sections, uint8_t ns, bool is_decoded = true) {
  return {mask, 2, feature, {{"", "", 0}, {word, sections, ns}}, is_decoded};
}

}  // namespace detail

/// The methods, in the order of AttributeMethod.
inline constexpr MethodInfo kMethods[] = {
    {AttributeMethod::kPosition,
     "positions",
     "",
     "A.6 A.6.1 A.6.2 A.6.3 A.1.2 A.1.5 A.3.6 A.6.4 A.6.5 A.6.6 A.6.7 A.6.8 A.3.3",
     0,
     8,
     {detail::modeField(position_mode::kWeights, Feature::kWeights, "weights", "", 5),
      detail::modeField(position_mode::kSelect, Feature::kTipSelection, "tip selection", "", 10),
      detail::modeField(position_mode::kShear, Feature::kShear, "shear", "A.6.10", 14,
                        decodes::kShear),
      detail::modeField(position_mode::kPalette, Feature::kPalette, "palette", "A.6.11", 40),
      detail::modeField(position_mode::kPlanes, Feature::kPlanes, "planes", "A.6.12", 45,
                        decodes::kPlanes),
      detail::modeField(position_mode::kFold, Feature::kFold, "fold", "", 6),
      detail::modeField(position_mode::kOwnScale, Feature::kOwnScale, "own scale", "", 0),
      detail::modeField(position_mode::kSplit, Feature::kSplit, "split", "", 1)}},
    {AttributeMethod::kValues,
     "values",
     "diagonal",
     "A.10.4 A.10.1 A.10.2",
     kHasEqualities,
     2,
     {{value_method::kFlags, 2, Feature::kValueFlags, {{"", "", 0}, {"flags", "", 0}}},
      detail::kEqualities}},
    {AttributeMethod::kNormal,
     "normal",
     "",
     "A.10.8 A.10.1 A.10.2 A.10.6 A.10.7 A.6.13",
     kHasEqualities | 1,
     4,
     {detail::kNormalWeight, detail::kNormalBlend, detail::kEqualities, detail::kMates}},
    {AttributeMethod::kTexcoord,
     "texture coordinate",
     "",
     "A.10.11 A.10.1 A.10.2",
     kHasEqualities,
     4,
     {{texcoord_method::kHinge,
       2,
       Feature::kTexcoordHinge,
       {{"diagonal", "A.10.11", 0}, {"hinge", "A.10.11", 0}}},
      {texcoord_method::kRemembers,
       2,
       Feature::kMemory,
       {{"", "", 0}, {"remembers", "A.10.10", 25}}},
      detail::kEqualities,
      detail::kMates}},
    {AttributeMethod::kTangent,
     "tangent angle",
     "chart",
     "A.10.13 A.10.12 A.10.7",
     kHasEqualities,
     2,
     {detail::kEqualities, detail::kTangentRepeats},
     decodes::kTangents},
    {AttributeMethod::kTangentPoint,
     "tangent point",
     "chart",
     "A.10.13 A.10.12 A.10.6",
     kHasEqualities,
     3,
     {detail::kEqualities,
      detail::kTangentRepeats,
      {tangent_method::kFaces,
       2,
       Feature::kTangentFaces,
       {{"", "", 0}, {"faces", "A.10.19", 5}},
       true,
       1}},
     decodes::kTangents},
    {AttributeMethod::kSkin,
     "skin",
     "skin",
     "A.10.14 A.10.1 A.10.2",
     kHasEqualities,
     1,
     {detail::kEqualities}},
    {AttributeMethod::kExactNormal,
     "exact normal",
     "",
     "A.10.16 A.10.9 A.10.15",
     kHasEqualities | 1,
     4,
     {detail::kNormalWeight,
      {exact_normal_method::kRemembers,
       2,
       Feature::kMemory,
       {{"", "", 0}, {"remembers", "A.10.10", 0}}},
      detail::kNormalBlend,
      detail::kEqualities},
     decodes::kExactFloats},
    {AttributeMethod::kExactTangent,
     "exact tangent",
     "chart",
     "A.10.17 A.10.9 A.10.15 A.10.12",
     kHasEqualities,
     2,
     {{exact_tangent_method::kPerpendicular,
       2,
       Feature::kPerpendicular,
       {{"", "", 0}, {"perpendicular", "", 0}}},
      detail::kEqualities},
     decodes::kExactFloats},
    {AttributeMethod::kSkinWeights,
     "skin weights",
     "with joints",
     "A.10.14",
     0,
     1,
     {{skin_weights_method::kSumsMask,
       3,
       Feature::kSkin,
       {{"", "", 0}, {"unit sum", "", 0}, {"usual sum", "", 0}}}}},
    {AttributeMethod::kAlias, "alias", "", "", 0, 0, {}},
};
static_assert(std::size(kMethods) == kAttributeMethods);

constexpr const MethodInfo& infoOf(AttributeMethod method) {
  return kMethods[static_cast<size_t>(method)];
}

constexpr bool isValidPredictor(AttributeMethod method, uint8_t predictor) {
  uint32_t rest = predictor;
  for (const PredictorField& field : infoOf(method)) {
    if (field.valueOf(predictor) >= field.value_count) return false;
    rest &= ~uint32_t{field.mask};
  }
  return rest == 0 &&
         (method != AttributeMethod::kPosition || position_mode::goTogether(predictor));
}

constexpr bool asksMates(AttributeMethod method, uint8_t predictor) {
  for (const PredictorField& field : infoOf(method)) {
    if (field.feature == Feature::kMates) return field.valueOf(predictor) != 0;
  }
  return false;
}

/// The minor version of the format that has everything a byte asks for.
constexpr uint8_t minorVersionOf(AttributeMethod method, uint8_t predictor) {
  uint8_t version = 0;
  for (const PredictorField& field : infoOf(method)) {
    if (field.valueOf(predictor) != 0 && field.since > version) version = field.since;
  }
  return version;
}

/// The bits of a method's byte that this decoder knows.
constexpr uint8_t decodedBits(AttributeMethod method) {
  uint32_t bits = 0;
  for (const PredictorField& field : infoOf(method)) bits |= field.is_decoded ? field.mask : 0u;
  return static_cast<uint8_t>(bits);
}

inline constexpr uint8_t kDecodedPositionModes = decodedBits(AttributeMethod::kPosition);

/// The time that a byte takes the decoder, in nanoseconds per vertex, more than the fastest byte of
/// its method takes. Measured in a release build with gcc 12 on a Zen 4, and rounded: it ranks the
/// choices, on any machine.
constexpr double timeOf(AttributeMethod method, uint8_t predictor) {
  double ns = 0;
  for (const PredictorField& field : infoOf(method)) ns += field.value[field.valueOf(predictor)].ns;
  return ns;
}

/// What the header of a payload is checked against: the table above without its words.
struct PredictorRules {
  uint8_t valid[kAttributeMethods][32] = {};  ///< a bit for each byte
  bool is_decoded[kAttributeMethods] = {};
  uint8_t decoded_bits[kAttributeMethods] = {};

  constexpr PredictorRules() {
    for (uint32_t m = 0; m < kAttributeMethods; ++m) {
      const AttributeMethod method = kMethods[m].method;
      is_decoded[m] = kMethods[m].is_decoded;
      decoded_bits[m] = decodedBits(method);
      for (uint32_t p = 0; p < 256; ++p) {
        const bool is_valid = isValidPredictor(method, static_cast<uint8_t>(p));
        valid[m][p / 8] = static_cast<uint8_t>(valid[m][p / 8] | (is_valid ? 1u << p % 8 : 0u));
      }
    }
  }
};
inline constexpr PredictorRules kPredictorRules;

/// Whether the byte `predictor` of an attribute is valid for its method.
constexpr bool isKnownPredictor(AttributeMethod method, uint8_t predictor) {
  const uint8_t* const valid = kPredictorRules.valid[static_cast<size_t>(method)];
  return (valid[predictor / 8] >> predictor % 8 & 1) != 0;
}

/// Whether this decoder, which may be the core alone, has what an attribute needs.
constexpr bool isDecoded(AttributeMethod method, uint8_t predictor) {
  if (kWhole) return true;
  const size_t m = static_cast<size_t>(method);
  return kPredictorRules.is_decoded[m] && (predictor & ~kPredictorRules.decoded_bits[m]) == 0;
}

}  // namespace mcc

#endif  // MCC_FORMAT_PREDICTORS_H_
