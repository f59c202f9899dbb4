// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "asset.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

#include "format/predictors.h"
#include "gltf/compress/plan.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/accessors.h"
#include "support/mesh_compare.h"
#include "support/sha256.h"

namespace mcc::conformance {
namespace {

using gltf::test::enumerantOf;

void check(const gltf::Result& result, const std::string& name) {
  if (!result.ok()) throw std::runtime_error(name + ": " + result.message());
}

/// Returns the smallest type that holds `wedge_count` indices; its largest value is not an index.
ComponentType indexType(uint32_t wedge_count) {
  if (wedge_count <= 0xff) return ComponentType::kUint8;
  return wedge_count <= 0xffff ? ComponentType::kUint16 : ComponentType::kUint32;
}

/// Returns what stands in the manifest for the elements (the hash rule of the suite's README).
std::string hashOf(std::span<const uint8_t> tight) { return test::sha256(tight).substr(0, 32); }

class Document {
 public:
  explicit Document(const Asset& asset) : asset_(asset) {
    check(gltf::decodePayload(asset.payload, asset.name, decoded_), asset.name);
    builder_.json = {{"asset", {{"version", "2.0"}, {"generator", "generate-conformance"}}},
                     {"extensionsUsed", {gltf::kExtensionName}},
                     {"extensionsRequired", {gltf::kExtensionName}},
                     {"scene", 0},
                     {"scenes", {{{"nodes", {0}}}}},
                     {"nodes", {{{"mesh", 0}}}},
                     {"meshes", {{{"primitives", Json::array()}}}},
                     {"accessors", Json::array()}};
    builder_.addView(asset.payload);
    expected_ = Json::array();
    const PayloadInfo& info = decoded_.payload.info();
    for (uint32_t p = 0; p < info.pieces.size(); ++p) {
      if (info.pieces[p].wedge_count != 0) addPiece(p, info.pieces[p]);
    }
    builder_.json["buffers"] = {{{"byteLength", builder_.bin.size()}}};
  }

  const gltf::test::Builder& made() const { return builder_; }
  const Json& expected() const { return expected_; }

 private:
  static Json describe(const NamedAttribute& a, uint32_t count, std::span<const uint8_t> tight) {
    Json expected = {{"type", a.type},
                     {"componentType", enumerantOf(a.format.component_type)},
                     {"count", count},
                     {"hash", hashOf(tight)}};
    if (a.format.normalized) expected["normalized"] = true;
    return expected;
  }

  static void addBounds(Json& accessor, const NamedAttribute& a, std::span<const uint8_t> tight) {
    const uint32_t bytes = componentBytes(a.format.component_type);
    std::vector<double> values;
    for (size_t at = 0; at < tight.size(); at += bytes)
      values.push_back(gltf::componentValue(&tight[at], a.format.component_type));
    gltf::test::Builder::setBounds<double>(accessor, values, a.format.component_count);
    for (const char* bound : {"min", "max"}) {
      for (Json& value : accessor[bound]) {
        const auto x = value.get<double>();
        if (x == std::floor(x) && std::fabs(x) < 1e15) value = static_cast<int64_t>(x);
      }
    }
  }

  uint32_t addAccessor(const NamedAttribute& a, uint32_t count, std::span<const uint8_t> tight) {
    Json accessor = {{"componentType", enumerantOf(a.format.component_type)},
                     {"count", count},
                     {"type", a.type}};
    if (a.format.normalized) accessor["normalized"] = true;
    if (a.name == "POSITION") addBounds(accessor, a, tight);
    return builder_.addAccessor(accessor);
  }

  /// An accessor with elements of its own.
  uint32_t addOrdinary(const NamedAttribute& a, uint32_t count) {
    const uint32_t number = addAccessor(a, count, a.bytes);
    const uint32_t view = builder_.addView(a.bytes);
    builder_.json["accessors"][number]["bufferView"] = view;
    return number;
  }

