// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Content of 3D Tiles 1.0 as content of 3D Tiles 1.1.
#ifndef MCC_TILES_UPGRADE_H_
#define MCC_TILES_UPGRADE_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mcc/gltf.h"

namespace mcc::tiles {

/// Turns a b3dm into a GLB with the same content: batch ids become feature ids of
/// EXT_mesh_features, the batch table becomes a property table of EXT_structural_metadata with the
/// same values, and RTC_CENTER a node above those of each scene. JSON and bytes of the GLB inside
/// stay as they are otherwise, and in order; buffer 0 grows at its end.
///
/// `glb` stays empty, and `kept_because` says why in one line, where something has no exact
/// counterpart: among others glTF 1.0, a batch table hierarchy, columns of mixed types, objects in
/// the batch table, batch ids outside of it, or values that are not finite.
///
/// up_axis   gltfUpAxis of the tileset: "X", "Y", "Z", or empty for "Y". The GLB is right in a
///           tileset without gltfUpAxis, whichever it is.
/// decoders  reads batch ids that Draco or meshoptimizer coded. Without it such tiles are kept.
///
/// Errors: the b3dm, its GLB or its glTF is damaged; the GLB would have 4 GiB. Safe for untrusted
/// input; deterministic. Exceptions of memory pass through: see gltf::guarded(). Tests:
/// tests/tiles/upgrade_test.cpp.
gltf::Result upgradeB3dm(std::span<const uint8_t> b3dm, const std::string& up_axis,
                         std::vector<uint8_t>& glb, std::string& kept_because,
                         const gltf::ForeignDecoders& decoders = {});

}  // namespace mcc::tiles

#endif  // MCC_TILES_UPGRADE_H_
