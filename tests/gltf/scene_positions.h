// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Computes where a renderer shows the vertices of a document, with morph targets, skins and nodes
// applied, in binary64.
#ifndef MCC_TESTS_GLTF_SCENE_POSITIONS_H_
#define MCC_TESTS_GLTF_SCENE_POSITIONS_H_

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "gltf/document/accessors.h"
#include "json/json.h"

namespace mcc::gltf::test {

using Matrix = std::array<double, 16>;  // column-major

inline Matrix identity() { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }

inline Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 4; ++row) {
      for (size_t k = 0; k < 4; ++k) result[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return result;
}

/// A number however it is spelt.
inline double realOf(const Json& json) {
  return std::strtod(json.text().c_str(), nullptr);
}

/// Reads a document and places its vertices.
class SceneReader {
 public:
  /// weights_from   null: the document itself; else the document whose skin weights are used.
  SceneReader(const std::vector<uint8_t>& file, const std::vector<uint8_t>* weights_from) {
    is_ok_ = loadDocument(file, nullptr, document_).ok() &&
             (weights_from == nullptr || loadDocument(*weights_from, nullptr, weights_).ok());
    if (weights_from == nullptr && is_ok_) is_ok_ = loadDocument(file, nullptr, weights_).ok();
    const Json& nodes = arrayOf(document_.json, "nodes");
    parents_.assign(nodes.size(), kNone);
    for (uint32_t node = 0; node < nodes.size(); ++node) {
      for (const Json& child : arrayOf(nodes[node], "children")) parents_[child] = node;
    }
  }

  bool isOk() const { return is_ok_; }

  /// Returns, for each node that shows a mesh, x y z of the vertices of all its primitives. A node
  /// whose number is not below `node_count` counts as its parent.
  std::map<uint32_t, std::vector<double>> positions(size_t node_count) const {
    std::map<uint32_t, std::vector<double>> all;
    const Json& nodes = arrayOf(document_.json, "nodes");
    for (uint32_t node = 0; node < nodes.size(); ++node) {
      if (findMember(nodes[node], "mesh") == nullptr) continue;
      const uint32_t key = node < node_count ? node : parents_[node];
      for (const Json& primitive :
           document_.json["meshes"][nodes[node]["mesh"].get<size_t>()]["primitives"]) {
        const std::vector<double> places = placesOf(node, primitive);
        all[key].insert(all[key].end(), places.begin(), places.end());
      }
    }
    return all;
  }

  /// Components of an accessor as a shader sees them.
  static std::vector<double> numbers(const Document& document, uint32_t index) {
    static constexpr double kLast[] = {127, 255, 32767, 65535, 4294967295.0, 1};
    std::vector<double> values;
    const Accessor& accessor = document.accessors[index];
    AccessorData data;
    if (!readAccessor(document, index, data).ok()) return values;
    const uint32_t bytes = componentBytes(accessor.component_type);
    for (uint64_t i = 0; i < data.count; ++i) {
      for (uint32_t c = 0; c < accessor.componentCount(); ++c) {
        const double raw =
            componentValue(data.element(i).data() + c * bytes, accessor.component_type);
        const double last = kLast[static_cast<size_t>(accessor.component_type)];
        values.push_back(accessor.normalized ? std::max(raw / last, -1.0) : raw);
      }
    }
    return values;
  }

 private:
  Matrix localMatrix(const Json& node) const {
    Matrix matrix = identity();
    if (const Json* given = findMember(node, "matrix")) {
      for (size_t i = 0; i < 16; ++i) matrix[i] = realOf((*given)[i]);
      return matrix;
    }
    const Json* r = findMember(node, "rotation");
    const double x = r ? realOf((*r)[0]) : 0, y = r ? realOf((*r)[1]) : 0;
    const double z = r ? realOf((*r)[2]) : 0, w = r ? realOf((*r)[3]) : 1;
    const double rotation[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
        2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
        2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y)};
    for (size_t column = 0; column < 3; ++column) {
      const Json* scale = findMember(node, "scale");
      const Json* translation = findMember(node, "translation");
      for (size_t row = 0; row < 3; ++row) {
        matrix[4 * column + row] =
            rotation[3 * column + row] * (scale ? realOf((*scale)[column]) : 1);
      }
      if (translation) matrix[12 + column] = realOf((*translation)[column]);
    }
    return matrix;
  }

  Matrix globalMatrix(uint32_t node) const {
    Matrix matrix = localMatrix(document_.json["nodes"][node]);
    for (uint32_t up = parents_[node]; up != kNone; up = parents_[up]) {
      matrix = product(localMatrix(document_.json["nodes"][up]), matrix);
    }
    return matrix;
  }

  std::vector<double> morphed(const Json& primitive) const {
    std::vector<double> values = numbers(document_, primitive["attributes"]["POSITION"]);
    double weight = 0.37;
    for (const Json& target : arrayOf(primitive, "targets")) {
      if (const Json* position = findMember(target, "POSITION")) {
        const std::vector<double> deltas = numbers(document_, *position);
        for (size_t i = 0; i < values.size(); ++i) values[i] += weight * deltas[i];
      }
      weight *= -0.7;
    }
    return values;
  }

  std::vector<Matrix> jointMatrices(const Json& skin) const {
    std::vector<double> inverse;
    if (const Json* number = findMember(skin, "inverseBindMatrices"))
      inverse = numbers(document_, *number);
    std::vector<Matrix> matrices;
    for (const Json& joint : skin["joints"]) {
      Matrix bind = identity();
      if (!inverse.empty()) {
        std::copy_n(inverse.begin() + static_cast<ptrdiff_t>(16 * matrices.size()), 16,
                    bind.begin());
      }
      matrices.push_back(product(globalMatrix(joint), bind));
    }
    return matrices;
  }

  /// Returns for each vertex the matrix that places it.
  std::vector<Matrix> skinMatrices(const Json& skin, const Json& attributes, size_t count) const {
    const std::vector<Matrix> joints = jointMatrices(skin);
    std::vector<Matrix> matrices(count, Matrix{});
    for (const std::string set : {"0", "1"}) {
      if (!attributes.contains("JOINTS_" + set)) continue;
      const std::vector<double> used = numbers(document_, attributes["JOINTS_" + set]);
      const std::vector<double> weights = numbers(weights_, attributes["WEIGHTS_" + set]);
      for (size_t i = 0; i < 4 * count; ++i) {
        const Matrix& joint = joints[static_cast<size_t>(used[i])];
        for (size_t k = 0; k < 16; ++k) matrices[i / 4][k] += weights[i] * joint[k];
      }
    }
    return matrices;
  }

  std::vector<double> placesOf(uint32_t number, const Json& primitive) const {
    const Json& node = document_.json["nodes"][number];
    std::vector<double> places = morphed(primitive);
    std::vector<Matrix> matrices;
    if (const Json* skin = findMember(node, "skin")) {
      matrices = skinMatrices(document_.json["skins"][skin->get<size_t>()], primitive["attributes"],
                              places.size() / 3);
    } else {
      matrices.assign(places.size() / 3, globalMatrix(number));
    }
    for (size_t i = 0; i < matrices.size(); ++i) {
      const Matrix& m = matrices[i];
      double* p = &places[3 * i];
      const double x = p[0], y = p[1], z = p[2];
      for (size_t row = 0; row < 3; ++row)
        p[row] = m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row];
    }
    return places;
  }

  Document document_;
  Document weights_;
  bool is_ok_ = false;
  std::vector<uint32_t> parents_;
};

