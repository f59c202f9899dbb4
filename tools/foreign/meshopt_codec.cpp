// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/meshopt_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include <meshoptimizer.h>
#include <zstd.h>

namespace mcc::foreign {
namespace {

constexpr size_t kMaxStrideBytes = 256;  // of meshoptimizer's vertex codec and of its remap

/// What to do with a file that is newer than the library.
constexpr char kAdvice[] =
    "; encodeGlb() of the npm package gltf-mcc reads it with the option meshoptDecoder, and "
    "gltfpack -noq decompresses it";

static_assert(std::endian::native == std::endian::little, "streams are written in host order");

bool isDirection(const AttributeFormat& format) {
  if (format.morph_target != 0 || format.component_type != ComponentType::kFloat32) return false;
  return (format.semantic == Semantic::kNormal && format.component_count == 3) ||
         (format.semantic == Semantic::kTangent && format.component_count == 4);
}

uint32_t padded(uint32_t bytes) { return (bytes + 3) & ~3u; }

/// Chooses how an attribute is stored; leaves stream.bytes open.
MeshoptStream describe(const AttributeView& view, uint32_t index, uint32_t wedge_count,
                       const MeshoptOptions& options) {
  MeshoptStream stream;
  stream.piece_attribute = index;
  stream.component_type = view.format.component_type;
  stream.component_count = view.format.component_count;
  stream.component_bytes = static_cast<uint8_t>(componentBytes(view.format.component_type));
  if (!options.is_lossless && view.quantization_bits > 0) {
    if (isDirection(view.format)) {
      if (allFinite(view, wedge_count)) {
        stream.storage =
            options.use_filters ? MeshoptStorage::kOctahedral : MeshoptStorage::kSigned;
        stream.bits = std::clamp<uint8_t>(view.quantization_bits, 2, 16);
        stream.component_bytes = stream.bits <= 8 ? 1 : 2;
        stream.stride_bytes = 4u * stream.component_bytes;
        return stream;
      }
    } else if (view.quantization_bits <= 24 &&
               effectiveLattice(view, wedge_count, stream.lattice)) {
      stream.storage = MeshoptStorage::kLattice;
      stream.bits = view.quantization_bits;
      stream.component_bytes = stream.bits <= 8 ? 1 : stream.bits <= 16 ? 2 : 4;
    }
  }
  stream.stride_bytes = padded(uint32_t{stream.component_bytes} * stream.component_count);
  return stream;
}

void store(uint8_t* place, uint32_t component_bytes, uint32_t value) {
  std::memcpy(place, &value, component_bytes);  // the low bytes
}

/// An attribute of all wedges as its stream stores it, before the codec.
std::vector<uint8_t> quantise(const AttributeView& view, const MeshoptStream& stream,
                              uint32_t wedge_count) {
  std::vector<uint8_t> result(size_t{wedge_count} * stream.stride_bytes, 0);
  const uint32_t count = stream.component_count;
  switch (stream.storage) {
    case MeshoptStorage::kRaw: {
      const auto* source = static_cast<const std::byte*>(view.data);
      for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
        std::memcpy(&result[size_t{wedge} * stream.stride_bytes],
                    source + size_t{wedge} * view.stride_bytes, elementBytes(view.format));
      }
      break;
    }
    case MeshoptStorage::kLattice: {
      const double last_index = static_cast<double>((uint64_t{1} << stream.bits) - 1);
      const double step = stream.lattice.step;
      for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
        uint8_t* place = &result[size_t{wedge} * stream.stride_bytes];
        for (uint32_t c = 0; c < count; ++c) {
          const double offset = readComponent(view, wedge, c) - double{stream.lattice.origin[c]};
          const double index = std::clamp(std::floor(offset / step + 0.5), 0.0, last_index);
          store(place + size_t{c} * stream.component_bytes, stream.component_bytes,
                static_cast<uint32_t>(index));
        }
      }
      break;
    }
    case MeshoptStorage::kSigned:
      for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
        uint8_t* place = &result[size_t{wedge} * stream.stride_bytes];
        for (uint32_t c = 0; c < count; ++c) {
          const int value =
              meshopt_quantizeSnorm(static_cast<float>(readComponent(view, wedge, c)), stream.bits);
          store(place + size_t{c} * stream.component_bytes, stream.component_bytes,
                static_cast<uint32_t>(value));
        }
      }
      break;
    case MeshoptStorage::kOctahedral: {
      std::vector<float> vectors(size_t{wedge_count} * 4, 0.0f);
      for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
        for (uint32_t c = 0; c < count; ++c) {
          vectors[size_t{wedge} * 4 + c] = static_cast<float>(readComponent(view, wedge, c));
        }
      }
      meshopt_encodeFilterOct(result.data(), wedge_count, stream.stride_bytes, stream.bits,
                              vectors.data());
      break;
    }
  }
  return result;
}

