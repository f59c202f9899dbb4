// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/measure_without.h"

#include <algorithm>
#include <iterator>

#include "bench/codecs.h"
#include "bench/measure.h"
#include "writer/settings.h"

namespace mcc::bench {
namespace {

/// Adds the features of "fold+shear". Returns false and sets `wrong` when a name is unknown.
bool parseTogether(std::string_view text, Ablation& ablation, std::string& wrong) {
  ablation.name = text;
  while (true) {
    const size_t plus = text.find('+');
    const std::string_view name = text.substr(0, plus);
    const auto* found = std::find_if(std::begin(kFeatures), std::end(kFeatures),
                                     [name](const FeatureInfo& f) { return f.name == name; });
    if (found == std::end(kFeatures)) {
      wrong = name;
      return false;
    }
    ablation.without.add(found->feature);
    if (plus == std::string_view::npos) return true;
    text.remove_prefix(plus + 1);
  }
}

/// Pieces with all of their attributes, which borrow from the geometry.
std::vector<std::vector<PieceInput>> allPieces(const Geometry& geometry) {
  std::vector<std::vector<PieceInput>> payloads;
  for (const gltf::EncodedPayload& payload : geometry.payloads) {
    std::vector<PieceInput>& pieces = payloads.emplace_back();
    for (const gltf::PiecePlan& piece : payload.plan.pieces) {
      pieces.push_back(makePiece(piece, true));
    }
  }
  return payloads;
}

foreign::Outcome encodeWithout(const std::vector<std::vector<PieceInput>>& payloads,
                               const EncodeSettings& settings, EncodedFile& encoded) {
  for (const std::vector<PieceInput>& pieces : payloads) {
    std::vector<PieceView> views;
    for (const PieceInput& piece : pieces) views.push_back(piece.view());
    encoded.payloads.emplace_back();
    const Status status = encodeWith(views, settings, encoded.payloads.back());
    if (!status.ok()) return foreign::failure(status.what);
  }
  return {};
}

foreign::Outcome timeDecode(const EncodedFile& encoded, double& least) {
  std::vector<DecodedUnit> units(encoded.unitCount());
  const double start = threadSeconds();
  for (size_t i = 0; i < units.size(); ++i) {
    if (foreign::Outcome done = decodeUnit(encoded, i, {}, units[i]); !done.ok()) return done;
  }
  const double seconds = threadSeconds() - start;
  least = least == 0 ? seconds : std::min(least, seconds);
  return {};
}

bool areEqual(const EncodedFile& a, const EncodedFile& b) {
  return std::equal(a.payloads.begin(), a.payloads.end(), b.payloads.begin(), b.payloads.end(),
                    [](const auto& x, const auto& y) { return x.payload == y.payload; });
}

}  // namespace

std::string parseAblations(std::string_view text, std::vector<Ablation>& ablations) {
  ablations.clear();
  if (text == "all") {
    for (const FeatureInfo& feature : kFeatures) {
      ablations.push_back({std::string(feature.name), {}});
      ablations.back().without.add(feature.feature);
    }
    return "";
  }
  std::string wrong;
  while (true) {
    const size_t comma = text.find(',');
    if (!parseTogether(text.substr(0, comma), ablations.emplace_back(), wrong)) return wrong;
    if (comma == std::string_view::npos) return "";
    text.remove_prefix(comma + 1);
  }
}

std::string featureNames() {
  std::string names;
  for (const FeatureInfo& feature : kFeatures) {
    if (!names.empty()) names += ", ";
    names += feature.name;
  }
  return names;
}

foreign::Outcome measureWithout(const std::string& name, const Geometry& geometry,
                                const std::vector<Ablation>& ablations, uint32_t run_count,
                                const std::function<void(const std::string&)>& progress,
                                WithoutFigures& figures) {
  figures = {};
  figures.name = name;
  figures.triangle_count = geometry.triangle_count;
  const std::vector<std::vector<PieceInput>> payloads = allPieces(geometry);
  EncodeSettings settings;
  settings.prefer = geometry.prefer;
  settings.block_triangles = geometry.block_triangles;
  EncodedFile full;
  if (auto done = encodeWithout(payloads, settings, full); !done.ok()) return done;
  figures.full_bytes = full.bytes();
  for (const Ablation& ablation : ablations) {
    progress(name + ": without " + ablation.name);
    settings.without = ablation.without;
    EncodedFile reduced;
    if (auto done = encodeWithout(payloads, settings, reduced); !done.ok()) return done;
    AblationFigures& row = figures.ablations.emplace_back();
    row.bytes = reduced.bytes();
    if (areEqual(full, reduced)) continue;
    for (uint32_t run = 0; run < run_count; ++run) {
      if (auto done = timeDecode(full, row.full_decode_seconds); !done.ok()) return done;
      if (auto done = timeDecode(reduced, row.decode_seconds); !done.ok()) return done;
    }
  }
  return {};
}

}  // namespace mcc::bench
