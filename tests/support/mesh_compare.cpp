// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "support/mesh_compare.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "support/triangles.h"

namespace mcc::test {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr uint8_t kUntouched = 0xa5;

template <typename... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  stream.precision(9);
  (stream << ... << parts);
  return stream.str();
}

std::string nameOf(const AttributeFormat& format) {
  constexpr const char* kNames[] = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD",
                                    "COLOR",    "JOINTS", "WEIGHTS", "custom"};
  std::string name = kNames[static_cast<size_t>(format.semantic)];
  if (format.semantic >= Semantic::kTexcoord) name += text('_', int{format.set_index});
  if (format.morph_target > 0) name += text(" of morph target ", format.morph_target - 1);
  return name;
}

/// Sorted triangles, each beginning with its smallest corner.
std::vector<TriangleOf<uint32_t>> canonical(std::span<const uint32_t> indices,
                                            std::span<const uint32_t> source_wedge) {
  return sorted(
      trianglesOf(indices, [&](uint32_t v) { return source_wedge.empty() ? v : source_wedge[v]; }));
}

float componentAt(const uint8_t* element, size_t component) {
  float value = 0;
  std::memcpy(&value, element + component * sizeof(float), sizeof(float));
  return value;
}

const uint8_t* elementOf(const AttributeView& view, uint32_t wedge) {
  return static_cast<const uint8_t*>(view.data) + size_t{wedge} * view.stride_bytes;
}

const uint8_t* elementOf(const DecodedAttribute& attribute, uint32_t wedge) {
  return attribute.bytes.data() + size_t{wedge} * elementBytes(attribute.info.format);
}

/// Returns what a writer rounds to and a reader makes of it. [A.10.5]
float latticeValue(float x, float origin, float step) {
  const double q = std::floor(
      (static_cast<double>(x) - static_cast<double>(origin)) / static_cast<double>(step) + 0.5);
  const float scaled = static_cast<float>(q) * step;
  return scaled + origin;
}

std::string compareLatticeItself(const AttributeView& source, uint32_t wedge_count,
                                 const AttributeInfo& info) {
  if (source.quantization_bits == 0)
    return "went on a lattice although exact floats were asked for";
  if (source.lattice != nullptr) {
    return info.lattice == *source.lattice ? "" : "the lattice is not the one the caller gave";
  }
  if (!(info.lattice.step > 0)) return text("the lattice's step is ", info.lattice.step);
  if (info.bits < source.quantization_bits) {
    return text("has ", int{info.bits}, " bits, asked for were ", int{source.quantization_bits});
  }
  double extent = 0;
  for (size_t k = 0; k < source.format.component_count; ++k) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (uint32_t i = 0; i < wedge_count; ++i) {
      const double x = static_cast<double>(componentAt(elementOf(source, i), k));
      low = std::min(low, x);
      high = std::max(high, x);
    }
    extent = std::max(extent, high - low);
  }
  // Deltas of morph targets are on the grid of what they are added to; all weights of a model on
  // one.
  if (source.format.morph_target != 0 || source.format.semantic == Semantic::kWeights) return {};
  const double step = extent / (std::ldexp(1.0, source.quantization_bits) - 1);
  // The lattice's step is a float: rounded by a part of itself, or among denormals to the next one.
  const double rounded_up = step * (1 + 1e-6) + std::numeric_limits<float>::denorm_min();
  if (extent > 0 && static_cast<double>(info.lattice.step) > rounded_up) {
    return text("the lattice's step is ", info.lattice.step, ", the extent needs ", step);
  }
  return "";
}

