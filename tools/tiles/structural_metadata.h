// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writes columns as a property table of EXT_structural_metadata.
#ifndef MCC_TILES_STRUCTURAL_METADATA_H_
#define MCC_TILES_STRUCTURAL_METADATA_H_

#include <cstdint>
#include <string>
#include <vector>

#include "tiles/batch_table.h"
#include "tiles/bin_end.h"

namespace mcc::tiles {

/// Returns an id for each name: letters, digits and underscores of ASCII, none twice. A name that
/// is such an id already keeps it, if the names differ.
std::vector<std::string> propertyIds(const std::vector<std::string>& names);

/// Adds the extension to the document, with one property table of `row_count` rows. There may be no
/// columns. The document must not have the extension; extensionsUsed is the caller's.
/// Errors: the values cannot be added, see BinEnd::addView(); `extensions` is not an object.
gltf::Result addPropertyTable(const BatchTable& table, uint64_t row_count, gltf::Json& root,
                              BinEnd& bin);

}  // namespace mcc::tiles

#endif  // MCC_TILES_STRUCTURAL_METADATA_H_
