// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "robustness/answers_io.h"

namespace mcc {
MCC_ALL_INSTANCES(, test::AnswersIo)
}  // namespace mcc
