/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0 */
#include <mcc/c_api.h>
#include <stdio.h>

int main(void) {
  printf("gltf-mcc %s\n", mcc_version());
  return 0;
}
