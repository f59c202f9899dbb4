// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "format_features.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "container/payload_header.h"
#include "format/codings.h"
#include "format/predictors.h"
#include "gltf/decompress/decompress.h"

namespace mcc::conformance {
namespace {

using Sections = std::set<std::string>;

/// What every payload shows.
constexpr const char* kEveryPayload = "payload";

/// The sections of a list of the format's tables, which spaces separate.
Sections sectionsIn(const std::string& list) {
  std::istringstream in(list);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Both lists of sections together.
Sections sectionsIn(const std::string& list, const std::string& others) {
  return sectionsIn(list + " " + others);
}

std::string text(const char* name, uint64_t number) {
  return std::string(name) + " " + std::to_string(number);
}

class Listing {
 public:
  explicit Listing(const PayloadHeader& header) : header_(header) {}

  Features run() {
    add(kEveryPayload, {"A.1.1", "A.1.2", "A.1.3", "A.1.5", "A.1.6", "A.2.1", "A.2.2", "A.2.3",
                        "A.2.5", "A.2.6", "A.2.7", "A.3.1", "A.3.2", "A.3.6", "A.3.8"});
    add(header_.singleCoder() ? "single coder" : "three streams",
        header_.singleCoder() ? Sections{"A.3.7"} : Sections{"A.3.3", "A.3.4"});
    if ((header_.flags & payload_flag::kPadded) != 0) add("PADDED", {"A.2.5", "A.2.6"});
    if (header_.startsTrained()) add("TRAINED", {"A.3.9"});
    if ((header_.flags & payload_flag::kManyPieces) != 0) add("MANY_PIECES", {"A.2.1", "A.3.6"});
    for (size_t i = 0; i < header_.pieces.size(); ++i) addPiece(header_.pieces[i]);
    if (header_.hasBlocks()) addBlocks();
    return std::move(features_);
  }

 private:
  void add(const std::string& name, const Sections& sections) {
    features_[name].insert(sections.begin(), sections.end());
  }

  void addBlocks() {
    add("BLOCKS", {"A.11.1", "A.11.2", "A.11.3", "A.11.4", "A.11.5"});
    for (size_t i = 0; i < header_.exceptions.size(); ++i) {
      add(header_.exceptions[i].number == kNone ? "exception: a new wedge"
                                                : "exception: an earlier wedge",
          {"A.11.1", "A.11.3"});
    }
    for (uint32_t i = 0; i < all_.size(); ++i)
      add(std::string("BLOCKS, ") + infoOf(methodOf(all_, i)).name, {"A.11.3"});
  }

  /// The flags whose stages look at what this one's stage does.
  static uint32_t meetsOf(uint32_t flag) {
    switch (flag) {
      case piece_flag::kManyParts:
        return piece_flag::kListed | piece_flag::kTriangleOrder | piece_flag::kVertexOrder;
      case piece_flag::kTriangleOrder: return piece_flag::kVertexOrder | piece_flag::kListed;
      case piece_flag::kVertexOrder: return piece_flag::kIsolated;
      default: return 0;
    }
  }

  void addSurface(const PieceHeader& piece) {
    const SurfaceInfo& surface = infoOf(piece.surface());
    add(surface.name, sectionsIn(surface.sections));
    if (piece.surface() == SurfaceCoding::kManifold || !piece.has(piece_flag::kSeams)) return;
    add(std::string(surface.name) + " and SEAMS",
        sectionsIn(surface.sections, "A.7.1 A.7.2 A.7.3"));
  }

  void addPiece(const PieceHeader& piece) {
    for (const PieceFlagInfo& flag : kPieceFlags) {
      if (!piece.has(flag.bit)) continue;
      add(flag.name, sectionsIn(flag.sections));
      const uint32_t meets = meetsOf(flag.bit);
      for (const PieceFlagInfo& other : kPieceFlags) {
        if ((meets & other.bit) == 0 || !piece.has(other.bit)) continue;
        add(std::string(flag.name) + " and " + other.name,
            sectionsIn(flag.sections, other.sections));
      }
    }
    addSurface(piece);
    if (piece.face_count == 0) add("empty piece", {"A.2.2"});
    if (piece.part_count > 1) {
      for (uint32_t i = 0; i < piece.part_count; ++i) {
        if (header_.parts[piece.first_part + i].triangle_count == 0) add("empty part", {"A.2.2"});
      }
    }
    if (piece.attribute_count == 0) {
      add("no attributes", {"A.2.3", "A.6"});
      if (piece.has(piece_flag::kSeams)) add("no attributes, SEAMS", {"A.6", "A.7"});
      return;
    }
    all_ = header_.attributesOf(piece);
    seams_ = piece.has(piece_flag::kSeams);
    addPosition(all_[0], piece);
    for (uint32_t i = 1; i < all_.size(); ++i) addAttribute(i);
  }

  void addCoding(const AttributeInfo& a) {
    const CodingInfo& coding = infoOf(a.coding);
    add(std::string("coding ") + coding.name, {"A.2.4", "A.10.18"});
    if (a.coding == AttributeCoding::kGrid) {
      add(text("grid", a.grid), sectionsIn(coding.sections));
      add(text("tails", a.tails) + (&a == all_.data() ? " of positions" : ""), {"A.10.5"});
    } else if (a.bits != 0) {
      add(text((std::string(coding.name) + " bits").c_str(), a.bits), sectionsIn(coding.sections));
    }
    add(text("component type", static_cast<uint64_t>(a.format.component_type)) +
            (a.format.normalized ? " normalized" : ""),
        {"A.2.4"});
    add(text("components", a.format.component_count), {"A.2.4"});
    if (a.format.set_index != 0) add("set other than 0", {"A.2.4"});
    if (a.format.set_index == 255) add("set 255", {"A.2.4"});
    if (a.format.morph_target != 0) add("morph target", {"A.2.4", "A.10.18"});
    if (a.format.morph_target == 65535) add("morph target 65535", {"A.2.4"});
  }

  void addPosition(const AttributeInfo& a, const PieceHeader& piece) {
    addCoding(a);
    const MethodInfo& method = infoOf(AttributeMethod::kPosition);
    std::string kind = "plain";
    Sections sections = sectionsIn(method.sections);
    for (const PredictorField& field : method) {
      if ((a.predictor & position_mode::kKinds & field.mask) == 0) continue;
      kind = field.mask == position_mode::kShear ? "sheared" : field.value[1].word;
      sections.insert(field.value[1].sections);
    }
    const std::string name = std::string(method.name) + " " + kind;
    add(name, sections);
    for (const PredictorField& field : method) {
      if ((a.predictor & ~position_mode::kKinds & field.mask) == 0) continue;
      add(name + " with " + field.value[1].word, sections);
    }
    const std::string coding =
        isExact(a.coding) && a.coding != AttributeCoding::kGrid ? "exact" : infoOf(a.coding).name;
    add("positions " + coding + " " + kind, sections);
    if (piece.isolated_count != 0) add("isolated wedges, " + kind, {"A.6.9"});
    if (piece.hasCopies()) add("copies, " + kind, {"A.6.1"});
    if (piece.has(piece_flag::kCreases)) add("creases, positions " + coding, {"A.7.4", "A.6.13"});
  }

  /// A method's name, with what the pieces around it may or may not have.
  std::string nameOf(const MethodInfo& method, const AttributeInfo& a) const {
    const std::string name = method.name;
    const bool exact_normal = exactNormalOf(all_) != kNone;
    const bool chart = chartOfTangents(all_) != kNone;
    switch (method.method) {
      case AttributeMethod::kTangent: return chart ? name : name + " without a chart";
      case AttributeMethod::kTangentPoint:
        return name + (exact_normal ? ", exact normal" : "") + (chart ? "" : ", no chart");
      case AttributeMethod::kExactTangent:
        return name + (exact_normal ? "" : " without exact normal") + (chart ? "" : ", no chart");
      case AttributeMethod::kValues: return nameOfValues(a);
      default: return name;
    }
  }

  static std::string nameOfValues(const AttributeInfo& a) {
    std::string name = infoOf(AttributeMethod::kValues).name;
    if (a.format.morph_target != 0) {
      static const char* const kNames[] = {" of POSITION deltas", " of NORMAL deltas",
                                           " of TANGENT deltas"};
      name += a.format.semantic <= Semantic::kTangent
                  ? kNames[static_cast<size_t>(a.format.semantic)]
                  : " of other deltas";
    }
    if (a.coding == AttributeCoding::kGrid) name += " on a grid";
    if (a.coding == AttributeCoding::kExactFloat) name += " of floats";
    return name;
  }

  /// Every value of every field, and all together but for what is remembered and equal values.
  void addPredictor(const MethodInfo& method, const std::string& name, uint8_t predictor) {
    Sections sections = sectionsIn(method.sections);
    uint8_t together = 0;
    for (const PredictorField& field : method) {
      const PredictorValue& value = field.value[field.valueOf(predictor)];
      if (field.mask == kHasEqualities) continue;
      // What a later version added must not change which assets show those before it.
      if (field.since != 0 && field.valueOf(predictor) == 0) continue;
      if (field.feature != Feature::kMemory) together |= field.mask;
      const Sections own = sectionsIn(method.sections, value.sections);
      add(text((name + ", field " + std::to_string(field.mask)).c_str(), field.valueOf(predictor)),
          own);
      sections.insert(own.begin(), own.end());
    }
    add(text((name + ", predictor").c_str(), predictor & together), sections);
    if (!seams_) return;
    const bool may_be_equal = (predictor & kHasEqualities) != 0;
    if (may_be_equal) sections.insert(detail::kEqualities.value[1].sections);
    add(name + (may_be_equal ? ", equal values" : ", seams without equal values"), sections);
  }

  void addAttribute(uint32_t index) {
    const AttributeInfo& a = all_[index];
    addCoding(a);
    const MethodInfo& method = infoOf(methodOf(all_, index));
    if (method.method == AttributeMethod::kAlias) return;
    if (isWithAnother(method.method)) {
      const std::string coding = isExact(a.coding) ? "exact" : infoOf(a.coding).name;
      add(text("weights, predictor", a.predictor) + " " + coding, sectionsIn(method.sections));
      return;
    }
    addPredictor(method, nameOf(method, a), a.predictor);
    if (method.method == AttributeMethod::kNormal && all_[0].coding != AttributeCoding::kLattice)
      add("normals of exact positions", {"A.6.13"});
    if (method.method == AttributeMethod::kTexcoord && a.coding == AttributeCoding::kGrid)
      add("texture coordinate on a grid", {"A.10.11", "A.10.5"});
  }

  const PayloadHeader& header_;
  AttributeInfos all_;
  bool seams_ = false;
  Features features_;
};

void addCodes(std::span<const uint8_t> payload, Features& features) {
  gltf::DecodedPayload decoded;
  CodeHistogram histogram{};
  const Status opened = decoded.payload.open(payload);
  if (!opened.ok()) throw std::runtime_error(opened.what);
  DecodeOptions options;
  options.histogram = &histogram;
  const gltf::Result result = gltf::toResult(gltf::decodePieces(decoded, options), "payload");
  if (!result.ok()) throw std::runtime_error(result.message());
  const auto add = [&](const std::string& name, uint64_t count, const Sections& sections) {
    if (count != 0) features[name].insert(sections.begin(), sections.end());
  };
  add("code S", histogram.start, {"A.4.4"});
  add("code E", histogram.end, {"A.4.1", "A.4.3"});
  add("code M", histogram.handle, {"A.4.4", "A.3.5"});
  add("dummies coded", histogram.dummy, {"A.4.5", "A.3.5"});
  for (uint32_t degree = 0; degree < 256; ++degree) {
    add(text("code of degree", std::min(degree, 16u)), histogram.degree[degree], {"A.4.5"});
  }
}

}  // namespace

Features featuresOf(std::span<const uint8_t> payload) {
  PayloadHeader header{Allocator{}};
  const Status status = parsePayload(payload, {}, header);
  if (!status.ok()) throw std::runtime_error(status.what);
  Features features = Listing(header).run();
  addCodes(payload, features);
  return features;
}

std::set<std::string> sectionsOf(const Features& features) {
  Sections all;
  for (const auto& [name, sections] : features) {
    if (name != kEveryPayload) all.insert(sections.begin(), sections.end());
  }
  return all;
}

}  // namespace mcc::conformance
