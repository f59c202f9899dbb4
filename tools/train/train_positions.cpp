// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// train-positions MESH.glb..: fits the universal weights of the position predictor again
// (kUniversalWeights in lib/src/positions/tables.h) and prints the table. Each mesh is fitted at 11
// and 14 bits; an entry of the table is the median over the meshes that have enough vertices of the
// class. See tools/train/run.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "entropy/decoder_io.h"
#include "json/json.h"
#include "mcc/writer.h"
#include "positions/enc_fit.h"
#include "positions/enc_recording.h"
#include "reader/piece.h"

namespace {

using namespace mcc;

struct Mesh {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

/// Reads the indexed float triangles of a GLB without external buffers, sparse accessors or
/// strides, which is enough for training.
std::vector<Mesh> loadMeshes(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::vector<Mesh> meshes;
  if (bytes.size() < 28) return meshes;
  uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, bytes.data() + 12, 4);
  const auto json = gltf::Json::parse(bytes.substr(20, json_bytes));
  const std::string chunk = bytes.substr(28 + json_bytes);
  for (const auto& mesh : json["meshes"]) {
    for (const auto& primitive : mesh["primitives"]) {
      if (primitive.value("mode", 4) != 4 || !primitive.contains("indices")) continue;
      const auto& position = json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
      const auto& index = json["accessors"][primitive["indices"].get<size_t>()];
      if (position["componentType"] != 5126) continue;
      const auto start = [&](const gltf::Json& accessor) {
        const auto& view = json["bufferViews"][accessor["bufferView"].get<size_t>()];
        return chunk.data() + view.value("byteOffset", 0) + accessor.value("byteOffset", 0);
      };
      Mesh m;
      m.positions.resize(3 * position["count"].get<size_t>());
      std::memcpy(m.positions.data(), start(position), 4 * m.positions.size());
      m.indices.resize(index["count"].get<size_t>());
      const size_t width = index["componentType"] == 5125   ? 4
                           : index["componentType"] == 5123 ? 2
                                                            : 1;
      for (size_t i = 0; i < m.indices.size(); ++i) {
        m.indices[i] = 0;
        std::memcpy(&m.indices[i], start(index) + i * width, width);
      }
      meshes.push_back(std::move(m));
    }
  }
  return meshes;
}

template <bool kSingle>
bool fitOf(const PayloadHeader& header, PredictorWeights& weights,
           uint32_t (&vertices)[kPredictorClasses]) {
  auto models = std::make_unique<PayloadModels>();
  DecoderIo<kSingle> io(header.streams.codes, header.streams.tokens, header.streams.raw);
  PieceCoder<DecoderIo<kSingle>> piece(io, *models, header.pieces[0],
                                       header.attributesOf(header.pieces[0]), {});
  const PieceTruth nothing;
  if (!piece.codeConnectivity(nothing).ok() || !piece.codeStitch(nothing).ok() ||
      !piece.codePositions(nothing).ok()) {
    return false;
  }
  std::vector<int32_t> truth;
  for (size_t v = 0; v < piece.records.size(); ++v) {
    truth.insert(truth.end(), piece.records[v].q, piece.records[v].q + 3);
  }
  PositionRecording recording;
  if (!recording.record(piece.mesh, piece.groups, piece.records.data(), truth.data()).ok())
    return false;
  const PositionCandidate candidate{&recording, truth.data(), header.attributes[0].bits, {}};
  weights = fitWeights({&candidate, 1}, false, false, ~0u, {});
  for (const PositionRecording::Visit& visit : recording.visits()) {
    const uint32_t degree = recording.records()[visit.vertex].degree();
    if (visit.kind == static_cast<uint32_t>(PositionRecording::Kind::kPlain)) {
      ++vertices[kClassPlain - kLeastDegree + std::clamp(degree, kLeastDegree, kMostDegree)];
    } else if (visit.kind == static_cast<uint32_t>(PositionRecording::Kind::kAny)) {
      for (uint32_t c = 0; c < kClassPlain; ++c) ++vertices[c];
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr uint32_t kEnough = 100;  // vertices of a class that a mesh must have to count
  std::vector<int16_t> samples[kPredictorClasses][kMostWeights];
  for (int i = 1; i < argc; ++i) {
    for (const Mesh& mesh : loadMeshes(argv[i])) {
      for (const uint8_t bits : {uint8_t{11}, uint8_t{14}}) {
        AttributeView position;
        position.data = mesh.positions.data();
        position.stride_bytes = 12;
        position.quantization_bits = bits;
        const PartView part{mesh.indices};
        const PieceView piece{
            static_cast<uint32_t>(mesh.positions.size() / 3), {&position, 1}, {&part, 1}};
        EncodeResult encoded;
        PayloadHeader header{Allocator{}};
        PredictorWeights weights{};
        uint32_t vertices[kPredictorClasses] = {};
        if (!encode({&piece, 1}, {}, encoded).ok() ||
            !parsePayload(encoded.payload, {}, header).ok() ||
            !(header.singleCoder() ? fitOf<true>(header, weights, vertices)
                                   : fitOf<false>(header, weights, vertices))) {
          std::fprintf(stderr, "train-positions: cannot use %s\n", argv[i]);
          return 1;
        }
        for (uint32_t c = 0; c < kPredictorClasses; ++c) {
          if (vertices[c] < kEnough) continue;
          for (uint32_t k = 0; k < weightCount(c); ++k) samples[c][k].push_back(weights.w[c][k]);
        }
      }
    }
  }
  std::printf("inline constexpr PredictorWeights kUniversalWeights{{\n");
  for (uint32_t c = 0; c < kClassSelect; ++c) {
    std::printf("    {");
    for (uint32_t k = 0; k < weightCount(c); ++k) {
      std::vector<int16_t>& s = samples[c][k];
      std::sort(s.begin(), s.end());
      std::printf("%s%d", k == 0 ? "" : ", ", s.empty() ? 0 : s[s.size() / 2]);
    }
    std::printf("},\n");
  }
  std::printf("}};\n");
  return 0;
}
