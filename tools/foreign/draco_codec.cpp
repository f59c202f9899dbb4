// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/draco_codec.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

#include "draco/compression/config/encoder_options.h"
#include "draco/compression/decode.h"
#include "draco/compression/mesh/mesh_edgebreaker_encoder.h"
#include "draco/compression/mesh/mesh_sequential_encoder.h"
#include "draco/compression/point_cloud/point_cloud_decoder.h"
#include "draco/core/draco_version.h"
#include "draco/core/options.h"
#include "draco/core/varint_decoding.h"
#include "draco/mesh/mesh.h"
#include "draco/metadata/metadata_decoder.h"

namespace mcc::foreign {
namespace {

Outcome fromDraco(const draco::Status& status) {
  return status.ok() ? Outcome{} : failure("Draco: " + status.error_msg_string());
}

/// Below speed 5 Draco predicts NORMAL on an octahedral grid whatever the type, and integer normals
/// come back as something else.
draco::GeometryAttribute::Type dracoType(const AttributeFormat& format) {
  if (format.semantic == Semantic::kNormal && format.component_type != ComponentType::kFloat32) {
    return draco::GeometryAttribute::GENERIC;
  }
  switch (format.semantic) {
    case Semantic::kPosition: return draco::GeometryAttribute::POSITION;
    case Semantic::kNormal: return draco::GeometryAttribute::NORMAL;
    case Semantic::kTexcoord: return draco::GeometryAttribute::TEX_COORD;
    case Semantic::kColor: return draco::GeometryAttribute::COLOR;
    case Semantic::kTangent:
    case Semantic::kJoints:
    case Semantic::kWeights:
    case Semantic::kCustom: return draco::GeometryAttribute::GENERIC;
  }
  return draco::GeometryAttribute::GENERIC;
}

draco::DataType dracoDataType(ComponentType type) {
  switch (type) {
    case ComponentType::kInt8: return draco::DT_INT8;
    case ComponentType::kUint8: return draco::DT_UINT8;
    case ComponentType::kInt16: return draco::DT_INT16;
    case ComponentType::kUint16: return draco::DT_UINT16;
    case ComponentType::kUint32: return draco::DT_UINT32;
    case ComponentType::kInt32: return draco::DT_INT32;
    case ComponentType::kFloat32: return draco::DT_FLOAT32;
  }
  return draco::DT_INVALID;
}

bool componentTypeOf(draco::DataType type, ComponentType& out) {
  switch (type) {
    case draco::DT_INT8: out = ComponentType::kInt8; return true;
    case draco::DT_UINT8: out = ComponentType::kUint8; return true;
    case draco::DT_INT16: out = ComponentType::kInt16; return true;
    case draco::DT_UINT16: out = ComponentType::kUint16; return true;
    case draco::DT_UINT32: out = ComponentType::kUint32; return true;
    case draco::DT_FLOAT32: out = ComponentType::kFloat32; return true;
    default: return false;
  }
}

/// Whether Draco's float32 arithmetic can put every value on the lattice: it subtracts the origin,
/// divides by the step and converts to int32 without a look at what comes of it.
bool canBeQuantised(const DracoAttribute& attribute, uint32_t wedge_count) {
  constexpr float kLargestPoint = 0x1p30f;
  const AttributeView& view = attribute.view;
  if (!std::isfinite(attribute.range) || !(attribute.range > 0)) return false;
  for (uint32_t wedge = 0; wedge < wedge_count; ++wedge) {
    for (uint32_t c = 0; c < view.format.component_count; ++c) {
      const auto value = static_cast<float>(readComponent(view, wedge, c));
      const float point = (value - attribute.lattice.origin[c]) / attribute.lattice.step;
      if (!(std::abs(point) <= kLargestPoint)) return false;
    }
  }
  return true;
}

/// Bytes of the parameters that follow the values of an attribute: part of the header in our
/// tables, since they do not grow with the mesh.
size_t parameterBytes(const DracoAttribute& attribute) {
  if (attribute.quantization_bits == 0) return 0;
  if (attribute.is_octahedral) return 1;                             // bits
  return 4 * size_t{attribute.view.format.component_count} + 4 + 1;  // origin, range, bits
}

Outcome buildMesh(const DracoInput& input, draco::Mesh& mesh) {
  mesh.set_num_points(input.wedge_count);
  for (const DracoAttribute& attribute : input.attributes) {
    const AttributeFormat& format = attribute.view.format;
    const size_t element_bytes = elementBytes(format);
    draco::GeometryAttribute description;
    // The wrapper never sets `normalized`; glTF keeps it in the accessor.
    description.Init(dracoType(format), nullptr, format.component_count,
                     dracoDataType(format.component_type), false,
                     static_cast<int64_t>(element_bytes), 0);
    const int id = mesh.AddAttribute(description, true, input.wedge_count);
    if (id < 0) return failure("Draco: attribute refused");
    draco::PointAttribute* target = mesh.attribute(id);
    const std::byte* source = static_cast<const std::byte*>(attribute.view.data);
    for (uint32_t wedge = 0; wedge < input.wedge_count; ++wedge) {
      target->SetAttributeValue(draco::AttributeValueIndex(wedge),
                                source + size_t{wedge} * attribute.view.stride_bytes);
    }
  }
  const size_t triangle_count = input.indices.size() / 3;
  mesh.SetNumFaces(triangle_count);
  for (size_t triangle = 0; triangle < triangle_count; ++triangle) {
    draco::Mesh::Face face;
    for (size_t corner = 0; corner < 3; ++corner) {
      face[corner] = draco::PointIndex(input.indices[3 * triangle + corner]);
    }
    mesh.SetFace(draco::FaceIndex(static_cast<uint32_t>(triangle)), face);
  }
  if (!input.deduplicate) return {};
  if (!mesh.DeduplicateAttributeValues()) return failure("Draco: deduplication of values failed");
  mesh.DeduplicatePointIds();
  return {};
}

/// The shortest decimal that reads back as the same float.
void appendExact(std::string& text, float value) {
  char digits[64];
  const std::to_chars_result end = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end.ptr);
}

/// Options by the names draco::ExpertEncoder's setters use. Its setter for explicit quantisation
/// keeps floats as text of six decimals, which moves the lattice of a small model by several steps:
/// so the same options are set here as text with all digits.
draco::EncoderOptions makeOptions(const DracoInput& input, int speed) {
  draco::EncoderOptions options = draco::EncoderOptions::CreateDefaultOptions();
  options.SetSpeed(speed, speed);
  options.SetGlobalInt("encoding_method", input.method == DracoMethod::kEdgebreaker
                                              ? draco::MESH_EDGEBREAKER_ENCODING
                                              : draco::MESH_SEQUENTIAL_ENCODING);
  for (size_t i = 0; i < input.attributes.size(); ++i) {
    const DracoAttribute& attribute = input.attributes[i];
    if (attribute.quantization_bits == 0) continue;
    draco::Options own;
    own.SetInt("quantization_bits", attribute.quantization_bits);
    if (!attribute.is_octahedral) {
      std::string origin;
      for (size_t c = 0; c < attribute.view.format.component_count; ++c) {
        if (c > 0) origin += ' ';
        appendExact(origin, attribute.lattice.origin[c]);
      }
      std::string range;
      appendExact(range, attribute.range);
      own.SetString("quantization_origin", origin);
      own.SetString("quantization_range", range);
    }
    options.SetAttributeOptions(static_cast<int32_t>(i), own);
  }
  return options;
}

/// A Draco encoder that notes where in the output each stage begins and ends; the bytes stay
/// Draco's.
template <typename Base>
class MeasuringEncoder final : public Base {
 public:
  explicit MeasuringEncoder(size_t attribute_count) {
    streams_.attribute_bytes.resize(attribute_count);
  }