/// Vertex of every wedge after merging wedges that are stored alike, and how many vertices that
/// makes. Nothing is merged when the elements are too wide for meshoptimizer's remap.
size_t mergeVertices(const std::vector<std::vector<uint8_t>>& columns,
                     const std::vector<MeshoptStream>& streams, std::span<const uint32_t> indices,
                     uint32_t wedge_count, std::vector<uint32_t>& remap) {
  size_t total = 0;
  for (const MeshoptStream& stream : streams) total += stream.stride_bytes;
  remap.resize(wedge_count);
  if (total > kMaxStrideBytes) {
    for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) remap[wedge] = wedge;
    return wedge_count;
  }
  std::vector<uint8_t> rows(size_t{wedge_count} * total);
  size_t offset = 0;
  for (size_t s = 0; s < streams.size(); ++s) {
    const size_t stride = streams[s].stride_bytes;
    for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
      std::memcpy(&rows[wedge * total + offset], &columns[s][wedge * stride], stride);
    }
    offset += stride;
  }
  return meshopt_generateVertexRemap(remap.data(), indices.data(), indices.size(), rows.data(),
                                     wedge_count, total);
}

template <typename T>
T loadAs(const uint8_t* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

/// value = float(float(index * step) + origin), as the lattices of the codec's own payloads.
template <typename T>
void fromLattice(const uint8_t* stored, const MeshoptStream& stream, uint32_t vertex_count,
                 float* out) {
  const uint32_t count = stream.component_count;
  const float step = stream.lattice.step;
  for (uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
    for (uint32_t c = 0; c < count; ++c) {
      const float scaled = static_cast<float>(loadAs<T>(stored + c * sizeof(T))) * step;
      *out++ = scaled + stream.lattice.origin[c];
    }
    stored += stream.stride_bytes;
  }
}

template <typename T>
void fromSigned(const uint8_t* stored, const MeshoptStream& stream, uint32_t vertex_count,
                float* out) {
  const uint32_t count = stream.component_count;
  // The octahedral filter fills the whole range of the type whatever the bits, w included.
  const int bits =
      stream.storage == MeshoptStorage::kOctahedral ? int{stream.component_bytes} * 8 : stream.bits;
  const float scale = 1.0f / static_cast<float>((1 << (bits - 1)) - 1);
  for (uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
    for (uint32_t c = 0; c < count; ++c) {
      *out++ = static_cast<float>(loadAs<T>(stored + c * sizeof(T))) * scale;
    }
    stored += stream.stride_bytes;
  }
}

Outcome decodeStream(const MeshoptStream& stream, std::span<const uint8_t> bytes,
                     uint32_t vertex_count, double& extract_ms, DecodedAttribute& out) {
  const size_t stored_bytes = size_t{vertex_count} * stream.stride_bytes;
  out.id = stream.piece_attribute;
  out.component_type = stream.component_type;
  out.component_count = stream.component_count;
  const size_t element_bytes = out.elementBytes();
  out.values = std::make_unique_for_overwrite<std::byte[]>(size_t{vertex_count} * element_bytes);
  const bool is_final =
      stream.storage == MeshoptStorage::kRaw && element_bytes == stream.stride_bytes;
  std::unique_ptr<uint8_t[]> stored;
  void* target = out.values.get();
  if (!is_final) {
    stored = std::make_unique_for_overwrite<uint8_t[]>(stored_bytes);
    target = stored.get();
  }
  if (meshopt_decodeVertexBuffer(target, vertex_count, stream.stride_bytes, bytes.data(),
                                 bytes.size()) != 0) {
    return failure("meshoptimizer: damaged vertex stream");
  }
  if (is_final) return {};
  const Stopwatch watch;
  auto* floats = reinterpret_cast<float*>(out.values.get());
  switch (stream.storage) {
    case MeshoptStorage::kRaw:
      for (uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
        std::memcpy(out.values.get() + vertex * element_bytes,
                    stored.get() + size_t{vertex} * stream.stride_bytes, element_bytes);
      }
      break;
    case MeshoptStorage::kLattice:
      if (stream.component_bytes == 1)
        fromLattice<uint8_t>(stored.get(), stream, vertex_count, floats);
      else if (stream.component_bytes == 2)
        fromLattice<uint16_t>(stored.get(), stream, vertex_count, floats);
      else
        fromLattice<uint32_t>(stored.get(), stream, vertex_count, floats);
      break;
    case MeshoptStorage::kOctahedral:
      meshopt_decodeFilterOct(stored.get(), vertex_count, stream.stride_bytes);
      [[fallthrough]];
    case MeshoptStorage::kSigned:
      if (stream.component_bytes == 1)
        fromSigned<int8_t>(stored.get(), stream, vertex_count, floats);
      else
        fromSigned<int16_t>(stored.get(), stream, vertex_count, floats);
      break;
  }
  extract_ms += watch.elapsedMs();
  return {};
}

Outcome decodeStreams(const MeshoptEncoded& layout, std::span<const uint8_t> bytes,
                      DecodedMesh& mesh) {
  size_t total = layout.index_bytes;
  for (const MeshoptStream& stream : layout.streams) total += stream.bytes;
  if (total != bytes.size()) return failure("sizes of the streams do not add up to the payload");
  mesh.vertex_count = layout.vertex_count;
  mesh.triangle_count = layout.triangle_count;
  const size_t index_count = size_t{layout.triangle_count} * 3;
  mesh.indices = std::make_unique_for_overwrite<uint32_t[]>(index_count);
  if (meshopt_decodeIndexBuffer(mesh.indices.get(), index_count, sizeof(uint32_t), bytes.data(),
                                layout.index_bytes) != 0) {
    return failure("meshoptimizer: damaged index stream");
  }
  size_t offset = layout.index_bytes;
  mesh.attributes.resize(layout.streams.size());
  for (size_t s = 0; s < layout.streams.size(); ++s) {
    const MeshoptStream& stream = layout.streams[s];
    Outcome done = decodeStream(stream, bytes.subspan(offset, stream.bytes), layout.vertex_count,
                                mesh.extract_ms, mesh.attributes[s]);
    if (!done.ok()) return done;
    offset += stream.bytes;
  }
  return {};
}

Outcome compressZstd(std::span<const uint8_t> bytes, int level, std::vector<uint8_t>& out) {
  out.resize(ZSTD_compressBound(bytes.size()));
  const size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size) != 0) return failure(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.resize(size);
  return {};
}

