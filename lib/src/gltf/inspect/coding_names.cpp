// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/inspect/coding_names.h"

#include "format/predictors.h"

namespace mcc::gltf {

std::string predictorName(AttributeInfos attributes, uint32_t index) {
  const MethodInfo& method = infoOf(methodOf(attributes, index));
  std::string name = method.word;
  for (const PredictorField& field : method) {
    const std::string word = field.value[field.valueOf(attributes[index].predictor)].word;
    if (!word.empty()) name += (name.empty() ? "" : ", ") + word;
  }
  return name;
}

}  // namespace mcc::gltf
