// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a GLB, or as the JSON and the buffer of one: decode, inspect, validate and convert
// must end with a file or with a message. Payloads in buffer views get the right checksum. What can
// be decoded must be decodable again after another compression.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "container/payload_header.h"
#include "fuzz/byte_feed.h"
#include "gltf/document/glb.h"
#include "json/json.h"
#include "mcc/glb.h"
#include "robustness/damage.h"

namespace mcc::gltf::test {
namespace {

uint64_t numberOr(const Json& object, const char* key, uint64_t otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() && *found >= 0 ? found->get<uint64_t>()
                                                                    : otherwise;
}

void repairPayloads(std::span<const uint8_t> text, std::vector<uint8_t>& bin) {
  Json json;
  if (!parseJson(text, json).ok() || !json.is_object()) return;
  const auto views = json.find("bufferViews");
  if (views == json.end() || !views->is_array()) return;
  for (const Json& view : *views) {
    if (!view.is_object()) continue;
    const uint64_t offset = numberOr(view, "byteOffset", 0);
    const uint64_t length = numberOr(view, "byteLength", 0);
    if (offset > bin.size() || length > bin.size() - offset || length < kChecksummedFrom) continue;
    if (bin[offset] != kMagic) continue;
    const auto begin = bin.begin() + static_cast<std::ptrdiff_t>(offset);
    std::vector<uint8_t> payload(begin, begin + static_cast<std::ptrdiff_t>(length));
    mcc::test::repairChecksum(payload);
    std::copy(payload.begin(), payload.end(), begin);
  }
}

/// [which][length of the JSON][JSON][buffer], or a GLB as it is.
std::vector<uint8_t> fileOf(const uint8_t* data, size_t size) {
  mcc::test::ByteFeed feed(data, size);
  if (size < 3 || data[0] != 1) return {data, data + size};
  feed.byte();
  const auto text = feed.take(feed.u16());
  const auto rest = feed.rest();
  std::vector<uint8_t> bin(rest.begin(), rest.end());
  repairPayloads(text, bin);
  const std::string json(text.begin(), text.end());
  std::vector<uint8_t> file;
  if (!writeGlb(json, bin, {}, file).ok()) return {};
  return file;
}

void requireMessage(const Result& result) {
  mcc::test::require(result.ok() || !result.message().empty(), "an error without a text");
}

}  // namespace
}  // namespace mcc::gltf::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace mcc::gltf;
  if (size > 1 << 16) return 0;
  const std::vector<uint8_t> file = test::fileOf(data, size);
  std::vector<uint8_t> decoded;
  DecodeReport decode_report;
  const Result result = decodeGlb(file, decoded, decode_report);
  test::requireMessage(result);
  InspectReport inspect_report;
  test::requireMessage(inspectGlb(file, true, inspect_report));
  ValidationReport validation;
  test::requireMessage(validateGlb(file, {}, validation));
  if (!result.ok()) return 0;
  std::vector<uint8_t> converted;
  ConvertOptions options;
  ConvertReport convert_report;
  const Result conversion = convertGlb(decoded, options, converted, convert_report);
  test::requireMessage(conversion);
  mcc::test::require(conversion.what.find("report this") == std::string::npos,
                     conversion.message());
  if (!conversion.ok()) return 0;
  mcc::test::require(decodeGlb(converted, decoded, decode_report).ok(),
                     "converted, it does not decode");
  return 0;
}
