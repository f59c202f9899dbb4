// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/upgrade.h"

#include <algorithm>
#include <iterator>

#include "gltf/decompress/coded_input.h"
#include "gltf/document/document.h"
#include "gltf/document/references.h"
#include "tiles/batch_table.h"
#include "tiles/bin_end.h"
#include "tiles/feature_ids.h"
#include "tiles/json_edit.h"
#include "tiles/little_endian.h"
#include "tiles/root_node.h"
#include "tiles/structural_metadata.h"
#include "tiles/tile_file.h"

namespace mcc::tiles {
namespace {

using gltf::Document;
using gltf::Result;

/// Extensions of glTF 1.0, some of which old tools also write into glTF 2.0.
constexpr const char* kOldExtensions[] = {"KHR_binary_glTF",      "KHR_blend",
                                          "KHR_materials_common", "KHR_technique_webgl",
                                          "KHR_techniques_webgl", "WEB3D_quantized_attributes"};

/// Extensions whose numbers of property tables and feature ids would become those of the batch
/// table.
constexpr const char* kMetadataExtensions[] = {"EXT_feature_metadata", "EXT_instance_features",
                                               "EXT_mesh_features", "EXT_structural_metadata"};

/// What the feature table says, apart from RTC_CENTER.
struct Features {
  uint64_t batch_count = 0;
  Json extras;  ///< null: there are none
};

/// Reads BATCH_LENGTH, which is a number or the place of one in the binary part.
Result readBatchCount(const Json& length, std::span<const uint8_t> binary, uint64_t& count) {
  constexpr uint64_t kMost = 0xffffffff;
  const Json* place = gltf::findMember(length, "byteOffset");
  if (place == nullptr) {
    return gltf::readUnsigned(length, "feature table /BATCH_LENGTH", kMost, count);
  }
  uint64_t offset = 0;
  if (!gltf::asUnsigned(*place, offset) || offset > binary.size() || binary.size() - offset < 4) {
    return gltf::error("feature table /BATCH_LENGTH", "it is beyond the binary part of the table");
  }
  count = numberAt(binary, offset);
  return {};
}

Result readFeatures(std::span<const uint8_t> json, std::span<const uint8_t> binary,
                    Features& features) {
  if (json.empty()) return {};
  Json table;
  MCC_GLTF_TRY(gltf::parseJson(json, table));
  if (!table.is_object()) return gltf::error("feature table", "it is not a JSON object");
  for (auto& [key, value] : table.get_ref<Json::object_t&>()) {
    if (key == "BATCH_LENGTH") {
      MCC_GLTF_TRY(readBatchCount(value, binary, features.batch_count));
    } else if (key == "extras") {
      features.extras = std::move(value);
    } else if (key != "RTC_CENTER") {
      return gltf::error("feature table", "its member \"" + key + "\" has no counterpart");
    }
  }
  return {};
}

bool isOneOf(const std::string& name, std::span<const char* const> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Finds extensions next to which nothing can be added. Objects may have extensions that
/// extensionsUsed does not list, so both are searched where they matter.
Result checkExtensions(const Json& root) {
  const auto check = [](const std::string& name) -> Result {
    if (isOneOf(name, kOldExtensions)) {
      return gltf::error("", "its glTF uses " + name + ", which 3D Tiles 1.1 does not have");
    }
    if (isOneOf(name, kMetadataExtensions)) {
      return gltf::error("", "its glTF uses " + name + " already");
    }
    return {};
  };
  const auto checkKeys = [&](const Json& object) -> Result {
    const Json* extensions = gltf::findMember(object, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return {};
    for (const auto& [name, value] : extensions->get_ref<const Json::object_t&>()) {
      MCC_GLTF_TRY(check(name));
    }
    return {};
  };
  for (const Json& name : gltf::arrayOf(root, "extensionsUsed")) {
    if (name.is_string()) MCC_GLTF_TRY(check(name.get<std::string>()));
  }
  MCC_GLTF_TRY(checkKeys(root));
  for (const Json& node : gltf::arrayOf(root, "nodes")) MCC_GLTF_TRY(checkKeys(node));
  for (const Json& mesh : gltf::arrayOf(root, "meshes")) {
    for (const Json& primitive : gltf::arrayOf(mesh, "primitives")) {
      MCC_GLTF_TRY(checkKeys(primitive));
    }
  }
  return {};
}

/// Decodes what may hold batch ids. Other documents are left alone, because decoding takes time.
Result decode(const gltf::ForeignDecoders& decoders, Document& document) {
  bool is_coded = false;
  for (const Json& name : gltf::arrayOf(document.json, "extensionsUsed")) {
    const std::string text = name.is_string() ? name.get<std::string>() : "";
    is_coded = is_coded || text == gltf::kMeshExtension || isOneOf(text, gltf::kViewExtensions);
  }
  if (!is_coded) return {};
  document.decoded = gltf::DecodedBytes(0, document.source_bytes);
  MCC_GLTF_TRY(gltf::decodeViews(decoders, document));
  return gltf::decodeMeshes(decoders, document);
}

/// Changes the document. Errors say why the b3dm is kept.
Result upgrade(const TileFile& tile, const std::string& up_axis,
               const gltf::ForeignDecoders& decoders, Document& document, BinEnd& bin) {
  const auto tables = tile.tablesOf(0);
  Features features;
  MCC_GLTF_TRY(readFeatures(tables[0], tables[1], features));
  BatchTable batch_table;
  MCC_GLTF_TRY(readBatchTable(tables[2], tables[3], features.batch_count, batch_table));
  Json& root = document.json;
  MCC_GLTF_TRY(checkExtensions(root));
  MCC_GLTF_TRY(addRootNode(tile.models()[0].center, up_axis, root));
  if (features.batch_count != 0) {
    bool has_ids = false;
    MCC_GLTF_TRY(decode(decoders, document));
    MCC_GLTF_TRY(convertBatchIds(features.batch_count, document, bin, has_ids));
    MCC_GLTF_TRY(addPropertyTable(batch_table, features.batch_count, root, bin));
    if (has_ids) gltf::addExtensionName(root, "extensionsUsed", "EXT_mesh_features");
    gltf::addExtensionName(root, "extensionsUsed", "EXT_structural_metadata");
  } else if (!batch_table.extras.is_null()) {
    return gltf::error("batch table /extras", "there are no batches whose table could hold them");
  }
  if (features.extras.is_null()) return {};
  if (findMember(root, "extras") != nullptr) {
    return gltf::error("feature table /extras", "the glTF has extras already");
  }
  addMember(root, "extras", std::move(features.extras));
  return {};
}

}  // namespace

Result upgradeB3dm(std::span<const uint8_t> b3dm, const std::string& up_axis,
                   std::vector<uint8_t>& glb, std::string& kept_because,
                   const gltf::ForeignDecoders& decoders) {
  glb.clear();
  kept_because.clear();
  if (kindOf(b3dm) != TileKind::kB3dm) return gltf::error("byte 0", "the file is not a b3dm");
  TileFile tile;
  MCC_GLTF_TRY(tile.read(b3dm));
  const TileModel& model = tile.models()[0];
  const auto source = b3dm.subspan(model.begin, model.end - model.begin);
  constexpr size_t kVersionByte = 4;
  if (source[kVersionByte] == 1) {
    kept_because = "its model is glTF 1.0";
    return {};
  }
  const std::string place = "the GLB at byte " + std::to_string(model.begin);
  gltf::GlbFile parts;
  Result done = gltf::readGlb(source, parts);
  Document document;
  if (done.ok()) done = gltf::loadDocument(source, nullptr, document);
  if (!done.ok()) return gltf::error(place, done.message());
  BinEnd bin(parts);
  const Result changed = upgrade(tile, up_axis, decoders, document, bin);
  if (!changed.ok()) {
    kept_because = changed.message();
    return {};
  }
  return gltf::writeGlb(gltf::printJson(document.json), bin.bytes(), parts.other_chunks, glb);
}

}  // namespace mcc::tiles
