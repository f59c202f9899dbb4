// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// variation-digest FILE...: decodes payloads, encodes what they hold again with choices made at
// random from fixed seeds, half of them with lattices and half exactly, decodes the results, and
// prints a CRC-32 of all new payloads and one of all that was decoded. tools/check/outputs compares
// them before and after a change of the code.
#include <cstdio>
#include <vector>

#include "base/crc32.h"
#include "encoded_again.h"
#include "writer/settings.h"

namespace {

constexpr uint64_t kVariations = 50;

/// Returns false if the reader refuses the payload.
bool addDecoded(const std::vector<uint8_t>& payload, uint32_t& crc) {
  mcc::machines::DecodedPayload decoded;
  if (!decoded.decode(payload).ok()) return false;
  for (const auto& piece : decoded.values) {
    for (const std::vector<uint8_t>& values : piece) crc = mcc::crc32(values, crc);
  }
  for (const auto& piece : decoded.indices) {
    for (const std::vector<uint32_t>& part : piece) {
      for (const uint32_t index : part) {
        const uint8_t bytes[] = {uint8_t(index), uint8_t(index >> 8), uint8_t(index >> 16),
                                 uint8_t(index >> 24)};
        crc = mcc::crc32(bytes, crc);
      }
    }
  }
  return true;
}

void printDigest(const char* name, const std::vector<uint8_t>& bytes) {
  mcc::machines::DecodedPayload decoded;
  if (!decoded.decode(bytes).ok()) return;
  const mcc::machines::PieceViews lattices(decoded, 11);
  const mcc::machines::PieceViews exact(decoded, 0);
  uint32_t payload_crc = 0;
  uint32_t decoded_crc = 0;
  uint32_t refused = 0;
  for (uint64_t variation = 1; variation <= kVariations; ++variation) {
    mcc::EncodeSettings settings;
    settings.variation = variation;
    const auto& views = variation % 2 != 0 ? lattices.views() : exact.views();
    mcc::EncodeResult result;
    if (!mcc::encodeWith(views, settings, result).ok() ||
        !addDecoded(result.payload, decoded_crc)) {
      ++refused;
    }
    payload_crc = mcc::crc32(result.payload, payload_crc);
  }
  std::printf("%s %u variations, %u refused: %08x %08x\n", name, unsigned{kVariations}, refused,
              payload_crc, decoded_crc);
}

}  // namespace

int main(int argc, char** argv) { return mcc::machines::forEachFile(argc, argv, printDigest); }
