// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/inspect/inspect_json.h"

#include "gltf/inspect/report_json.h"
#include "json/json.h"

namespace mcc::gltf {
namespace {

Json codesJson(const CodeHistogram& codes) {
  Json degrees = Json::object();
  for (uint32_t d = 0; d < 256; ++d) {
    if (codes.degree[d] != 0) degrees[std::to_string(d)] = codes.degree[d];
  }
  return {{"S", codes.start},
          {"E", codes.end},
          {"M", codes.handle},
          {"dummy", codes.dummy},
          {"degrees", degrees}};
}

Json pieceJson(const InspectPiece& piece) {
  Json attributes = Json::array();
  for (size_t k = 0; k < piece.attributes.size(); ++k) {
    const AttributeInfo& attribute = piece.attributes[k];
    Json json = {{"name", piece.details[k].name},
                 {"type", typeText(attribute)},
                 {"coding", codingName(attribute.coding, 0)},
                 {"bits", attribute.bits},
                 {"predictor", attribute.predictor},
                 {"predictor_name", piece.details[k].predictor},
                 {"coded_bytes", piece.details[k].coded_bits / 8},
                 {"error_unit", piece.details[k].is_angle ? "degrees" : "accessor units"},
                 {"error_bound", piece.details[k].error_bound}};
    if (attribute.coding == AttributeCoding::kAlias) json["alias_of"] = attribute.alias_of;
    if (attribute.coding == AttributeCoding::kLattice) {
      json["step"] = attribute.lattice.step;
      json["origin"] = attribute.lattice.origin;
    }
    attributes.push_back(std::move(json));
  }
  Json json = {{"vertices", piece.wedge_count},         {"positions", piece.vertex_count},
               {"triangles", piece.triangle_count},     {"parts", piece.part_count},
               {"surface", surfaceName(piece.surface)}, {"attributes", attributes}};
  if (!piece.whole_because.empty()) json["whole_because"] = piece.whole_because;
  for (const InspectBlock& block : piece.blocks) {
    json["blocks"].push_back({{"bytes", block.stream_bytes},
                              {"triangles", block.triangle_count},
                              {"vertices", block.wedge_count},
                              {"repeated", block.repeated_count},
                              {"min", block.low},
                              {"max", block.high}});
  }
  return json;
}

}  // namespace

std::string typeText(const AttributeInfo& attribute) {
  static constexpr const char* kTypes[] = {"i8", "u8", "i16", "u16", "u32", "f32"};
  const AttributeFormat& format = attribute.format;
  return std::string(kTypes[static_cast<size_t>(format.component_type)]) + "x" +
         std::to_string(format.component_count) + (format.normalized ? "n" : "");
}

std::string surfaceName(SurfaceCoding surface) {
  static constexpr const char* kNames[] = {"manifold", "cut at boundaries", "cut",
                                           "vertex by vertex"};
  return kNames[static_cast<size_t>(surface)];
}

Json inspectJson(const std::string& input, const InspectReport& report) {
  Json payloads = Json::array();
  for (const auto& payload : report.payloads) {
    Json pieces = Json::array();
    for (const auto& piece : payload.pieces) pieces.push_back(pieceJson(piece));
    Json json = {{"bufferView", payload.buffer_view},
                 {"bytes", payload.payload_bytes},
                 {"version", std::to_string(payload.version_major) + "." +
                                 std::to_string(payload.version_minor)},
                 {"header_bytes", payload.header_bytes},
                 {"codes_bytes", payload.codes_bytes},
                 {"tokens_bytes", payload.tokens_bytes},
                 {"raw_bits_bytes", payload.raw_bits_bytes},
                 {"single_coder", payload.single_coder},
                 {"primitives", payload.primitives},
                 {"pieces", pieces}};
    if (payload.has_codes) json["codes"] = codesJson(payload.codes);
    for (const StreamReport& stream : payload.streams) {
      json["stream_bytes"][stream.name] = stream.bits / 8;
    }
    payloads.push_back(std::move(json));
  }
  return {{"input", input},
          {"input_bytes", report.input_bytes},
          {"meshes", report.mesh_count},
          {"primitives", report.primitive_count},
          {"extensionsUsed", report.extensions_used},
          {"payloads", payloads}};
}

}  // namespace mcc::gltf
