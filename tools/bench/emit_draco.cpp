// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/emit_draco.h"

#include <algorithm>
#include <cmath>

#include "bench/geometry.h"
#include "foreign/draco_codec.h"
#include "gltf/compress/quantize.h"
#include "gltf/decompress/coded_input.h"
#include "gltf/document/accessors.h"
#include "gltf/document/layout.h"
#include "gltf/document/references.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"

namespace mcc::bench {
namespace {

using gltf::Json;
using gltf::PiecePlan;

constexpr char kDracoName[] = "KHR_draco_mesh_compression";

/// A part of a piece with what Draco made of it.
struct EmittedPart {
  const PiecePlan* piece = nullptr;
  const gltf::PartPlan* part = nullptr;
  foreign::DracoPrimitive draco;
};

void setBound(const char* name, const std::vector<double>& values, ComponentType type,
              bool is_required, Json& accessor) {
  const bool is_finite =
      std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  if (!is_finite) {
    accessor.erase(name);
  } else if (is_required || gltf::findMember(accessor, name) != nullptr) {
    accessor[name] = gltf::boundNumbers(values, type);
  }
}

/// Writes encoded parts into the JSON of a document.
class Emitter {
 public:
  /// is_taken  marks accessors that something else needs.
  Emitter(const gltf::Document& document, std::vector<bool> is_taken)
      : document_(document), json_(document.json), is_taken_(std::move(is_taken)) {}

  void add(EmittedPart& part) {
    const uint64_t view = gltf::kFirstNewView + views_.size();
    std::vector<uint32_t> accessors;
    Json ids = Json::object();
    for (const foreign::DracoPrimitiveAttribute& attribute : part.draco.attributes) {
      accessors.push_back(takeAttribute(part, attribute));
      ids[part.piece->attributes[attribute.piece_attribute].name] = attribute.unique_id;
    }
    const uint32_t indices = takeIndices(part);
    for (const gltf::PrimitiveRef& user : part.part->users) {
      Json& primitive = json_["meshes"][user.mesh]["primitives"][user.primitive];
      for (size_t i = 0; i < accessors.size(); ++i) {
        const uint32_t index = part.draco.attributes[i].piece_attribute;
        primitive["attributes"][part.piece->attributes[index].name] = accessors[i];
      }
      primitive["indices"] = indices;
      if (part.part->mode != 4) primitive["mode"] = 4;
      primitive["extensions"][kDracoName] = {{"bufferView", view}, {"attributes", ids}};
    }
    gltf::NewView new_view;
    new_view.hold(std::move(part.draco.bytes));
    views_.push_back(std::move(new_view));
  }

  gltf::Result finish(std::vector<uint8_t>& file) {
    if (!views_.empty()) {
      gltf::listExtension(json_, kDracoName, true);
    }
    const gltf::Layout layout = gltf::layOut(document_, views_, json_);
    std::span<uint8_t> bin;
    MCC_GLTF_TRY(gltf::startGlb(gltf::printJson(json_), layout.byte_count, document_.other_chunks,
                                file, bin));
    layout.copyTo(bin);
    return {};
  }

 private:
  /// Returns the accessor itself for the first user, else a clone; both without bytes.
  uint32_t take(uint32_t source) {
    Json& accessors = json_["accessors"];
    uint32_t index = source;
    if (is_taken_[source]) {
      index = static_cast<uint32_t>(accessors.size());
      Json clone = document_.json["accessors"][source];
      accessors.push_back(std::move(clone));
    }
    is_taken_[source] = true;
    for (const char* member : {"bufferView", "byteOffset", "sparse"})
      accessors[index].erase(member);
    return index;
  }

  uint32_t takeAttribute(const EmittedPart& part,
                         const foreign::DracoPrimitiveAttribute& attribute) {
    const gltf::AttributePlan& plan = part.piece->attributes[attribute.piece_attribute];
    const uint32_t index = take(plan.accessor);
    Json& accessor = json_["accessors"][index];
    accessor["count"] = part.draco.vertex_count;
    const bool is_position = plan.name == "POSITION";
    setBound("min", attribute.minimum, plan.format.component_type, is_position, accessor);
    setBound("max", attribute.maximum, plan.format.component_type, is_position, accessor);
    return index;
  }

