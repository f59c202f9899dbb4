// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/measure_meshlets.h"

#include <algorithm>
#include <utility>

#include "bench/codecs.h"
#include "bench/measure.h"

namespace mcc::bench {
namespace {

/// The triangles of a primitive as decoded, with the positions of the vertices of its piece.
struct DecodedPrimitive {
  std::span<const uint32_t> indices;
  size_t piece = 0;  ///< in DecodedFile::positions
};

struct DecodedFile {
  std::vector<DecodedUnit> units;
  std::vector<std::vector<float>> positions;  ///< one for each piece of each unit
  std::vector<DecodedPrimitive> primitives;

  foreign::MeshletMesh meshOf(const DecodedPrimitive& primitive) const {
    return {primitive.indices, positions[primitive.piece]};
  }
};

Outcome asOutcome(const Status& status) {
  return status.ok() ? Outcome{} : foreign::failure(status.what);
}

/// Encodes the triangles of all payloads without any attribute.
Outcome encodeTriangles(const Geometry& geometry, EncodedFile& encoded) {
  EncodeOptions options;
  options.prefer = geometry.prefer;
  options.block_triangles = geometry.block_triangles;
  options.indices_only = true;
  for (const PayloadInput& input : geometry.inputs) {
    std::vector<std::vector<AttributeView>> positions;
    for (const PieceInput& piece : input.pieces) {
      positions.emplace_back();
      for (const AttributeView& view : piece.source) {
        if (view.format.semantic == Semantic::kPosition && view.format.morph_target == 0)
          positions.back().push_back(view);
      }
    }
    std::vector<PieceView> views;
    for (size_t i = 0; i < positions.size(); ++i) {
      const PieceInput& piece = input.pieces[i];
      views.push_back({piece.wedge_count, positions[i], piece.parts});
    }
    encoded.payloads.emplace_back();
    if (Outcome done = asOutcome(encode(views, options, encoded.payloads.back())); !done.ok())
      return done;
  }
  return {};
}

/// Adds the seconds of a piece of code to `seconds`.
template <class Code>
Outcome addTime(double& seconds, const Code& code) {
  const double start = threadSeconds();
  Outcome done = code();
  seconds += threadSeconds() - start;
  return done;
}

/// Decodes all units; the arrays are freed after the clock was read.
Outcome decodeTimed(const EncodedFile& encoded, double& least, std::vector<DecodedUnit>& units) {
  units.clear();
  units.resize(encoded.unitCount());
  double seconds = 0;
  Outcome done = addTime(seconds, [&]() -> Outcome {
    for (size_t i = 0; i < units.size(); ++i) {
      if (Outcome decoded = decodeUnit(encoded, i, {}, units[i]); !decoded.ok()) return decoded;
    }
    return {};
  });
  least = least == 0 ? seconds : std::min(least, seconds);
  return done;
}

/// Returns the positions of a decoded piece as floats, whatever their type.
std::vector<float> positionsOf(const PieceInfo& info, const DecodedPiece& piece) {
  std::vector<float> positions;
  for (size_t k = 0; k < info.attributes.size(); ++k) {
    const AttributeFormat& format = info.attributes[k].format;
    if (format.semantic != Semantic::kPosition || format.morph_target != 0) continue;
    AttributeView view;
    view.format = format;
    view.data = piece.attributes[k].get();
    view.stride_bytes = elementBytes(format);
    for (uint32_t wedge = 0; wedge < info.wedge_count; ++wedge) {
      for (uint32_t c = 0; c < 3; ++c)
        positions.push_back(static_cast<float>(foreign::readComponent(view, wedge, c)));
    }
  }
  return positions;
}

Outcome listPrimitives(const EncodedFile& encoded, DecodedFile& decoded) {
  for (size_t unit = 0; unit < decoded.units.size(); ++unit) {
    Payload payload;
    if (Outcome done = asOutcome(payload.open(encoded.payloads[unit].payload)); !done.ok())
      return done;
    for (size_t i = 0; i < payload.info().pieces.size(); ++i) {
      const PieceInfo& info = payload.info().pieces[i];
      const DecodedPiece& piece = decoded.units[unit].pieces[i];
      for (size_t k = 0; k < info.parts.size(); ++k) {
        decoded.primitives.push_back(
            {{piece.parts[k].get(), size_t{3} * info.parts[k].triangle_count},
             decoded.positions.size()});
      }
      decoded.positions.push_back(positionsOf(info, piece));
    }
  }
  return {};
}

Outcome build(MeshletMaker maker, const foreign::MeshletMesh& mesh, simple::Meshlets& meshlets) {
  if (maker == MeshletMaker::kMeshopt) return foreign::buildMeshoptMeshlets(mesh, meshlets);
  MeshletOptions options;
  if (maker == MeshletMaker::kInOrder) options.shape = MeshletShape::kInOrder;
  const auto vertex_count = static_cast<uint32_t>(mesh.positions.size() / 3);
  return asOutcome(simple::buildMeshlets(mesh.indices, vertex_count, meshlets, options));
}

/// Makes the meshlets of all primitives, and measures how good they are outside of the time.
Outcome makeTimed(MeshletMaker maker, const DecodedFile& decoded, MeshletsMade& made) {
  made.figures = {};
  double seconds = 0;
  for (const DecodedPrimitive& primitive : decoded.primitives) {
    const foreign::MeshletMesh mesh = decoded.meshOf(primitive);
    simple::Meshlets meshlets;
    Outcome done = addTime(seconds, [&]() { return build(maker, mesh, meshlets); });
    if (!done.ok()) return done;
    foreign::addMeshletFigures(mesh, meshlets, made.figures);
  }
  made.seconds = made.seconds == 0 ? seconds : std::min(made.seconds, seconds);
  return {};
}

}  // namespace

Outcome measureMeshlets(const std::string& name, const Geometry& geometry, uint32_t run_count,
                        const std::function<void(const std::string&)>& progress,
                        MeshletsOfFile& figures) {
  figures = {};
  figures.name = name;
  progress(name + ": encode");
  EncodedFile whole;
  EncodedFile triangles;
  if (Outcome done = encodeFile(geometry, Codec::kMcc, whole); !done.ok()) return done;
  if (Outcome done = encodeTriangles(geometry, triangles); !done.ok()) return done;
  for (uint32_t run = 0; run < run_count; ++run) {
    progress(name + ": run " + std::to_string(run + 1) + " of " + std::to_string(run_count));
    DecodedFile decoded;
    if (Outcome done = decodeTimed(triangles, figures.indices_seconds, decoded.units); !done.ok())
      return done;
    if (Outcome done = decodeTimed(whole, figures.decode_seconds, decoded.units); !done.ok())
      return done;
    if (Outcome done = listPrimitives(whole, decoded); !done.ok()) return done;
    for (size_t maker = 0; maker < kMeshletMakerCount; ++maker) {
      Outcome done = makeTimed(static_cast<MeshletMaker>(maker), decoded, figures.makers[maker]);
      if (!done.ok()) return done;
    }
  }
  figures.triangle_count = figures.of(MeshletMaker::kRound).figures.triangle_count;
  return {};
}

}  // namespace mcc::bench
