// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// encode-digest FILE...: decodes payloads, encodes what they hold again, with lattices and exactly,
// and prints, for each, the CRC-32 of both new payloads or the error. Built for several machines by
// tools/check/machines: all must print the same.
#include <cstdio>
#include <vector>

#include "base/crc32.h"
#include "encoded_again.h"

namespace {

void printEncoded(const mcc::machines::DecodedPayload& decoded, uint8_t bits) {
  const mcc::machines::PieceViews pieces(decoded, bits);
  mcc::EncodeOptions options;
  mcc::EncodeResult result;
  const mcc::Status status = mcc::encode(pieces.views(), options, result);
  if (status.ok()) {
    std::printf(" %08x", static_cast<unsigned>(mcc::crc32(result.payload, 0)));
  } else {
    std::printf(" error %d", static_cast<int>(status.error));
  }
}

void printDigest(const char* name, const std::vector<uint8_t>& bytes) {
  mcc::machines::DecodedPayload decoded;
  if (!decoded.decode(bytes).ok()) return;
  std::printf("%s", name);
  printEncoded(decoded, 11);
  printEncoded(decoded, 0);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) { return mcc::machines::forEachFile(argc, argv, printDigest); }