  uint32_t takeIndices(const EmittedPart& part) {
    Json& accessors = json_["accessors"];
    uint32_t index = static_cast<uint32_t>(accessors.size());
    if (part.part->indices_accessor == kNone) {
      accessors.push_back({{"componentType", 0}, {"count", 0}, {"type", "SCALAR"}});
    } else {
      index = take(part.part->indices_accessor);
    }
    Json& accessor = accessors[index];
    accessor["componentType"] = part.draco.vertex_count <= 65535 ? 5123 : 5125;
    accessor["count"] = uint64_t{part.draco.triangle_count} * 3;
    accessor.erase("min");
    accessor.erase("max");
    return index;
  }

  const gltf::Document& document_;
  Json json_;
  std::vector<bool> is_taken_;
  std::vector<gltf::NewView> views_;
};

/// Encodes all parts; those that fail leave the plans.
void encodeParts(int speed, std::vector<gltf::EncodedPayload>& payloads,
                 std::vector<EmittedPart>& parts, std::vector<std::string>& notes) {
  for (gltf::EncodedPayload& payload : payloads) {
    for (PiecePlan& piece : payload.plan.pieces) {
      const PieceInput input = makePiece(piece, true);
      std::vector<gltf::PartPlan> kept;
      std::vector<foreign::DracoPrimitive> encoded;
      for (size_t i = 0; i < piece.parts.size(); ++i) {
        foreign::DracoPrimitive draco;
        const foreign::Outcome done = foreign::emitDracoPrimitive(input.view(), i, speed, draco);
        if (done.ok()) {
          kept.push_back(std::move(piece.parts[i]));
          encoded.push_back(std::move(draco));
        } else {
          notes.push_back(piece.parts[i].users[0].path() + ": left as it was: " + done.message);
        }
      }
      piece.parts = std::move(kept);
      for (size_t i = 0; i < encoded.size(); ++i) {
        parts.push_back({&piece, &piece.parts[i], std::move(encoded[i])});
      }
    }
  }
}

gltf::Result emit(std::span<const uint8_t> source, const gltf::FileReader& read_file,
                  const gltf::ConvertOptions& options, int speed, std::vector<uint8_t>& file,
                  std::vector<std::string>& notes) {
  gltf::Document document;
  MCC_GLTF_TRY(gltf::loadDocument(source, read_file, document));
  MCC_GLTF_TRY(gltf::embedImages(read_file, document));
  MCC_GLTF_TRY(gltf::decodeViews(options.decoders, document));
  MCC_GLTF_TRY(gltf::decodeMeshes(options.decoders, document));
  std::vector<gltf::PayloadPlan> plans;
  std::vector<gltf::LeftAlone> left_alone;
  MCC_GLTF_TRY(gltf::planPayloads(document, plans, left_alone));
  gltf::planQuantization(options, plans, notes);
  for (const gltf::LeftAlone& left : left_alone) {
    notes.push_back(left.primitive.path() + ": " + left.note);
  }
  std::vector<gltf::EncodedPayload> payloads(plans.size());
  for (size_t i = 0; i < plans.size(); ++i) payloads[i].plan = std::move(plans[i]);
  std::vector<EmittedPart> parts;
  encodeParts(speed, payloads, parts, notes);
  std::vector<bool> is_taken = gltf::accessorsInOtherUse(document, gltf::plansOf(payloads));
  for (const EmittedPart& part : parts) {
    for (const uint32_t left_out : part.draco.left_out) {
      const gltf::AttributePlan& attribute = part.piece->attributes[left_out];
      is_taken[attribute.accessor] = true;
      if (document.accessors[attribute.accessor].decoded_from == kNone) continue;
      return gltf::error(part.part->users[0].path(),
                         attribute.label() + " has its only bytes in what is replaced");
    }
  }
  Emitter emitter(document, std::move(is_taken));
  for (EmittedPart& part : parts) emitter.add(part);
  return emitter.finish(file);
}

}  // namespace

gltf::Result emitDraco(const std::filesystem::path& source, std::span<const uint8_t> file,
                       const gltf::ConvertOptions& options, std::vector<uint8_t>& output,
                       std::vector<std::string>& notes, int speed) {
  gltf::Result result = gltf::guarded([&]() {
    return emit(file, gltf::readerOf(source.parent_path()), options, speed, output, notes);
  });
  if (!result.ok()) {
    result.where = source.string() + (result.where.empty() ? "" : ": " + result.where);
  }
  return result;
}

}  // namespace mcc::bench
