// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/decompress/coded_input.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "gltf/decompress/decompress.h"
#include "gltf/document/accessors.h"

namespace mcc::gltf {
namespace {

/// Codecs of views expand one byte to at most 64; a view that claims far more is damaged.
constexpr uint64_t kMaxViewExpansion = 256;
/// The same bound as for our payloads.
constexpr uint64_t kMaxMeshExpansion = 4096;

Result inPlace(Result result, const std::string& where) {
  if (!result.ok() && result.where.empty()) result.where = where;
  return result;
}

template <typename Visit>
void visitTrianglePrimitives(const Document& document, const Visit& visit) {
  for (const Primitive& primitive : document.primitives) {
    if (primitive.mode >= 4) visit(primitive);
  }
}

/// How many coded bytes may be decoded, counted as often as they are: views and primitives may name
/// the same ones.
class Room {
 public:
  explicit Room(const Document& document) {
    for (const auto& buffer : document.buffers) bytes_ += kMaxSharing * buffer.size();
  }
  /// There is room for everything.
  Room() : bytes_(~uint64_t{0}) {}

  bool take(uint64_t bytes) {
    if (bytes > bytes_) return false;
    bytes_ -= bytes;
    return true;
  }

 private:
  static constexpr uint64_t kMaxSharing = 16;
  uint64_t bytes_ = 0;
};

const char* const kNoRoom = "its bytes are those of many others, and were decoded too often";

/// Decodes the elements of a view. What is wrong with it becomes its fault; an error is the limit
/// of the document.
Result decodeView(const ForeignDecoders& decoders, uint32_t number, Room& room,
                  Document& document) {
  BufferView& view = document.views[number];
  if (!view.isCoded() || view.coding.decoded != kNone || !view.fault.ok()) return {};
  const ViewCoding& coding = view.coding;
  const std::string where = at("/bufferViews", number) + "/extensions/" + coding.extension;
  if (coding.length / kMaxViewExpansion > view.length) {
    view.fault = error(where, view.length, " bytes cannot hold ", coding.length, " bytes");
    return {};
  }
  if (!room.take(view.length)) {
    view.fault = error(where, kNoRoom);
    return {};
  }
  document.decoded.add(coding.length);
  MCC_GLTF_TRY(document.decoded.check());
  const CodedView coded = {payloadBytes(document, number), coding.count, coding.stride, coding.mode,
                           coding.filter};
  std::vector<uint8_t> elements;
  view.fault = inPlace(decoders.view(coded, elements), where);
  if (view.fault.ok() && elements.size() != coding.length) {
    view.fault = error(where, "decodes to another size");
  }
  if (!view.fault.ok()) return {};
  view.coding.decoded = static_cast<uint32_t>(document.storage.size());
  document.storage.push_back(std::move(elements));
  return {};
}

/// One coded primitive while it is being decoded.
struct CodedPrimitive {
  std::string path;  ///< JSON path of the extension object
  uint32_t view = 0;
  uint32_t indices = 0;              ///< accessor number
  std::vector<uint32_t> attributes;  ///< accessor numbers
  CodedMesh coded;
  bool is_known = false;  ///< its accessors were filled for another primitive
};

class MeshReader {
 public:
  MeshReader(const ForeignDecoders& decoders, Document& document)
      : decoders_(decoders), document_(document), room_(document) {}

  /// Decodes a primitive. Where it is damaged, it stays as it is, with a note; an error is the
  /// limit of the document.
  Result read(const Primitive& primitive) {
    const Json* extension = extensionOf(*primitive.json, kMeshExtension);
    if (extension == nullptr) return {};
    const std::string path = primitive.ref.path();
    CodedPrimitive coded;
    coded.path = path + "/extensions/" + kMeshExtension;
    Result damage = parse(*primitive.json, path, *extension, coded);
    if (damage.ok()) {
      const std::string reason = obstacle(primitive, coded);
      if (!reason.empty()) {
        document_.notes.push_back(path + ": " + reason);
        return {};
      }
      damage = claim(coded);
    }
    if (damage.ok() && !coded.is_known) {
      addDecodedBytes(coded);
      MCC_GLTF_TRY(document_.decoded.check());
      damage = decode(coded);
    }
    if (!damage.ok()) document_.notes.push_back(damage.message());
    if (first_damage_.ok()) first_damage_ = damage;
    return {};
  }

