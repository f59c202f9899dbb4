// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "suite.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "asset.h"
#include "container/payload_header.h"
#include "format_features.h"
#include "found.h"
#include "gltf/decompress/decompress.h"
#include "header_fields.h"
#include "mcc/glb.h"
#include "negatives.h"
#include "sources.h"

namespace mcc::conformance {
namespace {

constexpr uint64_t kCandidates = 2500;
constexpr uint32_t kTimes = 2;  ///< every feature is in this many assets, if there are candidates
constexpr size_t kAssetBytes = 24000;
constexpr const char* kLists[] = {"assets", "negative", "invalid"};  ///< also folders

struct Candidate {
  Asset asset;
  Features features;
};

/// At most 40 characters, without an underscore at the end.
std::string fileName(const std::string& name) {
  std::string file = slug(name).substr(0, 40);
  while (!file.empty() && file.back() == '_') file.pop_back();
  return file;
}

/// The payload of the specification's Appendix C.
Asset appendixC() {
  Asset asset;
  asset.name = "appendix_c";
  asset.shows = "The payload of Appendix C: two triangles, without attributes";
  asset.payload = {0x4b, 0x10, 0xc0, 0x84, 0xbe, 0x84, 0x01, 0x08, 0x04,
                   0x02, 0x01, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x02};
  NamedAttribute positions = makeAttribute("POSITION", kNone, "VEC3", ComponentType::kFloat32);
  for (uint32_t i = 0; i < 4; ++i) {
    positions.append(static_cast<float>(i % 2));
    positions.append(static_cast<float>(i / 2));
    positions.append(0.0f);
  }
  asset.pieces.push_back({{}, {positions}});
  return asset;
}

/// Adds padding before the streams, the first of which is `streams`.
void pad(Asset& asset, const std::string& streams, uint8_t count) {
  HeaderFields fields(asset.payload);
  fields.set("flags", fields.get("flags") | payload_flag::kPadded);
  fields.insertBefore(streams, "padding bytes", {count});
  fields.insertBefore(streams, "padding", Bytes(count, 0));
  asset.payload = fields.payload();
}

/// Changes that must not matter.
void addVariants(std::vector<Asset>& assets) {
  Asset padded = assets[0];
  padded.name = "padded";
  padded.shows = "Padding that nobody needs";
  pad(padded, "codes", 3);
  assets.push_back(padded);
  Asset later = assets[0];
  later.name = "later_minor_version";
  later.shows = "Version 1.15, without anything that is new in it";
  later.payload[kVersionOffset] = kVersionMajor << 4 | 15;
  repairChecksum(later.payload);
  assets.push_back(later);
}

void addAsset(std::vector<Candidate>& all, Asset asset) {
  Features features = featuresOf(asset.payload);
  all.push_back({std::move(asset), std::move(features)});
}

/// Takes candidates until every feature was met kTimes, preferring small ones that show much.
std::vector<Candidate> choose(std::vector<Candidate> candidates,
                              std::map<std::string, uint32_t> met) {
  std::vector<Candidate> chosen;
  while (true) {
    double best = 0;
    size_t best_at = 0;
    for (size_t i = 0; i < candidates.size(); ++i) {
      double gain = 0;
      for (const auto& [name, sections] : candidates[i].features) {
        const auto it = met.find(name);
        const uint32_t times = it == met.end() ? 0 : it->second;
        if (times < kTimes) gain += times == 0 ? 1 : 0.3;
      }
      gain /= static_cast<double>(candidates[i].asset.payload.size()) + 800;
      if (gain > best) {
        best = gain;
        best_at = i;
      }
    }
    if (best == 0) return chosen;
    std::string news;
    uint32_t news_count = 0;
    for (const auto& [name, sections] : candidates[best_at].features) {
      if (met[name]++ == 0 && ++news_count <= 6) news += (news.empty() ? "" : "; ") + name;
    }
    Candidate& taken = candidates[best_at];
    if (!news.empty()) taken.asset.shows += ": " + news;
    chosen.push_back(std::move(taken));
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best_at));
  }
}

std::vector<Candidate> makeCandidates() {
  std::vector<Asset> fixed;
  fixed.push_back(appendixC());
  addVariants(fixed);
  for (const Source& source : chosenSources()) fixed.push_back(encodeSource(source));
  std::vector<Candidate> all;
  std::map<std::string, uint32_t> met;
  for (Asset& asset : fixed) {
    addAsset(all, std::move(asset));
    for (const auto& [name, sections] : all.back().features) ++met[name];
  }
  std::vector<Candidate> random;
  for (uint64_t seed = 1; seed <= kCandidates; ++seed) {
    Asset asset = encodeSource(seed % 25 == 0 ? planarSource(seed) : randomSource(seed));
    if (asset.payload.size() > kAssetBytes) continue;
    addAsset(random, std::move(asset));
  }
  for (Candidate& candidate : choose(std::move(random), met)) all.push_back(std::move(candidate));
  return all;
}

