// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/codecs.h"

#include <algorithm>

namespace mcc::bench {
namespace {

/// Prepends the number of the primitive to a message.
Outcome inPrimitive(size_t number, Outcome outcome) {
  if (!outcome.ok())
    outcome.message = "primitive " + std::to_string(number) + ": " + outcome.message;
  return outcome;
}

int dracoSpeed(Codec codec) {
  switch (codec) {
    case Codec::kDraco3: return 3;
    case Codec::kDraco5: return 5;
    default: return 0;
  }
}

Outcome fromStatus(const Status& status) {
  return status.ok() ? Outcome{} : foreign::failure(status.what);
}

Outcome encodeDracoPrimitive(const PrimitiveInput& primitive, Codec codec, EncodedFile& encoded) {
  foreign::DracoInput input;
  Outcome made = foreign::makeDracoInput(primitive.piece->view(), primitive.part, input);
  if (!made.ok()) return made;
  encoded.draco.emplace_back();
  return foreign::encodeDraco(input, dracoSpeed(codec), encoded.draco.back());
}

/// labels  of the attributes of all pieces of the payload.
void addOurStreams(const StreamSizes& sizes, const std::vector<std::string>& labels,
                   std::vector<Stream>& streams) {
  addStream(streams, "connectivity", sizes.connectivity_bits);
  addStream(streams, "stitching", sizes.stitch_bits);
  addStream(streams, "leftovers", sizes.leftover_bits);
  addStream(streams, "seams", sizes.seam_bits);
  addStream(streams, "POSITION", sizes.position_bits);
  for (size_t i = 0; i < std::min(labels.size(), sizes.attribute_bits.size()); ++i) {
    addStream(streams, labels[i], sizes.attribute_bits[i]);
  }
  addStream(streams, "order", sizes.order_bits);
  addStream(streams, "header", sizes.header_bits);
}

Outcome addDracoStreams(const PrimitiveInput& primitive, Codec codec,
                        const foreign::DracoEncoded& encoded, std::vector<Stream>& streams) {
  foreign::DracoInput input;
  Outcome done = foreign::makeDracoInput(primitive.piece->view(), primitive.part, input);
  if (!done.ok()) return done;
  foreign::DracoConnectivity alone;
  done = foreign::encodeDracoConnectivity(input, dracoSpeed(codec), alone);
  if (!done.ok()) return done;
  const auto bits = [](size_t bytes) { return 8 * static_cast<double>(bytes); };
  addStream(streams, "connectivity", bits(alone.connectivity_bytes));
  addStream(streams, "seams",
            bits(encoded.streams.connectivity_bytes) - bits(alone.connectivity_bytes));
  for (size_t i = 0; i < input.attributes.size(); ++i) {
    addStream(streams, primitive.piece->labels[input.attributes[i].piece_attribute],
              bits(encoded.streams.attribute_bytes[i]));
  }
  addStream(streams, "header", bits(encoded.streams.header_bytes));
  return {};
}

void addMeshoptStreams(const PrimitiveInput& primitive, const foreign::MeshoptEncoded& encoded,
                       std::vector<Stream>& streams) {
  addStream(streams, "connectivity", 8 * static_cast<double>(encoded.index_bytes));
  for (const foreign::MeshoptStream& stream : encoded.streams) {
    addStream(streams, primitive.piece->labels[stream.piece_attribute],
              8 * static_cast<double>(stream.bytes));
  }
  addStream(streams, "zstd",
            8 * (static_cast<double>(encoded.zstd_bytes.size()) -
                 static_cast<double>(encoded.bytes.size())));
}

Outcome decodeOurs(std::span<const uint8_t> bytes, const Allocator& allocator,
                   const RunJobs& run_jobs, DecodedUnit& decoded) {
  Payload payload;
  if (Outcome done = fromStatus(payload.open(bytes, {}, allocator)); !done.ok()) return done;
  const std::span<const PieceInfo> infos = payload.info().pieces;
  std::vector<std::vector<AttributeTarget>> attributes(infos.size());
  std::vector<std::vector<PartTarget>> parts(infos.size());
  std::vector<PieceTarget> targets(infos.size());
  decoded.pieces.resize(infos.size());
  for (size_t i = 0; i < infos.size(); ++i) {
    DecodedPiece& piece = decoded.pieces[i];
    for (const AttributeInfo& attribute : infos[i].attributes) {
      const size_t stride = elementBytes(attribute.format);
      const size_t size = infos[i].wedge_count * stride;
      piece.attributes.push_back(std::make_unique_for_overwrite<std::byte[]>(size));
      attributes[i].push_back({piece.attributes.back().get(), stride});
      decoded.array_bytes += size;
    }
    for (const PartInfo& part : infos[i].parts) {
      const size_t count = size_t{3} * part.triangle_count;
      piece.parts.push_back(std::make_unique_for_overwrite<uint32_t[]>(count));
      parts[i].push_back({piece.parts.back().get(), IndexType::kUint32});
      decoded.array_bytes += count * sizeof(uint32_t);
      decoded.triangle_count += part.triangle_count;
    }
    decoded.vertex_count += infos[i].wedge_count;
    targets[i] = {attributes[i], parts[i]};
  }
  DecodeOptions options;
  options.allocator = allocator;
  options.run_jobs = runnerOf(run_jobs);
  return fromStatus(payload.decode(targets, options));
}

void countMesh(DecodedUnit& decoded) {
  const foreign::DecodedMesh& mesh = decoded.mesh;
  decoded.triangle_count = mesh.triangle_count;
  decoded.vertex_count = mesh.vertex_count;
  decoded.array_bytes = uint64_t{mesh.triangle_count} * 3 * sizeof(uint32_t);
  for (const foreign::DecodedAttribute& attribute : mesh.attributes) {
    decoded.array_bytes += uint64_t{mesh.vertex_count} * attribute.elementBytes();
  }
}

void addError(const std::string& name, const foreign::AttributeError& error,
              std::vector<NamedError>& errors) {
  auto found = std::find_if(errors.begin(), errors.end(), [&](const NamedError& known) {
    return known.name == name && known.is_angle == error.is_angle;
  });
  if (found == errors.end()) {
    errors.push_back({name, error.is_angle, 0, 0, 0});
    found = errors.end() - 1;
  }
  found->maximum = std::max(found->maximum, error.maximum);
  const double count = static_cast<double>(found->measured_count);
  const double more = error.measured_count;
  if (more > 0) found->median = (found->median * count + error.median * more) / (count + more);
  found->measured_count += error.measured_count;
}

Outcome addOurErrors(const PayloadInput& input, const EncodeResult& result,
                     const DecodedUnit& decoded, std::vector<NamedError>& errors) {
  for (size_t i = 0; i < input.pieces.size(); ++i) {
    const PieceInput& piece = input.pieces[i];
    for (size_t k = 0; k < piece.source.size(); ++k) {
      foreign::AttributeError error;
      Outcome done = foreign::measureError(
          piece.source[k], piece.wedge_count, piece.source[k].format.component_type,
          decoded.pieces[i].attributes[k].get(), result.pieces[i].source_wedge, error);
      if (!done.ok()) return done;
      addError(piece.labels[k], error, errors);
    }
  }
  return {};
}

Outcome addDracoErrors(const PrimitiveInput& primitive, const DecodedUnit& decoded,
                       std::vector<NamedError>& errors, uint64_t& lost_wedges) {
  foreign::DracoInput input;
  Outcome done = foreign::makeDracoInput(primitive.piece->view(), primitive.part, input);
  if (!done.ok()) return done;
  foreign::DracoErrors measured;
  done = foreign::measureDracoErrors(input, decoded.mesh, measured);
  if (!done.ok()) return done;
  if (measured.unmatched_vertex_count != 0) {
    return foreign::failure(std::to_string(measured.unmatched_vertex_count) +
                            " decoded vertices are not in the source's");
  }
  lost_wedges += measured.missing_wedge_count;
  for (size_t i = 0; i < input.attributes.size(); ++i) {
    addError(primitive.piece->labels[input.attributes[i].piece_attribute], measured.attributes[i],
             errors);
  }
  return {};
}

Outcome addMeshoptErrors(const PrimitiveInput& primitive, const foreign::MeshoptEncoded& encoded,
                         const DecodedUnit& decoded, std::vector<NamedError>& errors,
                         uint64_t& lost_wedges) {
  std::vector<foreign::AttributeError> measured;
  Outcome done =
      foreign::measureMeshoptErrors(primitive.piece->view(), encoded, decoded.mesh, measured);
  if (!done.ok()) return done;
  for (size_t i = 0; i < measured.size(); ++i) {
    addError(primitive.piece->labels[encoded.streams[i].piece_attribute], measured[i], errors);
  }
  std::vector<bool> is_used(primitive.piece->wedge_count, false);
  for (const uint32_t index : primitive.piece->parts[primitive.part].indices) is_used[index] = true;
  for (size_t wedge = 0; wedge < is_used.size(); ++wedge) {
    if (is_used[wedge] && encoded.wedge_vertex[wedge] == kNone) ++lost_wedges;
  }
  return {};
}

}  // namespace

const char* codecName(Codec codec) {
  static constexpr const char* kNames[] = {"mcc", "draco 0", "draco 3", "draco 5", "meshopt+zstd"};
  return kNames[indexOf(codec)];
}

const char* codecKey(Codec codec) {
  static constexpr const char* kKeys[] = {"mcc", "draco_0", "draco_3", "draco_5", "meshopt_zstd"};
  return kKeys[indexOf(codec)];
}

void addStream(std::vector<Stream>& streams, const std::string& name, double bits) {
  for (Stream& stream : streams) {
    if (stream.name != name) continue;
    stream.bits += bits;
    return;
  }
  streams.push_back({name, bits});
}

double streamBits(const std::vector<Stream>& streams, const std::string& name) {
  for (const Stream& stream : streams) {
    if (stream.name == name) return stream.bits;
  }
  return 0;
}

uint64_t EncodedFile::bytes() const {
  uint64_t sum = 0;
  for (const EncodeResult& unit : payloads) sum += unit.payload.size();
  for (const foreign::DracoEncoded& unit : draco) sum += unit.bytes.size();
  for (const foreign::MeshoptEncoded& unit : meshoptimizer) sum += unit.zstd_bytes.size();
  return sum;
}

Outcome encodeOurs(const Geometry& geometry, const OurBlocks& blocks, EncodedFile& encoded) {
  EncodeOptions options;
  options.prefer = geometry.prefer;
  options.block_triangles = blocks.block_triangles;
  options.run_jobs = blocks.run_jobs;
  for (const PayloadInput& input : geometry.inputs) {
    std::vector<PieceView> views;
    for (const PieceInput& piece : input.pieces) views.push_back(piece.view());
    encoded.payloads.emplace_back();
    if (Outcome done = fromStatus(encode(views, options, encoded.payloads.back())); !done.ok())
      return done;
  }
  return {};
}

Outcome encodeFile(const Geometry& geometry, Codec codec, EncodedFile& encoded) {
  encoded = {};
  encoded.codec = codec;
  if (codec == Codec::kMcc) return encodeOurs(geometry, {geometry.block_triangles, {}}, encoded);
  const std::vector<PrimitiveInput> primitives = primitivesOf(geometry);
  for (size_t i = 0; i < primitives.size(); ++i) {
    Outcome done;
    if (isDraco(codec)) {
      done = encodeDracoPrimitive(primitives[i], codec, encoded);
    } else {
      encoded.meshoptimizer.emplace_back();
      done = foreign::encodeMeshopt(primitives[i].piece->view(), primitives[i].part, {},
                                    encoded.meshoptimizer.back());
    }
    if (!done.ok()) return inPrimitive(i, done);
  }
  return {};
}

Outcome streamsOf(const Geometry& geometry, const EncodedFile& encoded,
                  std::vector<Stream>& streams) {
  streams.clear();
  if (encoded.codec == Codec::kMcc) {
    for (size_t i = 0; i < encoded.payloads.size(); ++i) {
      std::vector<std::string> labels;
      for (const PieceInput& piece : geometry.inputs[i].pieces) {
        labels.insert(labels.end(), piece.labels.begin(), piece.labels.end());
      }
      addOurStreams(encoded.payloads[i].sizes, labels, streams);
    }
    return {};
  }
  const std::vector<PrimitiveInput> primitives = primitivesOf(geometry);
  for (size_t i = 0; i < primitives.size(); ++i) {
    if (encoded.codec == Codec::kMeshopt) {
      addMeshoptStreams(primitives[i], encoded.meshoptimizer[i], streams);
    } else {
      Outcome done = addDracoStreams(primitives[i], encoded.codec, encoded.draco[i], streams);
      if (!done.ok()) return inPrimitive(i, done);
    }
  }
  return {};
}

void fullStreams(const Geometry& geometry, std::vector<Stream>& streams) {
  for (const gltf::EncodedPayload& payload : geometry.payloads) {
    std::vector<std::string> labels;
    for (const gltf::PiecePlan& piece : payload.plan.pieces) {
      for (const gltf::AttributePlan& attribute : piece.attributes) {
        labels.push_back(attribute.label());
      }
    }
    addOurStreams(payload.result.sizes, labels, streams);
  }
}

Outcome decodeUnit(const EncodedFile& encoded, size_t unit, const Allocator& allocator,
                   DecodedUnit& decoded, const RunJobs& run_jobs) {
  Outcome done;
  if (encoded.codec == Codec::kMcc) {
    return decodeOurs(encoded.payloads[unit].payload, allocator, run_jobs, decoded);
  }
  if (isDraco(encoded.codec)) {
    done = foreign::decodeDraco(encoded.draco[unit].bytes, decoded.mesh);
  } else {
    const foreign::MeshoptEncoded& layout = encoded.meshoptimizer[unit];
    done = foreign::decodeMeshoptZstd(layout, layout.zstd_bytes, decoded.mesh);
  }
  if (done.ok()) countMesh(decoded);
  return inPrimitive(unit, done);
}

double cacheMisses(const EncodedFile& encoded, size_t unit, const DecodedUnit& decoded) {
  const auto misses = [](std::span<const uint32_t> indices, uint32_t vertex_count) {
    return foreign::averageCacheMissRatio(indices, vertex_count) *
           static_cast<double>(indices.size() / 3);
  };
  if (encoded.codec != Codec::kMcc) {
    return misses(decoded.mesh.indexSpan(), decoded.mesh.vertex_count);
  }
  double sum = 0;
  Payload payload;
  if (!payload.open(encoded.payloads[unit].payload).ok()) return 0;
  for (size_t i = 0; i < decoded.pieces.size(); ++i) {
    const PieceInfo& info = payload.info().pieces[i];
    for (size_t k = 0; k < info.parts.size(); ++k) {
      const size_t index_count = size_t{3} * info.parts[k].triangle_count;
      sum += misses({decoded.pieces[i].parts[k].get(), index_count}, info.wedge_count);
    }
  }
  return sum;
}

Outcome measureErrors(const Geometry& geometry, const EncodedFile& encoded,
                      const std::vector<DecodedUnit>& decoded, std::vector<NamedError>& errors,
                      uint64_t& lost_wedges) {
  errors.clear();
  lost_wedges = 0;
  Outcome done;
  if (encoded.codec == Codec::kMcc) {
    for (size_t i = 0; i < decoded.size() && done.ok(); ++i) {
      done = addOurErrors(geometry.inputs[i], encoded.payloads[i], decoded[i], errors);
    }
    return done;
  }
  const std::vector<PrimitiveInput> primitives = primitivesOf(geometry);
  for (size_t i = 0; i < primitives.size() && done.ok(); ++i) {
    if (isDraco(encoded.codec)) {
      done = addDracoErrors(primitives[i], decoded[i], errors, lost_wedges);
    } else {
      done = addMeshoptErrors(primitives[i], encoded.meshoptimizer[i], decoded[i], errors,
                              lost_wedges);
    }
    done = inPrimitive(i, done);
  }
  return done;
}

}  // namespace mcc::bench
