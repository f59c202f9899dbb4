// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The choices that the format leaves to the writer, tried on a counting coder.
#ifndef MCC_SRC_WRITER_CHOICES_H_
#define MCC_SRC_WRITER_CHOICES_H_

#include <vector>

#include "attributes/enc_variation.h"
#include "writer_plan.h"

namespace mcc {

/// Edges with more than two faces: joined in file order or cut apart, whichever is smaller.
Status choosePairing(Plan& plan, uint32_t start_half_edge, const Jobs& jobs);

/// The context set, predictors and methods, once the surface of every piece is settled.
Status chooseAll(std::vector<Plan>& plans, const EncodeSettings& options, const Jobs& jobs,
                 uint32_t& context_set);

/// Instead of chooseAll(), for tests: choices at random.
Status varyAll(std::vector<Plan>& plans, const EncodeSettings& options, Variation& variation,
               uint32_t& context_set);

}  // namespace mcc

#endif  // MCC_SRC_WRITER_CHOICES_H_
