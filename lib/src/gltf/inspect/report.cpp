// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/inspect/report.h"

#include <map>
#include <numbers>

#include "format/codings.h"
#include "format/methods.h"
#include "format/predictors.h"
#include "gltf/compress/quality.h"
#include "gltf/decompress/decompress.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"
#include "mcc/files.h"
#include "mcc/writer.h"

namespace mcc::gltf {
namespace {

void addStreams(const StreamSizes& sizes, PayloadReport& report) {
  report.streams = {{"connectivity", sizes.connectivity_bits},
                    {"stitching", sizes.stitch_bits},
                    {"leftovers", sizes.leftover_bits},
                    {"seams", sizes.seam_bits},
                    {"order", sizes.order_bits},
                    {"header", sizes.header_bits}};
}

void addCounts(const EncodedPayload& payload, PayloadReport& report) {
  report.mesh = payload.plan.mesh;
  report.same_as = payload.same_as;
  report.freed_bytes = payload.freed_bytes;
  report.piece_count = static_cast<uint32_t>(payload.plan.pieces.size());
  report.block_count = payload.result.block_count;
  report.whole_because = payload.result.whole_because;
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    const PiecePlan& piece = payload.plan.pieces[i];
    const PieceResult& result = payload.result.pieces[i];
    report.wedge_count += piece.wedge_count;
    report.triangle_count += piece.triangleCount();
    report.vertex_count += result.topological_vertex_count;
    report.component_count += result.component_count;
    report.hole_count += result.hole_count;
    report.cut_copy_count += result.cut_copy_count;
    report.leftover_triangle_count += result.leftover_triangle_count;
  }
}

/// Adds the coded bits to the measured attributes.
void addAttributeBits(const EncodedPayload& payload, const std::vector<size_t>& rows,
                      std::vector<AttributeReport>& attributes) {
  const StreamSizes& sizes = payload.result.sizes;
  size_t next = 0;
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    for (const AttributePlan& attribute : payload.plan.pieces[i].attributes) {
      double bits = next < sizes.attribute_bits.size() ? sizes.attribute_bits[next] : 0;
      if (attribute.isBase(Semantic::kPosition) && i < sizes.piece_position_bits.size())
        bits += sizes.piece_position_bits[i];
      attributes[rows[next++]].coded_bits += bits;
    }
  }
}

}  // namespace

void addPrimitives(const Document& document, const Compressed& compressed, ConvertReport& report) {
  std::map<PrimitiveRef, PrimitiveReport> known;
  for (uint32_t i = 0; i < compressed.payloads.size(); ++i) {
    const EncodeResult& result = compressed.payloads[i].result;
    if (!result.whole_because.empty()) {
      report.remarks.push_back(at("/meshes", compressed.payloads[i].plan.mesh) +
                               ": is not cut into blocks: " + result.whole_because);
    }
    const PayloadPlan& plan = compressed.payloads[i].plan;
    plan.visitUsers([&](size_t piece, size_t part, const PrimitiveRef& user) {
      PrimitiveReport& row = known[user];
      row.compressed = true;
      row.payload = i;
      row.triangle_count = plan.pieces[piece].parts[part].triangles.size() / 3;
      row.wedge_count = plan.pieces[piece].wedge_count;
    });
  }
  for (const EncodedPayload& preview : compressed.previews) {
    report.preview_bytes += preview.result.payload.size();
    preview.plan.visitUsers([&](size_t piece, size_t part, const PrimitiveRef& user) {
      const PartPlan& coarse = preview.plan.pieces[piece].parts[part];
      known[user].preview_triangle_count = coarse.triangles.size() / 3;
    });
  }
  for (const LeftAlone& left : compressed.left_alone) {
    known[left.primitive].note = left.note;
    (left.is_larger ? report.remarks : report.notes)
        .push_back(left.primitive.path() + ": " + left.note);
  }
  for (const Primitive& primitive : document.primitives) {
    PrimitiveReport& row = known[primitive.ref];
    row.mesh = primitive.ref.mesh;
    row.primitive = primitive.ref.primitive;
    report.primitives.push_back(std::move(row));
  }
}

void addPayloads(const std::vector<EncodedPayload>& payloads,
                 const std::vector<PayloadProof>& proofs, ConvertReport& report) {
  for (size_t i = 0; i < payloads.size(); ++i) {
    PayloadReport payload;
    addCounts(payloads[i], payload);
    payload.attributes = proofs[i].attributes;
    if (payloads[i].same_as == kNone) {  // else it takes no bytes
      payload.payload_bytes = payloads[i].result.payload.size();
      addStreams(payloads[i].result.sizes, payload);
      addAttributeBits(payloads[i], proofs[i].rows, payload.attributes);
    }
    report.payloads.push_back(std::move(payload));
  }
}

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
  return sentence(kTypes[static_cast<size_t>(format.component_type)], "x", format.component_count,
                  (format.normalized ? "n" : ""));
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

namespace {

/// Describes a predictor byte in the specification's words: "weights, palette". Empty for an alias.
std::string predictorName(AttributeInfos attributes, uint32_t index) {
  const MethodInfo& method = infoOf(methodOf(attributes, index));
  std::string name = method.word;
  for (const PredictorField& field : method) {
    const std::string word = field.value[field.valueOf(attributes[index].predictor)].word;
    if (!word.empty()) name += (name.empty() ? "" : ", ") + word;
  }
  return name;
}

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

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
      report.pieces[piece].details[attribute.id].name =
          attributeLabel(attribute.name, attribute.target);
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

Result inspectInput(const Input& input, bool count_codes, InspectReport& report) {
  report = {};
  Document document;
  MCC_GLTF_TRY(loadDocument(input.bytes, input.read_file, document));
  report.input_bytes = document.source_bytes;
  report.extensions_used = extensionNames(document.json, "extensionsUsed");
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
  return guarded([&]() { return inspectInput({{}, {}, source, nullptr}, count_codes, report); });
}

Result inspectFile(const std::filesystem::path& source, bool count_codes, InspectReport& report) {
  return guarded([&]() -> Result {
    Input input;
    MCC_GLTF_TRY(input.open({source, {}}));
    return inFile(source, inspectInput(input, count_codes, report));
  });
}

}  // namespace mcc::gltf