Outcome encodeChecked(const PieceView& piece, size_t part, const MeshoptOptions& options,
                      MeshoptEncoded& encoded) {
  const Stopwatch watch;
  if (part >= piece.parts.size()) return failure("no such part");
  const std::span<const uint32_t> source = piece.parts[part].indices;
  if (source.size() < 3 || source.size() % 3 != 0) return failure("no triangles");
  for (const uint32_t index : source) {
    if (index >= piece.wedge_count) return failure("index beyond the last vertex");
  }
  std::vector<std::vector<uint8_t>> columns;
  for (uint32_t i = 0; i < piece.attributes.size(); ++i) {
    const AttributeView& view = piece.attributes[i];
    if (view.data == nullptr) return failure("attribute without data");
    MeshoptStream stream = describe(view, i, piece.wedge_count, options);
    if (stream.stride_bytes == 0 || stream.stride_bytes > kMaxStrideBytes)
      return failure("element above 256 bytes");
    columns.push_back(quantise(view, stream, piece.wedge_count));
    encoded.streams.push_back(stream);
  }
  std::vector<uint32_t> remap;
  const size_t merged_count =
      mergeVertices(columns, encoded.streams, source, piece.wedge_count, remap);
  std::vector<uint32_t> indices;
  indices.reserve(source.size());
  for (size_t i = 0; i < source.size(); i += 3) {
    const uint32_t a = remap[source[i]];
    const uint32_t b = remap[source[i + 1]];
    const uint32_t c = remap[source[i + 2]];
    if (a == b || b == c || c == a) continue;
    indices.insert(indices.end(), {a, b, c});
  }
  if (indices.empty()) return failure("only degenerate triangles");
  if (options.use_filters) {
    meshopt_optimizeVertexCacheStrip(indices.data(), indices.data(), indices.size(), merged_count);
  } else {
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), merged_count);
  }
  std::vector<uint32_t> fetch(merged_count);
  const size_t vertex_count =
      meshopt_optimizeVertexFetchRemap(fetch.data(), indices.data(), indices.size(), merged_count);
  for (uint32_t& index : indices) index = fetch[index];
  encoded.vertex_count = static_cast<uint32_t>(vertex_count);
  encoded.triangle_count = static_cast<uint32_t>(indices.size() / 3);
  encoded.wedge_vertex.assign(piece.wedge_count, kNone);
  for (uint32_t wedge = 0; wedge < piece.wedge_count; ++wedge) {
    if (remap[wedge] != kNone) encoded.wedge_vertex[wedge] = fetch[remap[wedge]];
  }

  meshopt_encodeIndexVersion(1);
  meshopt_encodeVertexVersion(0);
  std::vector<uint8_t> scratch(meshopt_encodeIndexBufferBound(indices.size(), vertex_count));
  encoded.index_bytes =
      meshopt_encodeIndexBuffer(scratch.data(), scratch.size(), indices.data(), indices.size());
  if (encoded.index_bytes == 0) return failure("meshoptimizer: index encoder failed");
  encoded.bytes.assign(scratch.begin(),
                       scratch.begin() + static_cast<std::ptrdiff_t>(encoded.index_bytes));
  std::vector<uint8_t> ordered;
  for (size_t s = 0; s < columns.size(); ++s) {
    MeshoptStream& stream = encoded.streams[s];
    ordered.resize(vertex_count * stream.stride_bytes);
    for (uint32_t wedge = 0; wedge < piece.wedge_count; ++wedge) {
      const uint32_t vertex = encoded.wedge_vertex[wedge];
      if (vertex == kNone) continue;
      std::memcpy(&ordered[size_t{vertex} * stream.stride_bytes],
                  &columns[s][size_t{wedge} * stream.stride_bytes], stream.stride_bytes);
    }
    scratch.resize(meshopt_encodeVertexBufferBound(vertex_count, stream.stride_bytes));
    stream.bytes = meshopt_encodeVertexBuffer(scratch.data(), scratch.size(), ordered.data(),
                                              vertex_count, stream.stride_bytes);
    if (stream.bytes == 0) return failure("meshoptimizer: vertex encoder failed");
    encoded.bytes.insert(encoded.bytes.end(), scratch.begin(),
                         scratch.begin() + static_cast<std::ptrdiff_t>(stream.bytes));
  }
  encoded.encode_ms = watch.elapsedMs();
  const Stopwatch zstd_watch;
  Outcome compressed = compressZstd(encoded.bytes, options.zstd_level, encoded.zstd_bytes);
  encoded.zstd_ms = zstd_watch.elapsedMs();
  return compressed;
}

}  // namespace

