// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "negatives.h"

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>

#include "base/bytes.h"
#include "connectivity/enc_collapse.h"
#include "container/enc_payload.h"
#include "container/payload_header.h"
#include "entropy/enc_coder.h"
#include "format/predictors.h"
#include "found.h"
#include "header_fields.h"
#include "mcc/glb.h"
#include "sources.h"
#include "support/mesh_generators.h"
#include "writer/truth.h"

namespace mcc::conformance {
namespace {

using gltf::test::glbOf;

/// Returns how a payload fares; the decoded values are dropped.
Status decode(std::span<const uint8_t> bytes) {
  Payload payload;
  Limits limits;
  limits.max_elements = 1u << 20;
  MCC_TRY(payload.open(bytes, limits));
  std::vector<std::vector<AttributeTarget>> attributes;
  std::vector<std::vector<PartTarget>> parts;
  std::vector<PieceTarget> targets;
  for (const PieceInfo& piece : payload.info().pieces) {
    attributes.emplace_back(piece.attributes.size());
    parts.emplace_back(piece.parts.size());
    targets.push_back({attributes.back(), parts.back()});
  }
  return payload.decode(targets);
}

PayloadHeader headerOf(std::span<const uint8_t> payload) {
  PayloadHeader header{Allocator{}};
  const Status status = parsePayload(payload, {}, header);
  if (!status.ok()) throw std::runtime_error(status.what);
  return header;
}

/// Gives an attribute the flag MORE, with this set and morph target. `attribute` is the prefix of
/// its fields.
void stateMore(HeaderFields& fields, const std::string& attribute, uint8_t set,
               const Bytes& target) {
  fields.set(attribute + "kind", fields.get(attribute + "kind") | 0x80);
  fields.insertBefore(attribute + "predictor", attribute + "set", {set});
  fields.insertBefore(attribute + "predictor", attribute + "target", target);
}

class Maker {
 public:
  Maker(std::span<const Asset> assets, std::span<const Asset> all)
      : assets_(assets), every_asset_(all) {
    for (const Asset& asset : assets) headers_.push_back(headerOf(asset.payload));
  }

  std::vector<Negative> run() {
    frames();
    payloadFlags();
    pieces();
    attributes();
    methods();
    positionPredictors();
    streams();
    deepHandle();
    contradictions();
    searched();
    found();
    blocks();
    documents();
    sharedAccessors();
    emptyParts();
    mirrors();
    predictorsOfVersion11();
    anchors();
    trained();
    if (!problems_.empty()) throw std::runtime_error(problems_);
    return std::move(all_);
  }

  std::vector<Invalid> runInvalid() {
    bounds();
    lists();
    fallbacks();
    viewsAndManifolds();
    if (!problems_.empty()) throw std::runtime_error(problems_);
    return std::move(invalid_);
  }

 private:
  using Wanted = std::function<bool(const PayloadHeader&)>;

  /// Returns the smallest asset of this kind.
  const Asset& base(const Wanted& wanted) const {
    const Asset* best = nullptr;
    for (size_t i = 0; i < assets_.size(); ++i) {
      if (!wanted(headers_[i]) ||
          (best != nullptr && best->payload.size() <= assets_[i].payload.size()))
        continue;
      best = &assets_[i];
    }
    return best == nullptr ? throw std::runtime_error("there is no asset to damage") : *best;
  }
  static bool hasFlag(const PayloadHeader& h, uint32_t flag) {
    return h.pieces.size() == 1 && h.pieces[0].has(flag);
  }
  /// Returns the number of an attribute of the first piece for which `wanted` holds, or kNone.
  static uint32_t attributeWith(const PayloadHeader& h,
                                const std::function<bool(const AttributeInfo&)>& wanted) {
    if (h.pieces.size() != 1) return kNone;
    for (uint32_t i = 1; i < h.pieces[0].attribute_count; ++i) {
      if (wanted(h.attributes[i])) return i;
    }
    return kNone;
  }

  void add(const std::string& name, const std::string& section, Error error,
           const std::string& shows, const Asset& asset, Bytes payload) {
    const Status status = decode(payload);
    if (status.error != error) {
      const auto number = static_cast<uint32_t>(status.error);
      problems_ += name + ": the error is " + std::to_string(number) + ", " + status.what + "\n";
      return;
    }
    addFile(name, section, static_cast<uint32_t>(error), shows, withPayload(asset, payload));
  }

  void addFile(const std::string& name, const std::string& section, uint32_t error,
               const std::string& shows, std::vector<uint8_t> glb) {
    std::vector<uint8_t> output;
    gltf::DecodeReport report;
    if (gltf::decodeGlb(glb, output, report).ok()) {
      problems_ += name + " decodes without an error\n";
      return;
    }
    all_.push_back({slug(section) + "_" + slug(name), shows, section, error, std::move(glb)});
  }

  /// A change of the header's fields.
  void field(const std::string& name, const std::string& section, Error error,
             const std::string& shows, const Wanted& wanted,
             const std::function<void(HeaderFields&)>& change) {
    if (std::none_of(headers_.begin(), headers_.end(), wanted)) {
      problems_ += name + ": there is no asset to damage\n";
      return;
    }
    const Asset& asset = base(wanted);
    HeaderFields fields(asset.payload);
    change(fields);
    add(name, section, error, shows, asset, fields.payload());
  }
  void header(const std::string& name, const std::string& section, const std::string& shows,
              const Wanted& wanted, const std::function<void(HeaderFields&)>& change) {
    field(name, section, Error::kBadHeader, shows, wanted, change);
  }

  /// Makes the document claim what the payload's header does, so that the payload is what is
  /// refused.
  static void claimCounts(const Bytes& payload, Json& json) {
    Payload opened;
    if (!opened.open(payload).ok()) return;
    for (const Json& primitive : json["meshes"][0]["primitives"]) {
      const Json& extension = primitive["extensions"][gltf::kExtensionName];
      const PieceInfo& piece = opened.info().pieces[extension.value("piece", size_t{0})];
      const PartInfo& part = piece.parts[extension.value("part", size_t{0})];
      json["accessors"][primitive["indices"].get<size_t>()]["count"] = 3 * part.triangle_count;
      for (const auto& [name, accessor] : primitive["attributes"].items())
        json["accessors"][accessor.get<size_t>()]["count"] = piece.wedge_count;
    }
  }

  /// The file of an asset with another payload.
  static std::vector<uint8_t> withPayload(const Asset& asset, const Bytes& payload) {
    auto [json, source_bin] = documentOf(asset);
    Bytes bin = payload;
    while (bin.size() % 4 != 0) bin.push_back(0);
    const size_t before = (asset.payload.size() + 3) & ~size_t{3};
    bin.insert(bin.end(), source_bin.begin() + static_cast<std::ptrdiff_t>(before),
               source_bin.end());
    const int64_t moved =
        static_cast<int64_t>((payload.size() + 3) & ~size_t{3}) - static_cast<int64_t>(before);
    for (Json& view : json["bufferViews"]) {
      const auto offset = view["byteOffset"].get<int64_t>();
      if (offset != 0) view["byteOffset"] = offset + moved;
    }
    claimCounts(payload, json);
    json["bufferViews"][0]["byteLength"] = payload.size();
    json["buffers"][0]["byteLength"] = bin.size();
    return glbOf(json, bin);
  }

  static bool any(const PayloadHeader& h) {
    return h.pieces.size() == 1 && h.pieces[0].attribute_count == 1 &&
           h.attributes[0].coding == AttributeCoding::kLattice && h.pieces[0].vertex_count >= 4;
  }
  static bool threeStreams(const PayloadHeader& h) {
    return h.pieces.size() == 1 && h.pieces[0].attribute_count >= 1 &&
           h.attributes[0].coding == AttributeCoding::kLattice && !h.singleCoder() &&
           h.streams.raw.size() > 2;
  }

  void frames() {
    const Asset& asset = base(any);
    const auto cutTo = [&](size_t count) {
      Bytes bytes(asset.payload.begin(),
                  asset.payload.begin() + static_cast<std::ptrdiff_t>(count));
      repairChecksum(bytes);
      return bytes;
    };
    const auto with = [&](size_t at, uint8_t value, bool repair) {
      Bytes bytes = asset.payload;
      bytes[at] = value;
      if (repair) repairChecksum(bytes);
      return bytes;
    };
    add("other magic", "A.2.1", Error::kBadMagic, "The magic is L", asset, with(0, 'L', true));
    add("ends after magic", "A.2.1", Error::kTruncated, "The payload ends after the magic", asset,
        cutTo(kVersionOffset));
    add("ends in checksum", "A.2.1", Error::kTruncated, "The payload ends inside the checksum",
        asset, cutTo(kChecksummedFrom - 1));
    add("ends after checksum", "A.2.1", Error::kTruncated, "The payload has no flags", asset,
        cutTo(kChecksummedFrom));
    add("ends in header", "A.2.2", Error::kTruncated, "The payload ends inside the piece", asset,
        cutTo(kChecksummedFrom + 3));
    add("draft 0 9", "A.2.1", Error::kUnsupportedVersion, "The version is 0.9", asset,
        with(kVersionOffset, 0x09, true));
    add("version 2 0", "A.2.1", Error::kUnsupportedVersion, "The version is 2.0", asset,
        with(kVersionOffset, 0x20, true));
    Bytes withdrawn = asset.payload;
    std::copy_n(kWithdrawnMagic, 3, withdrawn.begin());
    add("withdrawn magic", "A.2.1", Error::kUnsupportedVersion, "The magic of a withdrawn draft",
        asset, withdrawn);
    add("damaged stream", "A.2.1", Error::kBadChecksum, "A bit of the streams is flipped", asset,
        with(asset.payload.size() - 1, asset.payload.back() ^ 1, false));
    add("damaged flags", "A.2.1", Error::kBadChecksum,
        "The flags differ, which the checksum covers", asset,
        with(kChecksummedFrom, asset.payload[kChecksummedFrom] ^ 4, false));
    add("damaged checksum", "A.1.3", Error::kBadChecksum, "A bit of the checksum is flipped", asset,
        with(kChecksumOffset, asset.payload[kChecksumOffset] ^ 0x80, false));
    Bytes longer = asset.payload;
    longer.push_back(0);
    add("a byte more", "A.2.1", Error::kBadChecksum, "A zero byte after the payload", asset,
        longer);
  }

