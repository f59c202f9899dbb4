// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// convert IN OUT BACK: uses writer, document layer and C API together.
#include "mcc/c_api.h"
#include "mcc/files.h"
#include "mcc/writer.h"

#include <cstdio>

int main(int argument_count, char** arguments) {
  if (argument_count != 4) return 2;
  mcc::gltf::ConvertReport report;
  mcc::gltf::Result result = mcc::gltf::convertFile(arguments[1], arguments[2], {}, report);
  mcc::gltf::DecodeReport decode_report;
  if (result.ok()) result = mcc::gltf::decodeFile(arguments[2], arguments[3], decode_report);
  if (!result.ok()) std::printf("%s\n", result.message().c_str());
  mcc::EncodeResult encoded;
  const bool is_refused = mcc::encode({}, {}, encoded).error == mcc::Error::kBadArgument;
  std::printf("gltf-mcc %s: %u payloads\n", mcc_version(), decode_report.payload_count);
  return result.ok() && is_refused && decode_report.payload_count != 0 ? 0 : 1;
}