  DracoStreams& streams() { return streams_; }

 protected:
  draco::Status EncodeConnectivity() override {
    const size_t before = this->buffer()->size();
    draco::Status status = Base::EncodeConnectivity();
    streams_.connectivity_bytes = this->buffer()->size() - before;
    return status;
  }

  bool EncodeAttributesEncoderIdentifier(int32_t encoder_id) override {
    order_.push_back(encoder_id);  // called in the order of encoding
    return Base::EncodeAttributesEncoderIdentifier(encoder_id);
  }

  /// Does what Draco's own does: every attributes encoder in order.
  bool EncodeAllAttributes() override {
    for (const int32_t encoder_id : order_) {
      draco::AttributesEncoder* encoder = this->attributes_encoder(encoder_id);
      const size_t before = this->buffer()->size();
      if (!encoder->EncodeAttributes(this->buffer())) return false;
      const auto first = static_cast<size_t>(encoder->GetAttributeId(0));
      streams_.attribute_bytes[first] += this->buffer()->size() - before;
    }
    return true;
  }

 private:
  DracoStreams streams_;
  std::vector<int32_t> order_;
};

template <typename Base>
Outcome runEncoder(const DracoInput& input, const draco::Mesh& mesh,
                   const draco::EncoderOptions& options, DracoEncoded& encoded) {
  const Stopwatch watch;
  MeasuringEncoder<Base> encoder(input.attributes.size());
  encoder.SetMesh(mesh);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.Encode(options, &buffer);
  encoded.encode_ms = watch.elapsedMs();
  if (!status.ok()) return fromDraco(status);
  const auto* data = reinterpret_cast<const uint8_t*>(buffer.data());
  encoded.bytes.assign(data, data + buffer.size());
  encoded.streams = std::move(encoder.streams());
  DracoStreams& streams = encoded.streams;
  size_t rest = encoded.bytes.size() - streams.connectivity_bytes;
  const bool is_joint = input.method == DracoMethod::kSequential;
  for (size_t i = 0; i < input.attributes.size(); ++i) {
    streams.attribute_bytes[is_joint ? 0 : i] -= parameterBytes(input.attributes[i]);
  }
  for (const size_t bytes : streams.attribute_bytes) rest -= bytes;
  streams.header_bytes = rest;
  return {};
}

Outcome extractAttribute(const draco::Mesh& source, const draco::PointAttribute& attribute,
                         DecodedAttribute& out) {
  if (!componentTypeOf(attribute.data_type(), out.component_type)) {
    return failure("Draco: attribute of a type glTF has not");
  }
  if (attribute.num_components() <= 0 || attribute.num_components() > 16) {
    return failure("Draco: attribute with " + std::to_string(attribute.num_components()) +
                   " components");
  }
  out.id = attribute.unique_id();
  out.component_count = static_cast<uint8_t>(attribute.num_components());
  const size_t element_bytes = out.elementBytes();
  const size_t value_count = attribute.size();
  if (attribute.byte_stride() != static_cast<int64_t>(element_bytes) ||
      attribute.byte_offset() != 0 ||
      attribute.buffer()->data_size() < value_count * element_bytes) {
    return failure("Draco: attribute is not packed");
  }
  const size_t vertex_count = source.num_points();
  out.values = std::make_unique_for_overwrite<std::byte[]>(vertex_count * element_bytes);
  const auto* values = reinterpret_cast<const std::byte*>(attribute.buffer()->data());
  if (attribute.is_mapping_identity()) {
    if (vertex_count > value_count) return failure("Draco: attribute with too few values");
    std::memcpy(out.values.get(), values, vertex_count * element_bytes);
    return {};
  }
  const auto gather = [&](auto element_bytes_constant) {
    std::byte* target = out.values.get();
    for (uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
      const uint32_t value = attribute.mapped_index(draco::PointIndex(vertex)).value();
      if (value >= value_count) return false;
      std::memcpy(target, values + size_t{value} * element_bytes_constant, element_bytes_constant);
      target += element_bytes_constant;
    }
    return true;
  };
  bool ok = false;
  switch (element_bytes) {  // the usual sizes as constants: a load and a store instead of a call
    case 4: ok = gather(std::integral_constant<size_t, 4>()); break;
    case 8: ok = gather(std::integral_constant<size_t, 8>()); break;
    case 12: ok = gather(std::integral_constant<size_t, 12>()); break;
    case 16: ok = gather(std::integral_constant<size_t, 16>()); break;
    default: ok = gather(element_bytes); break;
  }
  return ok ? Outcome{} : failure("Draco: vertex without a value");
}

/// One hash per decoded vertex of its values in all attributes, in the order of their ids. 64 bits:
/// two of a million tuples share one in one of ten million meshes, and then a check is a little
/// weaker.
bool hashTuples(const DecodedMesh& mesh, size_t attribute_count, std::vector<uint64_t>& hashes) {
  struct Column {
    const char* values;
    size_t element_bytes;
  };
  std::vector<Column> columns;
  size_t tuple_bytes = 0;
  for (uint32_t id = 0; id < attribute_count; ++id) {
    const DecodedAttribute* attribute = mesh.find(id);
    if (attribute == nullptr) return false;
    columns.push_back(
        {reinterpret_cast<const char*>(attribute->values.get()), attribute->elementBytes()});
    tuple_bytes += attribute->elementBytes();
  }
  std::string tuple(tuple_bytes, '\0');
  hashes.resize(mesh.vertex_count);
  for (size_t vertex = 0; vertex < hashes.size(); ++vertex) {
    char* place = tuple.data();
    for (const Column& column : columns) {
      std::memcpy(place, column.values + vertex * column.element_bytes, column.element_bytes);
      place += column.element_bytes;
    }
    hashes[vertex] = std::hash<std::string_view>()(tuple);
  }
  return true;
}

}  // namespace