  void payloadFlags() {
    for (const uint32_t bit : {5u, 6u, 7u}) {
      header("reserved bit " + std::to_string(bit), "A.2.1",
             "A reserved bit of the payload's flags", any,
             [=](HeaderFields& f) { f.set("flags", f.get("flags") | 1u << bit); });
    }
    for (const uint8_t count : {uint8_t{0}, uint8_t{1}}) {
      header("piece count " + std::to_string(count), "A.2.1",
             "A piece count that needs no statement", any, [=](HeaderFields& f) {
               f.set("flags", f.get("flags") | payload_flag::kManyPieces);
               f.insertBefore("0.flags", "piece count", {count});
             });
    }
    field("pieces above the limit", "A.2.1", Error::kLimit, "2^32 - 1 pieces", any,
          [](HeaderFields& f) {
            f.set("flags", f.get("flags") | payload_flag::kManyPieces);
            f.insertBefore("0.flags", "piece count", varint(0xffffffff));
          });
    header("varint with a zero", "A.1.1", "A number whose last byte is a zero that is not needed",
           any, [](HeaderFields& f) {
             Bytes& bytes = f.bytes("0.vertices");
             bytes.back() |= 0x80;
             bytes.push_back(0);
           });
    header("varint of 33 bits", "A.1.1", "A number whose fifth byte exceeds 15", any,
           [](HeaderFields& f) {
             f.bytes("0.vertices") = {0xff, 0xff, 0xff, 0xff, 0x10};
           });
    header("varint of six bytes", "A.1.1", "A number of six bytes", any,
           [](HeaderFields& f) { f.bytes("0.vertices") = {0x80, 0x80, 0x80, 0x80, 0x80, 0x01}; });
  }

  void pieces() {
    const auto withFlag = [](uint32_t flag) {
      return [=](const PayloadHeader& h) { return hasFlag(h, flag); };
    };
    for (const uint32_t bit : {12u, 31u}) {
      header("reserved bit " + std::to_string(bit), "A.2.2", "A reserved bit of the piece's flags",
             any, [=](HeaderFields& f) { f.set("0.flags", f.get("0.flags") | 1u << bit); });
    }
    const auto setFlag = [](uint32_t flag) {
      return [=](HeaderFields& f) { f.set("0.flags", f.get("0.flags") | flag); };
    };
    header("creases without seams", "A.2.2", "CREASES without SEAMS", any,
           setFlag(piece_flag::kCreases));
    header("pivots with handles", "A.2.2", "A surface that is not cut, with HANDLES", any,
           setFlag(piece_flag::kSurfaceMask | piece_flag::kHandles));
    struct Stated {
      uint32_t flag;
      const char* name;
    };
    for (const Stated& stated :
         {Stated{piece_flag::kHoles, "dummies"}, Stated{piece_flag::kIsolated, "isolated"},
          Stated{piece_flag::kListed, "listed"}}) {
      header(std::string("no ") + stated.name, "A.2.2",
             std::string("The number of ") + stated.name + " is stated as 0", withFlag(stated.flag),
             [&](HeaderFields& f) { f.set(std::string("0.") + stated.name, 0); });
    }
    const auto parts = withFlag(piece_flag::kManyParts);
    for (const uint32_t count : {0u, 1u}) {
      header(std::to_string(count) + " parts", "A.2.2", "A number of parts that needs no statement",
             parts, [=](HeaderFields& f) { f.set("0.parts", count); });
    }
    field("parts beyond the bytes", "A.2.2", Error::kTruncated, "More parts than bytes", parts,
          [](HeaderFields& f) { f.set("0.parts", 1u << 27); });
    header("parts do not sum", "A.2.2",
           "The triangles of the parts are one more than the piece has", parts,
           [](HeaderFields& f) { f.set("0.part 0", f.get("0.part 0") + 1); });
    struct Count {
      const char* name;
      const char* field;
      uint32_t value;
      Error error;
      const char* shows;
    };
    constexpr uint32_t kMuch = 1u << 28;
    const Count counts[] = {
        {"vertices at the limit", "0.vertices", kMuch, Error::kLimit, "2^28 vertices"},
        {"faces at the limit", "0.faces", kMuch, Error::kLimit, "2^28 faces"},
        {"wedges at the limit", "0.wedges", 2 * kMuch, Error::kLimit,
         "2^28 wedges more than vertices"},
        {"fewer wedges than none", "0.wedges", 0xffffffff, Error::kLimit,
         "The number of wedges is negative, that is, huge"},
        {"no vertices", "0.vertices", 0, Error::kBadHeader, "Faces without vertices"},
        {"no faces", "0.faces", 0, Error::kBadHeader, "Vertices without faces"},
        {"few faces", "0.faces", 1, Error::kBadHeader, "More than three vertices to a face"},
        {"operations", "0.operations", 200000, Error::kBadHeader,
         "More operations than vertices and four per face"},
        {"fewer operations than none", "0.operations", 0xffff, Error::kBadHeader,
         "The number of operations is negative"},
    };
    for (const Count& count : counts) {
      field(count.name, "A.2.2", count.error, count.shows, any, [&](HeaderFields& f) {
        // A small change of the faces may not end before the vertices.
        f.set(count.field, count.value);
        if (std::string(count.field) == "0.vertices" && count.value == 0) {
          f.set("0.operations", 4);
          f.set("0.wedges", 8);
        }
      });
    }
    header("wedges above corners", "A.2.2", "More wedges on the surface than corners", any,
           [](HeaderFields& f) {
             f.set("0.wedges", 2 * (3 * f.get("0.faces") + 1 - f.get("0.vertices")));
           });
    field("triangles at the limit", "A.2.2", Error::kLimit,
          "Faces and listed triangles are 2^28 together", withFlag(piece_flag::kListed),
          [](HeaderFields& f) { f.set("0.listed", kMuch - 1); });
    header("isolated above wedges", "A.2.2", "More isolated wedges than wedges",
           withFlag(piece_flag::kIsolated), [](HeaderFields& f) { f.set("0.isolated", 5000); });
    header("dummies above corners", "A.2.2", "More dummies than corners",
           withFlag(piece_flag::kHoles),
           [](HeaderFields& f) { f.set("0.dummies", 3 * f.get("0.faces") + 1); });
    field("many elements", "A.2.6", Error::kLimit, "More than 1024 elements to a byte",
          withFlag(piece_flag::kIsolated), [](HeaderFields& f) {
            const uint32_t more = 1u << 26;
            f.set("0.isolated", f.get("0.isolated") + more);
            f.set("0.wedges", f.get("0.wedges") + 2 * more);
          });
    // Few listed triangles by themselves, but too many for what counts each of them again.
    const auto hasList = [](const PayloadHeader& h) {
      return h.pieces[0].has(piece_flag::kListed) && !h.pieces[0].has(piece_flag::kManyParts);
    };
    const auto withList = [](uint64_t times) {
      return [times](HeaderFields& f) {
        const uint64_t most = kMaxElementsPerByte * f.payload().size();
        f.set("0.listed", static_cast<uint32_t>(most / times + 1));
      };
    };
    field(
        "many triangles of attributes", "A.2.6", Error::kLimit,
        "Triangles times attributes are more than 1024 elements to a byte",
        [&](const PayloadHeader& h) { return hasList(h) && h.pieces[0].attribute_count >= 3; },
        withList(3));
    field(
        "many places of triangles", "A.2.6", Error::kLimit,
        "Triangles in an order that is kept are more than 1024 elements to a byte",
        [&](const PayloadHeader& h) {
          return hasList(h) && h.pieces[0].has(piece_flag::kTriangleOrder) &&
                 h.pieces[0].attribute_count < 6;
        },
        withList(kElementsPerSearch));
    field(
        "wedges without seams", "A.2.7", Error::kBadAttribute,
        "A wedge more than groups, without seams",
        [](const PayloadHeader& h) {
          return any(h) && !h.pieces[0].has(piece_flag::kSeams | piece_flag::kIsolated) &&
                 h.pieces[0].wedge_count == h.pieces[0].vertex_count;
        },
        [](HeaderFields& f) { f.set("0.wedges", 2); });
    header("same attributes first", "A.2.3", "The first piece has the attributes of the one before",
           any, [](HeaderFields& f) {
             f.set("0.flags", f.get("0.flags") | piece_flag::kSameAttributes);
           });
    header(
        "creases without positions", "A.2.3", "CREASES in a piece without attributes",
        [](const PayloadHeader& h) {
          return h.pieces.size() == 1 && h.pieces[0].attribute_count == 0;
        },
        [](HeaderFields& f) {
          f.set("0.flags", f.get("0.flags") | piece_flag::kSeams | piece_flag::kCreases);
        });
    field("attributes above the limit", "A.2.3", Error::kLimit, "2^32 - 1 attributes", any,
          [](HeaderFields& f) { f.set("0.attributes", 0xffffffff); });
  }