bool decodes(const Bytes& payload) {
  gltf::DecodedPayload decoded;
  return gltf::decodePayload(payload, "", decoded).ok();
}

/// An exception says of a wedge what is the case without it: that it is new. So it is not in the
/// table when a later block looks for it, where it becomes another wedge. The encoder writes no
/// such exceptions; payloads with one about the wrong wedge do not decode.
Asset neverRepeated() {
  Asset asset = encodeSource(blockSources()[0]);
  asset.name = "blocks_never_repeated";
  asset.shows = "Blocks: a new wedge with an exception that it is new, which is so not repeated";
  PayloadHeader header{Allocator{}};
  if (!parsePayload(asset.payload, {}, header).ok()) throw std::runtime_error(asset.name);
  for (uint32_t wedge = 0; wedge < header.pieces[1].wedge_count; ++wedge) {
    for (uint32_t later = 2; later < header.blocks.size(); ++later) {
      HeaderFields fields(asset.payload);
      fields.set("block 1.exceptions", 1);
      fields.insertBefore("block 1.codes bytes", "block 1.skipped 0", varint(wedge));
      fields.insertBefore("block 1.codes bytes", "block 1.back 0", {0});
      const std::string repeated = "block " + std::to_string(later) + ".repeated";
      fields.set(repeated, fields.get(repeated) - 1);
      const Bytes payload = fields.payload();
      if (!decodes(payload)) continue;
      asset.payload = payload;
      return asset;
    }
  }
  throw std::runtime_error(asset.name + ": no wedge of block 1 is repeated later");
}

std::vector<Asset> assetsOf(const std::vector<Candidate>& candidates) {
  std::vector<Asset> assets;
  for (const Candidate& candidate : candidates) assets.push_back(candidate.asset);
  return assets;
}

/// Valid payloads that no writer makes.
void addFound(std::vector<Candidate>& candidates) {
  const std::vector<Asset> assets = assetsOf(candidates);
  for (const FoundPayload& found : kFoundValid) {
    const std::vector<uint8_t> payload = bytesOf(found.hex);
    Asset asset = closestTo(payload, assets);
    asset.name = found.name;
    asset.shows = found.shows;
    asset.payload = payload;
    addAsset(candidates, std::move(asset));
  }
}

/// Documents and headers that are written in another way than usual.
void addSpellings(std::vector<Candidate>& all) {
  Asset fractions = appendixC();
  fractions.name = "numbers_with_fractions";
  fractions.shows = "Integers of the JSON are written 1.0, as JSON allows";
  fractions.numbers_with_fractions = true;
  addAsset(all, std::move(fractions));
}

void addSources(std::vector<Candidate>& all) {
  for (const Source& source : addedSources()) addAsset(all, encodeSource(source));
  for (const Source& source : blockSources()) addAsset(all, encodeSource(source));
  Asset padded = encodeSource(blockSources()[0]);
  padded.name = "blocks_padded";
  padded.shows = "Blocks, and padding that nobody needs";
  pad(padded, "block 0.codes", 5);
  addAsset(all, std::move(padded));
  addAsset(all, neverRepeated());
}

/// Puts numbers before the names.
void numberNames(std::vector<Candidate>& all) {
  uint32_t number = 0;
  for (Candidate& candidate : all) {
    char prefix[8];
    std::snprintf(prefix, sizeof prefix, "%03u_", static_cast<unsigned>(++number));
    candidate.asset.name = prefix + fileName(candidate.asset.name);
  }
}

std::vector<uint8_t> asFile(const Json& manifest) {
  // One line for each asset: small differences of the suite are small differences of the file.
  std::string text = "{\n";
  bool first_member = true;
  for (const auto& [key, value] : manifest.items()) {
    text += std::string(first_member ? "" : ",\n") + "\"" + key + "\": ";
    first_member = false;
    if (!value.is_array()) {
      text += value.dump();
      continue;
    }
    text += "[\n";
    for (size_t i = 0; i < value.size(); ++i)
      text += "  " + value[i].dump() + (i + 1 < value.size() ? ",\n" : "\n");
    text += "]";
  }
  text += "\n}\n";
  return {text.begin(), text.end()};
}

std::vector<uint8_t> contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the existing manifest with the additions in `made`. Its lines stay, as their files do.
std::vector<uint8_t> extended(const std::vector<uint8_t>& there, const std::vector<uint8_t>& made) {
  if (there.empty()) return made;
  Json manifest, more;
  if (!gltf::parseJson(there, manifest).ok() || !gltf::parseJson(made, more).ok())
    throw std::runtime_error("the manifest is damaged");
  for (const char* const list : kLists) {
    std::set<std::string> known;
    for (const Json& entry : manifest[list]) known.insert(entry["file"].text());
    for (const Json& entry : more[list]) {
      if (known.insert(entry["file"].text()).second) manifest[list].push_back(entry);
    }
  }
  return asFile(manifest);
}