Outcome makeDracoInput(const PieceView& piece, size_t part, DracoInput& input) {
  input = {};
  if (part >= piece.parts.size()) return failure("no such part");
  input.wedge_count = piece.wedge_count;
  input.indices = piece.parts[part].indices;
  if (input.indices.size() < 3 || input.indices.size() % 3 != 0) return failure("no triangles");
  for (const uint32_t index : input.indices) {
    if (index >= piece.wedge_count) return failure("index beyond the last vertex");
  }
  for (uint32_t i = 0; i < piece.attributes.size(); ++i) {
    const AttributeView& view = piece.attributes[i];
    if (view.data == nullptr) return failure("attribute without data");
    if (view.format.morph_target != 0 || view.format.component_count > 4) {
      input.left_out.push_back(i);
      continue;
    }
    DracoAttribute attribute;
    attribute.view = view;
    attribute.piece_attribute = i;
    const bool is_float = view.format.component_type == ComponentType::kFloat32;
    if (is_float && view.quantization_bits > 0) {
      if (view.quantization_bits > 30) return failure("Draco quantises to at most 30 bits");
      attribute.is_octahedral =
          view.format.semantic == Semantic::kNormal && view.format.component_count == 3;
      if (attribute.is_octahedral) {
        if (view.quantization_bits < 2) return failure("Draco needs at least 2 bits for normals");
        if (allFinite(view, piece.wedge_count))
          attribute.quantization_bits = view.quantization_bits;
        else
          attribute.is_octahedral = false;
      } else if (effectiveLattice(view, piece.wedge_count, attribute.lattice)) {
        attribute.quantization_bits = view.quantization_bits;
        const double last_index = static_cast<double>((uint64_t{1} << view.quantization_bits) - 1);
        attribute.range =
            static_cast<float>(static_cast<double>(attribute.lattice.step) * last_index);
        if (!canBeQuantised(attribute, piece.wedge_count)) attribute.quantization_bits = 0;
      }
    }
    const bool is_position = view.format.semantic == Semantic::kPosition;
    // Draco looks for its positions under the first attribute of that type.
    if (is_position)
      input.attributes.insert(input.attributes.begin(), attribute);
    else
      input.attributes.push_back(attribute);
  }
  if (input.attributes.empty() || input.attributes[0].view.format.semantic != Semantic::kPosition) {
    return failure("no POSITION");
  }
  return {};
}