  void attributes() {
    struct Change {
      const char* name;
      const char* shows;
      std::function<void(HeaderFields&)> change;
    };
    const auto set = [](const std::string& name, uint32_t value) {
      return [=](HeaderFields& f) { f.set(name, value); };
    };
    const auto floatBits = [](float value) { return std::bit_cast<uint32_t>(value); };
    const auto setType = [](uint32_t type, uint32_t components) {
      return
          [=](HeaderFields& f) { f.setType("0.0.", static_cast<ComponentType>(type), components); };
    };
    const auto setBits = [](uint32_t bits) {
      return [=](HeaderFields& f) { f.setLatticeBits("0.0.", bits); };
    };
    const auto setFloat = [](uint32_t index, uint32_t value, uint32_t form) {
      return [=](HeaderFields& f) { f.setFloat("0.0.", index, value, form); };
    };
    // The position is on a lattice.
    const Change positions[] = {
        {"position is a normal", "The first attribute is no position", set("0.0.kind", 1)},
        {"position with a set", "The position has set 1",
         [](HeaderFields& f) { stateMore(f, "0.0.", 1, {0}); }},
        {"position of two components", "The position has two components",
         [](HeaderFields& f) {
           f.setType("0.0.", ComponentType::kFloat32, 2);
           f.setFloat("0.0.", 3, 0, 0);
           f.erase("0.0.origin 2");
         }},
        {"position octahedral", "The position is octahedral",
         [](HeaderFields& f) {
           f.setCoding("0.0.", AttributeCoding::kOctahedral);
           f.set("0.0.lattice", 8);
           f.erase("0.0.step");
           for (const char* name : {"0.0.origin 0", "0.0.origin 1", "0.0.origin 2"}) f.erase(name);
         }},
    };
    for (const Change& c : positions) header(c.name, "A.2.3", c.shows, any, c.change);
    const Change lattices[] = {
        {"component type 6", "A component type that is not assigned", setType(6, 3)},
        {"component type 7", "A component type that is not assigned", setType(7, 3)},
        {"usual type", "A type that needs no statement", setType(5, 3)},
        {"coding 7", "A coding that is not assigned", set("0.0.kind", 7 << 3)},
        {"more without need", "MORE, though set and morph target are 0",
         [](HeaderFields& f) { stateMore(f, "0.0.", 0, {0}); }},
        {"morph target 65536", "A morph target above 65535",
         [](HeaderFields& f) { stateMore(f, "0.0.", 0, varint(65536)); }},
        {"integer floats", "Floats with the coding of integers", set("0.0.kind", 1 << 3)},
        {"lattice of integers", "Integers with the coding of floats", setType(2, 3)},
        {"lattice of 0 bits", "A lattice of 0 bits", setBits(0)},
        {"lattice of 25 bits", "A lattice of 25 bits", setBits(25)},
        {"reserved bit of a lattice", "A form of an origin that the lattice does not have",
         [](HeaderFields& f) { f.set("0.0.lattice", f.get("0.0.lattice") | 1 << 13); }},
        {"step of 0", "A lattice whose step is 0", setFloat(0, 0, 2)},
        {"negative step", "A lattice with a negative step", setFloat(0, floatBits(-1.0f), 2)},
        {"step of minus zero", "A lattice whose step is -0", setFloat(0, 0x80000000, 2)},
        {"infinite step", "A lattice with an infinite step", setFloat(0, 0x7f800000, 2)},
        {"step of nan", "A lattice whose step is no number", setFloat(0, 0x7fc00000, 2)},
        {"infinite origin", "A lattice with an infinite origin", setFloat(2, 0xff800000, 2)},
        {"origin of nan", "A lattice whose origin is no number", setFloat(3, 0x7f800001, 0)},
        {"form 0 of three bytes", "A step of four bytes of which the lowest is 0",
         setFloat(0, 0x3a800100, 0)},
        {"form 1 of two bytes", "An origin of three bytes of which the lowest is 0",
         setFloat(1, 0x40400000, 1)},
        {"form 2 of no bytes", "An origin of 0 that is stated", setFloat(1, 0, 2)},
        {"usual step", "A step that needs no statement",
         [&](HeaderFields& f) {
           f.setLatticeBits("0.0.", 1);
           f.setFloat("0.0.", 0, floatBits(1), 2);
         }},
    };
    for (const Change& c : lattices) header(c.name, "A.2.4", c.shows, any, c.change);

    // A change of another attribute: `k` is its number.
    const auto other = [&](const std::string& name, const std::string& shows,
                           const std::function<bool(const AttributeInfo&)>& wanted,
                           const std::function<void(HeaderFields&, const std::string& k)>& change) {
      const Wanted has = [&](const PayloadHeader& h) { return attributeWith(h, wanted) != kNone; };
      header(name, "A.2.4", shows, has, [&](HeaderFields& f) {
        const uint32_t k = attributeWith(headerOf(base(has).payload), wanted);
        change(f, "0." + std::to_string(k) + ".");
      });
    };
    const auto coded = [](AttributeCoding coding) {
      return [=](const AttributeInfo& a) { return a.coding == coding; };
    };
    const auto baseNormal = [](const AttributeInfo& a) {
      return a.coding == AttributeCoding::kOctahedral && a.format.semantic == Semantic::kNormal;
    };
    for (const uint32_t bits : {1u, 17u}) {
      other("octahedral of " + std::to_string(bits) + " bits",
            "An octahedral grid of a number of bits that is not allowed", baseNormal,
            [=](HeaderFields& f, const std::string& k) { f.set(k + "bits", bits); });
      other("tangent angle of " + std::to_string(bits) + " bits",
            "A tangent angle of a number of bits that is not allowed",
            coded(AttributeCoding::kTangentAngle),
            [=](HeaderFields& f, const std::string& k) { f.set(k + "bits", bits); });
    }
    other("octahedral of four components",
          "An octahedral attribute that is no tangent, of four components", baseNormal,
          [](HeaderFields& f, const std::string& k) { f.setType(k, ComponentType::kFloat32, 4); });
    other(
        "octahedral tangent of three", "An octahedral tangent of three components",
        [](const AttributeInfo& a) {
          return a.coding == AttributeCoding::kOctahedral &&
                 a.format.semantic == Semantic::kTangent;
        },
        [](HeaderFields& f, const std::string& k) { f.setType(k, ComponentType::kFloat32, 3); });
    other(
        "octahedral tangent of a target", "An octahedral tangent of a morph target",
        [](const AttributeInfo& a) {
          return a.coding == AttributeCoding::kOctahedral &&
                 a.format.semantic == Semantic::kTangent;
        },
        [](HeaderFields& f, const std::string& k) { stateMore(f, k, 0, {1}); });
    other("angle that is no tangent", "A tangent angle whose semantic is not that of tangents",
          coded(AttributeCoding::kTangentAngle),
          [](HeaderFields& f, const std::string& k) { f.set(k + "kind", 4 << 3 | 4); });
    other("angle of three components", "A tangent angle of three components",
          coded(AttributeCoding::kTangentAngle),
          [](HeaderFields& f, const std::string& k) { f.setType(k, ComponentType::kFloat32, 3); });
    other("angle without a normal", "A tangent angle, and no octahedral normal before or after it",
          baseNormal, [](HeaderFields& f, const std::string& k) {
            f.set(k + "kind", 4 << 3 | 2);
            f.set(k + "predictor", 0);
          });
    other(
        "lattice of nine components", "A lattice of nine components",
        [](const AttributeInfo& a) {
          return a.coding == AttributeCoding::kLattice && a.format.component_count == 4;
        },
        [](HeaderFields& f, const std::string& k) { f.setType(k, ComponentType::kFloat32, 9); });
    const auto grid = coded(AttributeCoding::kGrid);
    other("grid of 0 bits", "A grid of 0 bits", grid,
          [](HeaderFields& f, const std::string& k) { f.set(k + "grid bits", 0); });
    other("grid of 28 bits", "A grid of 28 bits", grid,
          [](HeaderFields& f, const std::string& k) { f.set(k + "grid bits", 28); });
    other("tails 3", "Tails that are not assigned", grid,
          [](HeaderFields& f, const std::string& k) {
            f.set(k + "grid", 100);
            f.set(k + "grid bits", 3 << 5 | 8);
          });
    other("tails of decimals", "Tails below a decimal grid", grid,
          [](HeaderFields& f, const std::string& k) {
            f.set(k + "grid", 3);
            f.set(k + "grid bits", 1 << 5 | 8);
          });
    other("grid of nine components", "A grid of nine components", grid,
          [](HeaderFields& f, const std::string& k) { f.setType(k, ComponentType::kFloat32, 9); });
    const auto integers = [](const AttributeInfo& a) {
      return a.coding == AttributeCoding::kInteger && a.format.semantic == Semantic::kCustom;
    };
    for (const uint32_t components : {5u, 8u, 10u}) {
      other(std::to_string(components) + " components", "A number of components that no type has",
            integers, [=](HeaderFields& f, const std::string& k) {
              f.set(k + "type", (f.get(k + "type") & 0x87) | (components - 1) << 3);
            });
    }
    const auto alias = coded(AttributeCoding::kAlias);
    other("alias of the position", "An alias of attribute 0", alias,
          [](HeaderFields& f, const std::string& k) { f.set(k + "alias", 0); });
    other("alias of itself", "An alias of itself", alias,
          [](HeaderFields& f, const std::string& k) {
            f.set(k + "alias", static_cast<uint32_t>(std::stoul(k.substr(2))));
          });
    other("alias of none", "An alias of an attribute that is not there", alias,
          [](HeaderFields& f, const std::string& k) { f.set(k + "alias", 0xffffffff); });
    other("alias of another type", "An alias with another component type", alias,
          [](HeaderFields& f, const std::string& k) {
            f.setType(k, ComponentType::kInt16, f.componentsOf(k));
          });
    other("alias of other components", "An alias with another number of components", alias,
          [](HeaderFields& f, const std::string& k) { f.setType(k, ComponentType::kFloat32, 9); });
    other("alias with a predictor", "An alias whose predictor is not 0", alias,
          [](HeaderFields& f, const std::string& k) { f.set(k + "predictor", 0x80); });
  }

  /// Predictor bytes that a method does not have: a value beyond those of a field, and the lowest
  /// and the highest of the bits that no field of version 1.0 has.
  static std::vector<uint8_t> wrongPredictors(const MethodInfo& method) {
    std::vector<uint8_t> wrong;
    uint32_t free_bits = 0xff;
    for (const PredictorField& field : method) {
      if (field.since != 0) continue;
      const uint8_t beyond = field.with(0, field.value_count);
      if (field.valueOf(beyond) == field.value_count) wrong.push_back(beyond);
      free_bits &= ~uint32_t{field.mask};
    }
    wrong.push_back(static_cast<uint8_t>(free_bits & (0u - free_bits)));
    wrong.push_back(static_cast<uint8_t>(std::bit_floor(free_bits)));
    return wrong;
  }

