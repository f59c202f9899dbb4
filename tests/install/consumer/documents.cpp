// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// documents IN OUT: a program that uses only the document layer.
#include "mcc/files.h"

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  mcc::gltf::ConvertReport report;
  return mcc::gltf::convertFile(arguments[1], arguments[2], {}, report).ok() ? 0 : 1;
}
