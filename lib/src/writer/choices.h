// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The choices that the format leaves to the writer, tried on a counting coder.
#ifndef MCC_WRITER_CHOICES_H_
#define MCC_WRITER_CHOICES_H_

#include <vector>

#include "positions/enc_prices.h"
#include "writer/plan.h"
#include "writer/variation.h"

namespace mcc {

/// Chooses how to code a surface that is not a manifold: cut and stitched, or listed vertex by
/// vertex. If `variation` is not null, it chooses one of them at random.
Status chooseSurface(Plan& plan, uint32_t start_half_edge, const FeatureSet& without,
                     Variation* variation, const TimePrice& price, const Jobs& jobs);

/// Chooses predictors and methods, after the surface of every piece is settled.
Status chooseAll(std::vector<Plan>& plans, const EncodeSettings& options, const Jobs& jobs);

/// Chooses at random instead of chooseAll(), for tests.
Status varyAll(std::vector<Plan>& plans, Variation& variation, const FeatureSet& without);

}  // namespace mcc

#endif  // MCC_WRITER_CHOICES_H_