std::string compareLattice(const AttributeView& source, const DecodedAttribute& decoded,
                           std::span<const uint32_t> source_wedge) {
  const AttributeInfo& info = decoded.info;
  std::string failure =
      compareLatticeItself(source, static_cast<uint32_t>(source_wedge.size()), info);
  if (!failure.empty()) return failure;
  // Weights are moved to neighbouring lattice points so that they add up to one.
  const bool loose = source.format.semantic == Semantic::kWeights;
  const double step = static_cast<double>(info.lattice.step);
  for (uint32_t i = 0; i < source_wedge.size(); ++i) {
    for (size_t k = 0; k < source.format.component_count; ++k) {
      const float x = componentAt(elementOf(source, source_wedge[i]), k);
      const float got = componentAt(elementOf(decoded, i), k);
      const float origin = info.lattice.origin[std::min<size_t>(k, 3)];
      const float expected = latticeValue(x, origin, info.lattice.step);
      const double error = std::abs(static_cast<double>(got) - static_cast<double>(x));
      const double rounding = 1.2e-7 * std::max({std::abs(static_cast<double>(x)),
                                                 std::abs(static_cast<double>(origin)), step});
      if (error > step * (loose ? 1.0 : 0.5) + 2 * rounding) {
        return text("wedge ", i, " component ", k, ": ", x, " came back as ", got, ", off by ",
                    error, " at step ", step);
      }
      if (!loose && std::bit_cast<uint32_t>(got) != std::bit_cast<uint32_t>(expected)) {
        return text("wedge ", i, " component ", k, ": ", x, " is ", expected,
                    " on the lattice, came back as ", got);
      }
    }
  }
  return "";
}

std::string compareBits(const AttributeView& source, const DecodedAttribute& decoded,
                        std::span<const uint32_t> source_wedge) {
  const size_t bytes = elementBytes(source.format);
  for (uint32_t i = 0; i < source_wedge.size(); ++i) {
    if (std::memcmp(elementOf(source, source_wedge[i]), elementOf(decoded, i), bytes) != 0) {
      return text("wedge ", i, ": its bits differ from those of source wedge ", source_wedge[i]);
    }
  }
  return "";
}

std::array<double, 3> directionOf(const uint8_t* element) {
  std::array<double, 3> direction{};
  for (size_t k = 0; k < 3; ++k) direction[k] = static_cast<double>(componentAt(element, k));
  return direction;
}

/// Largest angle an octahedral grid of `bits` bits may turn a unit vector. Half a cell is h in x
/// and y, so at most 2h in z: sqrt(6) h on the octahedron, whose points are 1 / sqrt(3) or more
/// from the centre.
double octahedralAngle(uint8_t bits) {
  const double half_cell = 1 / (std::ldexp(1.0, bits) - 2);
  return std::sqrt(18.0) * half_cell;
}

std::string compareDirections(const AttributeView& source, const DecodedAttribute& decoded,
                              std::span<const uint32_t> source_wedge, double bound) {
  const bool has_sign = source.format.component_count == 4;
  for (uint32_t i = 0; i < source_wedge.size(); ++i) {
    const uint8_t* expected = elementOf(source, source_wedge[i]);
    const uint8_t* got = elementOf(decoded, i);
    const auto [x, y, z] = directionOf(got);
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(std::abs(length - 1) < 1e-3)) return text("wedge ", i, ": its length is ", length);
    const double angle = angleBetween(directionOf(expected), directionOf(got));
    if (!(angle <= bound))
      return text("wedge ", i, ": off by ", angle, " rad, allowed are ", bound);
    if (has_sign && componentAt(expected, 3) != componentAt(got, 3))
      return text("wedge ", i, ": its sign is wrong");
  }
  return "";
}

std::string compareAs(AttributeCoding coding, const PieceView& piece, const DecodedPiece& decoded,
                      size_t which, std::span<const uint32_t> source_wedge) {
  const AttributeView& source = piece.attributes[which];
  const DecodedAttribute& attribute = decoded.attributes[which];
  const bool is_float = source.format.component_type == ComponentType::kFloat32;
  switch (coding) {
    case AttributeCoding::kLattice:
      return is_float ? compareLattice(source, attribute, source_wedge)
                      : "is an integer and went on a lattice";
    case AttributeCoding::kInteger:
    case AttributeCoding::kExactFloat:
    case AttributeCoding::kGrid: return compareBits(source, attribute, source_wedge);
    case AttributeCoding::kOctahedral:
      if (source.quantization_bits == 0)
        return "was quantised although exact floats were asked for";
      return compareDirections(source, attribute, source_wedge,
                               octahedralAngle(attribute.info.bits) + 1e-6);
    case AttributeCoding::kTangentAngle: {
      if (source.quantization_bits == 0)
        return "was quantised although exact floats were asked for";
      // The angle lies in the decoded normal's plane; a source tangent may leave its plane a
      // little.
      double bound = kPi / std::ldexp(1.0, attribute.info.bits) + 0.03;
      for (const DecodedAttribute& other : decoded.attributes) {
        if (other.info.coding == AttributeCoding::kOctahedral)
          bound += octahedralAngle(other.info.bits);
      }
      return compareDirections(source, attribute, source_wedge, bound);
    }
    case AttributeCoding::kAlias: break;
  }
  return "has a coding this comparison does not know";
}

