// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "support/document_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "support/gltf_builder.h"
#include "support/triangles.h"

namespace mcc::gltf::test {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

void require(bool is_so, const std::string& what) {
  if (!is_so) fail(what);
}

// ---- JSON --------------------------------------------------------------------------------------

using Skip = std::function<bool(const std::string& path)>;

void compareJson(const Json& a, const Json& b, const std::string& path, const Skip& skip) {
  if (skip(path)) return;
  require(a.kind() == b.kind(), path + ": another type");
  if (a.is_array()) {
    require(a.size() == b.size(), path + ": another length");
    for (size_t i = 0; i < a.size(); ++i)
      compareJson(a[i], b[i], path + "/" + std::to_string(i), skip);
  } else if (a.is_object()) {
    // Compare members in their order, with repeated ones.
    const auto kept = [&](const Json& object) {
      std::vector<size_t> members;
      for (size_t i = 0; i < object.size(); ++i) {
        if (!skip(path + "/" + object.keyAt(i))) members.push_back(i);
      }
      return members;
    };
    const auto of_a = kept(a);
    const auto of_b = kept(b);
    for (size_t i = 0; i < std::min(of_a.size(), of_b.size()); ++i) {
      const std::string& key = a.keyAt(of_a[i]);
      const std::string& other = b.keyAt(of_b[i]);
      require(key == other, path + ": \"" + key + "\" became \"" + other + "\"");
      compareJson(a[of_a[i]], b[of_b[i]], path + "/" + key, skip);
    }
    require(of_a.size() == of_b.size(), path + ": another number of members");
  } else {
    require(a == b, path + ": " + a.dump() + " became " + b.dump());
  }
}

// ---- Values ------------------------------------------------------------------------------------

struct Box {
  double low[16];
  double high[16];
  uint32_t component_count = 0;
  bool is_finite = true;

  void add(const Elements& elements) {
    if (component_count == 0) {
      component_count = elements.component_count;
      std::fill_n(low, 16, std::numeric_limits<double>::infinity());
      std::fill_n(high, 16, -std::numeric_limits<double>::infinity());
    }
    for (size_t i = 0; i < elements.values.size(); ++i) {
      for (size_t c = 0; c < component_count; ++c)
        is_finite &= std::isfinite(component(elements, i, c));
    }
    if (!is_finite) return;
    for (size_t i = 0; i < elements.values.size(); ++i) {
      for (size_t c = 0; c < component_count; ++c) {
        low[c] = std::min(low[c], component(elements, i, c));
        high[c] = std::max(high[c], component(elements, i, c));
      }
    }
  }
  double side() const {
    double side = 0;
    for (uint32_t c = 0; c < component_count; ++c) side = std::max(side, high[c] - low[c]);
    return side;
  }
  double largest() const {
    double largest = 0;
    for (uint32_t c = 0; c < component_count; ++c)
      largest = std::max({largest, std::abs(low[c]), std::abs(high[c])});
    return largest;
  }
};

double stepsOf(int bits) { return std::ldexp(1.0, bits) - 1; }

/// How far a value may be from its source.
struct Bound {
  bool is_exact = true;
  double value = 0;     ///< deviation of a component
  double radians = 0;   ///< angle of a unit vector that is off by more than `value`; 0: not allowed
  double distance = 0;  ///< distance of a position; 0: not bounded
};

/// An attribute of a primitive, in the source and decoded.
struct Attribute {
  std::string name;
  int target = -1;
  Elements source;
  Elements decoded;
  Bound bound;

