// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_HOST_H_
#define MCC_BASE_HOST_H_

#include <bit>
#include <cfloat>

namespace mcc {

// glTF buffers are little-endian and so are all hosts this is built for; accessors are filled by memcpy.
static_assert(std::endian::native == std::endian::little, "big-endian hosts are not supported");
// The decoded bytes are the same everywhere only if float32 is rounded after every operation.
static_assert(FLT_EVAL_METHOD == 0, "build with SSE2 or an equivalent, not with x87 arithmetic");

}  // namespace mcc

/// For the few functions that every symbol passes through: gcc would leave them out of line at -O2.
#define MCC_ALWAYS_INLINE __attribute__((always_inline)) inline

#endif  // MCC_BASE_HOST_H_
