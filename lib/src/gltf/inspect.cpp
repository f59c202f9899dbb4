// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What is inside a compressed file.
#include <map>

#include "gltf/decompress.h"
#include "gltf/file_io.h"
#include "gltf/parallel.h"
#include "gltf/payload.h"
#include "mcc/gltf.h"

namespace mcc::gltf {
namespace {

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
