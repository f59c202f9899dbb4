// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_TILE_URI_H_
#define MCC_TILES_TILE_URI_H_

#include <string>

#include "mcc/result.h"

namespace mcc::tiles {

/// Finds the file that a URI in a file of the tileset names, relative to the folder of the tileset.
/// base  the file with the URI, relative to that folder
/// is_remote  becomes true for what is on a server or in a data URI; `path` is then unspecified.
/// Errors: it is not a file in the folder.
gltf::Result resolveTileUri(const std::string& base, std::string uri, std::string& path,
                            bool& is_remote);

}  // namespace mcc::tiles

#endif  // MCC_TILES_TILE_URI_H_
