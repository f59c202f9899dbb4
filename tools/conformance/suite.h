// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TOOLS_CONFORMANCE_SUITE_H_
#define MCC_TOOLS_CONFORMANCE_SUITE_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace mcc::conformance {

/// Files by path within tests/conformance.
using Suite = std::map<std::string, std::vector<uint8_t>>;

/// Everything that is generated. Prints a summary.
Suite makeSuite();

/// Return exit statuses. writeSuite() adds what is missing, checkSuite() prints what differs.
int writeSuite(const Suite& suite, const std::filesystem::path& folder);
int checkSuite(const Suite& suite, const std::filesystem::path& folder);

}  // namespace mcc::conformance

#endif  // MCC_TOOLS_CONFORMANCE_SUITE_H_