/// Returns the largest distance, along an axis, between the vertices of two documents, and the
/// largest coordinate. The second document may have more nodes than the first. The distance is
/// negative if they do not show the same vertices.
struct SceneDifference {
  double off = -1;
  double largest = 0;
};

inline SceneDifference compareScenes(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  SceneDifference difference;
  const SceneReader reader_a(a, nullptr);
  const SceneReader reader_b(b, &a);
  if (!reader_a.isOk() || !reader_b.isOk()) return difference;
  Document document;
  if (!loadDocument(a, nullptr, document).ok()) return difference;
  const size_t node_count = arrayOf(document.json, "nodes").size();
  const auto of_a = reader_a.positions(node_count);
  const auto of_b = reader_b.positions(node_count);
  if (of_a.size() != of_b.size()) return difference;
  double off = 0;
  for (const auto& [node, places] : of_a) {
    const auto other = of_b.find(node);
    if (other == of_b.end() || other->second.size() != places.size()) return difference;
    for (size_t i = 0; i < places.size(); ++i) {
      off = std::max(off, std::abs(places[i] - other->second[i]));
      difference.largest = std::max(difference.largest, std::abs(places[i]));
    }
  }
  difference.off = off;
  return difference;
}

}  // namespace mcc::gltf::test

#endif  // MCC_TESTS_GLTF_SCENE_POSITIONS_H_
