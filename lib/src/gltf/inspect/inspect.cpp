// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Lists what is inside a compressed file.
#include <map>
#include <numbers>

#include "format/methods.h"
#include "gltf/check/prove.h"
#include "gltf/compress/quality.h"
#include "gltf/decompress/decompress.h"
#include "gltf/files/file_io.h"
#include "gltf/inspect/report_json.h"
#include "host/parallel.h"
#include "mcc/files.h"
#include "mcc/glb.h"
#include "mcc/writer.h"

namespace mcc::gltf {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

std::string primitiveLabel(const ExtensionUse::AttributeUse& use) {
  return use.target == kNone ? use.name : "target " + std::to_string(use.target) + " " + use.name;
}

/// Derives the errors of an attribute from its coding.
void describeErrors(AttributeInfos attributes, uint32_t index, InspectAttribute& details) {
  const AttributeInfo& info = attributes[index];
  switch (info.coding) {
    case AttributeCoding::kInteger:
    case AttributeCoding::kExactFloat:
    case AttributeCoding::kGrid: return;
    case AttributeCoding::kAlias:
      return describeErrors(attributes, info.alias_of, details);  // never an alias itself
    case AttributeCoding::kLattice: {
      const bool is_adjusted = info.format.semantic == Semantic::kWeights;
      details.error_bound = double{info.lattice.step} * (is_adjusted ? 1 : 0.5);
      return;
    }
    case AttributeCoding::kOctahedral:
      details.error_bound = octahedralBound(info.bits) * kDegreesPerRadian;
      break;
    case AttributeCoding::kTangentAngle: {
      const uint32_t normal = normalOfTangents(attributes);
      details.error_bound = tangentBound(info.bits, attributes[normal].bits) * kDegreesPerRadian;
      break;
    }
  }
  details.is_angle = true;
}

void describeAttributes(const PieceInfo& piece, InspectPiece& row) {
  const auto count = static_cast<uint32_t>(piece.attributes.size());
  row.attributes.assign(piece.attributes.begin(), piece.attributes.end());
  for (uint32_t i = 0; i < count; ++i) {
    InspectAttribute details;
    details.name = "(unused)";
    details.predictor = predictorName(row.attributes, i);
    describeErrors(row.attributes, i, details);
    row.details.push_back(std::move(details));
  }
}

/// Decodes a payload to count its streams and codes.
class StreamCounter {
 public:
  explicit StreamCounter(InspectPayload& report) : report_(report) {}

  Result run(DecodedPayload& decoded, const std::string& where) {
    mcc::DecodeOptions options;
    options.histogram = &report_.codes;
    options.stage_bits = [](void* user, uint32_t piece, DecodeStage stage, uint32_t attribute,
                            uint64_t bits) {
      static_cast<StreamCounter*>(user)->add(piece, stage, attribute, static_cast<double>(bits));
    };
    options.stage_bits_user = this;
    MCC_GLTF_TRY(toResult(decodePieces(decoded, options), where));
    report_.has_codes = true;
    double header = 8 * static_cast<double>(report_.payload_bytes) - coded_bits_;
    for (size_t i = 0; i < std::size(kNames); ++i) {
      if (stages_[i] != 0) report_.streams.push_back({kNames[i], stages_[i]});
    }
    report_.streams.push_back({"header", header});
    return {};
  }

 private:
  static constexpr const char* kNames[] = {"connectivity", "stitching", "positions",
                                           "seams",        "leftovers", "order"};

  void add(uint32_t piece, DecodeStage stage, uint32_t attribute, double bits) {
    coded_bits_ += bits;
    std::vector<InspectAttribute>& details = report_.pieces[piece].details;
    const bool is_position = stage == DecodeStage::kPositions && !details.empty();
    if (is_position || stage == DecodeStage::kAttribute) {
      details[attribute].coded_bits += bits;
    } else {
      stages_[static_cast<size_t>(stage)] += bits;
    }
  }

