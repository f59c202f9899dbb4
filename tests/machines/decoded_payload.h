// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the programs of tools/check/machines share: payloads from files, decoded into arrays.
#ifndef MCC_MACHINES_DECODED_PAYLOAD_H_
#define MCC_MACHINES_DECODED_PAYLOAD_H_

#include <cstdint>
#include <cstdio>
#include <vector>

#include "mcc/reader.h"

namespace mcc::machines {

/// The values and indices of a payload, by piece.
struct DecodedPayload {
  Payload payload;
  std::vector<std::vector<std::vector<uint8_t>>> values;
  std::vector<std::vector<std::vector<uint32_t>>> indices;

  Status decode(const std::vector<uint8_t>& bytes) {
    if (const Status status = payload.open(bytes); !status.ok()) return status;
    const auto pieces = payload.info().pieces;
    values.resize(pieces.size());
    indices.resize(pieces.size());
    std::vector<std::vector<AttributeTarget>> attribute_targets(pieces.size());
    std::vector<std::vector<PartTarget>> part_targets(pieces.size());
    std::vector<PieceTarget> targets;
    for (size_t p = 0; p < pieces.size(); ++p) {
      for (const AttributeInfo& a : pieces[p].attributes) {
        const size_t stride = elementBytes(a.format);
        values[p].emplace_back(stride * pieces[p].wedge_count);
        attribute_targets[p].push_back({values[p].back().data(), stride});
      }
      for (const PartInfo& part : pieces[p].parts) {
        indices[p].emplace_back(size_t{3} * part.triangle_count);
        part_targets[p].push_back({indices[p].back().data(), IndexType::kUint32});
      }
      targets.push_back({attribute_targets[p], part_targets[p]});
    }
    return payload.decode(targets);
  }
};

inline bool readFile(const char* path, std::vector<uint8_t>& bytes) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) return false;
  uint8_t buffer[4096];
  for (size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file)) != 0;) {
    bytes.insert(bytes.end(), buffer, buffer + n);
  }
  return std::fclose(file) == 0;
}

/// Calls print(name, bytes) for every file that is named. The status of main().
template <class Print>
int forEachFile(int argc, char** argv, Print print) {
  for (int i = 1; i < argc; ++i) {
    std::vector<uint8_t> bytes;
    if (!readFile(argv[i], bytes)) {
      std::fprintf(stderr, "cannot read %s\n", argv[i]);
      return 1;
    }
    const char* name = argv[i];
    for (const char* c = argv[i]; *c != '\0'; ++c) {
      if (*c == '/') name = c + 1;
    }
    print(name, bytes);
  }
  return 0;
}

}  // namespace mcc::machines

#endif  // MCC_MACHINES_DECODED_PAYLOAD_H_