  void methods() {
    for (const MethodInfo& m : kMethods) {
      if (m.method == AttributeMethod::kPosition || m.method == AttributeMethod::kAlias) continue;
      const auto number = [&](const PayloadHeader& h) {
        if (h.pieces.size() != 1) return kNone;
        for (uint32_t i = 1; i < h.pieces[0].attribute_count; ++i) {
          if (methodOf(h.attributesOf(h.pieces[0]), i) == m.method) return i;
        }
        return kNone;
      };
      predictorsOf(m.name, wrongPredictors(m), number);
    }
  }

  /// Bits that minor version 1 added are wrong in version 1.0, others still are in 1.1.
  void predictorsOfVersion11() {
    const std::vector<Source> sources = tangentSources();
    const auto tangents = [&](uint8_t minor, const Source& source, uint32_t predictor) {
      const Asset asset = encodeSource(source);
      const PayloadHeader before = headerOf(asset.payload);
      const uint32_t last = before.pieces[0].attribute_count - 1;
      const std::string name = infoOf(methodOf(before.attributesOf(before.pieces[0]), last)).name;
      HeaderFields fields(asset.payload);
      fields.set("0." + std::to_string(last) + ".predictor", predictor);
      Bytes payload = fields.payload();
      payload[kVersionOffset] = static_cast<uint8_t>(kVersionMajor << 4 | minor);
      repairChecksum(payload);
      const std::string version = "1." + std::to_string(minor);
      add("predictor " + std::to_string(predictor) + " of " + name + " in " + version, "A.2.4",
          Error::kBadHeader,
          "A predictor that the method " + name + " does not have in version " + version, asset,
          payload);
    };
    tangents(0, sources[2], tangent_method::kFaces);
    tangents(1, sources[2], 4);
    tangents(1, sources[0], tangent_method::kFaces);
  }

  void predictorsOf(const std::string& name, const std::vector<uint8_t>& predictors,
                    const std::function<uint32_t(const PayloadHeader&)>& number) {
    const Wanted wanted = [&](const PayloadHeader& h) { return number(h) != kNone; };
    for (const uint8_t predictor : predictors) {
      header("predictor " + std::to_string(predictor) + " of " + name, "A.2.4",
             "A predictor that the method " + name + " does not have", wanted,
             [&](HeaderFields& f) {
               const uint32_t k = number(headerOf(base(wanted).payload));
               f.set("0." + std::to_string(k) + ".predictor", predictor);
             });
    }
  }

  void positionPredictors() {
    using namespace position_mode;
    for (const int predictor :
         {kShear | kPalette, kShear | kPlanes, kPalette | kPlanes, int{kKinds}}) {
      header("predictor " + std::to_string(predictor), "A.6.2",
             "More than one of shear, palette and planes", any,
             [=](HeaderFields& f) { f.set("0.0.predictor", predictor); });
    }
    header("selection without weights", "A.6.2", "Tip selection without weights", any,
           [](HeaderFields& f) { f.set("0.0.predictor", kSelect); });
    for (const uint32_t bit : {kFold, kOwnScale, kSplit}) {
      header("planes with bit " + std::to_string(bit), "A.6.2",
             "Planes with a flag they cannot have", any,
             [=](HeaderFields& f) { f.set("0.0.predictor", kPlanes | bit); });
    }
    header("planes of 18 bits", "A.6.2", "Planes of a lattice with more than 17 bits", any,
           [](HeaderFields& f) {
             f.set("0.0.predictor", kPlanes);
             f.setLatticeBits("0.0.", 18);
           });
    header(
        "planes of integers", "A.6.2", "Planes of positions that are not on a lattice",
        [](const PayloadHeader& h) {
          return h.pieces.size() == 1 && h.pieces[0].attribute_count == 1 &&
                 h.attributes[0].coding != AttributeCoding::kLattice;
        },
        [](HeaderFields& f) { f.set("0.0.predictor", kPlanes); });
  }

  void streams() {
    const auto padded = [](uint32_t count, uint8_t byte) {
      return [=](HeaderFields& f) {
        f.set("flags", f.get("flags") | payload_flag::kPadded);
        f.insertBefore("codes", "padding bytes", varint(count));
        f.insertBefore("codes", "padding", Bytes(count, byte));
      };
    };
    header("padding of 0 bytes", "A.2.5", "Padding of no bytes", any, padded(0, 0));
    header("padding with a one", "A.2.5", "Padding that is not zero", any, padded(4, 1));
    field("padding beyond the end", "A.2.5", Error::kTruncated, "More padding than bytes", any,
          [](HeaderFields& f) {
            f.set("flags", f.get("flags") | payload_flag::kPadded);
            f.insertBefore("codes", "padding bytes", varint(1u << 30));
          });
    const auto three = [this](const std::string& name, const std::string& section, Error error,
                              const std::string& shows,
                              const std::function<void(HeaderFields&)>& change) {
      field(name, section, error, shows, threeStreams, change);
    };
    three("codes beyond the end", "A.2.5", Error::kTruncated,
          "The length of codes is beyond the payload",
          [](HeaderFields& f) { f.set("codes bytes", 100000); });
    three("tokens beyond the end", "A.2.5", Error::kTruncated,
          "The length of tokens is beyond the payload",
          [](HeaderFields& f) { f.set("tokens bytes", 0xffffffff); });
    three("state below 2 16", "A.3.3", Error::kTruncated,
          "A state of the tokens is below 2^16 at the start", [](HeaderFields& f) {
            for (size_t i = 2; i < 4; ++i) f.bytes("tokens")[i] = 0;
          });
    three("no tokens", "A.3.3", Error::kTruncated, "The stream of tokens has less than 12 bytes",
          [](HeaderFields& f) {
            f.bytes("tokens").resize(10);
            f.set("tokens bytes", 10);
          });
    three("tokens cut", "A.3.3", Error::kTruncated, "The stream of tokens ends two bytes early",
          [](HeaderFields& f) {
            f.bytes("tokens").resize(f.bytes("tokens").size() - 2);
            f.set("tokens bytes", f.get("tokens bytes") - 2);
          });
    three("codes longer", "A.3.8", Error::kTrailingBytes, "Bytes after the end of codes",
          [](HeaderFields& f) {
            f.bytes("codes").resize(f.bytes("codes").size() + 12);
            f.set("codes bytes", f.get("codes bytes") + 12);
          });
    three("tokens longer", "A.3.8", Error::kTrailingBytes, "Bytes after the end of tokens",
          [](HeaderFields& f) {
            f.bytes("tokens").resize(f.bytes("tokens").size() + 2);
            f.set("tokens bytes", f.get("tokens bytes") + 2);
          });
    three("raw longer", "A.3.8", Error::kTrailingBytes, "A zero byte after the end of raw",
          [](HeaderFields& f) { f.bytes("raw").push_back(0); });
    three("raw cut", "A.3.8", Error::kTruncated, "The stream raw ends a byte early",
          [](HeaderFields& f) { f.bytes("raw").pop_back(); });
    field(
        "single longer", "A.3.8", Error::kTrailingBytes, "Bytes after the end of the only stream",
        [](const PayloadHeader& h) { return any(h) && h.singleCoder(); },
        [](HeaderFields& f) { f.bytes("codes").resize(f.bytes("codes").size() + 12); });
    field(
        "unused bit of raw", "A.3.8", Error::kTrailingBytes,
        "A bit of raw that nobody reads is set",
        [](const PayloadHeader& h) {
          return threeStreams(h) && h.streams.raw[h.streams.raw.size() - 1] < 0x40;
        },
        [](HeaderFields& f) { f.bytes("raw").back() |= 0x80; });
  }

  /// Streams that do not fit any more because the header changed.
  void contradictions() {
    field("planes without a step", "A.6.12", Error::kBadAttribute, "Planes with a step of 0",
          threeStreams, [](HeaderFields& f) {
            f.set("0.0.predictor", position_mode::kPlanes);
            f.setLatticeBits("0.0.", 12);
            for (uint8_t& byte : f.bytes("raw")) byte = 0;
          });
  }

  /// The whole surface of the asset that is normally cut. The encoder refuses what it has just
  /// written.
  void deepHandle() {
    const Asset asset = encodeSource(addedSources().back());
    const ClosedMesh mesh = closedMesh(test::plateWithTunnels(kTooManyTunnels, 1));
    const McRecord record = collapse(mesh);
    PayloadHeader header = headerOf(asset.payload);
    PieceHeader& piece = header.pieces[0];
    piece.setSurface(SurfaceCoding::kManifold);
    piece.flags &= ~(piece_flag::kHoles | piece_flag::kSeams | piece_flag::kCreases);
    piece.vertex_count = mesh.real_vertex_count;
    piece.operation_count = static_cast<uint32_t>(record.operations.size());
    piece.dummy_count = 0;
    EncoderIo io(header.singleCoder());
    (void)encodeCodes(io, header, mesh, record);
    const EncoderIo::Streams streams = io.finish();
    add("deep handle", "A.4.4", Error::kBadConnectivity, "A handle puts a digon below 256 others",
        asset, writePayload(header, {streams.codes, streams.tokens, streams.raw}));
  }
  /// A surface that is a closed manifold without holes.
  static ClosedMesh closedMesh(const test::TestMesh& mesh) {
    ClosedMesh closed;
    closed.corner_vertex = mesh.indices;
    closed.real_face_count = mesh.triangleCount();
    closed.real_vertex_count = mesh.vertexCount();
    closed.components = {{0, true}};
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> half_edge;
    const auto head = [&](uint32_t h) { return mesh.indices[h % 3 == 2 ? h - 2 : h + 1]; };
    for (uint32_t h = 0; h < mesh.indices.size(); ++h) half_edge[{mesh.indices[h], head(h)}] = h;
    for (uint32_t h = 0; h < mesh.indices.size(); ++h)
      closed.twin.push_back(half_edge.at({head(h), mesh.indices[h]}));
    return closed;
  }
  static Status encodeCodes(EncoderIo& io, const PayloadHeader& header, const ClosedMesh& mesh,
                            const McRecord& record) {
    const PieceHeader& piece = header.pieces[0];
    std::vector<uint32_t> nodes(record.node_count);
    std::vector<uint32_t> vertices(piece.vertex_count);
    std::vector<uint32_t> gates(piece.face_count);
    const McTruth truth = connectivityTruth(record, {nodes, vertices, gates});
    McModels models;
    FaceMesh faces{Allocator{}};
    if (!faces.words.resize(size_t{mesh.real_face_count} * kFaceWords)) {
      throw std::bad_alloc();
    }
    const McCounts counts{piece.operation_count, piece.vertex_count, 0, piece.face_count, true};
    return McMachine<EncoderIo>(io, models, counts, faces, truth).run();
  }