  std::string label() const {
    return target < 0 ? name : "target " + std::to_string(target) + " " + name;
  }
};

bool isNamed(const std::string& name, const char* prefix) {
  const std::string start = std::string(prefix) + "_";
  return name.starts_with(start) && name.size() > start.size() &&
         std::all_of(name.begin() + static_cast<ptrdiff_t>(start.size()), name.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

bool isWithin(const Attribute& attribute, size_t s, size_t d) {
  const Elements& source = attribute.source;
  const Elements& decoded = attribute.decoded;
  const Bound& bound = attribute.bound;
  if (bound.is_exact) return source.values[s] == decoded.values[d];
  double square = 0;
  bool is_near = true;
  for (uint32_t c = 0; c < source.component_count; ++c) {
    const double a = component(source, s, c);
    const double b = component(decoded, d, c);
    if (!std::isfinite(a) || !std::isfinite(b)) {
      if (source.values[s] != decoded.values[d]) return false;
      continue;
    }
    const double off = std::abs(a - b);
    // Allow for the roundings of decoding to float32.
    is_near &= off <= bound.value * (1 + 1e-6) + std::ldexp(std::abs(a) + std::abs(b), -23);
    square += off * off;
  }
  if (is_near && bound.distance != 0) is_near = std::sqrt(square) <= bound.distance * (1 + 1e-9);
  if (is_near || bound.radians == 0) return is_near;
  std::array<double, 3> a, b;
  for (uint32_t c = 0; c < 3; ++c) a[c] = component(source, s, c), b[c] = component(decoded, d, c);
  const bool has_sign =
      source.component_count < 4 || (component(source, s, 3) < 0) == (component(decoded, d, 3) < 0);
  return has_sign && mcc::test::angleBetween(a, b) <= bound.radians;
}

// ---- Primitives --------------------------------------------------------------------------------

std::vector<uint32_t> cornersOf(const PlainDocument& document, const Json& primitive,
                                size_t vertex_count) {
  std::vector<uint32_t> vertices;
  if (const Json& indices = memberOf(primitive, "indices"); !indices.is_null()) {
    const std::vector<double> numbers = document.numbers(numberOf(indices));
    vertices.assign(numbers.begin(), numbers.end());
  } else {
    vertices.resize(vertex_count);
    std::iota(vertices.begin(), vertices.end(), 0u);
  }
  for (const uint32_t vertex : vertices) require(vertex < vertex_count, "an index is out of range");
  const uint64_t mode = numberOf(primitive, "mode", 4);
  if (mode <= 4) return vertices;
  std::vector<uint32_t> triangles;
  for (size_t i = 0; i + 2 < vertices.size(); ++i) {
    if (mode == 5) {  // 3.7.2.1: p_i = {v_i, v_(i + 1 + i % 2), v_(i + 2 - i % 2)}
      triangles.insert(triangles.end(),
                       {vertices[i], vertices[i + 1 + i % 2], vertices[i + 2 - i % 2]});
    } else {  // p_i = {v_(i + 1), v_(i + 2), v_0}
      triangles.insert(triangles.end(), {vertices[i + 1], vertices[i + 2], vertices[0]});
    }
  }
  return triangles;
}

class Sets {
 public:
  explicit Sets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<uint32_t> parent_;
};

std::string describe(const Attribute& attribute, size_t s, size_t d) {
  std::string text = attribute.label() + " (source, decoded:";
  for (uint32_t c = 0; c < attribute.source.component_count; ++c) {
    char pair[80];
    std::snprintf(pair, sizeof pair, " %.9g %.9g,", component(attribute.source, s, c),
                  component(attribute.decoded, d, c));
    text += pair;
  }
  const Bound& bound = attribute.bound;
  char bounds[120];
  std::snprintf(bounds, sizeof bounds, " %s; bound %g, %g radians, %g)",
                bound.is_exact ? "exact" : "lossy", bound.value, bound.radians, bound.distance);
  return text + bounds;
}

/// For readers of a failure: the attributes of a decoded vertex that no source vertex has, or all
/// that some vertex has.
std::string whyNone(const std::vector<Attribute>& attributes, size_t d) {
  for (const Attribute& attribute : attributes) {
    size_t s = 0;
    while (s < attribute.source.values.size() && !isWithin(attribute, s, d)) ++s;
    if (s == attribute.source.values.size()) return "none has its " + describe(attribute, d, d);
  }
  // Find the source vertex that differs in the fewest attributes.
  size_t best = 0;
  size_t fewest = attributes.size();
  for (size_t s = 0; s < attributes[0].source.values.size(); ++s) {
    const auto others = static_cast<size_t>(
        std::count_if(attributes.begin(), attributes.end(),
                      [&](const Attribute& attribute) { return !isWithin(attribute, s, d); }));
    if (others < fewest) fewest = others, best = s;
  }
  for (const Attribute& attribute : attributes) {
    if (!isWithin(attribute, best, d))
      return "nearest is vertex " + std::to_string(best) + ", but for " +
             describe(attribute, best, d);
  }
  return "one has them all, but is not found by its exact ones";
}

/// Puts source vertices that one decoded vertex may stand for into one class. If all vertices are
/// distinct, each is its own class and the comparison is exact. A difference that is found is a
/// real one in any case.
void compareVertices(const std::vector<Attribute>& attributes, bool keeps_order,
                     std::vector<uint32_t>& class_of_source,
                     std::vector<uint32_t>& class_of_decoded) {
  const size_t count = attributes[0].source.values.size();
  class_of_source.resize(count);
  class_of_decoded.resize(count);
  if (keeps_order) {
    for (size_t i = 0; i < count; ++i) {
      class_of_source[i] = class_of_decoded[i] = static_cast<uint32_t>(i);
      for (const Attribute& attribute : attributes) {
        if (!isWithin(attribute, i, i))
          fail("vertex " + std::to_string(i) + ": " + describe(attribute, i, i));
      }
    }
    return;
  }
  std::unordered_map<std::string, std::vector<uint32_t>> by_exact;
  std::string key;
  const auto keyOf = [&](size_t i, bool is_decoded) -> const std::string& {
    key.clear();
    for (const Attribute& attribute : attributes) {
      if (attribute.bound.is_exact)
        key += (is_decoded ? attribute.decoded : attribute.source).values[i];
    }
    return key;
  };
  for (size_t i = 0; i < count; ++i) by_exact[keyOf(i, false)].push_back(static_cast<uint32_t>(i));
  Sets sets(count);
  std::vector<uint32_t> first_of(count);
  for (size_t d = 0; d < count; ++d) {
    uint32_t first = kNone;
    const auto found = by_exact.find(keyOf(d, true));
    if (found != by_exact.end()) {
      for (const uint32_t s : found->second) {
        const bool is_near =
            std::all_of(attributes.begin(), attributes.end(), [&](const Attribute& attribute) {
              return attribute.bound.is_exact || isWithin(attribute, s, d);
            });
        if (!is_near) continue;
        if (first == kNone) first = s;
        sets.join(s, first);
      }
    }
    if (first == kNone)
      fail("decoded vertex " + std::to_string(d) +
           " is none of the source: " + whyNone(attributes, d));
    first_of[d] = first;
  }
  std::vector<int64_t> excess(count, 0);
  for (uint32_t i = 0; i < count; ++i) {
    class_of_source[i] = sets.find(i);
    class_of_decoded[i] = sets.find(first_of[i]);
    ++excess[class_of_source[i]];
    --excess[class_of_decoded[i]];
  }
  for (const int64_t balance : excess)
    require(balance == 0, "a vertex is there more often or less often");
}

/// A primitive and the document that it is in.
struct PlacedPrimitive {
  const PlainDocument& document;
  const Json& json;
};

std::vector<Attribute> attributesOf(const PlacedPrimitive& source, const PlacedPrimitive& decoded) {
  std::vector<Attribute> attributes;
  const auto addMap = [&](const Json& a, const Json& b, int target) {
    require(a.size() == b.size(), "another number of attributes");
    for (const auto& [name, number] : a.items()) {
      Attribute attribute;
      attribute.name = name;
      attribute.target = target;
      const Json& other = memberOf(b, name.c_str());
      require(!other.is_null(), attribute.label() + " is missing");
      attribute.source = source.document.elements(numberOf(number));
      attribute.decoded = decoded.document.elements(numberOf(other));
      require(attribute.source.sameFormat(attribute.decoded),
              attribute.label() + " has another type");
      require(attribute.source.values.size() == attribute.decoded.values.size(),
              attribute.label() + " has another count");
      attributes.push_back(std::move(attribute));
    }
  };
  addMap(memberOf(source.json, "attributes"), memberOf(decoded.json, "attributes"), -1);
  const Json& targets = memberOf(source.json, "targets");
  const Json& decoded_targets = memberOf(decoded.json, "targets");
  require(targets.size() == decoded_targets.size(), "another number of targets");
  for (size_t i = 0; i < targets.size(); ++i)
    addMap(targets[i], decoded_targets[i], static_cast<int>(i));
  require(!attributes.empty(), "has no attributes");
  return attributes;
}

/// Compares triangles over vertices that are equal within the attributes' bounds.
void compareTriangles(const PlacedPrimitive& source, const PlacedPrimitive& decoded,
                      const std::vector<Attribute>& attributes, bool keeps_vertices,
                      bool keeps_triangles) {
  std::vector<uint32_t> class_of_source, class_of_decoded;
  compareVertices(attributes, keeps_vertices, class_of_source, class_of_decoded);
  const size_t count = attributes[0].source.values.size();
  const auto listOf = [&](const PlacedPrimitive& primitive, const std::vector<uint32_t>& class_of) {
    return mcc::test::trianglesOf(cornersOf(primitive.document, primitive.json, count),
                                  [&](uint32_t vertex) { return class_of[vertex]; });
  };
  const auto triangles = listOf(source, class_of_source);
  const auto decoded_triangles = listOf(decoded, class_of_decoded);
  require(triangles.size() == decoded_triangles.size(), "another number of triangles");
  if (keeps_triangles)
    require(triangles == decoded_triangles, "the order of triangles differs");
  else
    require(mcc::test::sorted(triangles) == mcc::test::sorted(decoded_triangles),
            "the triangles differ");
}

/// The same where nothing may differ. Points and lines are in their order in any case.
void comparePrimitives(const PlacedPrimitive& source, const PlacedPrimitive& decoded,
                       bool keeps_order) {
  const std::vector<Attribute> attributes = attributesOf(source, decoded);
  const bool has_triangles = numberOf(source.json, "mode", 4) >= 4;
  if (!has_triangles) {
    const size_t count = attributes[0].source.values.size();
    require(cornersOf(source.document, source.json, count) ==
                cornersOf(decoded.document, decoded.json, count),
            "the indices differ");
  }
  compareTriangles(source, decoded, attributes, keeps_order || !has_triangles,
                   keeps_order || !has_triangles);
}

// ---- Documents ---------------------------------------------------------------------------------

class Comparison {
 public:
  Comparison(const PlainDocument& source, const PlainDocument& converted,
             const PlainDocument& decoded, const ConvertOptions& options, const KeptNumbers& kept,
             const ConvertReport& report)
      : source_(source),
        converted_(converted),
        decoded_(decoded),
        options_(options),
        kept_(kept),
        report_(report) {}

  void run() {
    findUses();
    compareDocument();
    const Json& meshes = memberOf(source_.json, "meshes");
    for (size_t mesh = 0; mesh < meshes.size(); ++mesh) {
      for (size_t i = 0; i < memberOf(meshes[mesh], "primitives").size(); ++i) {
        if (isCompressed(mesh, i)) comparePrimitive(mesh, i);
      }
    }
    compareRest();
  }

 private:
  const Json& primitiveOf(const PlainDocument& document, size_t mesh, size_t i) const {
    return memberOf(document.json, "meshes")[mesh]["primitives"][i];
  }

  bool isCompressed(size_t mesh, size_t i) const {
    return !memberOf(memberOf(primitiveOf(converted_, mesh, i), "extensions"), kExtensionName)
                .is_null();
  }

  static std::vector<uint64_t> accessorsOf(const Json& primitive) {
    std::vector<uint64_t> accessors;
    for (const auto& [name, number] : memberOf(primitive, "attributes").items())
      accessors.push_back(numberOf(number));
    for (const Json& target : memberOf(primitive, "targets")) {
      for (const auto& [name, number] : target.items()) accessors.push_back(numberOf(number));
    }
    if (const Json& indices = memberOf(primitive, "indices"); !indices.is_null())
      accessors.push_back(numberOf(indices));
    return accessors;
  }

  /// Accessors that nothing but compressed primitives uses may change.
  void findUses() {
    const Json& meshes = memberOf(source_.json, "meshes");
    std::set<uint64_t> others(kept_.accessors.begin(), kept_.accessors.end());
    for (size_t mesh = 0; mesh < meshes.size(); ++mesh) {
      for (size_t i = 0; i < memberOf(meshes[mesh], "primitives").size(); ++i) {
        const auto accessors = accessorsOf(primitiveOf(source_, mesh, i));
        (isCompressed(mesh, i) ? compressed_ : others).insert(accessors.begin(), accessors.end());
      }
    }
    for (const Json& skin : memberOf(source_.json, "skins"))
      others.insert(numberOf(skin, "inverseBindMatrices", kNone));
    for (const Json& animation : memberOf(source_.json, "animations")) {
      for (const Json& sampler : memberOf(animation, "samplers")) {
        others.insert({numberOf(sampler, "input", kNone), numberOf(sampler, "output", kNone)});
      }
    }
    for (const Json& node : memberOf(source_.json, "nodes")) {
      for (const Json& number : memberOf(
               memberOf(memberOf(node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes")) {
        others.insert(numberOf(number));
      }
    }
    for (const uint64_t other : others) compressed_.erase(other);
  }

  void compareDocument() {
    Json source = source_.json;
    Json decoded = decoded_.json;
    for (Json* json : {&source, &decoded}) {
      for (const char* key : {"extensionsUsed", "extensionsRequired", "buffers", "bufferViews"})
        json->erase(key);
    }
    const size_t accessor_count = memberOf(source, "accessors").size();
    if (decoded.contains("accessors")) {
      Json kept = Json::array();
      for (size_t i = 0; i < std::min(accessor_count, decoded["accessors"].size()); ++i)
        kept.push_back(decoded["accessors"][i]);
      decoded["accessors"] = kept;
      if (kept.empty() && !source.contains("accessors")) decoded.erase("accessors");
    }
    dropEmptyExtensions(source);
    dropEmptyExtensions(decoded);
    compareJson(source, decoded, "", [&](const std::string& path) { return mayDiffer(path); });
    const auto namesOf = [](const PlainDocument& document, const char* list) {
      std::multiset<std::string> names;
      for (const Json& name : memberOf(document.json, list)) {
        if (name != "EXT_meshopt_compression" && name != "KHR_draco_mesh_compression" &&
            name != kExtensionName) {
          names.insert(name.get<std::string>());
        }
      }
      return names;
    };
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      require(namesOf(source_, list) == namesOf(decoded_, list),
              std::string("/") + list + " differs");
    }
  }

  /// Draco's extension is removed where the primitive is compressed, and an object of extensions
  /// that becomes empty is removed, too.
  void dropEmptyExtensions(Json& json) {
    if (!json.contains("meshes")) return;
    for (size_t mesh = 0; mesh < json["meshes"].size(); ++mesh) {
      for (size_t i = 0; i < json["meshes"][mesh]["primitives"].size(); ++i) {
        Json& primitive = json["meshes"][mesh]["primitives"][i];
        if (!isCompressed(mesh, i) || !primitive.contains("extensions")) continue;
        primitive["extensions"].erase("KHR_draco_mesh_compression");
        if (primitive["extensions"].empty()) primitive.erase("extensions");
      }
    }
  }

  bool mayDiffer(const std::string& path) const {
    std::vector<std::string> parts;
    for (size_t at = 1; at <= path.size();) {
      const size_t end = std::min(path.find('/', at), path.size());
      parts.push_back(path.substr(at, end - at));
      at = end + 1;
    }
    const auto is = [&](size_t i, std::initializer_list<const char*> names) {
      return parts.size() > i && std::any_of(names.begin(), names.end(),
                                             [&](const char* name) { return parts[i] == name; });
    };
    if (parts.size() == 3 && parts[0] == "images") return is(2, {"bufferView", "uri", "mimeType"});
    if (parts.size() >= 3 && parts[0] == "accessors") {
      if (parts.size() == 3 && is(2, {"bufferView", "byteOffset"})) return true;
      if (is(2, {"sparse"}) && is(4, {"bufferView", "byteOffset"})) return true;
      const bool is_compressed = compressed_.count(std::stoull(parts[1])) != 0;
      return is_compressed && parts.size() == 3 &&
             is(2, {"min", "max", "sparse", "count", "componentType"});
    }
    if (parts.size() == 5 && parts[0] == "meshes" && parts[2] == "primitives") {
      return is(4, {"attributes", "targets", "indices", "mode"}) &&
             isCompressed(std::stoull(parts[1]), std::stoull(parts[3]));
    }
    if (parts.size() == 6 && parts[0] == "meshes" && parts[2] == "primitives" &&
        parts[4] == "extensions") {
      return is(5, {"KHR_draco_mesh_compression"});  // its view has another number
    }
    return false;
  }

  void compareRest() {
    const size_t accessor_count = memberOf(source_.json, "accessors").size();
    for (uint64_t i = 0; i < accessor_count; ++i) {
      // Another use of what Draco holds sees zeros, as before.
      if (compressed_.count(i) != 0 || source_.isHeldByDraco(i)) continue;
      Elements source;
      try {
        source = source_.elements(i);
      } catch (const std::exception&) {
        continue;  // unreadable in the source, too
      }
      require(source.values == decoded_.elements(i).values,
              "/accessors/" + std::to_string(i) + ": an element changed");
    }
    for (const uint32_t view : kept_.views) {
      for (const PlainDocument* document : {&converted_, &decoded_}) {
        require(document->viewBytes(view) == source_.viewBytes(view),
                "/bufferViews/" + std::to_string(view) + ": the bytes changed");
      }
    }
    for (size_t i = 0; i < memberOf(source_.json, "images").size(); ++i) {
      for (const PlainDocument* document : {&converted_, &decoded_}) {
        require(document->imageBytes(i) == source_.imageBytes(i),
                "/images/" + std::to_string(i) + ": the bytes changed");
      }
    }
    for (const uint32_t accessor : kept_.accessors) {
      if (source_.isHeldByDraco(accessor)) continue;
      require(source_.elements(accessor).values == converted_.elements(accessor).values,
              "/accessors/" + std::to_string(accessor) +
                  ": changed, though something unknown refers to it");
    }
  }

  uint32_t payloadOf(size_t mesh, size_t primitive) const {
    for (const PrimitiveReport& report : report_.primitives) {
      if (report.mesh == mesh && report.primitive == primitive) return report.payload;
    }
    return kNone;
  }

  /// Returns the box of all positions that share a lattice with those of a payload, including
  /// primitives that end up uncompressed.
  Box boxOfPayload(uint32_t payload) const {
    std::set<size_t> meshes;
    for (const PrimitiveReport& report : report_.primitives) {
      if (report.payload == payload || options_.grid == Grid::kScene) meshes.insert(report.mesh);
    }
    Box box;
    for (const PrimitiveReport& report : report_.primitives) {
      if (report.payload != payload && meshes.count(report.mesh) == 0) continue;
      const Json& position = memberOf(
          memberOf(primitiveOf(source_, report.mesh, report.primitive), "attributes"), "POSITION");
      if (position.is_null()) continue;
      Box own;
      const Elements elements = source_.elements(numberOf(position));
      if (elements.component_type != 5126 || elements.type != "VEC3") continue;
      own.add(elements);
      if (own.is_finite) box.add(elements);
    }
    return box;
  }

  /// The same for a quality. Nothing is known of textures here, so all count as the smallest.
  Bound askedByQuality(const Attribute& attribute, const Box& own, const Box& positions) const {
    const double share = 1 / options_.quality;
    const double radians = 0.25 / 180 * std::numbers::pi * std::sqrt(4096 * share);
    const double unit = std::max(1.0, own.largest());
    const bool is_base = attribute.target < 0;
    const bool is_vector = attribute.source.type == "VEC3";
    Bound bound;
    const auto allow = [&](double value) {
      bound.is_exact = false;
      bound.value = value + std::ldexp(own.largest() + own.side(), -22);
    };
    if (attribute.name == "POSITION" && is_vector) {
      allow(share * std::max(positions.side(), is_base ? 0 : own.largest()));
      if (is_base) bound.value = bound.distance = share * positions.side();
    } else if (attribute.name == "NORMAL" && is_vector) {
      allow(radians * (is_base ? own.largest() : 1));
      if (is_base) bound.radians = radians + 1e-5;
    } else if (attribute.name == "TANGENT" && (is_vector || attribute.source.type == "VEC4")) {
      allow(radians);
      if (is_base) bound.radians = 2 * radians + 0.004;
    } else if (isNamed(attribute.name, "TEXCOORD") && attribute.source.type == "VEC2") {
      allow(std::max(0.25 / 1024, 0.25 * share * std::min(1.0, own.side())));
    } else if (isNamed(attribute.name, "COLOR") && (is_vector || attribute.source.type == "VEC4")) {
      allow(0.5 / 255 * unit);
    } else if (isNamed(attribute.name, "WEIGHTS") && attribute.source.type == "VEC4") {
      allow(2 * share * unit);
    }
    return bound;
  }

  /// Returns the deviation that the options allow, whatever the report says.
  Bound askedFor(const Attribute& attribute, const std::vector<Attribute>& all,
                 const Box& positions) const {
    Bound bound;
    const Elements& source = attribute.source;
    const bool is_base = attribute.target < 0;
    if (options_.lossless || options_.indices_only || source.component_type != 5126) return bound;
    Box own;
    own.add(source);
    if (!own.is_finite) return bound;
    if (options_.quality != 0) return askedByQuality(attribute, own, positions);
    const QuantizationBits& bits = options_;
    const auto allow = [&](double value) {
      bound.is_exact = false;
      bound.value = value + std::ldexp(own.largest() + own.side(), -22);
    };
    const double position_step =
        options_.step != 0          ? options_.step
        : options_.position_lattice ? options_.position_lattice->step
        : options_.max_position_error > 0
            ? 2 * options_.max_position_error * (options_.is_error_relative ? positions.side() : 1)
        : bits.position_bits == 0 ? 0
                                  : positions.side() / stepsOf(bits.position_bits);
    const bool is_vector = source.type == "VEC3";
    if (attribute.name == "POSITION" && is_vector) {
      // The deltas of exact positions may have a lattice of their own.
      const double delta_step = is_base || bits.position_bits == 0
                                    ? 0
                                    : std::max(own.side(), 1.0) / stepsOf(bits.position_bits);
      const double step = std::max(position_step, delta_step);
      if (step == 0 && (bits.position_bits == 0 || !is_base))
        return bound;  // otherwise all are one point
      // Decoding rounds twice, relative to the lattice's origin.
      const double origin = options_.position_lattice ? 2 : 0;
      allow(step / 2 + std::ldexp(positions.largest() + positions.side() + origin, -23));
      if (options_.max_position_error > 0 && !options_.position_lattice && is_base)
        bound.distance = position_step / 2;
      if (bound.distance != 0) bound.value = bound.distance;
    } else if (attribute.name == "NORMAL" && is_vector && bits.normal_bits != 0) {
      allow((is_base ? own.side() / 2 : 1) / stepsOf(bits.normal_bits));
      if (is_base) bound.radians = 4.5 / (std::ldexp(1.0, bits.normal_bits) - 2) + 1e-5;
    } else if (attribute.name == "TANGENT" && bits.tangent_bits != 0 &&
               (is_vector || source.type == "VEC4")) {
      allow(is_base ? std::ldexp(1.0, -bits.tangent_bits) : 1 / stepsOf(bits.tangent_bits));
      const bool has_lossy_normal =
          bits.normal_bits != 0 && std::any_of(all.begin(), all.end(), [](const Attribute& other) {
            return other.name == "NORMAL" && other.target < 0 &&
                   other.source.component_type == 5126;
          });
      if (is_base) {
        // The angle around a normal on the octahedral grid or, without a normal, a grid of its own.
        const double own_grid = 4.5 / (std::ldexp(1.0, bits.tangent_bits) - 2);
        const double around_normal =
            std::numbers::pi * std::ldexp(1.0, -bits.tangent_bits) + 0.004 +
            (has_lossy_normal ? 4.5 / (std::ldexp(1.0, bits.normal_bits) - 2) : 0);
        bound.radians = std::max(own_grid, around_normal);
      }
    } else if (isNamed(attribute.name, "TEXCOORD") && source.type == "VEC2" &&
               bits.texcoord_bits != 0) {
      allow(std::max(own.side(), is_base ? 0 : 1.0) / stepsOf(bits.texcoord_bits) / 2);
    } else if (isNamed(attribute.name, "COLOR") &&
               (source.type == "VEC3" || source.type == "VEC4") && bits.color_bits != 0) {
      allow(std::max(own.side(), 1.0) / stepsOf(bits.color_bits) / 2);
    } else if (isNamed(attribute.name, "WEIGHTS") && source.type == "VEC4" &&
               bits.weight_bits != 0) {
      allow(std::max(own.side(), 1.0) / stepsOf(bits.weight_bits));
    }
    return bound;
  }

  /// Returns the report's promise where that is less.
  void tighten(uint32_t payload, Attribute& attribute) const {
    Bound& bound = attribute.bound;
    if (bound.is_exact || payload >= report_.payloads.size()) return;
    // A row for several pieces promises what the worst of them does, in units or in degrees.
    if (report_.payloads[payload].piece_count > 1) return;
    double value = 0;
    double radians = 0;
    for (const AttributeReport& row : report_.payloads[payload].attributes) {
      if (row.name != attribute.label()) continue;
      double& promised = row.is_angle ? radians : value;
      promised =
          std::max(promised, row.promised_error * (row.is_angle ? std::numbers::pi / 180 : 1));
    }
    if (bound.distance == 0) bound.value = std::min(bound.value, value);
    bound.radians = std::min(bound.radians, radians * (1 + 1e-6));
    bound.is_exact = value == 0 && radians == 0;
  }

  void comparePrimitive(size_t mesh, size_t i) try {
    const Json& source = primitiveOf(source_, mesh, i);
    const Json& decoded = primitiveOf(decoded_, mesh, i);
    require(numberOf(decoded, "mode", 4) == 4, "is no triangle list");
    std::vector<Attribute> attributes = attributesOf({source_, source}, {decoded_, decoded});
    const uint32_t payload = payloadOf(mesh, i);
    const bool was_compressed = payload == kNone;  // by the author of the source
    const Box positions = was_compressed ? Box{} : boxOfPayload(payload);
    for (Attribute& attribute : attributes) {
      if (was_compressed) continue;
      attribute.bound = askedFor(attribute, attributes, positions);
      tighten(payload, attribute);
    }
    compareTriangles({source_, source}, {decoded_, decoded}, attributes, options_.keep_vertex_order,
                     options_.keep_triangle_order);
  } catch (const std::exception& error) {
    fail("/meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(i) + ": " +
         error.what());
  }

  const PlainDocument& source_;
  const PlainDocument& converted_;
  const PlainDocument& decoded_;
  const ConvertOptions& options_;
  const KeptNumbers& kept_;
  const ConvertReport& report_;
  std::set<uint64_t> compressed_;
};

}  // namespace

std::string differenceOf(const PlainDocument& source, const PlainDocument& converted,
                         const PlainDocument& decoded, const ConvertOptions& options,
                         const KeptNumbers& kept, const ConvertReport& report) try {
  Comparison(source, converted, decoded, options, kept, report).run();
  return "";
} catch (const std::exception& error) {
  return error.what();
}

std::string differenceOfPrimitives(const Bytes& source_file, const Bytes& decoded_file,
                                   bool keeps_order) {
  PlainDocument source, decoded;
  for (const std::string& why : {source.load({{"source", source_file}}, "source"),
                                 decoded.load({{"decoded", decoded_file}}, "decoded")}) {
    if (!why.empty()) return why;
  }
  const Json& meshes = memberOf(source.json, "meshes");
  for (size_t mesh = 0; mesh < meshes.size(); ++mesh) {
    const Json& primitives = memberOf(meshes[mesh], "primitives");
    for (size_t i = 0; i < primitives.size(); ++i) {
      try {
        comparePrimitives({source, primitives[i]},
                          {decoded, decoded.json["meshes"][mesh]["primitives"][i]}, keeps_order);
      } catch (const std::exception& error) {
        return "/meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(i) + ": " +
               error.what();
      }
    }
  }
  return "";
}

}  // namespace mcc::gltf::test