const char* kindOf(uint32_t error) {
  static const char* const kKinds[] = {"document",           "Truncated",   "BadMagic",
                                       "UnsupportedVersion", "BadChecksum", "BadHeader",
                                       "BadConnectivity",    "BadStitch",   "BadAttribute",
                                       "TrailingBytes",      "Limit"};
  return kKinds[error];
}

Json sectionsOf(const Negative& negative) {
  Json sections = {negative.section};
  if (negative.error != 0) sections.push_back("A.1.4");
  const bool is_stream_end = negative.error == static_cast<uint32_t>(Error::kTruncated) &&
                             negative.section.starts_with("A.3");
  if (is_stream_end) sections.push_back("A.1.4");
  return sections;
}

}  // namespace

Suite makeSuite() {
  std::vector<Candidate> candidates = makeCandidates();
  const std::vector<Asset> assets = assetsOf(candidates);  // from which negative ones are made
  addSources(candidates);
  addFound(candidates);
  for (const Source& source : rareSources()) addAsset(candidates, encodeSource(source));
  addSpellings(candidates);
  const auto addOfVersion11 = [&](const std::vector<Source>& sources) {
    for (const Source& source : sources) {
      Asset asset = encodeSource(source);
      const bool is_new = asset.payload[kVersionOffset] != kVersionMajor << 4;
      if (is_new) addAsset(candidates, std::move(asset));
    }
  };
  addOfVersion11(mirroredSources());
  addOfVersion11(tangentSources());
  addOfVersion11(matesSources());
  addOfVersion11(anchorSources());
  addOfVersion11(trainedSources());
  addOfVersion11(boundarySources());
  addOfVersion11(readingSources());
  numberNames(candidates);
  Suite suite;
  Json manifest = {{"extension", gltf::kExtensionName},
                   {"payloadVersion", "1.1"},
                   {"assets", Json::array()},
                   {"negative", Json::array()},
                   {"invalid", Json::array()}};
  std::set<std::string> features;
  size_t bytes = 0;
  for (const Candidate& candidate : candidates) {
    const std::string file = "assets/" + candidate.asset.name + ".glb";
    suite[file] = makeGlb(candidate.asset);
    bytes += suite[file].size();
    for (const auto& [name, sections] : candidate.features) features.insert(name);
    manifest["assets"].push_back({{"file", file},
                                  {"shows", candidate.asset.shows},
                                  {"spec", sectionsOf(candidate.features)},
                                  {"primitives", expectedOf(candidate.asset)}});
  }
  const std::vector<Negative> negatives = makeNegatives(assets, assetsOf(candidates));
  for (const Negative& negative : negatives) {
    const std::string file = "negative/" + negative.name + ".glb";
    suite[file] = negative.glb;
    bytes += negative.glb.size();
    manifest["negative"].push_back({{"file", file},
                                    {"shows", negative.shows},
                                    {"spec", sectionsOf(negative)},
                                    {"error", negative.error},
                                    {"kind", kindOf(negative.error)}});
  }
  for (const Invalid& invalid : makeInvalid(assets)) {
    const std::string file = "invalid/" + invalid.name + ".glb";
    suite[file] = invalid.glb;
    bytes += invalid.glb.size();
    manifest["invalid"].push_back(
        {{"file", file}, {"shows", invalid.shows}, {"rule", invalid.rule}, {"code", invalid.code}});
  }
  suite["manifest.json"] = asFile(manifest);
  std::printf("%zu assets, %zu negative ones, %zu features, %zu bytes, manifest %zu bytes\n",
              candidates.size(), negatives.size(), features.size(), bytes,
              suite["manifest.json"].size());
  return suite;
}

int writeSuite(const Suite& suite, const std::filesystem::path& folder) {
  for (const char* const part : kLists) {
    std::filesystem::create_directories(folder / part);
  }
  uint32_t added = 0;
  for (const auto& [name, made] : suite) {
    const bool is_manifest = name == "manifest.json";
    if (!is_manifest && std::filesystem::exists(folder / name)) continue;
    const std::vector<uint8_t> bytes =
        is_manifest ? extended(contentOf(folder / name), made) : made;
    std::ofstream file(folder / name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) {
      std::fprintf(stderr, "generate-conformance: cannot write %s\n", name.c_str());
      return 1;
    }
    added += is_manifest ? 0 : 1;
  }
  std::printf("%u files are new\n", added);
  return 0;
}

int checkSuite(const Suite& suite, const std::filesystem::path& folder) {
  uint32_t different = 0;
  for (const auto& [name, bytes] : suite) {
    if (contentOf(folder / name) == bytes) continue;
    std::printf("%s differs\n", name.c_str());
    ++different;
  }
  for (const char* const part : kLists) {
    for (const auto& entry : std::filesystem::directory_iterator(folder / part)) {
      const std::string name = std::string(part) + "/" + entry.path().filename().string();
      if (suite.contains(name)) continue;
      std::printf("%s is not generated\n", name.c_str());
      ++different;
    }
  }
  if (different != 0) std::printf("%u of %zu files differ\n", different, suite.size());
  return different == 0 ? 0 : 1;
}

}  // namespace mcc::conformance