  InspectPayload& report_;
  double stages_[std::size(kNames)] = {};
  double coded_bits_ = 0;
};

/// Returns why a piece that is large enough for blocks has none.
std::string whyWhole(const PayloadInfo& payload, const PieceInfo& piece, uint64_t triangle_count) {
  if (!piece.blocks.empty() ||
      blockTriangles(kBlocksByPreference, Preference::kBalanced, triangle_count) == 0)
    return "";
  if (piece.keeps_vertex_order || piece.keeps_triangle_order) return "an order is kept";
  if (piece.attributes.empty()) return "the payload has no attributes";
  if (payload.pieces.size() > 1) return "the payload has other pieces";
  return "its writer was not asked for blocks, or found that it does not cut well; the report of "
         "convert says which";
}

/// Names the primitives of a payload, and its attributes.
void nameUses(const PayloadUse& payload, InspectPayload& report) {
  const auto name = [&](const ExtensionUse& use, uint64_t piece) {
    report.primitives.push_back(primitivePath(use.mesh, use.primitive));
    for (const auto& attribute : use.attributes) {
      report.pieces[piece].details[attribute.id].name = primitiveLabel(attribute);
    }
  };
  for (const ExtensionUse* use : payload.users) name(*use, use->piece);
  for (const ExtensionUse* use : payload.previewed) name(*use, use->preview->piece);
}

Result inspectView(const Document& document, const PayloadUse& payload, bool count_codes,
                   DecodedBytes& decoded_bytes, InspectPayload& report) {
  const std::string where = payload.where();
  const std::span<const uint8_t> bytes = payloadBytes(document, payload.view);
  DecodedPayload decoded;
  MCC_GLTF_TRY(toResult(decoded.payload.open(bytes), where));
  const PayloadInfo& info = decoded.payload.info();
  report.buffer_view = payload.view;
  report.is_preview = payload.users.empty();
  report.payload_bytes = bytes.size();
  report.version_major = info.version_major;
  report.version_minor = info.version_minor;
  report.header_bytes = info.header_bytes;
  report.codes_bytes = info.codes_bytes;
  report.tokens_bytes = info.tokens_bytes;
  report.raw_bits_bytes = info.raw_bits_bytes;
  report.single_coder = info.single_coder;
  for (const PieceInfo& piece : info.pieces) {
    InspectPiece row;
    row.wedge_count = piece.wedge_count;
    row.vertex_count = piece.vertex_count;
    row.surface = piece.surface;
    row.part_count = static_cast<uint32_t>(piece.parts.size());
    for (const PartInfo& part : piece.parts) row.triangle_count += part.triangle_count;
    describeAttributes(piece, row);
    for (const BlockInfo& block : piece.blocks) {
      InspectBlock& to = row.blocks.emplace_back();
      to.wedge_count = block.wedge_count;
      to.repeated_count = block.repeated_count;
      to.triangle_count = block.triangle_count;
      to.stream_bytes = block.stream_bytes;
      std::copy_n(block.low, 3, to.low);
      std::copy_n(block.high, 3, to.high);
    }
    row.whole_because = whyWhole(info, piece, row.triangle_count);
    report.pieces.push_back(std::move(row));
  }
  MCC_GLTF_TRY(checkAgainstPayload(document, payload, info));
  nameUses(payload, report);
  if (!count_codes) return {};
  decoded_bytes.add(outputBytes(info));
  MCC_GLTF_TRY(decoded_bytes.check());
  return StreamCounter(report).run(decoded, where);
}

Result inspectBytes(std::span<const uint8_t> source, const FileReader& read_file, bool count_codes,
                    InspectReport& report) {
  report = {};
  Document document;
  MCC_GLTF_TRY(loadDocument(source, read_file, document));
  report.input_bytes = document.source_bytes;
  for (const Json& name : arrayOf(document.json, "extensionsUsed")) {
    if (name.is_string()) report.extensions_used.push_back(name.get<std::string>());
  }
  report.mesh_count = static_cast<uint32_t>(document.first_primitive_of.size());
  report.primitive_count = static_cast<uint32_t>(document.primitives.size());
  std::vector<ExtensionUse> uses;
  MCC_GLTF_TRY(findExtensionUses(document, uses));
  DecodedBytes decoded(0, document.source_bytes);
  const std::vector<PayloadUse> payloads = payloadUses(document, uses);
  MCC_GLTF_TRY(checkPayloadLengths(document, payloads));
  for (const PayloadUse& payload : payloads) {
    report.payloads.emplace_back();
    MCC_GLTF_TRY(inspectView(document, payload, count_codes, decoded, report.payloads.back()));
  }
  return {};
}

}  // namespace

Result inspectGlb(std::span<const uint8_t> source, bool count_codes, InspectReport& report) {
  return guarded([&]() { return inspectBytes(source, nullptr, count_codes, report); });
}

Result inspectFile(const std::filesystem::path& source, bool count_codes, InspectReport& report) {
  return guarded([&]() -> Result {
    std::vector<uint8_t> bytes;
    MCC_GLTF_TRY(readFile(source, bytes));
    return inFile(source, inspectBytes(bytes, readerOf(source.parent_path()), count_codes, report));
  });
}

}  // namespace mcc::gltf
