// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress/integer_accessors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gltf/document/accessors.h"
#include "values/enc_extent.h"

namespace mcc::gltf {
namespace {

/// Much larger than the rounding of a unit vector's component, and much smaller than any step.
constexpr double kSlack = 1e-6;

struct IntegerType {
  ComponentType type;
  double last;  ///< the integer that stands for 1
};
constexpr IntegerType kSigned[] = {{ComponentType::kInt8, 127}, {ComponentType::kInt16, 32767}};
constexpr IntegerType kUnsigned[] = {{ComponentType::kUint8, 255}, {ComponentType::kUint16, 65535}};

bool isUnitVector(const AttributeFormat& format) {
  return format.semantic == Semantic::kNormal || format.semantic == Semantic::kTangent;
}

/// Returns the distance of neighbouring values of the coded grid.
double codedStep(const AttributeInfo& info) {
  const auto points = static_cast<double>(uint64_t{1} << info.bits);
  switch (info.coding) {
    case AttributeCoding::kOctahedral: return 2 / (points - 2);
    case AttributeCoding::kTangentAngle: return 2 * std::numbers::pi / points;
    default: return double{info.lattice.step};
  }
}

/// Returns the smallest type whose steps are not coarser than the coded ones; null if there is
/// none.
const IntegerType* typeFor(const AttributeInfo& info) {
  for (const IntegerType& type : isUnitVector(info.format) ? kSigned : kUnsigned) {
    if (1 / type.last <= codedStep(info) * (1 + kSlack)) return &type;
  }
  return nullptr;
}

/// Returns why an attribute stays float; empty when it can become integer.
std::string obstacle(const AttributeInfo& info, uint32_t accessor,
                     const IntegerAccessors& accessors) {
  if (typeFor(info) == nullptr) return "has finer steps than 16 bits can hold";
  const double low = isUnitVector(info.format) ? -1 : 0;
  const uint64_t count = accessors.count(accessor) * info.format.component_count;
  for (uint64_t i = 0; i < count; ++i) {
    const double value = accessors.value(accessor, i);
    if (value < low - kSlack || value > 1 + kSlack) {
      return std::string("has values outside ") + (low == 0 ? "0 to 1" : "-1 to 1");
    }
  }
  return "";
}

void storeNormalized(const AttributeInfo& info, uint32_t accessor, IntegerAccessors& accessors) {
  const IntegerType& type = *typeFor(info);
  std::vector<int32_t> values(accessors.count(accessor) * info.format.component_count);
  for (uint64_t i = 0; i < values.size(); ++i) {
    const double value = std::clamp(accessors.value(accessor, i), -1.0, 1.0);
    values[i] = static_cast<int32_t>(std::floor(value * type.last + 0.5));
  }
  accessors.replace(accessor, type.type, true, values);
}

/// Stores the WEIGHTS of one primitive. Tuples that add up to one still do so.
void storeWeights(const std::vector<uint32_t>& sets, const IntegerType& type,
                  IntegerAccessors& accessors) {
  const uint64_t count = accessors.count(sets[0]);
  std::vector<std::vector<int32_t>> values(sets.size());
  std::vector<double> points(4 * sets.size());
  for (uint64_t vertex = 0; vertex < count; ++vertex) {
    for (size_t i = 0; i < points.size(); ++i) {
      points[i] = accessors.value(sets[i / 4], vertex * 4 + i % 4) * type.last;
    }
    roundTogether(points, type.last);
    for (size_t i = 0; i < points.size(); ++i) {
      values[i / 4].push_back(static_cast<int32_t>(std::clamp(points[i], 0.0, type.last)));
    }
  }
  for (size_t k = 0; k < sets.size(); ++k) accessors.replace(sets[k], type.type, true, values[k]);
}

/// Returns the accessors of WEIGHTS_n of every primitive that has some.
std::set<std::vector<uint32_t>> weightSets(const Json& meshes) {
  std::set<std::vector<uint32_t>> all;
  for (const Json& mesh : meshes) {
    for (const Json& primitive : arrayOf(mesh, "primitives")) {
      const Json* map = findMember(primitive, "attributes");
      if (map == nullptr) continue;
      std::vector<uint32_t> sets;
      for (const auto& [name, value] : map->items()) {
        uint64_t accessor = 0;
        const bool is_set = name.starts_with("WEIGHTS_") && asUnsigned(value, accessor);
        if (is_set) sets.push_back(static_cast<uint32_t>(accessor));
      }
      if (!sets.empty()) all.insert(std::move(sets));
    }
  }
  return all;
}

/// Stores the weights of a primitive when all of its sets can become integers.
void storeWeightsOf(const std::vector<uint32_t>& sets, IntegerAccessors& accessors,
                    std::vector<std::string>& notes) {
  const IntegerType* type = &kUnsigned[0];
  for (const uint32_t set : sets) {
    const AttributeInfo* info = accessors.coding(set);
    if (info == nullptr) return;
    const std::string reason = obstacle(*info, set, accessors);
    if (!reason.empty()) {
      notes.push_back(accessors.label(set) + " " + reason + "; it stays float");
      return;
    }
    if (typeFor(*info)->last > type->last) type = typeFor(*info);
  }
  storeWeights(sets, *type, accessors);
}

}  // namespace

IntegerAccessors::IntegerAccessors(const Document& source, const CodedAttributes& coded, Json& json,
                                   std::vector<NewView>& views)
    : source_(source), coded_(coded), json_(json["accessors"]), views_(views) {
  for (const Json& mesh : arrayOf(json, "meshes")) {
    for (const Json& primitive : arrayOf(mesh, "primitives")) {
      if (const Json* map = findMember(primitive, "attributes")) noteUser(*map, false);
      for (const Json& target : arrayOf(primitive, "targets")) noteUser(target, true);
    }
  }
}

void IntegerAccessors::noteUser(const Json& map, bool is_target) {
  if (!map.is_object()) return;
  for (const auto& [name, value] : map.items()) {
    uint64_t accessor = 0;
    if (!asUnsigned(value, accessor) || accessor >= source_.accessors.size()) continue;
    meanings_[static_cast<uint32_t>(accessor)].insert((is_target ? "target " : "") + name);
  }
}

const AttributeInfo* IntegerAccessors::coding(uint32_t accessor) const {
  const auto found = coded_.find(accessor);
  if (found == coded_.end()) return nullptr;
  const Accessor& source = source_.accessors[accessor];
  if (source.isUsedOutsideMeshes() || source.extension_uses != 0) return nullptr;
  switch (found->second.coding) {
    case AttributeCoding::kLattice:
    case AttributeCoding::kOctahedral:
    case AttributeCoding::kTangentAngle: break;
    default: return nullptr;
  }
  const bool is_free = replaced_.count(accessor) == 0 && meanings_.at(accessor).size() == 1;
  return is_free ? &found->second : nullptr;
}

std::string IntegerAccessors::label(uint32_t accessor) const {
  return at("/accessors", accessor) + ": " + *meanings_.at(accessor).begin();
}

double IntegerAccessors::value(uint32_t accessor, uint64_t index) const {
  const uint64_t view = json_[accessor]["bufferView"].get<uint64_t>();
  return componentValue(views_[view - kFirstNewView].bytes + 4 * index, ComponentType::kFloat32);
}

void IntegerAccessors::replace(uint32_t index, ComponentType type, bool normalized,
                               const std::vector<int32_t>& values) {
  static constexpr int kGlTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
  replaced_.insert(index);
  Accessor accessor = source_.accessors[index];
  accessor.component_type = type;
  const uint32_t bytes = componentBytes(type);
  const uint32_t components = accessor.componentCount();
  std::vector<uint8_t> tight;
  std::vector<int32_t> low(components, std::numeric_limits<int32_t>::max());
  std::vector<int32_t> high(components, std::numeric_limits<int32_t>::min());
  for (size_t i = 0; i < values.size(); ++i) {
    for (uint32_t b = 0; b < bytes; ++b) tight.push_back(static_cast<uint8_t>(values[i] >> 8 * b));
    low[i % components] = std::min(low[i % components], values[i]);
    high[i % components] = std::max(high[i % components], values[i]);
  }
  Json& json = json_[index];
  NewView& view = views_[json["bufferView"].get<uint64_t>() - kFirstNewView];
  view.hold(packAttribute(tight, accessor, view.stride_bytes));
  json["componentType"] = kGlTypes[static_cast<size_t>(type)];
  json.erase("normalized");
  if (normalized) json["normalized"] = true;
  if (findMember(json, "min") != nullptr) json["min"] = low;
  if (findMember(json, "max") != nullptr) json["max"] = high;
}

bool storeIntegerValues(const CodedAttributes& coded, const Json& meshes,
                        IntegerAccessors& accessors, std::vector<std::string>& notes) {
  bool needs_extension = false;
  for (const auto& [accessor, info] : coded) {
    const Semantic semantic = info.format.semantic;
    const bool is_other = semantic == Semantic::kPosition || semantic == Semantic::kWeights;
    if (is_other || accessors.coding(accessor) == nullptr) continue;
    const bool is_delta = info.format.morph_target != 0 && !isUnitVector(info.format);
    const std::string reason = is_delta ? "is a difference" : obstacle(info, accessor, accessors);
    if (reason.empty()) {
      storeNormalized(info, accessor, accessors);
      needs_extension |= isUnitVector(info.format);
    } else {
      notes.push_back(accessors.label(accessor) + " " + reason + "; it stays float");
    }
  }
  for (const std::vector<uint32_t>& sets : weightSets(meshes)) {
    storeWeightsOf(sets, accessors, notes);
  }
  return needs_extension;
}

}  // namespace mcc::gltf
