// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// generate-conformance FOLDER adds what is new to assets/, negative/ and manifest.json of the
// conformance suite in FOLDER. generate-conformance --check FOLDER compares what it would write
// with what is there.
#include <cstdio>
#include <cstring>
#include <exception>

#include "suite.h"

int main(int argc, char** argv) {
  const bool check = argc == 3 && std::strcmp(argv[1], "--check") == 0;
  if (!check && (argc != 2 || argv[1][0] == '-')) {
    std::fputs("usage: generate-conformance [--check] FOLDER\n", stderr);
    return 2;
  }
  try {
    const mcc::conformance::Suite suite = mcc::conformance::makeSuite();
    return check ? mcc::conformance::checkSuite(suite, argv[2])
                 : mcc::conformance::writeSuite(suite, argv[1]);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "generate-conformance: %s\n", exception.what());
    return 1;
  }
}