std::string checkTargets(const PieceInfo& info, std::span<const std::vector<uint8_t>> memory,
                         uint32_t padding) {
  for (size_t a = 0; a < memory.size(); ++a) {
    const size_t element = elementBytes(info.attributes[a].format);
    for (size_t i = 0; i < memory[a].size(); ++i) {
      const bool between =
          i / (element + padding) >= info.wedge_count || i % (element + padding) >= element;
      if (between && memory[a][i] != kUntouched) {
        return text("attribute ", a, ": byte ", i, " is outside its elements and was written");
      }
    }
  }
  return "";
}

uint32_t indexAt(const uint8_t* indices, size_t i, size_t bytes) {
  uint32_t index = 0;
  for (size_t k = 0; k < bytes; ++k) index |= uint32_t{indices[i * bytes + k]} << (8 * k);
  return index;
}

std::string describe(const Status& status) {
  return text("error ", static_cast<int>(status.error), ": ", status.what);
}

}  // namespace

std::string compareWedges(uint32_t wedge_count, std::span<const uint32_t> source_wedge) {
  if (source_wedge.size() != wedge_count) {
    return text(wedge_count, " wedges went in, ", source_wedge.size(), " came back");
  }
  std::vector<bool> seen(wedge_count, false);
  for (uint32_t i = 0; i < wedge_count; ++i) {
    if (source_wedge[i] >= wedge_count)
      return text("wedge ", i, " claims to be source wedge ", source_wedge[i]);
    if (seen[source_wedge[i]]) return text("two wedges claim to be source wedge ", source_wedge[i]);
    seen[source_wedge[i]] = true;
  }
  return "";
}

std::string compareTriangles(std::span<const uint32_t> source, std::span<const uint32_t> decoded,
                             std::span<const uint32_t> source_wedge) {
  for (const uint32_t v : decoded) {
    if (v >= source_wedge.size())
      return text("index ", v, " is beyond the ", source_wedge.size(), " wedges");
  }
  const std::vector<TriangleOf<uint32_t>> expected = canonical(source, {});
  const std::vector<TriangleOf<uint32_t>> got = canonical(decoded, source_wedge);
  for (size_t t = 0; t < std::max(expected.size(), got.size()); ++t) {
    if (t < expected.size() && t < got.size() && expected[t] == got[t]) continue;
    const bool missing = t >= got.size() || (t < expected.size() && expected[t] < got[t]);
    const TriangleOf<uint32_t>& odd = missing ? expected[t] : got[t];
    return text("triangle ", odd[0], ' ', odd[1], ' ', odd[2],
                missing ? " of the source is missing" : " is too much", " (", expected.size(),
                " went in, ", got.size(), " came back)");
  }
  return "";
}

