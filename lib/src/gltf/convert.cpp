// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The public functions: load, compress or decompress, write, check.
#include <chrono>
#include <map>
#include <set>

#include "gltf/accessors.h"
#include "gltf/check.h"
#include "gltf/coded_input.h"
#include "gltf/compress.h"
#include "gltf/decompress.h"
#include "gltf/file_io.h"
#include "gltf/glb.h"
#include "gltf/parallel.h"
#include "gltf/payload.h"
#include "gltf/rebuild.h"
#include "gltf/uri.h"
#include "mcc/gltf.h"

namespace mcc::gltf {
namespace {

namespace fs = std::filesystem;

class Stopwatch {
 public:
  double seconds() const {
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
    return time.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

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
  report.payload_bytes = payload.payload_bytes;
  report.freed_bytes = payload.freed_bytes;
  report.piece_count = static_cast<uint32_t>(payload.plan.pieces.size());
  for (size_t i = 0; i < payload.plan.pieces.size(); ++i) {
    const PiecePlan& piece = payload.plan.pieces[i];
    const PieceResult& result = payload.result.pieces[i];
    report.wedge_count += piece.wedge_count;
    report.vertex_count += result.topological_vertex_count;
    report.component_count += result.component_count;
    report.hole_count += result.hole_count;
    report.cut_copy_count += result.cut_copy_count;
    report.leftover_triangle_count += result.leftover_triangle_count;
    for (const PartPlan& part : piece.parts) report.triangle_count += part.triangles.size() / 3;
  }
}

/// Adds the coded bits to the measured attributes.
void addAttributeBits(const EncodedPayload& payload, std::vector<AttributeReport>& attributes) {
  std::map<std::string, double> bits;
  size_t next = 0;
  for (const PiecePlan& piece : payload.plan.pieces) {
    for (const AttributePlan& attribute : piece.attributes) {
      const auto& attribute_bits = payload.result.sizes.attribute_bits;
      if (next < attribute_bits.size()) bits[attribute.label()] += attribute_bits[next];
      ++next;
    }
  }
  bits["POSITION"] += payload.result.sizes.position_bits;
  for (AttributeReport& attribute : attributes) attribute.coded_bits = bits[attribute.name];
}

void addPrimitives(const Document& document, const Compressed& compressed, ConvertReport& report) {
  std::map<std::pair<uint32_t, uint32_t>, PrimitiveReport> known;
  for (uint32_t i = 0; i < compressed.payloads.size(); ++i) {
    for (const PiecePlan& piece : compressed.payloads[i].plan.pieces) {
      for (const PartPlan& part : piece.parts) {
        for (const PrimitiveRef& user : part.users) {
          known[{user.mesh, user.primitive}] = {
              user.mesh, user.primitive, true, i, part.triangles.size() / 3, piece.wedge_count, ""};
        }
      }
    }
  }
  for (const LeftAlone& left : compressed.left_alone) {
    PrimitiveReport& primitive = known[{left.primitive.mesh, left.primitive.primitive}];
    primitive.note = left.note;
    report.notes.push_back(left.primitive.path() + ": " + left.note);
  }
  const Json& meshes = arrayOf(document.json, "meshes");
  for (uint32_t m = 0; m < meshes.size(); ++m) {
    const size_t count = arrayOf(meshes[m], "primitives").size();
    for (uint32_t p = 0; p < count; ++p) {
      PrimitiveReport primitive = known[{m, p}];
      primitive.mesh = m;
      primitive.primitive = p;
      report.primitives.push_back(primitive);
    }
  }
}

void copySource(std::span<const uint8_t> source, std::vector<uint8_t>& output,
                ConvertReport& report) {
  output.assign(source.begin(), source.end());
  report.copied = true;
  report.checked = true;
  report.payloads.clear();
  for (PrimitiveReport& primitive : report.primitives) {
    primitive.compressed = false;
    primitive.payload = kNone;
  }
}

/// One conversion from a loaded document; the check comes later, on the bytes that were stored.
struct Conversion {
  Document document;
  Compressed compressed;
};

/// A .gltf in which nothing was compressed still becomes a GLB.
Result writeUncompressed(const Document& document, std::vector<uint8_t>& output) {
  Json json = document.json;
  std::vector<uint8_t> bin;
  std::vector<NewView> no_views;
  const ForeignReferences foreign = findForeignReferences(document.json);
  MCC_GLTF_TRY(rebuildBuffers(document, foreign, no_views, json, bin));
  return writeGlb(printJson(json), bin, document.other_chunks, output);
}

/// What is compressed already must decode: it is part of what the check compares.
Result checkOldPayloads(const Document& document) {
  Decompressed ignored;
  return decompressDocument(document, ignored);
}

Result convertBytes(std::span<const uint8_t> source, const FileReader& read_file,
                    const ConvertOptions& options, Conversion& conversion,
                    std::vector<uint8_t>& output, ConvertReport& report) {
  report = {};
  const Stopwatch watch;
  Document& document = conversion.document;
  Compressed& compressed = conversion.compressed;
  MCC_GLTF_TRY(loadDocument(source, read_file, document));
  MCC_GLTF_TRY(embedImages(read_file, document));
  MCC_GLTF_TRY(decodeViews(options.decoders, document));
  // Attributes beside a payload of triangles would have to be stored anew.
  if (!options.indices_only) MCC_GLTF_TRY(decodeMeshes(options.decoders, document));
  report.input_bytes = document.source_bytes;
  report.notes = document.notes;
  MCC_GLTF_TRY(checkOldPayloads(document));
  MCC_GLTF_TRY(compressDocument(document, options, compressed));
  report.notes.insert(report.notes.end(), compressed.notes.begin(), compressed.notes.end());
  addPrimitives(document, compressed, report);
  if (!compressed.payloads.empty()) {
    MCC_GLTF_TRY(
        writeGlb(printJson(compressed.json), compressed.bin, document.other_chunks, output));
    compressed.json = {};
    compressed.bin = {};
  }
  const bool is_larger = document.is_glb && !options.allow_larger && output.size() >= source.size();
  if (compressed.payloads.empty() || is_larger) {
    compressed.payloads.clear();
    if (document.is_glb) {
      copySource(source, output, report);
      report.notes.push_back("nothing becomes smaller; the output is a copy of the input");
    } else {
      MCC_GLTF_TRY(writeUncompressed(document, output));
    }
  }
  report.encode_seconds = watch.seconds();
  report.output_bytes = output.size();
  return {};
}

/// Checks the stored output and completes the report.
Result checkBytes(const Conversion& conversion, const ForeignDecoders& decoders,
                  std::span<const uint8_t> stored, ConvertReport& report) {
  if (report.copied) return {};
  const Stopwatch watch;
  CheckResult checked;
  const std::vector<EncodedPayload>& payloads = conversion.compressed.payloads;
  MCC_GLTF_TRY(checkConversion(conversion.document, payloads, decoders, stored, checked));
  for (size_t i = 0; i < payloads.size(); ++i) {
    PayloadReport payload;
    addCounts(payloads[i], payload);
    addStreams(payloads[i].result.sizes, payload);
    payload.attributes = std::move(checked.attributes[i]);
    addAttributeBits(payloads[i], payload.attributes);
    report.payloads.push_back(std::move(payload));
  }
  report.decode_seconds = checked.decode_seconds;
  report.check_seconds = watch.seconds() - checked.decode_seconds;
  report.checked = true;
  return {};
}

Result decodeBytes(std::span<const uint8_t> source, const FileReader& read_file, DecodeTo decode_to,
                   std::vector<uint8_t>& output, DecodeReport& report) {
  report = {};
  const Stopwatch watch;
  Document document;
  MCC_GLTF_TRY(loadDocument(source, read_file, document));
  MCC_GLTF_TRY(embedImages(read_file, document));
  report.input_bytes = document.source_bytes;
  report.notes = document.notes;
  Decompressed decompressed;
  MCC_GLTF_TRY(decompressDocument(document, decompressed, decode_to));
  report.notes.insert(report.notes.end(), decompressed.notes.begin(), decompressed.notes.end());
  report.payload_count = decompressed.payload_count;
  report.primitive_count = decompressed.primitive_count;
  report.triangle_count = decompressed.triangle_count;
  report.wedge_count = decompressed.wedge_count;
  if (decompressed.payload_count != 0) {
    MCC_GLTF_TRY(
        writeGlb(printJson(decompressed.json), decompressed.bin, document.other_chunks, output));
  } else if (document.is_glb) {
    report.notes.push_back("nothing in it is compressed; the output is a copy of the input");
    output.assign(source.begin(), source.end());
  } else {
    MCC_GLTF_TRY(writeUncompressed(document, output));
  }
  report.decode_seconds = watch.seconds();
  report.output_bytes = output.size();
  return {};
}

std::string primitiveLabel(const ExtensionUse::AttributeUse& use) {
  return use.target == kNone ? use.name : "target " + std::to_string(use.target) + " " + use.name;
}

Result inspectView(const Document& document, uint32_t view,
                   const std::vector<const ExtensionUse*>& users, bool count_codes,
                   InspectPayload& report) {
  const std::string where = users[0]->path + "/bufferView";
  const std::span<const uint8_t> bytes = payloadBytes(document, view);
  DecodedPayload decoded;
  MCC_GLTF_TRY(toResult(decoded.payload.open(bytes), where));
  const PayloadInfo& info = decoded.payload.info();
  report.buffer_view = view;
  report.payload_bytes = bytes.size();
  report.version_major = info.version_major;
  report.version_minor = info.version_minor;
  report.header_bytes = info.header_bytes;
  report.codes_bytes = info.codes_bytes;
  report.tokens_bytes = info.tokens_bytes;
  report.raw_bits_bytes = info.raw_bits_bytes;
  for (const PieceInfo& piece : info.pieces) {
    InspectPiece row;
    row.wedge_count = piece.wedge_count;
    row.vertex_count = piece.vertex_count;
    row.part_count = static_cast<uint32_t>(piece.parts.size());
    for (const PartInfo& part : piece.parts) row.triangle_count += part.triangle_count;
    row.attributes.assign(piece.attributes.begin(), piece.attributes.end());
    row.attribute_names.assign(row.attributes.size(), "(unused)");
    report.pieces.push_back(std::move(row));
  }
  for (const ExtensionUse* use : users) {
    MCC_GLTF_TRY(checkAgainstPayload(document, *use, info));
    report.primitives.push_back(primitivePath(use->mesh, use->primitive));
    for (const auto& attribute : use->attributes) {
      report.pieces[use->piece].attribute_names[attribute.id] = primitiveLabel(attribute);
    }
  }
  if (!count_codes) return {};
  report.has_codes = true;
  return decodePieces(where, decoded, &report.codes);
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
  for (const Json& mesh : arrayOf(document.json, "meshes")) {
    ++report.mesh_count;
    report.primitive_count += static_cast<uint32_t>(arrayOf(mesh, "primitives").size());
  }
  std::vector<ExtensionUse> uses;
  MCC_GLTF_TRY(findExtensionUses(document, uses));
  std::map<uint32_t, std::vector<const ExtensionUse*>> by_view;
  for (const ExtensionUse& use : uses) by_view[use.view].push_back(&use);
  for (const auto& [view, users] : by_view) {
    report.payloads.emplace_back();
    MCC_GLTF_TRY(inspectView(document, view, users, count_codes, report.payloads.back()));
  }
  return {};
}

/// Relative references of images lead elsewhere from another folder.
void noteFilesLeftBehind(const Document& document, const fs::path& source, const fs::path& output,
                         std::vector<std::string>& notes) {
  std::error_code ignored;
  const fs::path from = fs::absolute(source, ignored).parent_path();
  if (fs::equivalent(from, fs::absolute(output, ignored).parent_path(), ignored)) return;
  const Json& images = arrayOf(document.json, "images");
  for (size_t i = 0; i < images.size(); ++i) {
    const Json* uri = findMember(images[i], "uri");
    if (uri == nullptr || !uri->is_string() || isDataUri(uri->get<std::string>())) continue;
    notes.push_back(at("/images", i) + ": \"" + uri->get<std::string>() +
                    "\" stays a file beside the input; copy it to the output's folder");
  }
}

/// Puts the name of the file in front of where in it something is wrong.
Result inFile(const fs::path& path, Result result) {
  if (result.ok()) return result;
  result.where = result.where.empty() ? path.string() : path.string() + ": " + result.where;
  return result;
}

}  // namespace

Result convertGlb(std::span<const uint8_t> source, const ConvertOptions& options,
                  std::vector<uint8_t>& output, ConvertReport& report) {
  return guarded([&]() -> Result {
    Conversion conversion;
    MCC_GLTF_TRY(convertBytes(source, nullptr, options, conversion, output, report));
    return checkBytes(conversion, options.decoders, output, report);
  });
}

Result convertFile(const fs::path& source, const fs::path& output, const ConvertOptions& options,
                   ConvertReport& report) {
  return guarded([&]() -> Result {
    std::vector<uint8_t> bytes;
    MCC_GLTF_TRY(readFile(source, bytes));
    ReplacementFile file(output);
    MCC_GLTF_TRY(file.check());
    Conversion conversion;
    std::vector<uint8_t> result;
    MCC_GLTF_TRY(inFile(source, convertBytes(bytes, readerOf(source.parent_path()), options,
                                             conversion, result, report)));
    noteFilesLeftBehind(conversion.document, source, output, report.notes);
    MCC_GLTF_TRY(file.write(result));
    MCC_GLTF_TRY(readFile(file.temporaryPath(), result));
    MCC_GLTF_TRY(inFile(source, checkBytes(conversion, options.decoders, result, report)));
    return file.commit();
  });
}

Result decodeGlb(std::span<const uint8_t> source, std::vector<uint8_t>& output,
                 DecodeReport& report, DecodeTo decode_to) {
  return guarded([&]() { return decodeBytes(source, nullptr, decode_to, output, report); });
}

Result decodeFile(const fs::path& source, const fs::path& output, DecodeReport& report,
                  DecodeTo decode_to) {
  return guarded([&]() -> Result {
    std::vector<uint8_t> bytes;
    MCC_GLTF_TRY(readFile(source, bytes));
    ReplacementFile file(output);
    MCC_GLTF_TRY(file.check());
    std::vector<uint8_t> result;
    MCC_GLTF_TRY(inFile(
        source, decodeBytes(bytes, readerOf(source.parent_path()), decode_to, result, report)));
    MCC_GLTF_TRY(file.write(result));
    return file.commit();
  });
}

Result inspectGlb(std::span<const uint8_t> source, bool count_codes, InspectReport& report) {
  return guarded([&]() { return inspectBytes(source, nullptr, count_codes, report); });
}

Result inspectFile(const fs::path& source, bool count_codes, InspectReport& report) {
  return guarded([&]() -> Result {
    std::vector<uint8_t> bytes;
    MCC_GLTF_TRY(readFile(source, bytes));
    return inFile(source, inspectBytes(bytes, readerOf(source.parent_path()), count_codes, report));
  });
}

}  // namespace mcc::gltf
