// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Replaces the installed header in the WebAssembly decoder, whose caller sees only the number of an
// error. A status is that number, in a register.
#ifndef MCC_STATUS_H_
#define MCC_STATUS_H_

#include <cstdint>

#include "mcc/error.h"

namespace mcc {

struct [[nodiscard]] Status {
  Error error = Error::kOk;

  constexpr bool ok() const { return error == Error::kOk; }
};
constexpr Status fail(Error error, const char*, uint64_t = 0) { return Status{error}; }

}  // namespace mcc

#endif  // MCC_STATUS_H_
