// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Replaces the installed header in the WebAssembly decoder, which has one heap. An allocator is an
// empty struct there, so that objects that hold one do not grow.
#ifndef MCC_ALLOCATOR_H_
#define MCC_ALLOCATOR_H_

#include <cstddef>

namespace mcc {

struct Allocator {};

}  // namespace mcc

#endif  // MCC_ALLOCATOR_H_
