// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Meshes with attributes of all kinds.
#ifndef MCC_TOOLS_CONFORMANCE_SOURCES_H_
#define MCC_TOOLS_CONFORMANCE_SOURCES_H_

#include <cstdint>
#include <vector>

#include "asset.h"

namespace mcc::conformance {

/// A plate with this many tunnels has a handle that puts a digon below 256 others, one more than is
/// allowed.
inline constexpr uint32_t kTooManyTunnels = 259;

/// Sources that show one thing each; all become assets.
std::vector<Source> chosenSources();

/// Sources of assets that came later; nothing that was there before depends on them.
std::vector<Source> addedSources();

/// Sources of assets with blocks. The first has positions on a lattice alone.
std::vector<Source> blockSources();

/// Branches of a decoder that nothing else enters.
std::vector<Source> rareSources();

/// Sources of version 1.1, with mirrors. The first has positions on a lattice alone.
std::vector<Source> mirroredSources();
std::vector<Source> anchorSources();
/// Sources of version 1.1 whose models start trained.
std::vector<Source> trainedSources();
/// Sources of version 1.1 that lie just beyond limits, and where rules meet that seldom do.
std::vector<Source> boundarySources();
/// Sources of version 1.1 for rules that somebody who wrote a decoder could read in two ways.
std::vector<Source> readingSources();
/// Sources of version 1.1, with normals and texture coordinates of mates.
std::vector<Source> matesSources();

/// Sources of assets of minor version 1: tangents that repeat, or lie in faces.
std::vector<Source> tangentSources();

/// A random source: surface, attributes, options. The same for the same seed on every machine.
Source randomSource(uint64_t seed);
/// The same of an isosurface whose positions may lie on planes.
Source planarSource(uint64_t seed);

}  // namespace mcc::conformance

#endif  // MCC_TOOLS_CONFORMANCE_SOURCES_H_
