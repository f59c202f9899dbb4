// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// write-fuzz-seeds DIR: writes initial inputs for every target to DIR/TARGET/. They are the same
// each time.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "container/payload_header.h"
#include "fuzz/byte_feed.h"
#include "gltf/document/glb.h"
#include "mcc/glb.h"
#include "robustness/payloads.h"
#include "support/mesh_generators.h"

namespace mcc::test {
namespace {

class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {
    for (const char* target : {"payload", "codes", "entropy", "roundtrip", "glb", "json"}) {
      std::filesystem::create_directories(folder_ / target);
    }
  }
  void add(const std::string& target, const std::vector<uint8_t>& bytes) {
    std::ofstream out(folder_ / target / std::to_string(count_++), std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  }

 private:
  std::filesystem::path folder_;
  size_t count_ = 0;
};

void append(std::vector<uint8_t>& to, std::span<const uint8_t> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}
void append16(std::vector<uint8_t>& to, size_t value) {
  to.push_back(static_cast<uint8_t>(value & 255));
  to.push_back(static_cast<uint8_t>(value >> 8 & 255));
}

void addPayloads(Seeds& seeds) {
  for (const NamedPayload& payload : robustnessPayloads()) {
    if (payload.bytes.size() > 3000) continue;
    seeds.add("payload", payload.bytes);
    PayloadHeader header{Allocator{}};
    if (!parsePayload(payload.bytes, {}, header).ok()) continue;
    std::vector<uint8_t> script;
    Random random(payload.bytes.size());
    for (uint32_t i = 0; i < 300; ++i) script.push_back(static_cast<uint8_t>(random.below(256)));
    std::vector<uint8_t> reads = {static_cast<uint8_t>(header.singleCoder() ? 1 : 0)};
    append16(reads, script.size());
    append16(reads, header.streams.codes.size());
    append16(reads, header.streams.tokens.size());
    append(reads, script);
    append(reads, header.streams.codes);
    append(reads, header.streams.tokens);
    append(reads, header.streams.raw);
    seeds.add("entropy", reads);
  }
}

void addRandom(Seeds& seeds) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    std::vector<uint8_t> codes;
    append16(codes, random.between(1, 60));
    append16(codes, 4000);
    append16(codes, 8000);
    codes.push_back(static_cast<uint8_t>(random.below(4)));
    for (uint32_t i = 0; i < 200; ++i) {
      codes.push_back(static_cast<uint8_t>(random.below(256) & random.below(256)));
    }
    seeds.add("codes", codes);
    std::vector<uint8_t> mesh;
    for (uint32_t i = 0; i < 400; ++i) mesh.push_back(static_cast<uint8_t>(random.below(256)));
    mesh[0] = static_cast<uint8_t>(seed);
    seeds.add("roundtrip", mesh);
  }
}

/// The samples, compressed and as they are; both forms that the target takes.
void addSamples(Seeds& seeds) {
  for (const char* name :
       {"torus", "moebius", "morphed", "skinned", "two_materials", "quantized"}) {
    std::ifstream in(std::string(MCC_SAMPLES_DIR "/") + name + ".glb", std::ios::binary);
    const std::vector<char> chars((std::istreambuf_iterator<char>(in)), {});
    const std::vector<uint8_t> source(chars.begin(), chars.end());
    std::vector<uint8_t> file;
    gltf::ConvertReport report;
    if (!gltf::convertGlb(source, {}, file, report).ok()) continue;
    seeds.add("glb", file);
    gltf::GlbFile glb;
    if (!gltf::readGlb(file, glb).ok()) continue;
    std::vector<uint8_t> version3;
    const std::string text(glb.json.begin(), glb.json.end());
    if (gltf::writeGlb(text, glb.bin, {}, version3, 3).ok()) seeds.add("glb", version3);
    seeds.add("json", {glb.json.begin(), glb.json.end()});
    std::vector<uint8_t> parts = {1};
    append16(parts, glb.json.size());
    parts.insert(parts.end(), glb.json.begin(), glb.json.end());
    append(parts, glb.bin);
    seeds.add("glb", parts);
  }
}

}  // namespace
}  // namespace mcc::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write-fuzz-seeds DIR\n");
    return 2;
  }
  mcc::test::Seeds seeds(argv[1]);
  mcc::test::addPayloads(seeds);
  mcc::test::addRandom(seeds);
  mcc::test::addSamples(seeds);
  return 0;
}
