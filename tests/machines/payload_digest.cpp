// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// payload-digest FILE...: decodes payloads using only the reader, and prints for each a CRC-32 of
// every index and every element, or the error. tools/check/machines builds it for several machines;
// all must print the same.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "base/crc32.h"
#include "mcc/reader.h"

namespace {

bool readFile(const char* path, std::vector<uint8_t>& bytes) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) return false;
  uint8_t buffer[4096];
  for (size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file)) != 0;) {
    bytes.insert(bytes.end(), buffer, buffer + n);
  }
  return std::fclose(file) == 0;
}

uint32_t checksumOf(uint32_t before, const void* data, size_t bytes) {
  return mcc::crc32({static_cast<const uint8_t*>(data), bytes}, before);
}

void printDigest(const char* name, const std::vector<uint8_t>& bytes) {
  mcc::Payload payload;
  mcc::Status status = payload.open(bytes);
  uint32_t checksum = 0;
  if (status.ok()) {
    const auto pieces = payload.info().pieces;
    std::vector<std::vector<std::vector<uint8_t>>> values(pieces.size());
    std::vector<std::vector<std::vector<uint32_t>>> indices(pieces.size());
    std::vector<std::vector<mcc::AttributeTarget>> attribute_targets(pieces.size());
    std::vector<std::vector<mcc::PartTarget>> part_targets(pieces.size());
    std::vector<mcc::PieceTarget> targets;
    for (size_t p = 0; p < pieces.size(); ++p) {
      for (const mcc::AttributeInfo& a : pieces[p].attributes) {
        const size_t stride = mcc::elementBytes(a.format);
        values[p].emplace_back(stride * pieces[p].wedge_count);
        attribute_targets[p].push_back({values[p].back().data(), stride});
      }
      for (const mcc::PartInfo& part : pieces[p].parts) {
        indices[p].emplace_back(size_t{3} * part.triangle_count);
        part_targets[p].push_back({indices[p].back().data(), mcc::IndexType::kUint32});
      }
      targets.push_back({attribute_targets[p], part_targets[p]});
    }
    status = payload.decode(targets);
    for (size_t p = 0; p < pieces.size(); ++p) {
      for (const auto& v : values[p]) checksum = checksumOf(checksum, v.data(), v.size());
      for (const auto& i : indices[p]) checksum = checksumOf(checksum, i.data(), 4 * i.size());
    }
  }
  if (status.ok()) {
    std::printf("%s %08x\n", name, static_cast<unsigned>(checksum));
  } else {
    std::printf("%s error %d\n", name, static_cast<int>(status.error));
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    std::vector<uint8_t> bytes;
    if (!readFile(argv[i], bytes)) {
      std::fprintf(stderr, "payload-digest: cannot read %s\n", argv[i]);
      return 1;
    }
    const char* name = argv[i];
    for (const char* c = argv[i]; *c != '\0'; ++c) {
      if (*c == '/') name = c + 1;
    }
    printDigest(name, bytes);
  }
  return 0;
}