  const Result& firstDamage() const { return first_damage_; }

 private:
  Result accessorOf(const Json* number, const std::string& name, const std::string& path,
                    uint32_t& accessor) const {
    accessor = indexOf(number, document_.accessors.size());
    return accessor != kNone ? Result()
                             : error(at(path, name), "must be the number of an accessor");
  }

  Result parse(const Json& primitive, const std::string& path, const Json& extension,
               CodedPrimitive& coded) const {
    uint64_t view = 0;
    MCC_GLTF_TRY(readUnsigned(extension, "bufferView", coded.path, kNone, view));
    if (view >= document_.views.size() || document_.views[view].isCoded()) {
      return error(coded.path + "/bufferView", "bufferView ", view,
                   " does not exist or is itself compressed");
    }
    coded.view = static_cast<uint32_t>(view);
    MCC_GLTF_TRY(accessorOf(findMember(primitive, "indices"), "indices", path, coded.indices));
    const Json* ids = findMember(extension, "attributes");
    if (ids == nullptr || !ids->is_object()) {
      return error(coded.path, "\"attributes\" is missing or not an object");
    }
    const Json* accessors = findMember(primitive, "attributes");
    for (const auto& [name, value] : ids->items()) {
      CodedMesh::Attribute attribute;
      uint64_t id = 0;
      MCC_GLTF_TRY(readUnsigned(value, at(coded.path + "/attributes", name), kNone, id));
      uint32_t accessor = 0;
      MCC_GLTF_TRY(accessorOf(findMember(accessors, name), name, path + "/attributes", accessor));
      attribute.id = static_cast<uint32_t>(id);
      attribute.component_type = document_.accessors[accessor].component_type;
      attribute.component_count = document_.accessors[accessor].componentCount();
      coded.attributes.push_back(accessor);
      coded.coded.attributes.push_back(attribute);
    }
    return {};
  }

  /// Returns why a primitive is not decoded; empty when it can be. Completes the claims.
  std::string obstacle(const Primitive& primitive, CodedPrimitive& coded) const {
    if (primitive.mode != 4) return "is compressed but not a triangle list";
    std::vector<uint32_t> all = coded.attributes;
    all.push_back(coded.indices);
    const auto has_bytes = [&](uint32_t accessor) {
      return !document_.accessors[accessor].views().empty();
    };
    if (std::any_of(all.begin(), all.end(), has_bytes)) {
      return "is compressed, but its accessors have bytes of their own";
    }
    for (const uint32_t accessor : all) {
      const Result& fault = document_.accessors[accessor].fault;
      if (!fault.ok()) return "is compressed, but " + fault.message();
    }
    if (!document_.views[coded.view].fault.ok()) {
      return "is compressed, but " + document_.views[coded.view].fault.message();
    }
    const Accessor& indices = document_.accessors[coded.indices];
    coded.coded.bytes = payloadBytes(document_, coded.view);
    coded.coded.triangle_count = indices.count / 3;
    if (!indices.is_known_type || indices.componentCount() != 1 || indices.count % 3 != 0 ||
        coded.attributes.empty()) {
      return "is compressed, but its accessors do not describe triangles";
    }
    coded.coded.vertex_count = document_.accessors[coded.attributes[0]].count;
    for (const uint32_t accessor : coded.attributes) {
      const Accessor& claimed = document_.accessors[accessor];
      if (!claimed.is_known_type || claimed.columns != 1 ||
          claimed.count != coded.coded.vertex_count) {
        return "is compressed, but its accessors have different counts";
      }
    }
    const uint64_t limit = kMaxMeshExpansion * coded.coded.bytes.size();
    if (coded.coded.vertex_count > limit || coded.coded.triangle_count > limit) {
      return "is compressed, but claims more vertices or triangles than its bytes can hold";
    }
    return "";
  }

  /// Where the elements of an accessor come from.
  using Origin = std::tuple<uint32_t, bool, uint32_t>;  // view, is an attribute, id