  void addPiece(uint32_t p, const PieceInfo& info) {
    const PieceNames& names = asset_.pieces[p];
    Json primitive = {{"attributes", Json::object()}, {"indices", 0}};
    Json extension = {{"bufferView", 0}};
    if (p != 0) extension["piece"] = p;
    Json expected = {{"indices", Json::object()}, {"attributes", Json::object()}};
    Json targets = Json::array();
    Json target_ids = Json::array();
    Json expected_targets = Json::array();
    const auto place = [&](const NamedAttribute& a, uint32_t accessor, int64_t id, Json described) {
      if (a.target == kNone) {
        primitive["attributes"][a.name] = accessor;
        if (id >= 0) extension["attributes"][a.name] = id;
        expected["attributes"][a.name] = std::move(described);
        return;
      }
      while (targets.size() <= a.target) {
        for (Json* list : {&targets, &target_ids, &expected_targets})
          list->push_back(Json::object());
      }
      targets[a.target][a.name] = accessor;
      if (id >= 0) target_ids[a.target][a.name] = id;
      expected_targets[a.target][a.name] = std::move(described);
    };
    for (size_t i = 0; i < names.coded.size(); ++i) {
      const NamedAttribute& a = names.coded[i];
      const std::vector<uint8_t>& tight = decoded_.pieces[p].attributes[i];
      if (a.name.empty()) continue;
      place(a, addAccessor(a, info.wedge_count, tight), static_cast<int64_t>(i),
            describe(a, info.wedge_count, tight));
    }
    for (const NamedAttribute& a : names.ordinary) {
      place(a, addOrdinary(a, info.wedge_count), -1, describe(a, info.wedge_count, a.bytes));
    }
    if (!targets.empty()) {
      primitive["targets"] = targets;
      extension["targets"] = target_ids;
      expected["targets"] = expected_targets;
    }
    for (uint32_t part = 0; part < info.parts.size(); ++part) {
      const std::vector<uint32_t>& indices = decoded_.pieces[p].parts[part];
      if (indices.empty()) continue;
      if (part != 0) extension["part"] = part;
      primitive["indices"] =
          builder_.addAccessor({{"componentType", enumerantOf(indexType(info.wedge_count))},
                                {"count", indices.size()},
                                {"type", "SCALAR"}});
      primitive["extensions"][gltf::kExtensionName] = extension;
      builder_.json["meshes"][0]["primitives"].push_back(primitive);
      expected["indices"] = {{"count", indices.size()},
                             {"hash", hashOf(gltf::test::bytesOf(indices))}};
      expected_.push_back(expected);
    }
  }

