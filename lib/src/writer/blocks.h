// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Writes a large piece as blocks.                                                          [A.11]
#ifndef MCC_WRITER_BLOCKS_H_
#define MCC_WRITER_BLOCKS_H_

#include "writer/plan.h"

namespace mcc {

/// Encodes the only piece of a payload as blocks, if the options ask for them and it cuts well.
/// Otherwise leaves `result.payload` empty and says why in `result.whole_because`.
Status encodeBlocks(const Plan& whole, const EncodeSettings& options, const Jobs& jobs,
                    EncodeResult& result);

}  // namespace mcc

#endif  // MCC_WRITER_BLOCKS_H_
