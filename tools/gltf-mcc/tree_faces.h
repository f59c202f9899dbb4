// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOL_TREE_FACES_H_
#define MCC_TOOL_TREE_FACES_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace mcc::tool {

/// A triangle on the page.
struct FlatFace {
  std::array<double, 3> x;
  std::array<double, 3> y;
  std::string color;
};

/// Faces of one colour.
struct FaceGroup {
  std::string color;
  std::vector<uint32_t> faces;  ///< indices, from back to front
};

/// Groups faces, which are given from back to front, so that a picture that draws one group after
/// the other shows the same. A face joins an earlier group of its colour unless it covers a face
/// of a later group, so that there are much fewer groups than changes of the colour. Takes linear
/// time, because it looks only at a limited number of faces before each.
std::vector<FaceGroup> groupsOf(const std::vector<FlatFace>& faces);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TREE_FACES_H_
