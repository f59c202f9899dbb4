// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "plain_report.h"

#include <fmt/format.h>

#include <set>

#include "gltf/document/layout.h"
#include "gltf/document/references.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"
#include "host/text.h"
#include "suggest.h"

namespace mcc::tool {
namespace {

struct Drawn {
  uint64_t triangles = 0;
  uint64_t vertices = 0;  ///< primitives that share their positions share their vertices
};

/// Returns how many elements an accessor has that a member of an object names; 0: there is none.
uint64_t countOf(const gltf::Document& document, const gltf::Json* owner, const char* member,
                 uint64_t& accessor) {
  const gltf::Json* number = owner == nullptr ? nullptr : gltf::findMember(*owner, member);
  if (number == nullptr || !gltf::asUnsigned(*number, accessor)) return 0;
  return accessor < document.accessors.size() ? document.accessors[accessor].count : 0;
}

Drawn drawnBy(const gltf::Document& document) {
  Drawn drawn;
  std::set<uint64_t> known;
  gltf::visitPrimitives(document.json, [&](const gltf::PrimitiveRef&, const gltf::Json& primitive) {
    uint64_t mode = 4;
    const gltf::Json* given = gltf::findMember(primitive, "mode");
    if (given != nullptr && !gltf::asUnsigned(*given, mode)) return;
    uint64_t accessor = 0;
    const gltf::Json* attributes = gltf::findMember(primitive, "attributes");
    const uint64_t vertices = countOf(document, attributes, "POSITION", accessor);
    if (vertices != 0 && known.insert(accessor).second) drawn.vertices += vertices;
    const bool has_indices = gltf::findMember(primitive, "indices") != nullptr;
    const uint64_t corners =
        has_indices ? countOf(document, &primitive, "indices", accessor) : vertices;
    if (mode == 4) drawn.triangles += corners / 3;
    if ((mode == 5 || mode == 6) && corners > 2) drawn.triangles += corners - 2;
  });
  return drawn;
}

/// Returns another codec that the file names, or an empty string.
std::string otherCodec(const gltf::Document& document) {
  for (const gltf::Json& name : gltf::arrayOf(document.json, "extensionsUsed")) {
    for (const char* codec :
         {gltf::kMeshExtension, gltf::kViewExtensions[0], gltf::kViewExtensions[1]}) {
      if (name.is_string() && name.text() == codec) return codec;
    }
  }
  return "";
}

Table contentsTable(const gltf::Document& document, Format format) {
  const gltf::Contents contents = gltf::contentsOf(document);
  const Drawn drawn = drawnBy(document);
  Table table({"", "bytes", "what"}, {2});
  table.addRow({"geometry", count(contents.geometry_bytes, format),
                counted(drawn.triangles, "triangle", "triangles") + ", " +
                    counted(drawn.vertices, "vertex", "vertices")});
  if (contents.image_count + contents.image_file_count != 0) {
    std::string images = counted(contents.image_count, "image", "images");
    if (contents.image_file_count != 0) {
      images += ", and " + counted(contents.image_file_count, "file", "files") + " beside it";
    }
    table.addRow({"images", count(contents.image_bytes, format), images});
  }
  if (contents.animation_count != 0) {
    table.addRow({"animations", count(contents.animation_bytes, format),
                  counted(contents.animation_count, "animation", "animations")});
  }
  table.addRow({"the rest", count(contents.other_bytes, format), "JSON, nodes, materials"});
  return table;
}

std::string advice(const std::string& name, const gltf::Document& document) {
  if (drawnBy(document).triangles == 0) return "There are no triangles that could be compressed.\n";
  const std::string codec = otherCodec(document);
  std::string text = "To compress the geometry: gltf-mcc convert " +
                     gltf::printable(shellWord(name)) + " OUT.glb\n";
  if (!codec.empty()) text = "It uses " + codec + ", which convert reads. " + text;
  return text;
}

}  // namespace

gltf::Result plainReport(const std::string& name, const gltf::Source& source, Format format,
                         std::string& text) {
  return gltf::guarded([&]() -> gltf::Result {
    gltf::Input input;
    gltf::Document document;
    MCC_GLTF_TRY(input.open(source));
    MCC_GLTF_TRY(gltf::loadDocument(input.bytes, input.read_file, document));
    text = contentsTable(document, format).print(format) + "\n" + advice(name, document);
    return {};
  });
}

}  // namespace mcc::tool