DracoInput positionsOnly(const DracoInput& input) {
  DracoInput result = input;
  result.left_out.clear();
  if (result.attributes.size() > 1) result.attributes.resize(1);
  return result;
}

Outcome encodeDraco(const DracoInput& input, int speed, DracoEncoded& encoded) {
  encoded = {};
  return guarded([&]() -> Outcome {
    const Stopwatch watch;
    draco::Mesh mesh;
    if (Outcome built = buildMesh(input, mesh); !built.ok()) return built;
    const draco::EncoderOptions options = makeOptions(input, speed);
    encoded.prepare_ms = watch.elapsedMs();
    return input.method == DracoMethod::kEdgebreaker
               ? runEncoder<draco::MeshEdgebreakerEncoder>(input, mesh, options, encoded)
               : runEncoder<draco::MeshSequentialEncoder>(input, mesh, options, encoded);
  });
}

Outcome encodeDracoConnectivity(const DracoInput& input, int speed,
                                DracoConnectivity& connectivity) {
  connectivity = {};
  DracoInput welded = positionsOnly(input);
  welded.method = DracoMethod::kEdgebreaker;
  welded.deduplicate = true;
  if (Outcome done = encodeDraco(welded, speed, connectivity.positions_only); !done.ok())
    return done;
  connectivity.connectivity_bytes = connectivity.positions_only.streams.connectivity_bytes;
  return {};
}

