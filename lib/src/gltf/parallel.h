// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_PARALLEL_H_
#define MCC_GLTF_PARALLEL_H_

#include <cstddef>
#include <cstdint>
#include <functional>

#include "gltf/result.h"

namespace mcc::gltf {

/// Runs job(0) … job(count - 1) on up to `thread_count` threads. Returns the error of the lowest
/// job that failed; jobs behind it may or may not have run. Exceptions become errors.
Result runParallel(size_t count, uint32_t thread_count, const std::function<Result(size_t)>& job);

/// Runs a function; an exception that leaves it (out of memory) becomes an error.
Result guarded(const std::function<Result()>& function);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_PARALLEL_H_
