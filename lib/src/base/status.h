// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_BASE_STATUS_H_
#define MCC_BASE_STATUS_H_

#include "mcc/status.h"  // IWYU pragma: export

/// Returns early with the status of `expression` unless it is ok.
#define MCC_TRY(expression)                         \
  do {                                              \
    const ::mcc::Status mcc_status_ = (expression); \
    if (!mcc_status_.ok()) return mcc_status_;      \
  } while (false)

#endif  // MCC_BASE_STATUS_H_
