// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "report_file.h"

#include "gltf/files/file_io.h"
#include "host/text.h"
#include "interrupt.h"
#include "json/json.h"

namespace mcc::tool {

using gltf::Json;

std::string printReport(const Json& json) {
  // Pure ASCII, so that control characters in names cannot reach a terminal.
  return json.dump(2, true) + "\n";
}

namespace {

gltf::Result ofReport(gltf::Result result) {
  if (!result.ok()) result.what = "the report cannot be written: " + result.what;
  return result;
}

}  // namespace

gltf::Result checkReport(const std::string& path) {
  return ofReport(gltf::checkWritable(gltf::pathOf(path)));
}

gltf::Result writeReport(const std::string& path, const std::string& text) {
  return ofReport(gltf::writeFile(gltf::pathOf(path),
                                  {reinterpret_cast<const uint8_t*>(text.data()), text.size()},
                                  &temporaryFiles()));
}

}  // namespace mcc::tool
