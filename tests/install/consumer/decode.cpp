// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "mcc/reader.h"

int main() {
  const uint8_t bytes[1] = {'K'};
  mcc::Payload payload;
  return payload.open(bytes).error == mcc::Error::kTruncated ? 0 : 1;
}
