// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/inspect/report_json.h"

#include "format/codings.h"
#include "format/predictors.h"
#include "json/json.h"

namespace mcc::gltf {
namespace {

Json attributeJson(const AttributeReport& attribute) {
  Json json = {{"name", attribute.name},
               {"coding", codingName(attribute.coding, 0)},
               {"bits", attribute.bits},
               {"components", attribute.component_count},
               {"vertices", attribute.vertex_count},
               {"coded_bytes", attribute.coded_bits / 8},
               {"error_unit", attribute.is_angle ? "degrees" : "accessor units"},
               {"promised_error", attribute.promised_error},
               {"max_error", attribute.max_error}};
  if (attribute.promised_distance > 0) {
    json["promised_distance"] = attribute.promised_distance;
    json["max_distance"] = attribute.max_distance;
  }
  if (attribute.is_angle) json["median_error"] = attribute.median_error;
  if (attribute.extent > 0) json["extent"] = attribute.extent;
  json["primitives"] = attribute.primitives;
  return json;
}

Json payloadJson(const PayloadReport& payload) {
  Json streams = Json::object();
  for (const auto& stream : payload.streams) streams[stream.name] = stream.bits / 8;
  Json attributes = Json::array();
  for (const auto& attribute : payload.attributes) attributes.push_back(attributeJson(attribute));
  Json json = {{"mesh", payload.mesh},
               {"bytes", payload.payload_bytes},
               {"freed_bytes", payload.freed_bytes},
               {"pieces", payload.piece_count},
               {"vertices", payload.wedge_count},
               {"positions", payload.vertex_count},
               {"triangles", payload.triangle_count},
               {"components", payload.component_count},
               {"holes", payload.hole_count},
               {"cut_copies", payload.cut_copy_count},
               {"leftover_triangles", payload.leftover_triangle_count},
               {"stream_bytes", streams},
               {"attributes", attributes}};
  if (payload.same_as != kNone) json["same_as"] = payload.same_as;
  if (payload.block_count != 0) json["blocks"] = payload.block_count;
  if (!payload.whole_because.empty()) json["whole_because"] = payload.whole_because;
  return json;
}

Json primitiveJson(const PrimitiveReport& primitive) {
  Json json = {{"mesh", primitive.mesh},
               {"primitive", primitive.primitive},
               {"compressed", primitive.compressed}};
  if (primitive.compressed) {
    json["payload"] = primitive.payload;
    json["triangles"] = primitive.triangle_count;
    json["vertices"] = primitive.wedge_count;
  }
  if (primitive.preview_triangle_count != 0) {
    json["preview_triangles"] = primitive.preview_triangle_count;
  }
  if (!primitive.note.empty()) json["note"] = primitive.note;
  return json;
}

Json choiceJson(const QualityChoice& choice) {
  Json json = {{"name", choice.name},
               {"attributes", choice.attribute_count},
               {"exact_attributes", choice.exact_count},
               {"why", choice.why}};
  if (choice.most_bits != 0) {
    json["fewest_bits"] = choice.fewest_bits;
    json["most_bits"] = choice.most_bits;
  }
  return json;
}

Json contentsJson(const Contents& contents) {
  return {{"geometry_bytes", contents.geometry_bytes},
          {"image_bytes", contents.image_bytes},
          {"animation_bytes", contents.animation_bytes},
          {"other_bytes", contents.other_bytes},
          {"images", contents.image_count},
          {"image_files", contents.image_file_count},
          {"animations", contents.animation_count}};
}

}  // namespace

Json optionsJson(const ConvertOptions& options) {
  static constexpr const char* kGrids[] = {"mesh", "scene", "primitive"};
  static constexpr const char* kPreferences[] = {"balanced", "size", "speed"};
  Json lattice;
  if (options.position_lattice) {
    const Lattice& l = *options.position_lattice;
    lattice = {l.origin[0], l.origin[1], l.origin[2], l.step};
  }
  Json json = {{"lossless", options.lossless},
               {"max_position_error", options.max_position_error},
               {"is_error_relative", options.is_error_relative},
               {"position_lattice", lattice},
               {"step", options.step},
               {"quality", options.quality},
               {"indices_only", options.indices_only},
               {"drop_unused", options.drop_unused},
               {"fallback", options.fallback},
               {"keep_vertex_order", options.keep_vertex_order},
               {"keep_triangle_order", options.keep_triangle_order},
               {"grid", kGrids[static_cast<size_t>(options.grid)]},
               {"prefer", kPreferences[static_cast<size_t>(options.prefer)]},
               {"position_bits", options.position_bits},
               {"normal_bits", options.normal_bits},
               {"texcoord_bits", options.texcoord_bits},
               {"color_bits", options.color_bits},
               {"tangent_bits", options.tangent_bits},
               {"weight_bits", options.weight_bits},
               {"glb_version", static_cast<uint32_t>(options.glb_version)},
               {"allow_larger", options.allow_larger}};
  if (options.block_triangles != kBlocksByPreference) {
    json["block_triangles"] = options.block_triangles;
  }
  if (options.preview_triangles == kPreviewsByShare) {
    json["preview_triangles"] = "2 %";
  } else if (options.preview_triangles != kNoPreviews) {
    json["preview_triangles"] = options.preview_triangles;
  }
  return json;
}

std::string codingName(AttributeCoding coding, uint32_t bits) {
  const std::string name = infoOf(coding).word;
  return infoOf(coding).has_bits && bits != 0 ? name + " " + std::to_string(bits) : name;
}

Json reportJson(const ConvertReport& report, const ConvertOptions& options) {
  Json payloads = Json::array();
  for (const auto& payload : report.payloads) payloads.push_back(payloadJson(payload));
  Json primitives = Json::array();
  for (const auto& primitive : report.primitives) primitives.push_back(primitiveJson(primitive));
  std::vector<std::string> notes = report.notes;
  notes.insert(notes.end(), report.remarks.begin(), report.remarks.end());
  Json json = {{"options", optionsJson(options)},
               {"input_bytes", report.input_bytes},
               {"output_bytes", report.output_bytes},
               {"fallback_bytes", report.fallback_bytes},
               {"input_contents", contentsJson(report.input_contents)},
               {"output_contents", contentsJson(report.output_contents)},
               {"copied", report.copied},
               {"checked", report.checked},
               {"encode_seconds", report.encode_seconds},
               {"decode_seconds", report.decode_seconds},
               {"check_seconds", report.check_seconds},
               {"payloads", payloads},
               {"primitives", primitives},
               {"notes", notes}};
  if (report.preview_bytes != 0) json["preview_bytes"] = report.preview_bytes;
  for (const QualityChoice& choice : report.quality_choices) {
    json["quality_choices"].push_back(choiceJson(choice));
  }
  return json;
}

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
    if (payload.is_preview) json["preview"] = true;
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

std::string predictorName(AttributeInfos attributes, uint32_t index) {
  const MethodInfo& method = infoOf(methodOf(attributes, index));
  std::string name = method.word;
  for (const PredictorField& field : method) {
    const std::string word = field.value[field.valueOf(attributes[index].predictor)].word;
    if (!word.empty()) name += (name.empty() ? "" : ", ") + word;
  }
  return name;
}

}  // namespace mcc::gltf