  /// Errors that only damaged streams show: the smallest payload that a search finds for each
  /// message.
  void searched() {
    struct Message {
      const char* what;
      const char* section;
    };
    static const Message kMessages[] = {
        {"a stream ends before its last symbol", "A.3.8"},
        {"the token stream does not end where its last symbol does", "A.3.8"},
        {"the token stream ends inside the positions", "A.3.3"},
        {"the token stream ends inside an attribute", "A.3.3"},
        {"the codes yield more triangles than the header claims", "A.4.1"},
        {"the codes create more vertices than the header claims", "A.4.1"},
        {"the codes do not yield the counts that the header claims", "A.4.2"},
        {"a waiting digon was closed", "A.4.4"},
        {"a handle refers to a node that is not there", "A.4.4"},
        {"a handle refers to a closed node", "A.4.4"},
        {"a handle refers to a digon that is not there", "A.4.4"},
        {"a dummy vertex takes more edges than its digon has", "A.4.5"},
        {"a component ends while digons wait on the stack", "A.4.6"},
        {"a copy refers to a group that is not there", "A.5.3"},
        {"a vertex has no triangle", "A.6.1"},
        {"a weight of the positions is out of range", "A.6.2"},
        {"a scale of the positions is out of range", "A.6.2"},
        {"the seams make more wedges than the header claims", "A.7.3"},
        {"the seams make fewer wedges than the header claims", "A.7.1"},
        {"a wedge is merged with none of its group", "A.7.3"},
        {"a triangle is in no part", "A.8.1"},
        {"a listed triangle refers to a face that is not there", "A.8.2"},
        {"a listed triangle refers to a vertex that is not there", "A.8.2"},
        {"a triangle refers to a vertex that does not exist", "A.4.7"},
        {"a new spoke leads to the vertex of another one", "A.4.7"},
        {"the codes yield fewer triangles than the header claims", "A.4.7"},
        {"the codes leave a vertex without a triangle", "A.4.7"},
        {"an order refers to an element that is not there", "A.9.1"},
        {"a part has another number of triangles than the header claims", "A.9.4"},
        {"a palette has more values than there are vertices", "A.6.11"},
        {"a palette is not increasing", "A.6.11"},
    };
    struct Found {
      const Asset* asset = nullptr;
      Bytes payload;
      Error error = Error::kOk;
    };
    std::map<std::string, Found> found;
    test::Random random(1);
    const auto search = [&](const Asset& asset, size_t header_bytes) {
      for (uint32_t round = 0; round < kRounds; ++round) {
        Bytes payload = asset.payload;
        if (header_bytes >= payload.size()) break;
        for (uint32_t change = random.between(1, 3); change != 0; --change) {
          const uint32_t range = static_cast<uint32_t>(payload.size() - header_bytes);
          payload[header_bytes + random.below(range)] = static_cast<uint8_t>(random.below(256));
        }
        repairChecksum(payload);
        const Status status = decode(payload);
        if (status.ok()) continue;
        Found& best = found[status.what];
        if (best.asset != nullptr && best.payload.size() <= payload.size()) continue;
        best = {&asset, std::move(payload), status.error};
      }
    };
    const auto isComplete = [&] {
      return std::all_of(std::begin(kMessages), std::end(kMessages),
                         [&](const Message& message) { return found.count(message.what) != 0; });
    };
    for (uint32_t search_count = 0; search_count < kSearches && !isComplete(); ++search_count) {
      for (size_t i = 0; i < assets_.size(); ++i) {
        if (assets_[i].payload.size() <= kSearchedBytes)
          search(assets_[i], headers_[i].header_bytes);
      }
    }
    for (const Message& message : kMessages) {
      const auto it = found.find(message.what);
      if (it == found.end()) {
        problems_ += std::string("no payload found: ") + message.what + "\n";
        continue;
      }
      const Found& f = it->second;
      add(message.what, message.section, f.error,
          std::string("The streams say that ") + message.what, *f.asset, f.payload);
    }
  }

  // ---- Blocks -----------------------------------------------------------------------------------

  void blocks() {
    const std::vector<Source> sources = blockSources();
    const auto named = [&](const char* name) {
      const auto it = std::find_if(sources.begin(), sources.end(),
                                   [&](const Source& source) { return source.name == name; });
      if (it == sources.end()) throw std::runtime_error(std::string("no source ") + name);
      return encodeSource(*it);
    };
    const Asset plain = named("blocks_torus");
    blockPieces(plain);
    blockTable(plain, named("blocks_equal_tuples"));
    blockStreams(plain, named("blocks_charts"));
    gluedPiece(plain, named("blocks_equal_tuples"));
  }

  void block(const std::string& name, const std::string& section, Error error,
             const std::string& shows, const Asset& asset,
             const std::function<void(HeaderFields&)>& change) {
    HeaderFields fields(asset.payload);
    change(fields);
    add(name, section, error, shows, asset, fields.payload());
  }

  /// What a block may not have, or must.
  void blockPieces(const Asset& asset) {
    const auto bad = [&](const std::string& name, const std::string& shows,
                         const std::function<void(HeaderFields&)>& change) {
      block(name, "A.11.1", Error::kBadHeader, shows, asset, change);
    };
    const auto flags = [](const std::string& name, uint32_t set, uint32_t clear) {
      return [=](HeaderFields& f) { f.set(name, (f.get(name) & ~clear) | set); };
    };
    bad("blocks of a single coder", "BLOCKS with SINGLE_CODER",
        flags("flags", payload_flag::kSingleCoder, 0));
    bad("one block", "BLOCKS without MANY_PIECES", flags("flags", 0, payload_flag::kManyPieces));
    bad("block with attributes", "The second block has attributes of its own", [](HeaderFields& f) {
      f.set("1.flags", f.get("1.flags") & ~piece_flag::kSameAttributes);
      Bytes all;
      for (const char* const name : {"attributes", "0.kind", "0.predictor", "0.lattice", "0.step",
                                     "0.origin 0", "0.origin 1", "0.origin 2"}) {
        const Bytes& bytes = f.bytes(std::string("0.") + name);
        all.insert(all.end(), bytes.begin(), bytes.end());
      }
      f.insertBefore("2.flags", "1.all", all);
    });
    bad("blocks without attributes", "The blocks have no attributes", [](HeaderFields& f) {
      f.set("0.attributes", 0);
      for (const char* const name :
           {"kind", "predictor", "lattice", "step", "origin 0", "origin 1", "origin 2"})
        f.erase(std::string("0.0.") + name);
    });
    bad("block of other parts", "The second block has two parts, the first one",
        [](HeaderFields& f) {
          f.set("1.flags", f.get("1.flags") | piece_flag::kManyParts);
          Bytes parts = {2};
          for (const uint8_t byte : varint(f.get("1.faces"))) parts.push_back(byte);
          parts.push_back(0);
          f.insertBefore("2.flags", "1.all parts", parts);
        });
    bad("block without faces", "The second block has no faces and no wedges", [](HeaderFields& f) {
      if (f.has("1.dummies")) f.erase("1.dummies");
      f.set("1.flags", piece_flag::kSameAttributes);
      for (const char* const name : {"vertices", "faces", "operations", "wedges"})
        f.set(std::string("1.") + name, 0);
      f.set("block 1.repeated", 0);
    });
    bad("block of pivots", "A block that is not cut", [](HeaderFields& f) {
      if (f.has("1.dummies")) f.erase("1.dummies");
      f.erase("1.operations");
      f.set("1.flags", piece_flag::kSameAttributes | piece_flag::kSurfaceMask);
    });
    bad("block with a triangle order", "A block with TRIANGLE_ORDER",
        flags("1.flags", piece_flag::kTriangleOrder, 0));
    bad("block with a vertex order", "A block with VERTEX_ORDER",
        flags("1.flags", piece_flag::kVertexOrder, 0));
    bad("first block with a vertex order", "The first block has VERTEX_ORDER",
        flags("0.flags", piece_flag::kVertexOrder, 0));
  }

  void blockTable(const Asset& asset, const Asset& with_exceptions) {
    const auto bad = [&](const std::string& name, const std::string& shows, const Asset& of,
                         const std::function<void(HeaderFields&)>& change) {
      block(name, "A.11.1", Error::kBadHeader, shows, of, change);
    };
    const auto wedges = [](const Asset& of, uint32_t index) {
      const PieceHeader piece = headerOf(of.payload).pieces[index];
      return piece.wedge_count - piece.isolated_count;
    };
    bad("repeated above wedges", "A block repeats more wedges than it has", asset,
        [&](HeaderFields& f) { f.set("block 1.repeated", wedges(asset, 1) + 1); });
    // A block with an exception, and the first of its fields.
    const PayloadHeader header = headerOf(with_exceptions.payload);
    uint32_t index = 1;
    while (header.blocks[index].exception_count < 2) ++index;
    const std::string row = "block " + std::to_string(index) + ".";
    bad("exception of no wedge", "An exception about a wedge that the block does not have",
        with_exceptions,
        [&](HeaderFields& f) { f.set(row + "skipped 0", wedges(with_exceptions, index)); });
    bad("second exception of no wedge", "The second exception is about a wedge beyond the last",
        with_exceptions, [&](HeaderFields& f) {
          const uint32_t first = f.get(row + "skipped 0") + 1;
          f.set(row + "skipped 1", wedges(with_exceptions, index) - first);
        });
    bad("exception with no wedge", "An exception names a wedge before the first", with_exceptions,
        [&](HeaderFields& f) { f.set(row + "back 0", header.blocks[index].first_wedge + 1); });
    bad("exceptions above wedges", "2^30 exceptions", with_exceptions,
        [&](HeaderFields& f) { f.set(row + "exceptions", 1u << 30); });
    bad("box above 2 31", "A box ends above 2^31 - 1", asset, [](HeaderFields& f) {
      f.set("block 1.low 0", 2);  // zigzag: 1
      f.set("block 1.size 0", 0x7fffffff);
    });
    bad("box of 2 32", "A box whose size wraps", asset,
        [](HeaderFields& f) { f.set("block 1.size 2", 0xffffffff); });
    bad("header too short", "The header is said to be a byte shorter than it is", asset,
        [](HeaderFields& f) { f.changeHeaderLength(-1); });
    bad("header too long", "The header is said to be a byte longer than it is", asset,
        [](HeaderFields& f) { f.changeHeaderLength(1); });
    const auto whole = static_cast<int32_t>(headerOf(asset.payload).header_bytes);
    bad("header ends before its flags", "The header is said to have three bytes", asset,
        [=](HeaderFields& f) { f.changeHeaderLength(3 - whole); });
    block("header beyond the end", "A.2.1", Error::kTruncated,
          "The header is said to be longer than the payload", asset,
          [](HeaderFields& f) { f.changeHeaderLength(1 << 20); });
    // Faces that only the copies of models make too many.
    block("elements of copies", "A.2.6", Error::kLimit,
          "Blocks whose elements and copies of models are more than 1024 elements to a byte", asset,
          [&](HeaderFields& f) {
            const uint64_t elements = elementsOf(headerOf(asset.payload));
            const uint64_t most = kMaxElementsPerByte * (asset.payload.size() + 8);
            f.set("1.faces", f.get("1.faces") + static_cast<uint32_t>((most - elements) / 2 + 1));
          });
  }

