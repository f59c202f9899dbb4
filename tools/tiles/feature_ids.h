// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Turns the batch ids of primitives into feature ids of EXT_mesh_features.
#ifndef MCC_TILES_FEATURE_IDS_H_
#define MCC_TILES_FEATURE_IDS_H_

#include <cstdint>

#include "gltf/document/document.h"
#include "tiles/bin_end.h"

namespace mcc::tiles {

/// Makes the attribute _BATCHID (or BATCHID) of each primitive of `document` its _FEATURE_ID_0,
/// whose rows are those of property table 0. Accessors that feature ids cannot have are written
/// anew at the end of `bin`; the old ones stay. Coded primitives and views must have been decoded,
/// see gltf::decodeMeshes(). `has_ids` becomes whether there were any.
/// Errors: ids cannot be read, are not whole numbers below `batch_count`, or would clash with
/// feature ids that are there. The document is then unspecified.
gltf::Result convertBatchIds(uint64_t batch_count, gltf::Document& document, BinEnd& bin,
                             bool& has_ids);

}  // namespace mcc::tiles

#endif  // MCC_TILES_FEATURE_IDS_H_