Outcome encodeMeshopt(const PieceView& piece, size_t part, const MeshoptOptions& options,
                      MeshoptEncoded& encoded) {
  encoded = {};
  return guarded([&]() { return encodeChecked(piece, part, options, encoded); });
}

Outcome decodeMeshopt(const MeshoptEncoded& layout, std::span<const uint8_t> bytes,
                      DecodedMesh& mesh) {
  mesh = {};
  return guarded([&]() {
    const Stopwatch watch;
    Outcome done = decodeStreams(layout, bytes, mesh);
    mesh.decode_ms = watch.elapsedMs();
    return done;
  });
}

Outcome decodeMeshoptZstd(const MeshoptEncoded& layout, std::span<const uint8_t> zstd_bytes,
                          DecodedMesh& mesh) {
  mesh = {};
  return guarded([&]() -> Outcome {
    const Stopwatch watch;
    size_t size = layout.index_bytes;
    for (const MeshoptStream& stream : layout.streams) size += stream.bytes;
    const auto bytes = std::make_unique_for_overwrite<uint8_t[]>(size);
    const size_t got = ZSTD_decompress(bytes.get(), size, zstd_bytes.data(), zstd_bytes.size());
    if (ZSTD_isError(got) != 0) return failure(std::string("zstd: ") + ZSTD_getErrorName(got));
    if (got != size) return failure("zstd: payload of another size than described");
    Outcome done = decodeStreams(layout, {bytes.get(), size}, mesh);
    mesh.decode_ms = watch.elapsedMs();
    return done;
  });
}