  void blockStreams(const Asset& asset, const Asset& with_attributes) {
    const uint32_t last = static_cast<uint32_t>(headerOf(asset.payload).blocks.size()) - 1;
    const std::string end = "block " + std::to_string(last) + ".";
    block("block beyond the end", "A.11.1", Error::kTruncated,
          "The last stream is beyond the payload", asset,
          [&](HeaderFields& f) { f.set(end + "raw bytes", f.get(end + "raw bytes") + 1); });
    block("block beyond 2 32", "A.11.1", Error::kTruncated,
          "Lengths of streams whose sum modulo 2^32 fits", asset, [](HeaderFields& f) {
            f.set("block 0.raw bytes", f.get("block 0.raw bytes") + 0x80000000);
            f.set("block 1.raw bytes", f.get("block 1.raw bytes") + 0x80000000);
          });
    Bytes longer = asset.payload;
    longer.push_back(0);
    add("byte after the last block", "A.11.1", Error::kTrailingBytes,
        "A zero byte after the last block", asset, longer);
    const auto damaged = [&](const std::string& name, uint32_t index) {
      block("damaged " + name, "A.11.1", Error::kBadChecksum,
            "A bit of the " + name + " is flipped", asset, [&](HeaderFields& f) {
              f.bytes("block " + std::to_string(index) + ".tokens").back() ^= 1;
            });
    };
    damaged("first block", 0);
    damaged("second block", 1);
    damaged("last block", last);
    block("damaged checksum of a block", "A.11.1", Error::kBadChecksum,
          "A bit of the checksum of a block is flipped", asset,
          [](HeaderFields& f) { f.set("block 1.checksum", f.get("block 1.checksum") ^ 0x100); });
    Bytes flipped = asset.payload;
    flipped[headerOf(asset.payload).header_bytes - 1] ^= 1;
    add("damaged table", "A.2.1", Error::kBadChecksum, "The last byte of the table is changed",
        asset, flipped);
    block("block that does not end", "A.11.2", Error::kTrailingBytes,
          "A zero byte more in raw of the second block", asset, [](HeaderFields& f) {
            f.bytes("block 1.raw").push_back(0);
            f.repairBlock(1);
          });
    block("first block that does not end", "A.11.2", Error::kTrailingBytes,
          "Bytes more in codes of the first block", asset, [](HeaderFields& f) {
            f.bytes("block 0.codes").resize(f.bytes("block 0.codes").size() + 12);
            f.repairBlock(0);
          });
    block("block that ends early", "A.11.2", Error::kTruncated,
          "The stream raw of the second block ends a byte early, where that of the third begins",
          with_attributes, [](HeaderFields& f) {
            f.bytes("block 1.raw").pop_back();
            f.repairBlock(1);
          });
  }

  void gluedPiece(const Asset& asset, const Asset& with_exceptions) {
    const uint32_t last = static_cast<uint32_t>(headerOf(asset.payload).blocks.size()) - 1;
    const std::string end = "block " + std::to_string(last) + ".";
    for (const int32_t change : {-1, 1}) {
      const std::string what = change < 0 ? "fewer" : "more";
      const auto amount = static_cast<uint32_t>(change);
      block("one repeated " + what, "A.11.3", Error::kBadAttribute,
            "The last block repeats a wedge " + what + " than it says", asset,
            [&](HeaderFields& f) { f.set(end + "repeated", f.get(end + "repeated") - amount); });
    }
    // An exception says that a wedge is new. Without it, the wedge is repeated.
    const PayloadHeader header = headerOf(with_exceptions.payload);
    block("exception left out", "A.11.3", Error::kBadAttribute,
          "Without an exception a block repeats a wedge more", with_exceptions,
          [&](HeaderFields& f) {
            for (size_t i = header.blocks.size(); --i != 0;) {
              const std::span<const BlockException> all = header.exceptionsOf(header.blocks[i]);
              if (all.empty() || all.back().number != kNone) continue;
              const std::string prefix = "block " + std::to_string(i) + ".";
              const std::string last_one = std::to_string(all.size() - 1);
              f.set(prefix + "exceptions", static_cast<uint32_t>(all.size()) - 1);
              f.erase(prefix + "skipped " + last_one);
              f.erase(prefix + "back " + last_one);
              return;
            }
          });
    for (const bool is_low : {true, false}) {
      block(is_low ? "box too low" : "box too high", "A.11.4", Error::kBadAttribute,
            "The box of a block is larger than its positions", asset, [=](HeaderFields& f) {
              if (is_low) f.set("block 1.low 1", zigzag(unzigzag(f.get("block 1.low 1")) - 1));
              f.set("block 1.size 1", f.get("block 1.size 1") + 1);
            });
    }
    block("box too small", "A.11.4", Error::kBadAttribute,
          "The box of the last block is smaller than its positions", asset,
          [&](HeaderFields& f) { f.set(end + "size 2", f.get(end + "size 2") - 1); });
    block("box of the first block", "A.11.4", Error::kBadAttribute,
          "The box of the first block is beside its positions", asset,
          [](HeaderFields& f) { f.set("block 0.low 0", f.get("block 0.low 0") + 2); });
    constexpr uint32_t kHalf = 1u << 27;
    block("triangles of all blocks", "A.11.4", Error::kLimit, "Two blocks have 2^27 faces each",
          asset, [](HeaderFields& f) {
            f.set("0.faces", kHalf);
            f.set("1.faces", kHalf);
          });
    block("vertices of all blocks", "A.11.4", Error::kLimit, "Two blocks have 2^27 vertices each",
          asset, [](HeaderFields& f) {
            for (const char* const piece : {"0.", "1."}) {
              f.set(std::string(piece) + "vertices", kHalf);
              f.set(std::string(piece) + "faces", kHalf - 1000);
            }
          });
    block("wedges of all blocks", "A.11.4", Error::kLimit, "Two blocks have 2^27 wedges each",
          asset, [](HeaderFields& f) {
            for (const char* const piece : {"0.", "1."}) {
              f.set(std::string(piece) + "wedges", 2 * kHalf);
              f.set(std::string(piece) + "faces", kHalf - 1000);
            }
          });
  }

  void found() {
    for (const FoundPayload& found : kFoundMalformed) {
      const Bytes payload = bytesOf(found.hex);
      const Status status = decode(payload);
      add(found.name, found.section, status.error, found.shows, closestTo(payload, every_asset_),
          payload);
    }
  }

  // ---- Documents --------------------------------------------------------------------------------

  /// Changes an asset's JSON. `change` gets the document, its first primitive and that one's
  /// extension object.
  void document(const std::string& name, const std::string& shows, const Asset& asset,
                const std::function<void(Json& json, Json& primitive, Json& extension)>& change) {
    auto [json, bin] = documentOf(asset);
    Json& primitive = json["meshes"][0]["primitives"][0];
    change(json, primitive, primitive["extensions"][gltf::kExtensionName]);
    addFile(name, "restrictions", 0, shows, glbOf(json, bin));
  }