  /// Claims the accessors for the primitive. Error: they are filled from somewhere else, too.
  Result claim(CodedPrimitive& coded) {
    coded.is_known = true;
    for (size_t i = 0; i <= coded.attributes.size(); ++i) {
      const bool is_attribute = i < coded.attributes.size();
      const uint32_t accessor = is_attribute ? coded.attributes[i] : coded.indices;
      const Origin origin = {coded.view, is_attribute,
                             is_attribute ? coded.coded.attributes[i].id : 0};
      const auto [found, is_new] = origins_.try_emplace(accessor, origin);
      if (found->second != origin) {
        return error(coded.path, "accessor ", accessor, " is filled from two different places");
      }
      coded.is_known &= !is_new;
    }
    return {};
  }

  void addDecodedBytes(const CodedPrimitive& coded) {
    document_.decoded.add(12 * coded.coded.triangle_count);
    for (const uint32_t accessor : coded.attributes) {
      document_.decoded.add(coded.coded.vertex_count * document_.accessors[accessor].tightBytes());
    }
  }

  /// Fills all accessors of a primitive, or none.
  Result decode(const CodedPrimitive& coded) {
    if (!room_.take(coded.coded.bytes.size())) return error(coded.path, kNoRoom);
    DecodedMesh mesh;
    MCC_GLTF_TRY(inPlace(decoders_.mesh(coded.coded, mesh), coded.path));
    if (mesh.indices.size() != 3 * coded.coded.triangle_count ||
        mesh.attributes.size() != coded.attributes.size()) {
      return error(coded.path, "decodes to other counts than the accessors have");
    }
    const uint32_t bytes = document_.accessors[coded.indices].tightBytes();
    for (const uint32_t index : mesh.indices) {
      if (index >= coded.coded.vertex_count || uint64_t{index} >> 8 * bytes != 0) {
        return error(coded.path, "has an index that its accessor cannot hold");
      }
    }
    for (size_t i = 0; i < coded.attributes.size(); ++i) {
      const Accessor& accessor = document_.accessors[coded.attributes[i]];
      if (mesh.attributes[i].size() == accessor.count * accessor.tightBytes()) continue;
      return error(coded.path, "decodes to another size than accessor ", coded.attributes[i],
                   " has");
    }
    for (size_t i = 0; i < coded.attributes.size(); ++i) {
      store(coded, coded.attributes[i], std::move(mesh.attributes[i]));
    }
    store(coded, coded.indices, narrowIndices(mesh.indices, bytes));
    return {};
  }

  void store(const CodedPrimitive& coded, uint32_t number, std::vector<uint8_t> elements) {
    Accessor& accessor = document_.accessors[number];
    accessor.decoded = static_cast<uint32_t>(document_.storage.size());
    accessor.decoded_from = coded.view;
    document_.storage.push_back(std::move(elements));
  }

  const ForeignDecoders& decoders_;
  Document& document_;
  std::map<uint32_t, Origin> origins_;  ///< origin of each accessor
  Room room_;
  Result first_damage_;
};

}  // namespace

Result decodeViews(const ForeignDecoders& decoders, Document& document, const Document* source,
                   Result* refused) {
  if (!decoders.view) return {};
  std::vector<bool> is_used(document.accessors.size(), false);
  const auto markUsed = [&](const Primitive& primitive) {
    const auto mark = [&](uint32_t accessor) {
      if (accessor < is_used.size()) is_used[accessor] = true;
    };
    for (const Primitive::Attribute& attribute : primitive.attributes) mark(attribute.accessor);
    mark(primitive.indices);
  };
  visitTrianglePrimitives(document, markUsed);
  if (source != nullptr) visitTrianglePrimitives(*source, markUsed);
  Room room = source == nullptr ? Room(document) : Room();
  for (size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) continue;
    for (const uint32_t number : document.accessors[i].views()) {
      MCC_GLTF_TRY(decodeView(decoders, number, room, document));
      const BufferView& view = document.views[number];
      const bool is_first = refused != nullptr && refused->ok();
      if (is_first && view.isCoded() && !document.isMissing(view.buffer)) *refused = view.fault;
    }
  }
  return {};
}

Result decodeMeshes(const ForeignDecoders& decoders, Document& document, Result* refused) {
  if (!decoders.mesh) return {};
  MeshReader reader(decoders, document);
  Result result;
  visitTrianglePrimitives(document, [&](const Primitive& primitive) {
    if (result.ok()) result = reader.read(primitive);
  });
  if (refused != nullptr && refused->ok()) *refused = reader.firstDamage();
  return result;
}

}  // namespace mcc::gltf