  const Asset& asset_;
  gltf::DecodedPayload decoded_;
  gltf::test::Builder builder_;
  Json expected_;
};

std::vector<std::vector<AttributeView>> viewsOf(const Source& source) {
  std::vector<std::vector<AttributeView>> views;
  for (const SourcePiece& piece : source.pieces) {
    views.emplace_back();
    for (const NamedAttribute& a : piece.attributes) {
      if (a.bytes.size() != size_t{piece.wedge_count} * elementBytes(a.format))
        throw std::runtime_error(source.name + ": " + a.name + " has not one element per wedge");
      views.back().push_back({a.format, a.bytes.data(), elementBytes(a.format), a.bits,
                              a.lattice ? &*a.lattice : nullptr});
      if (source.options.indices_only) break;
    }
  }
  return views;
}

/// Attributes that the payload does not hold, in the decoded order.
std::vector<NamedAttribute> reordered(const SourcePiece& piece, const PieceResult& result) {
  std::vector<NamedAttribute> all = piece.attributes;
  for (NamedAttribute& a : all) {
    const std::vector<uint8_t> source = a.bytes;
    const size_t bytes = elementBytes(a.format);
    for (size_t w = 0; w < piece.wedge_count; ++w)
      std::memcpy(&a.bytes[w * bytes], &source[result.source_wedge[w] * bytes], bytes);
  }
  return all;
}

/// Writes the integers of the first primitive, its accessors and buffer views as 1.0 instead of 1.
void writeFractions(Json& json) {
  std::vector<Json*> todo = {&json["meshes"][0]["primitives"][0], &json["accessors"],
                             &json["bufferViews"]};
  while (!todo.empty()) {
    Json& value = *todo.back();
    todo.pop_back();
    if (value.is_structured()) {
      for (Json& member : value) todo.push_back(&member);
    } else if (value.is_number() && value.text().find_first_of(".eE") == std::string::npos) {
      value = value.get<double>();
    }
  }
}

}  // namespace

NamedAttribute makeAttribute(const std::string& name, uint32_t target, const std::string& type,
                             ComponentType component_type, bool normalized) {
  gltf::Accessor accessor;
  accessor.columns = gltf::test::shapeOf(type).columns;
  accessor.rows = gltf::test::shapeOf(type).rows;
  accessor.component_type = component_type;
  accessor.normalized = normalized;
  NamedAttribute a;
  a.name = name;
  a.target = target;
  a.type = type;
  a.format = gltf::formatOf(name, target, accessor);
  return a;
}

std::vector<uint8_t> bytesOf(const std::string& hex) {
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < hex.size(); i += 2)
    bytes.push_back(static_cast<uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

const Asset& closestTo(const std::vector<uint8_t>& payload, std::span<const Asset> assets) {
  constexpr size_t kMostDifferences = 10;  // the checksum, and what was damaged
  for (const Asset& asset : assets) {
    if (asset.payload.size() != payload.size()) continue;
    size_t differences = 0;
    for (size_t i = 0; i < payload.size(); ++i) differences += asset.payload[i] != payload[i];
    if (differences <= kMostDifferences) return asset;
  }
  throw std::runtime_error("a payload that was found is like no asset: search anew");
}

EncodeSettings ofVersion10() {
  EncodeSettings settings;
  settings.without.add(Feature::kMirrors);
  settings.without.add(Feature::kAnchors);
  settings.without.add(Feature::kStarts);
  for (const MethodInfo& method : kMethods) {
    for (const PredictorField& field : method) {
      if (field.since != 0) settings.without.add(field.feature);
    }
  }
  return settings;
}

Asset encodeSource(const Source& source) {
  const std::vector<std::vector<AttributeView>> attributes = viewsOf(source);
  std::vector<std::vector<PartView>> parts;
  std::vector<PieceView> pieces;
  for (size_t i = 0; i < source.pieces.size(); ++i) {
    parts.emplace_back();
    for (const std::vector<uint32_t>& part : source.pieces[i].parts) parts[i].push_back({part});
  }
  for (size_t i = 0; i < source.pieces.size(); ++i)
    pieces.push_back({source.pieces[i].wedge_count, attributes[i], parts[i]});
  test::RoundTrip trip = test::roundTrip(pieces, source.options);
  if (!trip.failure.empty()) throw std::runtime_error(source.name + ": " + trip.failure);
  if (source.options.block_triangles != kBlocksByPreference && trip.encoded.block_count == 0)
    throw std::runtime_error(source.name + " has no blocks: " + trip.encoded.whole_because);
  Asset asset{source.name, source.shows, std::move(trip.encoded.payload), {}};
  for (size_t i = 0; i < pieces.size(); ++i) {
    PieceNames names;
    if (source.options.indices_only) {
      names.ordinary = reordered(source.pieces[i], trip.encoded.pieces[i]);
    } else {
      names.coded = source.pieces[i].attributes;
      for (NamedAttribute& a : names.coded) {
        a.bytes.clear();
        // Targets that no primitive of a small document can have are left unnamed.
        if (a.target != kNone && a.target >= 16) a.name.clear();
      }
    }
    asset.pieces.push_back(std::move(names));
  }
  return asset;
}

std::string slug(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      out += c;
    else if (c >= 'A' && c <= 'Z')
      out += static_cast<char>(c - 'A' + 'a');
    else if (!out.empty() && out.back() != '_')
      out += '_';
  }
  return out;
}

gltf::test::Builder documentOf(const Asset& asset) {
  gltf::test::Builder made = Document(asset).made();
  if (asset.numbers_with_fractions) writeFractions(made.json);
  made.bin.resize((made.bin.size() + 3) & ~size_t{3}, 0);
  return made;
}

std::vector<uint8_t> makeGlb(const Asset& asset) {
  const gltf::test::Builder made = documentOf(asset);
  return gltf::test::glbOf(made.json, made.bin);
}

Json expectedOf(const Asset& asset) { return Document(asset).expected(); }

}  // namespace mcc::conformance
