// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Stands in for the installed header in the WebAssembly decoder, which has one heap: an allocator
// takes no memory in the objects that hold one.
#ifndef MCC_ALLOCATOR_H_
#define MCC_ALLOCATOR_H_

#include <cstddef>

namespace mcc {

struct Allocator {};

}  // namespace mcc

#endif  // MCC_ALLOCATOR_H_
