// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/inspect/report_json.h"

#include "format/codings.h"
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
  if (!primitive.note.empty()) json["note"] = primitive.note;
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
  return {{"lossless", options.lossless},
          {"max_position_error", options.max_position_error},
          {"is_error_relative", options.is_error_relative},
          {"position_lattice", lattice},
          {"indices_only", options.indices_only},
          {"drop_unused", options.drop_unused},
          {"fallback", options.fallback},
          {"keep_vertex_order", options.keep_vertex_order},
          {"keep_triangle_order", options.keep_triangle_order},
          {"grid", kGrids[static_cast<size_t>(options.grid)]},
          {"prefer", kPreferences[static_cast<size_t>(options.prefer)]},
          {"quantize_position", options.bits.position},
          {"quantize_normal", options.bits.normal},
          {"quantize_texcoord", options.bits.texcoord},
          {"quantize_color", options.bits.color},
          {"quantize_tangent", options.bits.tangent},
          {"quantize_weight", options.bits.weight}};
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
  return {{"options", optionsJson(options)},
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
}

}  // namespace mcc::gltf
