// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The flag of payloads whose models start trained, which minor version 1 added. [A.2.1, A.3.9]
#ifndef MCC_FORMAT_STARTS_H_
#define MCC_FORMAT_STARTS_H_

#include <cstdint>

namespace mcc::payload_flag {
inline constexpr uint32_t kTrained = 1u << 4;
}  // namespace mcc::payload_flag

#endif  // MCC_FORMAT_STARTS_H_