Outcome decodeMeshoptView(std::span<const uint8_t> bytes, uint64_t count, uint32_t stride,
                          const std::string& mode, const std::string& filter,
                          std::vector<uint8_t>& elements) {
  const bool is_vertices = mode == "ATTRIBUTES";
  const bool is_triangles = mode == "TRIANGLES";
  if (!is_vertices && !is_triangles && mode != "INDICES") {
    return failure("has the unknown mode \"" + mode + "\"");
  }
  const bool stride_fits = is_vertices ? stride != 0 && stride % 4 == 0 && stride <= kMaxStrideBytes
                                       : stride == 2 || stride == 4;
  if (!stride_fits || (is_triangles && count % 3 != 0)) {
    return failure("has a stride or count its mode does not allow");
  }
  // The upper half of the first byte is the kind of stream, the lower half its version.
  const uint8_t kind = is_vertices ? 0xa0 : is_triangles ? 0xe0 : 0xd0;
  const uint8_t newest = is_vertices ? 0 : 1;
  if (!bytes.empty() && (bytes[0] & 0xf0) == kind && (bytes[0] & 0x0f) > newest) {
    return failure("has version " + std::to_string(bytes[0] & 0x0f) +
                   " of its codec, which meshoptimizer " + meshoptVersion() + " cannot read" +
                   kAdvice);
  }
  return guarded([&]() -> Outcome {
    elements.resize(count * stride);
    int status = 0;
    if (is_vertices) {
      status =
          meshopt_decodeVertexBuffer(elements.data(), count, stride, bytes.data(), bytes.size());
    } else if (is_triangles) {
      status =
          meshopt_decodeIndexBuffer(elements.data(), count, stride, bytes.data(), bytes.size());
    } else {
      status =
          meshopt_decodeIndexSequence(elements.data(), count, stride, bytes.data(), bytes.size());
    }
    if (status != 0) return failure("is damaged");
    if (filter == "NONE") return {};
    if (is_vertices && filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
      meshopt_decodeFilterOct(elements.data(), count, stride);
    } else if (is_vertices && filter == "QUATERNION" && stride == 8) {
      meshopt_decodeFilterQuat(elements.data(), count, stride);
    } else if (is_vertices && filter == "EXPONENTIAL") {
      meshopt_decodeFilterExp(elements.data(), count, stride);
    } else {
      return failure("has the filter \"" + filter + "\", which meshoptimizer " + meshoptVersion() +
                     " cannot undo" + kAdvice);
    }
    return {};
  });
}

