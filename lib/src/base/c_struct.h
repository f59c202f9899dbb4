// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Structures of the C API that may grow at their end: their first member, `struct_bytes`, says how
// much of a structure the caller knows. Here are also the checks of what C lets through and C++
// does not: numbers that are no flag or no enumerator.
#ifndef MCC_BASE_C_STRUCT_H_
#define MCC_BASE_C_STRUCT_H_

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <initializer_list>

#include "base/caller_memory.h"
#include "base/status.h"
#include "mcc/c_api.h"
#include "mcc/types.h"

namespace mcc {

inline mcc_status toC(const Status& status) {
  return {static_cast<int32_t>(status.error), status.what, status.offset_bytes};
}

inline mcc_status badArgument(const char* what) { return toC(fail(Error::kBadArgument, what)); }

/// Refuses numbers other than 0 and 1, which later versions may give a meaning.
inline Status checkFlags(std::initializer_list<uint32_t> flags) {
  for (const uint32_t flag : flags) {
    if (flag > 1) return fail(Error::kBadArgument, "a flag is neither 0 nor 1");
  }
  return {};
}

/// Whether the format of an attribute has only numbers that mcc::AttributeFormat can have.
inline bool isFormat(const mcc_attribute_format& format) {
  return format.semantic <= MCC_CUSTOM && format.set_index <= UINT8_MAX &&
         format.component_type <= MCC_FLOAT32 && isComponentCount(format.component_count) &&
         format.normalized <= 1 && format.morph_target <= UINT16_MAX;
}

/// Writes as much of the defaults as the caller's structure has room for.
template <class Struct>
void initStruct(Struct* out, size_t struct_bytes, Struct defaults) {
  if (out == nullptr || struct_bytes < sizeof(defaults.struct_bytes)) return;
  defaults.struct_bytes = struct_bytes;
  std::memcpy(static_cast<void*>(out), &defaults, std::min(struct_bytes, sizeof(Struct)));
}

/// Reads `given`, and uses `defaults` for members that the caller does not know. The size of a
/// structure in C is a multiple of its alignment; any other could end within a pointer.
template <class Struct>
Status readStruct(const Struct* given, Struct defaults, Struct& read) {
  read = defaults;
  if (given == nullptr) return {};
  if (given->struct_bytes < sizeof(given->struct_bytes)) {
    return fail(Error::kBadArgument,
                "options whose struct_bytes is not set; call their init function");
  }
  if (given->struct_bytes % alignof(Struct) != 0) {
    return fail(Error::kBadArgument,
                "options whose struct_bytes is not the size of a structure; pass their sizeof");
  }
  std::memcpy(static_cast<void*>(&read), given, std::min(given->struct_bytes, sizeof(Struct)));
  return {};
}

/// Fills as much of the caller's structure as it has room for, which its `struct_bytes` says, and
/// leaves `struct_bytes` as it is.
template <class Struct>
Status writeStruct(Struct info, Struct* out) {
  if (out->struct_bytes < sizeof(out->struct_bytes)) {
    return fail(Error::kBadArgument, "the struct_bytes of a structure to be filled is not set");
  }
  info.struct_bytes = out->struct_bytes;
  std::memcpy(static_cast<void*>(out), &info, std::min(out->struct_bytes, sizeof(Struct)));
  return {};
}

}  // namespace mcc

#endif  // MCC_BASE_C_STRUCT_H_