Outcome decodeDraco(std::span<const uint8_t> bytes, DecodedMesh& mesh) {
  mesh = {};
  return guarded([&]() -> Outcome {
    const Stopwatch watch;
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return fromDraco(decoded.status());
    const std::unique_ptr<draco::Mesh> source = std::move(decoded).value();
    const double codec_ms = watch.elapsedMs();
    mesh.vertex_count = source->num_points();
    mesh.triangle_count = source->num_faces();
    mesh.indices = std::make_unique_for_overwrite<uint32_t[]>(size_t{mesh.triangle_count} * 3);
    uint32_t* index = mesh.indices.get();
    for (uint32_t triangle = 0; triangle < mesh.triangle_count; ++triangle) {
      const draco::Mesh::Face& face = source->face(draco::FaceIndex(triangle));
      for (size_t corner = 0; corner < 3; ++corner) *index++ = face[corner].value();
    }
    mesh.attributes.resize(static_cast<size_t>(source->num_attributes()));
    for (int32_t i = 0; i < source->num_attributes(); ++i) {
      Outcome extracted =
          extractAttribute(*source, *source->attribute(i), mesh.attributes[static_cast<size_t>(i)]);
      if (!extracted.ok()) return extracted;
    }
    mesh.decode_ms = watch.elapsedMs();
    mesh.extract_ms = mesh.decode_ms - codec_ms;
    return {};
  });
}

Outcome readDracoCounts(std::span<const uint8_t> bytes, DracoCounts& counts) {
  counts = {};
  return guarded([&]() -> Outcome {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DracoHeader header;
    const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&buffer, &header);
    if (!status.ok()) return fromDraco(status);
    const auto version =
        static_cast<uint16_t>(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor));
    if (header.encoder_type != draco::TRIANGULAR_MESH) return failure("Draco: no triangle mesh");
    if (version < DRACO_BITSTREAM_VERSION(2, 2)) return failure("Draco: older than version 2.2");
    buffer.set_bitstream_version(version);
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
      draco::GeometryMetadata ignored;
      draco::MetadataDecoder decoder;
      if (!decoder.DecodeGeometryMetadata(&buffer, &ignored)) {
        return failure("Draco: damaged metadata");
      }
    }
    uint8_t traversal = 0;
    uint32_t first = 0;
    uint32_t second = 0;
    const bool is_edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
    if ((is_edgebreaker && !buffer.Decode(&traversal)) || !draco::DecodeVarint(&first, &buffer) ||
        !draco::DecodeVarint(&second, &buffer)) {
      return failure("Draco: the data end in the header");
    }
    counts.vertex_count = is_edgebreaker ? first : second;
    counts.triangle_count = is_edgebreaker ? second : first;
    return {};
  });
}