Outcome encodeMeshoptView(std::span<const uint8_t> elements, uint64_t count, uint32_t stride,
                          const std::string& mode, std::vector<uint8_t>& bytes) {
  const bool is_vertices = mode == "ATTRIBUTES";
  const bool is_triangles = mode == "TRIANGLES";
  const bool stride_fits = is_vertices ? stride != 0 && stride % 4 == 0 && stride <= kMaxStrideBytes
                                       : stride == 2 || stride == 4;
  if (!stride_fits || (!is_vertices && !is_triangles && mode != "INDICES") ||
      (is_triangles && count % 3 != 0) || count == 0 || elements.size() / stride < count) {
    return failure("has a mode, stride or count that cannot be coded");
  }
  return guarded([&]() -> Outcome {
    if (is_vertices) {
      bytes.resize(meshopt_encodeVertexBufferBound(count, stride));
      bytes.resize(
          meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), elements.data(), count, stride));
      return {};
    }
    std::vector<uint32_t> indices(count);
    uint32_t vertex_count = 0;
    for (size_t i = 0; i < count; ++i) {
      std::memcpy(&indices[i], elements.data() + i * stride, stride);
      vertex_count = std::max(vertex_count, indices[i] + 1);
    }
    if (is_triangles) {
      bytes.resize(meshopt_encodeIndexBufferBound(count, vertex_count));
      bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), count));
    } else {
      bytes.resize(meshopt_encodeIndexSequenceBound(count, vertex_count));
      bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), count));
    }
    return {};
  });
}

Outcome measureMeshoptErrors(const PieceView& piece, const MeshoptEncoded& layout,
                             const DecodedMesh& decoded, std::vector<AttributeError>& errors) {
  errors.assign(layout.streams.size(), {});
  if (layout.wedge_vertex.size() != piece.wedge_count) return failure("layout of another mesh");
  return guarded([&]() -> Outcome {
    // Per wedge the value it decodes to: merged wedges share one, but not its error.
    std::vector<uint32_t> source_wedge(piece.wedge_count);
    std::vector<std::byte> per_wedge;
    for (size_t s = 0; s < layout.streams.size(); ++s) {
      const uint32_t index = layout.streams[s].piece_attribute;
      const DecodedAttribute* attribute = decoded.find(index);
      if (attribute == nullptr || index >= piece.attributes.size())
        return failure("decode of another mesh");
      const size_t element_bytes = attribute->elementBytes();
      per_wedge.resize(size_t{piece.wedge_count} * element_bytes);
      for (uint32_t wedge = 0; wedge < piece.wedge_count; ++wedge) {
        const uint32_t vertex = layout.wedge_vertex[wedge];
        source_wedge[wedge] = vertex == kNone ? kNone : wedge;
        if (vertex == kNone) continue;
        if (vertex >= decoded.vertex_count) return failure("decode of another mesh");
        std::memcpy(&per_wedge[wedge * element_bytes],
                    attribute->values.get() + vertex * element_bytes, element_bytes);
      }
      Outcome done =
          measureError(piece.attributes[index], piece.wedge_count, attribute->component_type,
                       per_wedge.data(), source_wedge, errors[s]);
      if (!done.ok()) return done;
    }
    return {};
  });
}

double averageCacheMissRatio(std::span<const uint32_t> indices, uint32_t vertex_count,
                             uint32_t cache_size) {
  if (indices.size() < 3 || vertex_count == 0) return 0;
  return double{
      meshopt_analyzeVertexCache(indices.data(), indices.size(), vertex_count, cache_size, 0, 0)
          .acmr};
}

std::string meshoptVersion() {
  return std::to_string(MESHOPTIMIZER_VERSION / 1000) + "." +
         std::to_string(MESHOPTIMIZER_VERSION % 1000 / 10);
}

std::string zstdVersion() { return ZSTD_versionString(); }

}  // namespace mcc::foreign
