// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// encode-digest FILE...: decodes payloads, encodes what they hold again, with lattices and exactly,
// and prints, for each, the CRC-32 of both new payloads or the error. Built for several machines by
// tools/check/machines: all must print the same.
#include <cstdio>
#include <vector>

#include "base/crc32.h"
#include "decoded_payload.h"
#include "mcc/writer.h"

namespace {

void printEncoded(const mcc::machines::DecodedPayload& decoded, uint8_t bits) {
  const auto pieces = decoded.payload.info().pieces;
  std::vector<std::vector<mcc::AttributeView>> attributes(pieces.size());
  std::vector<std::vector<mcc::PartView>> parts(pieces.size());
  std::vector<mcc::PieceView> views;
  for (size_t p = 0; p < pieces.size(); ++p) {
    for (size_t a = 0; a < decoded.values[p].size(); ++a) {
      mcc::AttributeView view;
      view.format = pieces[p].attributes[a].format;
      view.data = decoded.values[p][a].data();
      view.stride_bytes = mcc::elementBytes(view.format);
      view.quantization_bits = bits;
      attributes[p].push_back(view);
    }
    for (const auto& i : decoded.indices[p]) parts[p].push_back({i});
    views.push_back({pieces[p].wedge_count, attributes[p], parts[p]});
  }
  mcc::EncodeOptions options;
  mcc::EncodeResult result;
  const mcc::Status status = mcc::encode(views, options, result);
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
