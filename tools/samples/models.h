// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The sample models. Each is made by one function, with the same bytes on every platform.
#ifndef MCC_TOOLS_SAMPLES_MODELS_H_
#define MCC_TOOLS_SAMPLES_MODELS_H_

#include <span>

#include "glb_builder.h"

namespace mcc::samples {

struct Model {
  const char* file;
  const char* shows;  ///< a phrase for the table that is printed
  GlbBuilder (*build)();
};

/// Meshes whose edges have many faces, for `bench`. They are too large to be kept in the
/// repository.
std::span<const Model> soupModels();

/// Ten kinds of models that nothing in the codec was fitted on, for `bench`.
std::span<const Model> benchModels();

/// A surface of 20 million triangles, for `bench --blocks`.
std::span<const Model> largeModels();

}  // namespace mcc::samples

#endif  // MCC_TOOLS_SAMPLES_MODELS_H_
