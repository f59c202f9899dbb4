// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What --to-glb changes in the JSON of tilesets: names of contents, and the version.
#ifndef MCC_TILES_TO_GLB_H_
#define MCC_TILES_TO_GLB_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mcc/gltf.h"

namespace mcc::tiles {

/// Returns the name under which a b3dm is stored, for a name, a URI or a template of URIs: x.b3dm
/// becomes x.glb. Empty for other names. Depends on the text alone, so that all parts of a tileset
/// agree; the rare b3dm that cannot become a GLB gets the name, too, which readers do not mind,
/// because they look at a content's first bytes.
std::optional<std::string> glbNameOf(std::string_view name);

/// Returns the JSON of a tileset with the URIs of its contents renamed, and with version 1.1 in
/// place of 1.0. Every other byte stays.
/// name  of the file in the folder of the tileset
/// Errors: those of readTilesetJson().
gltf::Result renameContents(const std::filesystem::path& folder, const std::string& name,
                            uint64_t max_tiles, std::vector<uint8_t>& json);

}  // namespace mcc::tiles

#endif  // MCC_TILES_TO_GLB_H_
