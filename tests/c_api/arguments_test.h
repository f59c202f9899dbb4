/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0 */
#ifndef MCC_TESTS_C_API_ARGUMENTS_TEST_H_
#define MCC_TESTS_C_API_ARGUMENTS_TEST_H_

#include <stddef.h>
#include <stdint.h>

/* Calls every function with wrong arguments. `glb` can be compressed. Returns how many failed, each
 * of which was printed. */
int test_arguments(const uint8_t* glb, size_t glb_bytes);

#endif