Outcome measureDracoErrors(const DracoInput& input, const DecodedMesh& decoded,
                           DracoErrors& errors) {
  errors = {};
  DracoInput ordered = input;
  ordered.method = DracoMethod::kSequential;
  ordered.deduplicate = false;
  // Its decoder refuses more vertices than corners, so more corners are made up.
  std::vector<uint32_t> indices(input.indices.begin(), input.indices.end());
  for (uint32_t wedge = 0; wedge < input.wedge_count; ++wedge) {
    if (indices.size() < input.wedge_count) indices.insert(indices.end(), 3, wedge);
  }
  ordered.indices = indices;
  DracoEncoded encoded;
  if (Outcome done = encodeDraco(ordered, 10, encoded); !done.ok()) return done;
  DecodedMesh reference;
  if (Outcome done = decodeDraco(encoded.bytes, reference); !done.ok()) return done;
  if (reference.vertex_count != input.wedge_count) return failure("sequential Draco lost vertices");
  return guarded([&]() -> Outcome {
    std::vector<uint64_t> decoded_hashes;
    std::vector<uint64_t> wedge_hashes;
    if (!hashTuples(decoded, input.attributes.size(), decoded_hashes) ||
        !hashTuples(reference, input.attributes.size(), wedge_hashes)) {
      return failure("decoded mesh lacks attributes of the input");
    }
    std::vector<uint64_t> known = wedge_hashes;
    std::sort(known.begin(), known.end());
    for (const uint64_t hash : decoded_hashes) {
      if (!std::binary_search(known.begin(), known.end(), hash)) ++errors.unmatched_vertex_count;
    }
    std::sort(decoded_hashes.begin(), decoded_hashes.end());
    std::vector<bool> is_used(input.wedge_count, false);
    for (const uint32_t index : input.indices) is_used[index] = true;
    std::vector<uint32_t> source_wedge(input.wedge_count, kNone);
    for (uint32_t wedge = 0; wedge < input.wedge_count; ++wedge) {
      if (!is_used[wedge]) continue;
      if (std::binary_search(decoded_hashes.begin(), decoded_hashes.end(), wedge_hashes[wedge])) {
        source_wedge[wedge] = wedge;
      } else {
        ++errors.missing_wedge_count;
      }
    }
    errors.attributes.resize(input.attributes.size());
    for (uint32_t i = 0; i < input.attributes.size(); ++i) {
      const DecodedAttribute* attribute = reference.find(i);
      const AttributeView& view = input.attributes[i].view;
      if (attribute == nullptr || attribute->component_count != view.format.component_count) {
        return failure("Draco changed the shape of an attribute");
      }
      Outcome measured = measureError(view, input.wedge_count, attribute->component_type,
                                      attribute->values.get(), source_wedge, errors.attributes[i]);
      if (!measured.ok()) return measured;
    }
    return {};
  });
}

Outcome emitDracoPrimitive(const PieceView& piece, size_t part, int speed,
                           DracoPrimitive& primitive) {
  primitive = {};
  DracoInput input;
  if (Outcome made = makeDracoInput(piece, part, input); !made.ok()) return made;
  if (!input.left_out.empty()) {
    input.method = DracoMethod::kSequential;
    input.deduplicate = false;
  }
  DracoEncoded encoded;
  if (Outcome done = encodeDraco(input, speed, encoded); !done.ok()) return done;
  DecodedMesh decoded;
  if (Outcome done = decodeDraco(encoded.bytes, decoded); !done.ok()) return done;
  primitive.bytes = std::move(encoded.bytes);
  primitive.vertex_count = decoded.vertex_count;
  primitive.triangle_count = decoded.triangle_count;
  primitive.left_out = input.left_out;
  primitive.method = input.method;
  for (uint32_t id = 0; id < input.attributes.size(); ++id) {
    const DecodedAttribute* values = decoded.find(id);
    if (values == nullptr) return failure("Draco lost an attribute");
    DracoPrimitiveAttribute attribute;
    attribute.piece_attribute = input.attributes[id].piece_attribute;
    attribute.unique_id = id;
    attribute.minimum.assign(values->component_count, std::numeric_limits<double>::infinity());
    attribute.maximum.assign(values->component_count, -std::numeric_limits<double>::infinity());
    AttributeView view;
    view.format = input.attributes[id].view.format;
    view.format.component_type = values->component_type;
    view.format.component_count = values->component_count;
    view.data = values->values.get();
    view.stride_bytes = values->elementBytes();
    for (uint32_t vertex = 0; vertex < decoded.vertex_count; ++vertex) {
      for (uint32_t c = 0; c < values->component_count; ++c) {
        const double value = readComponent(view, vertex, c);
        attribute.minimum[c] = std::min(attribute.minimum[c], value);
        attribute.maximum[c] = std::max(attribute.maximum[c], value);
      }
    }
    primitive.attributes.push_back(std::move(attribute));
  }
  return {};
}

std::string dracoVersion() { return draco::kDracoVersion; }

}  // namespace mcc::foreign
