// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_ROOT_NODE_H_
#define MCC_TILES_ROOT_NODE_H_

#include <array>
#include <string>

#include "gltf/base/result.h"
#include "gltf/document/json.h"

namespace mcc::tiles {

/// Puts the nodes of each scene below a new node, which does what 3D Tiles 1.0 does around a glTF:
/// it turns the axis `up_axis` of the glTF up ("X", "Y" or "Z"; empty is "Y") and then moves the
/// model by `center`, whose z points up. Where that changes nothing, there is no new node.
/// Errors: no scene shows the nodes, or scenes share a part of their nodes.
gltf::Result addRootNode(const std::array<double, 3>& center, const std::string& up_axis,
                         gltf::Json& root);

}  // namespace mcc::tiles

#endif  // MCC_TILES_ROOT_NODE_H_