  void documents() {
    const Asset& plain = base([](const PayloadHeader& h) {
      const bool both = attributeWith(h, [](const AttributeInfo& a) {
                          return a.coding == AttributeCoding::kOctahedral &&
                                 a.format.semantic == Semantic::kNormal;
                        }) != kNone;
      return both && h.pieces[0].wedge_count > 5 && h.pieces[0].wedge_count < 255;
    });
    const auto accessorOf = [](Json& json, Json& primitive, const char* name) -> Json& {
      return json["accessors"][primitive["attributes"][name].get<size_t>()];
    };
    const auto indicesOf = [](Json& json, Json& primitive) -> Json& {
      return json["accessors"][primitive["indices"].get<size_t>()];
    };
    document("no buffer view", "the extension object has no bufferView", plain,
             [](Json&, Json&, Json& e) { e.erase("bufferView"); });
    document("no such buffer view", "bufferView is none of the document", plain,
             [](Json&, Json&, Json& e) { e["bufferView"] = 99; });
    document("buffer view no integer", "bufferView is a string", plain,
             [](Json&, Json&, Json& e) { e["bufferView"] = "0"; });
    cutView(plain);
    document("payload beyond the buffer", "the buffer view ends outside of the buffer", plain,
             [](Json& j, Json&, Json&) { j["bufferViews"][0]["byteLength"] = 1 << 20; });
    document("no such piece", "piece is none of the payload", plain,
             [](Json&, Json&, Json& e) { e["piece"] = 1; });
    document("no such part", "part is none of the piece", plain,
             [](Json&, Json&, Json& e) { e["part"] = 1; });
    document("negative part", "part is negative", plain,
             [](Json&, Json&, Json& e) { e["part"] = -1; });
    document("no such attribute", "an attribute's number is none of the piece", plain,
             [](Json&, Json&, Json& e) { e["attributes"]["NORMAL"] = 99; });
    document("attribute of no accessor",
             "the extension names an attribute that the primitive has not", plain,
             [](Json&, Json& p, Json&) { p["attributes"].erase("NORMAL"); });
    document("exchanged attributes",
             "POSITION and NORMAL are exchanged: their semantics contradict the payload", plain,
             [](Json&, Json&, Json& e) {
               std::swap(e["attributes"]["POSITION"], e["attributes"]["NORMAL"]);
             });
    document("attributes no object", "attributes is an array", plain,
             [](Json&, Json&, Json& e) { e["attributes"] = Json::array({0}); });
    document("extension no object", "the extension is a number", plain,
             [](Json&, Json&, Json& e) { e = 1; });
    document("mode 5", "the primitive is a strip", plain,
             [](Json&, Json& p, Json&) { p["mode"] = 5; });
    document("mode 0", "the primitive is points", plain,
             [](Json&, Json& p, Json&) { p["mode"] = 0; });
    document("no indices", "the primitive has no indices", plain,
             [](Json&, Json& p, Json&) { p.erase("indices"); });
    document("indices of floats", "the indices are FLOAT", plain,
             [&](Json& j, Json& p, Json&) { indicesOf(j, p)["componentType"] = 5126; });
    document("indices of shorts", "the indices are SHORT", plain,
             [&](Json& j, Json& p, Json&) { indicesOf(j, p)["componentType"] = 5122; });
    document("indices of pairs", "the indices are VEC2", plain,
             [&](Json& j, Json& p, Json&) { indicesOf(j, p)["type"] = "VEC2"; });
    document("normalized indices", "the indices are normalized", plain,
             [&](Json& j, Json& p, Json&) { indicesOf(j, p)["normalized"] = true; });
    document("fewer indices", "the indices are one triangle fewer than the part has", plain,
             [&](Json& j, Json& p, Json&) {
               indicesOf(j, p)["count"] = indicesOf(j, p)["count"].get<int>() - 3;
             });
    document("more indices", "the indices are one more than the part has", plain,
             [&](Json& j, Json& p, Json&) {
               indicesOf(j, p)["count"] = indicesOf(j, p)["count"].get<int>() + 1;
             });
    document("huge count", "an accessor claims 2^31 elements", plain,
             [&](Json& j, Json& p, Json&) { accessorOf(j, p, "POSITION")["count"] = 2147483648u; });
    document("fewer elements", "POSITION has fewer elements than the piece has wedges", plain,
             [&](Json& j, Json& p, Json&) {
               accessorOf(j, p, "POSITION")["count"] =
                   accessorOf(j, p, "POSITION")["count"].get<int>() - 1;
             });
    document("other component type", "NORMAL is BYTE, in the payload FLOAT", plain,
             [&](Json& j, Json& p, Json&) { accessorOf(j, p, "NORMAL")["componentType"] = 5120; });
    document("other type", "NORMAL is VEC4, in the payload it has three components", plain,
             [&](Json& j, Json& p, Json&) { accessorOf(j, p, "NORMAL")["type"] = "VEC4"; });
    document("other normalized", "NORMAL is normalized, in the payload not", plain,
             [&](Json& j, Json& p, Json&) { accessorOf(j, p, "NORMAL")["normalized"] = true; });
    document("narrow indices", "the indices are UNSIGNED_BYTE, for 255 wedges and more",
             base([](const PayloadHeader& h) {
               return h.pieces.size() == 1 && h.pieces[0].wedge_count > 255;
             }),
             [&](Json& j, Json& p, Json&) { indicesOf(j, p)["componentType"] = 5121; });
    const Asset& two = base([](const PayloadHeader& h) {
      return h.pieces.size() >= 2 && h.pieces[0].attribute_count != 0 &&
             h.pieces[0].wedge_count != 0;
    });
    document("one accessor for two attributes",
             "one accessor is filled from POSITION of two pieces", two,
             [](Json& j, Json& p, Json&) {
               Json& other = j["meshes"][0]["primitives"].back();
               other["attributes"]["POSITION"] = p["attributes"]["POSITION"];
             });
    const Asset& morphed = base([](const PayloadHeader& h) {
      return attributeWith(h, [](const AttributeInfo& a) {
               return a.format.morph_target == 1 && a.format.semantic == Semantic::kPosition &&
                      a.coding != AttributeCoding::kAlias;
             }) != kNone;
    });
    document("more targets", "the extension has a target more than the primitive", morphed,
             [](Json&, Json&, Json& e) { e["targets"].push_back(Json::object()); });
    document("target of the base", "a target's POSITION is the attribute of the base mesh", morphed,
             [](Json&, Json&, Json& e) { e["targets"][0]["POSITION"] = 0; });
    document("ordinary attribute too short",
             "an attribute beside the payload has fewer elements than the piece has wedges",
             base([](const PayloadHeader& h) { return h.pieces[0].attribute_count == 0; }),
             [&](Json& j, Json& p, Json&) {
               accessorOf(j, p, "POSITION")["count"] =
                   accessorOf(j, p, "POSITION")["count"].get<int>() - 1;
             });
    document("draco besides", "the primitive also has KHR_draco_mesh_compression", plain,
             [](Json& j, Json& p, Json&) {
               p["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                                {"attributes", {{"POSITION", 0}}}};
               j["extensionsUsed"].push_back("KHR_draco_mesh_compression");
             });
    document("meshopt below", "the payload's buffer view has EXT_meshopt_compression", plain,
             [](Json& j, Json&, Json&) {
               j["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
                   {"buffer", 0},
                   {"byteLength", 8},
                   {"byteStride", 4},
                   {"count", 1},
                   {"mode", "ATTRIBUTES"}};
               j["extensionsUsed"].push_back("EXT_meshopt_compression");
             });
  }

  /// The error is the payload's: its checksum is not that of the bytes that are left.
  void cutView(const Asset& asset) {
    document("payload cut", "the buffer view is a byte shorter than the payload", asset,
             [](Json& j, Json&, Json&) {
               j["bufferViews"][0]["byteLength"] =
                   j["bufferViews"][0]["byteLength"].get<size_t>() - 1;
             });
    all_.back().error = static_cast<uint32_t>(Error::kBadChecksum);
  }

  /// Accessors that a payload fills and something else refers to.
  void sharedAccessors() {
    const Asset& plain = base([](const PayloadHeader& h) {
      return attributeWith(h, [](const AttributeInfo& a) {
               return a.format.semantic == Semantic::kNormal && a.format.morph_target == 0 &&
                      a.format.component_count == 3;
             }) != kNone;
    });
    document(
        "accessor of another mesh", "another primitive, without the extension, draws POSITION",
        plain, [](Json& j, Json& p, Json&) {
          const Json position = p["attributes"]["POSITION"];
          j["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", position}}}}}}});
        });
    document("accessor of an ordinary attribute",
             "an attribute beside the payload has the accessor of NORMAL", plain,
             [](Json&, Json& p, Json&) { p["attributes"]["_COPY"] = p["attributes"]["NORMAL"]; });
    document("accessor of instances", "instances are moved by the accessor of NORMAL", plain,
             [](Json& j, Json& p, Json&) {
               const Json normal = p["attributes"]["NORMAL"];
               j["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {
                   {"attributes", {{"TRANSLATION", normal}}}};
               j["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
             });
    document("two views of the same bytes",
             "one accessor is filled from payloads in two buffer views, whose bytes are the same",
             plain, [](Json& j, Json& p, Json&) {
               j["bufferViews"].push_back(j["bufferViews"][0]);
               Json other = p;
               other["extensions"][gltf::kExtensionName]["bufferView"] =
                   j["bufferViews"].size() - 1;
               j["meshes"].push_back({{"primitives", {other}}});
             });
    document("accessor of a skin", "the inverse bind matrices are the accessor of NORMAL", plain,
             [](Json& j, Json& p, Json&) {
               const Json normal = p["attributes"]["NORMAL"];
               j["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", normal}}};
             });
    document("accessor of an animation", "an animation's output is the accessor of NORMAL", plain,
             [](Json& j, Json& p, Json&) {
               const Json normal = p["attributes"]["NORMAL"];
               const Json input = {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
               j["accessors"].push_back(input);
               j["animations"] = {
                   {{"channels", Json::array()},
                    {"samplers", {{{"input", j["accessors"].size() - 1}, {"output", normal}}}}}};
             });
  }

  /// Accessors have at least one element.
  void emptyParts() {
    const auto emptyPart = [](const PayloadHeader& h) {
      for (uint32_t i = 0; h.pieces.size() == 1 && i < h.pieces[0].part_count; ++i) {
        if (h.parts[i].triangle_count == 0) return i;
      }
      return kNone;
    };
    const Asset& parts = base([&](const PayloadHeader& h) { return emptyPart(h) != kNone; });
    const uint32_t part = emptyPart(headerOf(parts.payload));
    document("part without triangles", "the part has no triangles", parts,
             [&](Json& j, Json& p, Json& e) {
               e["part"] = part;
               j["accessors"][p["indices"].get<size_t>()]["count"] = 0;
             });
    const auto emptyPiece = [](const PayloadHeader& h) {
      for (uint32_t i = 0; i < h.pieces.size(); ++i) {
        if (h.pieces[i].wedge_count == 0) return i;
      }
      return kNone;
    };
    const Asset& pieces = base([&](const PayloadHeader& h) { return emptyPiece(h) != kNone; });
    const uint32_t piece = emptyPiece(headerOf(pieces.payload));
    document("piece without wedges", "the piece has no wedges, and so its part no triangles",
             pieces, [&](Json& j, Json& p, Json& e) {
               e = {{"bufferView", 0}, {"piece", piece}};
               p["attributes"] = Json::object();
               p.erase("targets");
               j["accessors"][p["indices"].get<size_t>()]["count"] = 0;
             });
  }

  void mirrors() {
    const std::vector<Source> sources = mirroredSources();
    const Asset asset = encodeSource(sources[0]);
    const auto bad = [&](const std::string& name, const std::string& section,
                         const std::string& shows,
                         const std::function<void(HeaderFields&)>& change) {
      block(name, section, Error::kBadHeader, shows, asset, change);
    };
    bad("mirrors with planes", "A.6.2", "MIRRORS with planes",
        [](HeaderFields& f) { f.set("0.0.predictor", position_mode::kPlanes); });
    bad("mirrors without attributes", "A.2.3", "MIRRORS without attributes", [](HeaderFields& f) {
      f.set("0.attributes", 0);
      for (const char* const name :
           {"kind", "predictor", "lattice", "step", "origin 0", "origin 1", "origin 2"}) {
        if (f.has(std::string("0.0.") + name)) f.erase(std::string("0.0.") + name);
      }
    });
    bad("mirrors in 1 0", "A.2.2", "MIRRORS in a payload of version 1.0",
        [](HeaderFields& f) { f.setMinorVersion(0); });
    block("mirrors in a block", "A.11.1", Error::kBadHeader, "A block has MIRRORS",
          encodeSource(blockSources()[0]), [](HeaderFields& f) {
            f.setMinorVersion(1);
            f.set("0.flags", f.get("0.flags") | piece_flag::kMirrors);
          });
    const std::map<std::string, const char*> wanted = {
        {"a mirror has no axis", "The axis of a mirror is 3"},
        {"there are too many mirrors", "Four mirrors"},
        {"a vertex is the image of none",
         "A vertex is the image of a candidate that there is not"}};
    searchErrors(asset, "A.6.14", wanted);
  }

  void trained() {
    block("trained in 1 0", "A.2.1", Error::kBadHeader, "TRAINED in a payload of version 1.0",
          encodeSource(trainedSources()[0]), [](HeaderFields& f) { f.setMinorVersion(0); });
    block("trained blocks", "A.11.1", Error::kBadHeader, "Blocks with TRAINED",
          encodeSource(blockSources()[0]), [](HeaderFields& f) {
            f.setMinorVersion(1);
            f.set("flags", f.get("flags") | payload_flag::kTrained);
          });
  }

  void anchors() {
    const Asset asset = encodeSource(anchorSources()[1]);
    block("anchors with planes", "A.6.2", Error::kBadHeader, "ANCHORS with planes", asset,
          [](HeaderFields& f) { f.set("0.0.predictor", position_mode::kPlanes); });
    block("anchors in 1 0", "A.2.2", Error::kBadHeader, "ANCHORS in a payload of version 1.0",
          asset, [](HeaderFields& f) { f.setMinorVersion(0); });
    block("anchors in a block", "A.11.1", Error::kBadHeader, "A block has ANCHORS",
          encodeSource(blockSources()[0]), [](HeaderFields& f) {
            f.setMinorVersion(1);
            f.set("0.flags", f.get("0.flags") | piece_flag::kAnchors);
          });
    const std::map<std::string, const char*> wanted = {
        {"an anchor is no vertex", "An anchor with a number that no vertex has"},
        {"an anchor is not known", "An anchor that is not coded yet"},
        {"a turn has no order of axes", "The number of an order of axes is above 5"}};
    searchErrors(asset, "A.6.15", wanted);
  }

  /// Damages streams until each of these errors of a section was met.
  void searchErrors(const Asset& asset, const char* section,
                    std::map<std::string, const char*> wanted) {
    test::Random random(1);
    const size_t first = static_cast<size_t>(headerOf(asset.payload).header_bytes);
    for (uint32_t round = 0; round < 200 * kRounds && !wanted.empty(); ++round) {
      Bytes payload = asset.payload;
      const size_t rest = payload.size() - first;
      payload[first + random.below(static_cast<uint32_t>(rest))] ^=
          static_cast<uint8_t>(1 + random.below(255));
      repairChecksum(payload);
      const Status status = decode(payload);
      const auto found = wanted.find(status.what);
      if (status.ok() || found == wanted.end()) continue;
      add(found->first, section, Error::kBadAttribute, found->second, asset, payload);
      wanted.erase(found);
    }
    for (const auto& [what, shows] : wanted) problems_ += what + ": was not found\n";
  }

  // ---- Documents that a validator reports -------------------------------------------------------

  using DocumentChange = std::function<void(Json& json, Json& primitive, Bytes& bin)>;

  void invalid(const std::string& name, const std::string& rule, const std::string& code,
               const std::string& shows, const Asset& asset, const DocumentChange& change) {
    auto [json, bin] = documentOf(asset);
    change(json, json["meshes"][0]["primitives"][0], bin);
    Invalid made{slug(rule) + "_" + slug(name), shows, rule, code, glbOf(json, bin)};
    gltf::ValidationReport report;
    const gltf::Result result = gltf::validateGlb(made.glb, {}, report);
    const bool is_found =
        result.ok() && std::any_of(report.issues.begin(), report.issues.end(),
                                   [&](const auto& issue) { return issue.code == code; });
    if (!is_found) problems_ += name + ": validate() does not report " + code + "\n";
    invalid_.push_back(std::move(made));
  }

  /// A payload of a single piece with positions and without anything that no JSON can name.
  const Asset& simpleAsset() const {
    return base([](const PayloadHeader& h) {
      return h.pieces.size() == 1 && h.pieces[0].attribute_count == 1 && !h.hasBlocks() &&
             h.pieces[0].part_count == 1 &&
             h.attributes[0].format.component_type == ComponentType::kFloat32;
    });
  }

  void bounds() {
    const auto bound = [](const char* key) {
      return [key](Json& j, Json& p, Bytes&) {
        Json& accessor = j["accessors"][p["attributes"]["POSITION"].get<size_t>()];
        accessor[key][1] = accessor[key][1].get<double>() + 0.5;
      };
    };
    const Asset& asset = simpleAsset();
    invalid("min", "V1", "BOUNDS_MISMATCH", "min of POSITION is above the smallest y", asset,
            bound("min"));
    invalid("max", "V1", "BOUNDS_MISMATCH", "max of POSITION is above the largest y", asset,
            bound("max"));
  }

  void lists() {
    const Asset& asset = simpleAsset();
    invalid("not used", "V2", "EXTENSION_NOT_LISTED_AS_USED",
            "The extension is not listed in extensionsUsed", asset,
            [](Json& j, Json&, Bytes&) { j.erase("extensionsUsed"); });
    invalid("not required", "V2", "EXTENSION_REQUIRED_MISMATCH",
            "There is no fallback, and the extension is not listed in extensionsRequired", asset,
            [](Json& j, Json&, Bytes&) { j.erase("extensionsRequired"); });
  }

  /// Gives an accessor a buffer view of its own, of zeros.
  static void addElements(Json& json, size_t accessor, Bytes& bin) {
    Json& a = json["accessors"][accessor];
    const size_t bytes = a["count"].get<size_t>() *
                         gltf::test::widthOf(a["componentType"].get<int>()) *
                         gltf::test::shapeOf(a["type"].text()).rows;
    bin.resize((bin.size() + 3) / 4 * 4);
    a["bufferView"] = json["bufferViews"].size();
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes}});
    bin.resize(bin.size() + bytes);
    json["buffers"][0]["byteLength"] = bin.size();
  }

  void fallbacks() {
    const Asset& asset = simpleAsset();
    invalid("fallback of some accessors", "V2", "FALLBACK_INCOMPLETE",
            "POSITION has a fallback, the indices have none", asset,
            [](Json& j, Json& p, Bytes& bin) {
              addElements(j, p["attributes"]["POSITION"].get<size_t>(), bin);
            });
    const auto addAll = [](Json& j, Json& p, Bytes& bin) {
      addElements(j, p["attributes"]["POSITION"].get<size_t>(), bin);
      addElements(j, p["indices"].get<size_t>(), bin);
    };
    invalid("required with a fallback", "V2", "EXTENSION_REQUIRED_MISMATCH",
            "Everything has a fallback, and the extension is listed in extensionsRequired", asset,
            addAll);
    invalid("other elements", "V3", "FALLBACK_MISMATCH",
            "The elements of the fallback are zeros, those of the payload are not", asset,
            [&](Json& j, Json& p, Bytes& bin) {
              addAll(j, p, bin);
              j.erase("extensionsRequired");
            });
  }

  void viewsAndManifolds() {
    const Asset& asset = simpleAsset();
    invalid("manifold", "V4", "MANIFOLD_WITHOUT_ORDER",
            "The mesh has EXT_mesh_manifold, and the payload keeps no order", asset,
            [](Json& j, Json&, Bytes&) {
              j["meshes"][0]["extensions"]["EXT_mesh_manifold"] = {
                  {"manifoldPrimitive", {{"indices", 0}}}};
              j["extensionsUsed"].push_back("EXT_mesh_manifold");
            });
    invalid("stride", "V5", "INVALID_PAYLOAD_BUFFER_VIEW", "The payload's buffer view has a stride",
            asset, [](Json& j, Json&, Bytes&) { j["bufferViews"][0]["byteStride"] = 16; });
    invalid("target", "V5", "INVALID_PAYLOAD_BUFFER_VIEW", "The payload's buffer view has a target",
            asset, [](Json& j, Json&, Bytes&) { j["bufferViews"][0]["target"] = 34962; });
    invalid("image", "V5", "PAYLOAD_BUFFER_VIEW_USED_ELSEWHERE",
            "An image is in the payload's buffer view", asset, [](Json& j, Json&, Bytes&) {
              j["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
            });
  }

  static constexpr size_t kSearchedBytes = 700;
  static constexpr uint32_t kRounds = 1000;  ///< of each asset, in each search
  static constexpr uint32_t kSearches = 20;  ///< at most: until each message was found

  std::span<const Asset> assets_;
  std::span<const Asset> every_asset_;
  std::vector<PayloadHeader> headers_;
  std::vector<Negative> all_;
  std::vector<Invalid> invalid_;
  std::string problems_;  ///< in what is made here
};

}  // namespace

std::vector<Negative> makeNegatives(std::span<const Asset> assets, std::span<const Asset> all) {
  return Maker(assets, all).run();
}
std::vector<Invalid> makeInvalid(std::span<const Asset> assets) {
  return Maker(assets, assets).runInvalid();
}

}  // namespace mcc::conformance