std::string compareAttribute(const PieceView& source, const DecodedPiece& decoded, size_t which,
                             std::span<const uint32_t> source_wedge) {
  const AttributeFormat& format = source.attributes[which].format;
  const DecodedAttribute& attribute = decoded.attributes[which];
  const std::string name = nameOf(format) + ": ";
  if (!(attribute.info.format == format)) return name + "came back in another format";
  if (attribute.bytes.size() != size_t{source.wedge_count} * elementBytes(format)) {
    return name + text(attribute.bytes.size(), " bytes came back");
  }
  std::string failure;
  if (attribute.info.coding == AttributeCoding::kAlias) {
    failure = "is an alias of nothing";
    for (size_t other = 0; other < which && !failure.empty(); ++other) {
      DecodedPiece as_other = decoded;
      const AttributeFormat kept = as_other.attributes[which].info.format;
      as_other.attributes[which].info = decoded.attributes[other].info;
      as_other.attributes[which].info.format = kept;
      if (decoded.attributes[other].bytes != attribute.bytes) continue;
      failure =
          compareAs(decoded.attributes[other].info.coding, source, as_other, which, source_wedge);
    }
  } else {
    failure = compareAs(attribute.info.coding, source, decoded, which, source_wedge);
  }
  return failure.empty() ? "" : name + failure;
}

std::string comparePiece(const PieceView& source, const DecodedPiece& decoded,
                         std::span<const uint32_t> source_wedge) {
  if (decoded.wedge_count != source.wedge_count) {
    return text(source.wedge_count, " wedges went in, ", decoded.wedge_count, " came back");
  }
  std::string failure = compareWedges(source.wedge_count, source_wedge);
  if (!failure.empty()) return failure;
  if (decoded.parts.size() != source.parts.size())
    return text(decoded.parts.size(), " parts came back");
  for (size_t p = 0; p < source.parts.size(); ++p) {
    failure = compareTriangles(source.parts[p].indices, decoded.parts[p], source_wedge);
    if (!failure.empty()) return text("part ", p, ": ", failure);
  }
  if (decoded.attributes.size() != source.attributes.size()) {
    return text(decoded.attributes.size(), " attributes came back");
  }
  for (size_t a = 0; a < source.attributes.size(); ++a) {
    failure = compareAttribute(source, decoded, a, source_wedge);
    if (!failure.empty()) return failure;
  }
  return "";
}

std::string decodePayload(std::span<const uint8_t> payload, const TargetLayout& layout,
                          std::vector<DecodedPiece>& pieces, CodeHistogram* histogram) {
  Payload opened;
  Status status = opened.open(payload);
  if (!status.ok()) return "open: " + describe(status);

  struct Memory {
    std::vector<std::vector<uint8_t>> attributes;
    std::vector<std::vector<uint8_t>> indices;
    std::vector<AttributeTarget> attribute_targets;
    std::vector<PartTarget> part_targets;
  };
  const std::span<const PieceInfo> infos = opened.info().pieces;
  const size_t index_bytes = static_cast<size_t>(layout.index_type);
  std::vector<Memory> memory(infos.size());
  std::vector<PieceTarget> targets(infos.size());
  for (size_t p = 0; p < infos.size(); ++p) {
    Memory& m = memory[p];
    for (const AttributeInfo& attribute : infos[p].attributes) {
      const size_t stride = elementBytes(attribute.format) + layout.padding_bytes;
      m.attributes.emplace_back(stride * infos[p].wedge_count, kUntouched);
      m.attribute_targets.push_back({m.attributes.back().data(), stride});
    }
    for (const PartInfo& part : infos[p].parts) {
      m.indices.emplace_back(size_t{part.triangle_count} * 3 * index_bytes, kUntouched);
      m.part_targets.push_back({m.indices.back().data(), layout.index_type});
    }
    targets[p] = {m.attribute_targets, m.part_targets};
  }
  DecodeOptions options;
  options.histogram = histogram;
  status = opened.decode(targets, options);
  if (!status.ok()) return "decode: " + describe(status);

  pieces.clear();
  for (size_t p = 0; p < infos.size(); ++p) {
    std::string failure = checkTargets(infos[p], memory[p].attributes, layout.padding_bytes);
    if (!failure.empty()) return failure;
    DecodedPiece piece;
    piece.wedge_count = infos[p].wedge_count;
    piece.vertex_count = infos[p].vertex_count;
    for (size_t a = 0; a < infos[p].attributes.size(); ++a) {
      DecodedAttribute attribute{infos[p].attributes[a], {}};
      const size_t element = elementBytes(attribute.info.format);
      attribute.bytes.resize(element * piece.wedge_count);
      for (size_t i = 0; i < piece.wedge_count; ++i) {
        std::memcpy(&attribute.bytes[i * element],
                    &memory[p].attributes[a][i * (element + layout.padding_bytes)], element);
      }
      piece.attributes.push_back(std::move(attribute));
    }
    for (const std::vector<uint8_t>& indices : memory[p].indices) {
      std::vector<uint32_t> part(indices.size() / index_bytes);
      for (size_t i = 0; i < part.size(); ++i) part[i] = indexAt(indices.data(), i, index_bytes);
      piece.parts.push_back(std::move(part));
    }
    pieces.push_back(std::move(piece));
  }
  return "";
}

