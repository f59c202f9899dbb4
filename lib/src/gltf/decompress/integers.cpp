// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress/integers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>

#include "gltf/document/accessors.h"
#include "values/enc_extent.h"

namespace mcc::gltf {
namespace {

/// Reads and replaces the elements of decoded accessors in a document that is not laid out yet.
class IntegerAccessors {
 public:
  /// json and views are those of layOut(); both must outlive the object.
  IntegerAccessors(const Document& source, const CodedAttributes& coded, Json& json,
                   std::vector<NewView>& views)
      : source_(source), coded_(coded), json_(json["accessors"]), views_(views) {
    for (const Primitive& primitive : source.primitives) {
      for (const auto& [name, target, accessor] : primitive.attributes) {
        if (accessor == kNone) continue;
        meanings_[accessor].insert((target == kNone ? "" : "target ") + std::string(name));
      }
    }
  }

  /// Returns how an accessor was coded if it still holds floats on a grid and all its users mean
  /// the same attribute by it; else null.
  const AttributeInfo* coding(uint32_t accessor) const {
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

  /// Returns a label such as "/accessors/3: target POSITION". The accessor must have a coding.
  std::string label(uint32_t accessor) const {
    return at("/accessors", accessor) + ": " + *meanings_.at(accessor).begin();
  }
  uint64_t count(uint32_t accessor) const { return source_.accessors[accessor].count; }
  /// Returns component `index`, counted over all components of all elements.
  double value(uint32_t accessor, uint64_t index) const {
    const uint64_t view = json_[accessor]["bufferView"].get<uint64_t>();
    return componentValue(views_[view - kFirstNewView].bytes + 4 * index, ComponentType::kFloat32);
  }

  /// Replaces the values, three per element for a VEC3 and so on, and updates the bounds. Must be
  /// called at most once per accessor.
  void replace(uint32_t index, ComponentType type, bool normalized,
               const std::vector<int32_t>& values) {
    replaced_.insert(index);
    Accessor accessor = source_.accessors[index];
    accessor.component_type = type;
    const uint32_t bytes = componentBytes(type);
    std::vector<uint8_t> tight;
    for (const int32_t value : values) {
      for (uint32_t b = 0; b < bytes; ++b) tight.push_back(static_cast<uint8_t>(value >> 8 * b));
    }
    Json& json = json_[index];
    NewView& view = views_[json["bufferView"].get<uint64_t>() - kFirstNewView];
    view.hold(packAttribute(tight, accessor, view.stride_bytes));
    json["componentType"] = kGlTypes[static_cast<size_t>(type)];
    json.erase("normalized");
    if (normalized) json["normalized"] = true;
    setBounds(boundsOf(tight, type, accessor.componentCount()), type, false, json);
  }

 private:
  const Document& source_;
  const CodedAttributes& coded_;
  Json& json_;
  std::vector<NewView>& views_;
  std::map<uint32_t, std::set<std::string>> meanings_;  ///< the attributes it is used as
  std::set<uint32_t> replaced_;
};

// ---- Values other than positions

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
std::set<std::vector<uint32_t>> weightSets(const Document& source) {
  std::set<std::vector<uint32_t>> all;
  for (const Primitive& primitive : source.primitives) {
    std::vector<uint32_t> sets;
    for (const auto& [name, target, accessor] : primitive.attributes) {
      if (target == kNone && name.starts_with("WEIGHTS_")) sets.push_back(accessor);
    }
    if (!sets.empty()) all.insert(std::move(sets));
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

/// Stores attributes other than positions as normalised integers, where their range allows it and
/// no step becomes coarser. Normals and tangents become signed; texture coordinates, colours and
/// weights become unsigned. Returns true when KHR_mesh_quantization is needed.
bool storeIntegerValues(const Document& source, const CodedAttributes& coded,
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
  for (const std::vector<uint32_t>& sets : weightSets(source)) {
    storeWeightsOf(sets, accessors, notes);
  }
  return needs_extension;
}

// ---- Positions

constexpr int64_t kLastPoint = 65535;
constexpr int64_t kLastDelta = 32767;

/// Extensions of a node that mean the same when its mesh moves to a child.
constexpr std::string_view kMovableNodeExtensions[] = {"KHR_lights_punctual",
                                                       "KHR_node_hoverability",
                                                       "KHR_node_selectability",
                                                       "KHR_node_visibility",
                                                       "KHR_xmp",
                                                       "KHR_xmp_json_ld"};

/// A mesh whose positions may become points of one lattice.
struct MeshPlan {
  std::vector<uint32_t> positions;  ///< accessors of POSITION
  std::vector<uint32_t> deltas;     ///< accessors of POSITION of morph targets
  std::vector<uint32_t> nodes;      ///< nodes that show the mesh
  Lattice lattice;
  bool is_chosen = false;
};

class PositionStore {
 public:
  PositionStore(const Document& source, IntegerAccessors& accessors, Json& json,
                std::vector<NewView>& views, std::vector<std::string>& notes)
      : source_(source),
        accessors_(accessors),
        json_(json),
        nodes_(member(&json_, "nodes")),
        skins_(member(&json_, "skins")),
        all_accessors_(member(&json_, "accessors")),
        skin_room_(kSkinBytes + kMaxCopies * source.source_bytes),
        views_(views),
        notes_(notes),
        node_extension_(nodeDependentExtension(source.json, source.foreign)) {}

  bool run() {
    collectMeshes();
    for (size_t mesh = 0; mesh < meshes_.size(); ++mesh) chooseMesh(mesh);
    dropSharers();
    for (const MeshPlan& mesh : meshes_) storeMesh(mesh);
    moveWeightChannels();
    moveSkins();
    const auto is_chosen = [](const MeshPlan& mesh) { return mesh.is_chosen; };
    return std::any_of(meshes_.begin(), meshes_.end(), is_chosen);
  }

 private:
  /// The matrices of a skin are stored for each lattice of its meshes. A file may have many of
  /// both, so what they take is limited, by this and by this many times the bytes of the file.
  static constexpr uint64_t kSkinBytes = uint64_t{1} << 24;
  static constexpr uint64_t kMaxCopies = 16;
  static constexpr uint64_t kBytesOfJoint = 80;  // a matrix, and a number in the JSON

  struct SkinnedNode {
    uint32_t node;
    Lattice lattice;
  };

  void collectMeshes() {
    meshes_.resize(source_.first_primitive_of.size());
    for (const Primitive& primitive : source_.primitives) {
      MeshPlan& plan = meshes_[primitive.ref.mesh];
      for (const auto& [name, target, accessor] : primitive.attributes) {
        if (name != "POSITION") continue;
        (target == kNone ? plan.positions : plan.deltas).push_back(accessor);
      }
    }
    const Json& nodes = arrayOf(json_, "nodes");
    for (uint32_t node = 0; node < nodes.size(); ++node) {
      const uint32_t mesh = indexOf(findMember(nodes[node], "mesh"), meshes_.size());
      if (mesh != kNone) meshes_[mesh].nodes.push_back(node);
    }
  }

  bool isOnLattice(uint32_t accessor) const {
    const AttributeInfo* info = accessors_.coding(accessor);
    return info != nullptr && info->coding == AttributeCoding::kLattice;
  }

  void chooseMesh(size_t number) {
    MeshPlan& mesh = meshes_[number];
    const auto is_on_lattice = [&](uint32_t accessor) { return isOnLattice(accessor); };
    if (std::none_of(mesh.positions.begin(), mesh.positions.end(), is_on_lattice)) return;
    const std::string reason = obstacle(mesh);
    mesh.is_chosen = reason.empty();
    if (!mesh.is_chosen) {
      notes_.push_back(at("/meshes", number) + ": " + reason + "; its positions stay float");
    }
  }

  /// Returns why the positions of a mesh stay float; empty when they can become integers. Finds
  /// their lattice.
  std::string obstacle(MeshPlan& mesh) {
    if (!node_extension_.empty()) {
      return "the extension " + node_extension_ + " may refer to its nodes";
    }
    for (const uint32_t accessor : mesh.positions) {
      if (!isOnLattice(accessor)) return "not all of its primitives are on a lattice";
      const Lattice& lattice = accessors_.coding(accessor)->lattice;
      if (accessor == mesh.positions[0]) mesh.lattice = lattice;
      if (lattice != mesh.lattice) return "its primitives are on different lattices";
      if (!areOn(mesh.lattice, accessor, false)) {
        return "its lattice has more than 16 bits";
      }
    }
    for (const uint32_t accessor : mesh.deltas) {
      const bool has_same_step =
          isOnLattice(accessor) && accessors_.coding(accessor)->lattice.step == mesh.lattice.step;
      if (!has_same_step || !areOn(mesh.lattice, accessor, true)) {
        return "a morph target is not on its lattice";
      }
    }
    if (mesh.nodes.empty()) return "no node shows it";
    for (const uint32_t node : mesh.nodes) {
      const std::string reason = nodeObstacle((*nodes_)[node]);
      if (!reason.empty()) return at("/nodes", node) + " " + reason;
    }
    if (!takeSkinRoom(mesh)) return "the matrices of its skins would be stored too often";
    return "";
  }

  /// Whether values are points of a lattice, or differences of some. fits() looks at every value,
  /// so it is called once per accessor, however many primitives share it.
  bool areOn(const Lattice& lattice, uint32_t accessor, bool is_delta) {
    constexpr float kZero[3] = {0, 0, 0};
    const auto [found, is_new] = are_on_lattice_.try_emplace({accessor, is_delta}, false);
    if (is_new) {
      found->second = is_delta ? fits(accessor, kZero, lattice.step, -kLastDelta, kLastDelta)
                               : fits(accessor, lattice.origin, lattice.step, 0, kLastPoint);
    }
    return found->second;
  }

  /// Returns the lattice point nearest to a value.
  static int64_t pointOf(double value, double origin, double step) {
    const double point = std::floor((value - origin) / step + 0.5);
    return static_cast<int64_t>(std::clamp(point, -0x1p40, 0x1p40));
  }

  /// Whether all values are lattice points within these bounds. Far from the origin, floats are too
  /// coarse to identify their point.
  bool fits(uint32_t accessor, const float* origin, float step, int64_t first, int64_t last) const {
    const uint64_t count = 3 * accessors_.count(accessor);
    for (uint64_t i = 0; i < count; ++i) {
      const double value = accessors_.value(accessor, i);
      const int64_t point = pointOf(value, double{origin[i % 3]}, double{step});
      if (point < first || point > last) return false;
      const double off = value - double{origin[i % 3]} - static_cast<double>(point) * double{step};
      const double rounding = std::ldexp(std::abs(value) + std::abs(double{origin[i % 3]}), -23);
      if (!(std::abs(off) <= rounding + 0x1p-10 * double{step})) return false;
    }
    return true;
  }

  std::string nodeObstacle(const Json& node) {
    if (const Json* extensions = findMember(node, "extensions")) {
      if (!extensions->is_object()) return "has malformed extensions";
      for (const auto& [name, value] : extensions->items()) {
        const bool is_harmless =
            std::find(std::begin(kMovableNodeExtensions), std::end(kMovableNodeExtensions), name) !=
            std::end(kMovableNodeExtensions);
        if (!is_harmless) return "has the extension " + name;
      }
    }
    const Json* children = findMember(node, "children");
    if (children != nullptr && !children->is_array()) return "has malformed children";
    const Json* skin = findMember(node, "skin");
    return skin == nullptr || hasMatrices(*skin) ? "" : "has a skin without valid matrices";
  }

  /// Takes room for the matrices of the skins of a mesh; its nodes have valid ones.
  bool takeSkinRoom(const MeshPlan& mesh) {
    std::set<uint64_t> skins;
    for (const uint32_t node : mesh.nodes) {
      uint64_t skin = 0;
      if (asUnsigned(findMember((*nodes_)[node], "skin"), skin)) skins.insert(skin);
    }
    for (const uint64_t skin : skins) {
      const uint64_t bytes = kBytesOfJoint * arrayOf((*skins_)[skin], "joints").size();
      if (bytes > skin_room_) return false;
      skin_room_ -= bytes;
    }
    return true;
  }

  /// Looks at each skin once, since many nodes may share it.
  bool hasMatrices(const Json& skin_number) {
    uint64_t skin = 0;
    if (!asUnsigned(skin_number, skin)) return false;
    const auto [found, is_new] = has_matrices_.try_emplace(skin, false);
    if (is_new) found->second = inverseBindMatrices(skin_number).has_value();
    return found->second;
  }

  /// Meshes that share accessors become integers together or not at all.
  void dropSharers() {
    std::map<uint32_t, std::vector<size_t>> meshes_with;  // meshes by accessor
    std::vector<size_t> float_meshes;                     // those still to be visited
    for (size_t number = 0; number < meshes_.size(); ++number) {
      const MeshPlan& mesh = meshes_[number];
      for (const uint32_t accessor : mesh.positions) meshes_with[accessor].push_back(number);
      for (const uint32_t accessor : mesh.deltas) meshes_with[accessor].push_back(number);
      if (!mesh.is_chosen) float_meshes.push_back(number);
    }
    std::set<size_t> dropped;
    const auto dropUsersOf = [&](uint32_t accessor) {
      std::vector<size_t> users;
      users.swap(meshes_with[accessor]);  // visit each accessor only once
      for (const size_t number : users) {
        if (!meshes_[number].is_chosen) continue;
        meshes_[number].is_chosen = false;
        dropped.insert(number);
        float_meshes.push_back(number);
      }
    };
    while (!float_meshes.empty()) {
      const MeshPlan& mesh = meshes_[float_meshes.back()];
      float_meshes.pop_back();
      for (const uint32_t accessor : mesh.positions) dropUsersOf(accessor);
      for (const uint32_t accessor : mesh.deltas) dropUsersOf(accessor);
    }
    for (const size_t number : dropped) {
      notes_.push_back(at("/meshes", number) +
                       ": shares positions with a mesh whose positions stay float");
    }
  }

  void storePoints(uint32_t accessor, const Lattice& lattice, bool is_delta) {
    if (accessors_.coding(accessor) == nullptr) return;  // it was already stored
    std::vector<int32_t> points(3 * accessors_.count(accessor));
    for (uint64_t i = 0; i < points.size(); ++i) {
      const double origin = is_delta ? 0.0 : double{lattice.origin[i % 3]};
      points[i] = static_cast<int32_t>(
          pointOf(accessors_.value(accessor, i), origin, double{lattice.step}));
    }
    const IntegerType* const types = is_delta ? kSigned : kUnsigned;
    const auto [low, high] = std::minmax_element(points.begin(), points.end());
    const bool is_small = *low >= -types[0].last && *high <= types[0].last;
    accessors_.replace(accessor, types[is_small ? 0 : 1].type, false, points);
  }

  void storeMesh(const MeshPlan& mesh) {
    if (!mesh.is_chosen) return;
    for (const uint32_t accessor : mesh.positions) storePoints(accessor, mesh.lattice, false);
    for (const uint32_t accessor : mesh.deltas) storePoints(accessor, mesh.lattice, true);
    for (const uint32_t node : mesh.nodes) {
      uint64_t skin = 0;
      if (asUnsigned(findMember((*nodes_)[node], "skin"), skin)) {
        skinned_[skin].push_back({node, mesh.lattice});
      } else {
        moveToChild(node, mesh.lattice);
      }
    }
  }

  /// Moves the mesh of a node to a new child whose transform is the lattice. Everything else about
  /// the node stays, and so do its animations.
  void moveToChild(uint32_t number, const Lattice& lattice) {
    const size_t child_number = nodes_->size();
    Json& node = (*nodes_)[number];
    Json child = {{"mesh", std::move(node["mesh"])},
                  {"translation", {lattice.origin[0], lattice.origin[1], lattice.origin[2]}},
                  {"scale", {lattice.step, lattice.step, lattice.step}}};
    node.erase("mesh");
    if (findMember(node, "weights") != nullptr) child["weights"] = std::move(node["weights"]);
    node.erase("weights");
    node["children"].push_back(child_number);
    nodes_->push_back(std::move(child));
    child_of_node_[number] = child_number;
  }

  /// Redirects animations of the weights of morph targets to the new node of the mesh.
  void moveWeightChannels() {
    if (child_of_node_.empty()) return;
    visitPath(&json_, "animations/[]/channels/[]/target", [&](Json& target) {
      uint64_t node = 0;
      const Json* path = findMember(target, "path");
      if (path == nullptr || *path != "weights" || !asUnsigned(findMember(target, "node"), node))
        return;
      const auto moved = child_of_node_.find(node);
      if (moved != child_of_node_.end()) target["node"] = moved->second;
    });
  }

  /// Returns the matrices of a skin, identities when it names none, or nothing when they are
  /// unusable.
  std::optional<std::vector<float>> inverseBindMatrices(const Json& skin_number) const {
    uint64_t skin = 0;
    const Json& skins = arrayOf(json_, "skins");
    if (!asUnsigned(skin_number, skin) || skin >= skins.size()) return {};
    const size_t joint_count = arrayOf(skins[skin], "joints").size();
    if (joint_count == 0) return {};
    std::vector<float> matrices(16 * joint_count, 0.0f);
    const Json* number = findMember(skins[skin], "inverseBindMatrices");
    if (number == nullptr) {
      for (size_t i = 0; i < joint_count; ++i) {
        for (size_t k = 0; k < 4; ++k) matrices[16 * i + 5 * k] = 1;
      }
      return matrices;
    }
    const uint32_t index = indexOf(number, source_.accessors.size());
    if (index == kNone) return {};
    const Accessor& accessor = source_.accessors[index];
    const bool is_usable = accessor.is_known_type && accessor.columns == 4 &&
                           accessor.component_type == ComponentType::kFloat32 &&
                           accessor.count >= joint_count;
    AccessorData data;
    if (!is_usable || !readAccessor(source_, index, data).ok()) return {};
    for (size_t i = 0; i < joint_count; ++i) {
      std::memcpy(&matrices[16 * i], data.element(i).data(), 16 * sizeof(float));
    }
    return matrices;
  }

  /// Computes matrix * (translation by the origin) * (scale by the step), in column-major order.
  static void fold(const Lattice& lattice, float* matrix) {
    for (size_t row = 0; row < 4; ++row) {
      double moved = double{matrix[12 + row]};
      for (size_t column = 0; column < 3; ++column) {
        float& entry = matrix[4 * column + row];
        moved += double{entry} * double{lattice.origin[column]};
        entry = static_cast<float>(double{entry} * double{lattice.step});
      }
      matrix[12 + row] = static_cast<float>(moved);
    }
  }

  /// Gives the nodes of a skin that have the same lattice a skin of their own. The last such group
  /// reuses the original skin if no other node uses it.
  void moveSkins() {
    if (skinned_.empty()) return;
    std::map<uint64_t, size_t> user_counts = countMembers("nodes", "skin");
    matrix_users_ = countMembers("skins", "inverseBindMatrices");
    for (const auto& [skin, nodes] : skinned_) {
      size_t& user_count = user_counts[skin];
      for (const std::vector<SkinnedNode>& group : byLattice(nodes)) {
        const uint64_t folded = foldedSkin(skin, group[0].lattice, group.size() == user_count);
        for (const SkinnedNode& node : group) (*nodes_)[node.node]["skin"] = folded;
        user_count -= group.size();
      }
    }
  }

  /// Counts how often each number occurs as this member of the elements of an array.
  std::map<uint64_t, size_t> countMembers(const char* array, const char* key) const {
    std::map<uint64_t, size_t> counts;
    for (const Json& element : arrayOf(json_, array)) {
      uint64_t number = 0;
      if (asUnsigned(findMember(element, key), number)) ++counts[number];
    }
    return counts;
  }

  /// Groups nodes by equal lattices. The group of the last node comes first.
  static std::vector<std::vector<SkinnedNode>> byLattice(const std::vector<SkinnedNode>& nodes) {
    std::map<std::array<float, 4>, size_t> group_of;
    std::vector<std::vector<SkinnedNode>> groups;
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
      const float* origin = node->lattice.origin;
      const std::array<float, 4> key = {node->lattice.step, origin[0], origin[1], origin[2]};
      const auto [found, is_new] = group_of.try_emplace(key, groups.size());
      if (is_new) groups.emplace_back();
      groups[found->second].push_back(*node);
    }
    return groups;
  }

  /// Whether the matrices of a skin belong to it alone.
  bool hasOwnMatrices(const Json& skin) const {
    const Json* const number = findMember(skin, "inverseBindMatrices");
    const uint32_t accessor = indexOf(number, source_.accessors.size());
    const auto users = matrix_users_.find(accessor);
    return users != matrix_users_.end() && users->second == 1 &&
           !source_.accessors[accessor].is_foreign;
  }

  /// Returns the number of a skin whose matrices apply to lattice points.
  uint64_t foldedSkin(uint64_t number, const Lattice& lattice, bool in_place) {
    std::vector<float> matrices = *inverseBindMatrices(Json(number));
    for (size_t i = 0; i < matrices.size(); i += 16) fold(lattice, &matrices[i]);
    Json skin = (*skins_)[number];
    uint64_t accessor = all_accessors_->size();
    if (in_place && hasOwnMatrices(skin)) {
      asUnsigned(skin["inverseBindMatrices"], accessor);
    } else {
      uint64_t left = 0;
      if (in_place && asUnsigned(findMember(skin, "inverseBindMatrices"), left))
        --matrix_users_[left];
      all_accessors_->push_back({{"componentType", 5126}, {"type", "MAT4"}});
    }
    skin["inverseBindMatrices"] = accessor;
    Json& json = (*all_accessors_)[accessor];
    for (const char* key : {"sparse", "min", "max"}) json.erase(key);
    json["count"] = matrices.size() / 16;
    NewView view;
    std::vector<uint8_t> bytes(4 * matrices.size());
    std::memcpy(bytes.data(), matrices.data(), bytes.size());
    view.hold(std::move(bytes));
    addView(std::move(view), json, views_);
    if (in_place) {
      (*skins_)[number] = std::move(skin);
      return number;
    }
    skins_->push_back(std::move(skin));
    return skins_->size() - 1;
  }

  const Document& source_;
  IntegerAccessors& accessors_;
  Json& json_;
  // Members of the document, or null. None is added while this lives.
  Json* const nodes_;
  Json* const skins_;
  Json* const all_accessors_;
  uint64_t skin_room_;  ///< bytes that matrices of skins may still take
  std::vector<NewView>& views_;
  std::vector<std::string>& notes_;
  const std::string node_extension_;  ///< an extension that may refer to nodes, or empty
  std::vector<MeshPlan> meshes_;
  std::map<std::pair<uint32_t, bool>, bool> are_on_lattice_;  ///< by accessor and `is_delta`
  std::map<uint64_t, bool> has_matrices_;                     ///< by skin
  std::map<uint64_t, uint64_t> child_of_node_;
  std::map<uint64_t, std::vector<SkinnedNode>> skinned_;  ///< by skin
  std::map<uint64_t, size_t> matrix_users_;               ///< skins by accessor of matrices
};

}  // namespace

void storeIntegers(const Document& source, const CodedAttributes& coded, Json& json,
                   std::vector<NewView>& views, std::vector<std::string>& notes) {
  IntegerAccessors accessors(source, coded, json, views);
  bool needs_extension = PositionStore(source, accessors, json, views, notes).run();
  needs_extension |= storeIntegerValues(source, coded, accessors, notes);
  if (needs_extension) listExtension(json, "KHR_mesh_quantization", true);
}

}  // namespace mcc::gltf