std::string compareOrder(const PieceView& source, const DecodedPiece& decoded,
                         std::span<const uint32_t> source_wedge, const EncodeOptions& options) {
  for (uint32_t i = 0; options.keep_vertex_order && i < source_wedge.size(); ++i) {
    if (source_wedge[i] != i) return text("wedge ", i, " was wedge ", source_wedge[i]);
  }
  for (size_t p = 0; options.keep_triangle_order && p < source.parts.size(); ++p) {
    for (size_t i = 0; i < source.parts[p].indices.size(); ++i) {
      if (source_wedge[decoded.parts[p][i]] != source.parts[p].indices[i]) {
        return text("part ", p, ": triangle ", i / 3, " is another one or turned");
      }
    }
  }
  return "";
}

RoundTrip roundTrip(std::span<const PieceView> pieces, const EncodeSettings& settings,
                    const TargetLayout& layout) {
  RoundTrip result;
  const Status status = encodeWith(pieces, settings, result.encoded);
  if (!status.ok()) {
    result.failure = "encode: " + describe(status);
    return result;
  }
  result.failure = decodePayload(result.encoded.payload, layout, result.decoded, &result.histogram);
  if (!result.failure.empty()) return result;
  if (result.decoded.size() != pieces.size() || result.encoded.pieces.size() != pieces.size()) {
    result.failure = text(result.decoded.size(), " pieces came back");
    return result;
  }
  for (size_t p = 0; p < pieces.size(); ++p) {
    PieceView coded = pieces[p];
    if (settings.indices_only) coded.attributes = {};
    result.failure = comparePiece(coded, result.decoded[p], result.encoded.pieces[p].source_wedge);
    if (result.failure.empty()) {
      result.failure = compareOrder(pieces[p], result.decoded[p],
                                    result.encoded.pieces[p].source_wedge, settings);
    }
    if (!result.failure.empty()) {
      if (pieces.size() > 1) result.failure = text("piece ", p, ": ", result.failure);
      break;
    }
  }
  return result;
}

RoundTrip roundTrip(const PieceView& piece, const EncodeSettings& settings,
                    const TargetLayout& layout) {
  return roundTrip(std::span<const PieceView>(&piece, 1), settings, layout);
}

MeshPiece::MeshPiece(const TestMesh& mesh, const MeshBits& bits)
    : wedge_count_(mesh.vertexCount()), parts_{PartView{mesh.indices}} {
  AttributeFormat format;
  add(format, mesh.positions.data(), bits.position);
  if (!mesh.normals.empty()) {
    format.semantic = Semantic::kNormal;
    add(format, mesh.normals.data(), bits.normal);
  }
  if (!mesh.texcoords.empty()) {
    format.semantic = Semantic::kTexcoord;
    format.component_count = 2;
    add(format, mesh.texcoords.data(), bits.texcoord);
  }
}

void MeshPiece::add(const AttributeFormat& format, const void* data, uint8_t quantization_bits) {
  AttributeView view;
  view.format = format;
  view.data = data;
  view.stride_bytes = elementBytes(format);
  view.quantization_bits = quantization_bits;
  attributes_.push_back(view);
}

void MeshPiece::setPositions(const AttributeFormat& format, const void* data) {
  attributes_[0].format = format;
  attributes_[0].data = data;
  attributes_[0].stride_bytes = elementBytes(format);
}

}  // namespace mcc::test
