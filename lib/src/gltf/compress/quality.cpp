// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/compress/quality.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "format/codings.h"
#include "gltf/compress/quantize.h"
#include "gltf/document/extension_uses.h"
#include "gltf/document/package.h"
#include "gltf/document/references.h"
#include "json/json.h"
#include "values/enc_extent.h"

namespace mcc::gltf {
namespace {

using Bytes = std::span<const uint8_t>;

/// Reads a number of `count` bytes; 0 when they are not all there.
uint32_t bigEndian(Bytes bytes, size_t at, size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return 0;
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

uint32_t littleEndian(Bytes bytes, size_t at, size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return 0;
  uint32_t value = 0;
  for (size_t i = count; i-- != 0;) value = value << 8 | bytes[at + i];
  return value;
}

/// Walks over the segments of a JPEG to the first start of frame.
ImageSize sizeOfJpeg(Bytes bytes) {
  constexpr int kMostSegments = 1000;
  size_t at = 2;  // the marker that begins the image comes first
  for (int i = 0; i < kMostSegments && bigEndian(bytes, at, 1) == 0xff; ++i) {
    const uint32_t marker = bigEndian(bytes, at + 1, 1);
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    const bool is_table = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !is_table) {
      return {bigEndian(bytes, at + 7, 2), bigEndian(bytes, at + 5, 2)};
    }
    const uint32_t length = bigEndian(bytes, at + 2, 2);
    if (length < 2) break;
    at += 2 + size_t{length};
  }
  return {};
}

ImageSize sizeOfWebp(Bytes bytes) {
  switch (bigEndian(bytes, 12, 4)) {
    case 0x56503820:  // "VP8 ": 14 bits each follow the start code
      return {littleEndian(bytes, 26, 2) & 0x3fff, littleEndian(bytes, 28, 2) & 0x3fff};
    case 0x5650384c: {  // "VP8L": 14 bits each, less one
      const uint32_t sizes = littleEndian(bytes, 21, 4);
      if (bytes.size() < 25) return {};
      return {(sizes & 0x3fff) + 1, (sizes >> 14 & 0x3fff) + 1};
    }
    case 0x56503858:  // "VP8X": 24 bits each, less one
      if (bytes.size() < 30) return {};
      return {littleEndian(bytes, 24, 3) + 1, littleEndian(bytes, 27, 3) + 1};
    default: return {};
  }
}

}  // namespace

ImageSize imageSizeOf(std::span<const uint8_t> bytes) {
  const std::string type = imageTypeOf(bytes);
  if (type == "image/png") return {bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4)};
  if (type == "image/jpeg") return sizeOfJpeg(bytes);
  if (type == "image/webp") return sizeOfWebp(bytes);
  if (type == "image/ktx2") return {littleEndian(bytes, 20, 4), littleEndian(bytes, 24, 4)};
  return {};
}

namespace {

/// Returns the larger scale of a texture's transform, of which there may be none.
double scaleOf(const Json* transform) {
  const Json* scale = findMember(transform, "scale");
  if (scale == nullptr || !scale->is_array()) return 1;
  double largest = 0;
  for (const Json& number : *scale) {
    double value = 0;
    if (asNumber(number, value) && std::isfinite(value))
      largest = std::max(largest, std::abs(value));
  }
  return largest;
}

}  // namespace

TextureUses::TextureUses(const Document& document) : document_(document) {
  findTextureSizes();
  for (const Json& material : arrayOf(document.json, "materials")) {
    addTextures(material, of_material_.emplace_back());
  }
}

/// Adds what has the form of a textureInfo: an object with a number `index`. Extensions of
/// materials have theirs in many places. JSON is at most kMaxJsonDepth deep.
void TextureUses::addTextures(const Json& json, BySet& texels) const {
  if (!json.is_structured()) return;
  uint64_t texture = 0;
  if (json.is_object() && asUnsigned(findMember(json, "index"), texture)) {
    uint64_t set = 0;
    (void)asUnsigned(findMember(json, "texCoord"), set);
    const Json* transform = extensionOf(json, "KHR_texture_transform");
    (void)asUnsigned(findMember(transform, "texCoord"), set);
    const bool is_known = texture < texture_texels_.size();
    double& largest = texels[set];
    largest = std::max(largest,
                       (is_known ? texture_texels_[texture] : kUsualTexels) * scaleOf(transform));
  }
  for (const Json& value : json) addTextures(value, texels);
}

void TextureUses::findTextureSizes() {
  std::vector<double> images;
  for (const Json& image : arrayOf(document_.json, "images")) images.push_back(imageTexels(image));
  for (const Json& texture : arrayOf(document_.json, "textures")) {
    double largest = 0;
    const auto add = [&](const Json* source) {
      const uint32_t image = indexOf(source, images.size());
      if (image != kNone) largest = std::max(largest, images[image]);
    };
    add(findMember(texture, "source"));
    if (const Json* extensions = findMember(texture, "extensions")) {
      for (const Json& extension : *extensions) add(findMember(extension, "source"));
    }
    texture_texels_.push_back(largest == 0 ? kUsualTexels : largest);
  }
}

double TextureUses::imageTexels(const Json& image) const {
  ImageSize size;
  const uint32_t view = indexOf(findMember(image, "bufferView"), document_.views.size());
  const Json* uri = findMember(image, "uri");
  if (uri != nullptr && uri->is_string() && isDataUri(uri->text())) {
    std::vector<uint8_t> bytes;
    if (decodeDataUri(uri->text(), "", bytes).ok()) size = imageSizeOf(bytes);
  } else if (view != kNone && !document_.views[view].isCoded()) {
    size = imageSizeOf(payloadBytes(document_, view));
  }
  const double texels = std::max(size.width, size.height);
  return texels == 0 ? kUsualTexels : texels;
}

double TextureUses::texels(const PrimitiveRef& primitive, uint32_t set) const {
  double largest = 0;
  const auto add = [&](const Json* number) {
    const uint32_t material = indexOf(number, of_material_.size());
    if (material == kNone) return;
    const auto found = of_material_[material].find(set);
    if (found != of_material_[material].end()) largest = std::max(largest, found->second);
  };
  const Json& json = *document_.primitive(primitive).json;
  add(findMember(json, "material"));
  if (const Json* variants = extensionOf(json, "KHR_materials_variants")) {
    for (const Json& mapping : arrayOf(*variants, "mappings")) add(findMember(mapping, "material"));
  }
  return largest;
}

namespace {

constexpr double kUsualPixels = 4096;
constexpr double kUsualRadians = 0.25 / 180 * std::numbers::pi;

/// Returns the fewest bits, in a range, for which error(bits) is small enough; the most otherwise.
template <class Error>
uint8_t fewestBits(uint32_t least, uint32_t most, double largest, const Error& error) {
  uint32_t bits = least;
  while (bits < most && error(bits) > largest) ++bits;
  return static_cast<uint8_t>(bits);
}

double texelError(double texels) { return 0.25 / StatedErrors::countedTexels(texels); }

}  // namespace

StatedErrors::StatedErrors(double pixels)
    : share(1 / pixels),
      radians(kUsualRadians * std::sqrt(kUsualPixels / pixels)),
      weight(2 / pixels) {}

double StatedErrors::countedTexels(double texels) {
  constexpr double kFewestTexels = 1024;
  return texels == 0 ? TextureUses::kUsualTexels : std::max(texels, kFewestTexels);
}

double StatedErrors::texcoord(double texels, double range) const {
  return std::max(texelError(texels), 0.25 * share * std::min(range, 1.0));
}

bool StatedErrors::isPixel(double texels, double range) const {
  return texcoord(texels, range) > texelError(texels);
}

/// There are 2^bits - 1 points per axis. Half a cell along both axes moves a point of the
/// octahedron by sqrt(6) half cells, and its faces are 1/sqrt(3) from the centre.
double octahedralBound(uint32_t bits) {
  const double half_cell = 1.0 / static_cast<double>((uint64_t{1} << bits) - 2);
  return std::sqrt(18.0) * half_cell * (1 + half_cell) + 1e-6;
}

std::string numberText(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : "inf";
  const double places = value == 0 ? 0 : 5 - std::floor(std::log10(std::abs(value)));
  const double power = std::pow(10, std::abs(places));
  const std::string text =
      Json(places > 0 ? std::round(value * power) / power : std::round(value / power) * power)
          .dump();
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

uint8_t octahedralBitsFor(double radians) {
  return fewestBits(kMinUnitBits, kMaxUnitBits, radians, octahedralBound);
}

uint8_t unitBitsFor(double step) {
  return fewestBits(1, kMaxLatticeBits, step, [](uint32_t bits) {
    return 1 / (std::ldexp(1.0, static_cast<int>(bits)) - 1);
  });
}

namespace {

constexpr const char* kTooFine =
    " would need a lattice of more than 24 bits, or one finer than float32, for the quality; it "
    "stays exact";

/// Lengths of the vectors of an attribute, without its fourth component and without those that are
/// zero.
struct Lengths {
  double shortest = 0;  ///< 0: all are zero
  bool are_unit = true;
};

Lengths lengthsOf(const AttributePlan& attribute) {
  constexpr double kUnitTolerance = 0.01;  // as the writer has it
  Lengths lengths;
  for (uint64_t i = 0; i < attribute.source.count; ++i) {
    double square = 0;
    for (uint32_t c = 0; c < std::min<uint32_t>(attribute.format.component_count, 3); ++c) {
      const double value = floatAt(attribute, i, c);
      square += value * value;
    }
    const double length = std::sqrt(square);
    if (std::fabs(length - 1) > kUnitTolerance) lengths.are_unit = false;
    if (length > 0 && (lengths.shortest == 0 || length < lengths.shortest))
      lengths.shortest = length;
  }
  return lengths;
}

/// Like fitError(), with a step that may be a little shorter: the largest side is a multiple of 64
/// steps, or of 2 if it has few. Both of its ends, its middle and its quarters are then points, so
/// that symmetric models stay symmetric, and boxes whole, which makes them smaller by much more
/// than it takes.
bool fitWholeSide(const Extent& extent, double error, Lattice& lattice, uint8_t& bits) {
  constexpr double kManySteps = 1024;
  if (!fitError(extent, error, lattice, bits)) return false;
  const double size = extent.size();
  const double steps = size / double{lattice.step};
  const double multiple = steps < kManySteps ? 2 : 64;
  const double points = std::ceil(steps / multiple) * multiple;
  Lattice whole = lattice;
  whole.step = static_cast<float>(size / points);
  if (points >= std::ldexp(1.0, kMaxLatticeBits) || !std::isnormal(whole.step) ||
      whole.step > lattice.step)
    return true;
  lattice = whole;
  bits = static_cast<uint8_t>(std::bit_width(static_cast<uint64_t>(points)));
  return true;
}

/// What was chosen for attributes of one name.
struct Tally {
  QualityChoice choice;
  double least_texels = std::numeric_limits<double>::infinity();
  double most_texels = 0;
  bool has_pixel = false;  ///< of the screen, where that is more than a texel

  void addTexels(double texels, bool is_pixel) {
    least_texels = std::min(least_texels, texels);
    most_texels = std::max(most_texels, texels);
    has_pixel |= is_pixel;
  }
  void add(const AttributePlan& attribute) {
    ++choice.attribute_count;
    if (attribute.bits == 0) {
      ++choice.exact_count;
      return;
    }
    const bool is_first = choice.most_bits == 0;
    choice.fewest_bits = is_first ? attribute.bits : std::min(choice.fewest_bits, attribute.bits);
    choice.most_bits = std::max(choice.most_bits, attribute.bits);
  }
};

class QualityPlanner {
 public:
  QualityPlanner(const Document& document, const ConvertOptions& options,
                 std::vector<PayloadPlan>& payloads, std::vector<std::string>& notes)
      : options_(options),
        errors_(options.quality),
        textures_(document),
        payloads_(payloads),
        notes_(notes) {}

  void run() {
    visitPositionGroups(options_.grid, payloads_, notes_,
                        [&](PositionGroup& group) { planPositions(group); });
    for (PayloadPlan& payload : payloads_) {
      for (PiecePlan& piece : payload.pieces) {
        for (AttributePlan& attribute : piece.attributes) planAttribute(piece, attribute);
        noteRoundedWeights(piece);
        noteLostTriangles(piece);
      }
    }
  }

  std::vector<QualityChoice> choices() const {
    std::vector<QualityChoice> all;
    for (const auto& [key, tally] : tallies_) {
      all.push_back(tally.choice);
      all.back().why = whyOf(std::get<Semantic>(key), tally);
    }
    return all;
  }

 private:
  static constexpr double kMargin = 1 - 0x1p-20;  ///< for the roundings of decoding

  /// Positions that are few and far away cost bits, but do not make the others less accurate: the
  /// model is as large as its box, but at most four times as large as the box without the outer
  /// hundredth of the positions at each end.
  void planPositions(PositionGroup& group) {
    constexpr double kMostOuter = 4;
    Extent& extent = group.extent;
    const double size = std::min(extent.size(), kMostOuter * extent.innerSize());
    const double distance = errors_.share * size;
    Lattice lattice;
    uint8_t bits = 1;
    const bool fits = extent.size() == 0
                          ? fitLattice(extent, bits, lattice)
                          : fitWholeSide(extent, distance / std::sqrt(3.0), lattice, bits);
    if (!fits) {
      notes_.push_back(group.where() + kTooFine);
      return;
    }
    group.use(lattice, bits, distance);
  }

  void planAttribute(const PiecePlan& piece, AttributePlan& attribute) {
    const Semantic semantic = attribute.format.semantic;
    const bool is_chosen = semantic != Semantic::kJoints && semantic != Semantic::kCustom;
    if (!is_chosen || !isFloat(attribute)) return;
    const bool is_target = attribute.target != kNone;
    Tally& tally = tallies_[{semantic, is_target, attribute.name}];
    tally.choice.name = (is_target ? "target " : "") + attribute.name;
    Extent extent(attribute.format.component_count);
    Lattice lattice;
    uint8_t bits = 0;
    const char* why = "";  // it stays exact
    const bool is_vector = semantic == Semantic::kNormal || semantic == Semantic::kTangent;
    if (attribute.isBase(Semantic::kPosition))
      return tally.add(attribute);  // it is planned already
    if (!addTo(extent, attribute)) {
      why = kNotFinite;
    } else if (is_target) {
      if (!fitDelta(piece, attribute, extent, tally, lattice, bits)) why = kTooManySteps;
    } else if (is_vector) {
      if (!fitVectors(attribute, extent, lattice, bits)) why = kNotUnit;
    } else if (!fitValues(piece, attribute, extent, tally, lattice, bits)) {
      why = kTooFine;
    }
    useLattice(piece, attribute, lattice, bits, why, notes_);
    tally.add(attribute);
  }

  /// Returns the largest error of a component of anything but positions and vectors.
  double errorOf(const PiecePlan& piece, const AttributePlan& attribute, const Extent& extent,
                 Tally& tally) const {
    const double unit = std::max(1.0, extent.farthest());
    if (attribute.format.semantic == Semantic::kColor) return errors_.color * unit;
    if (attribute.format.semantic == Semantic::kWeights) return errors_.weight * unit;
    double texels = 0;
    for (const PartPlan& part : piece.parts) {
      for (const PrimitiveRef& user : part.users)
        texels = std::max(texels, textures_.texels(user, attribute.format.set_index));
    }
    tally.addTexels(StatedErrors::countedTexels(texels), errors_.isPixel(texels, extent.size()));
    return errors_.texcoord(texels, extent.size());
  }

  /// Fits a lattice where float32 does not hold the error for the farthest values, as long as it
  /// does for all but a hundredth of them. Through 0 it rounds each value as float32 rounds that
  /// value, so those that are far away move by that as well, but do not cost the others anything.
  static bool fitAmongOutliers(Extent& extent, double error, Lattice& lattice, uint8_t& bits) {
    constexpr double kRounding = 1.0 / 64;  // most of the error that rounding may take
    if (std::ldexp(extent.innerFarthest(), -22) > kRounding * error) return false;
    return fitAroundZero(extent, static_cast<float>(2 * error * (1 - kRounding)), lattice, bits);
  }

  bool fitValues(const PiecePlan& piece, const AttributePlan& attribute, Extent& extent,
                 Tally& tally, Lattice& lattice, uint8_t& bits) {
    const double error = errorOf(piece, attribute, extent, tally);
    const Semantic semantic = attribute.format.semantic;
    if (semantic == Semantic::kTexcoord || !extent.isInside(0, 1)) {
      return fitWholeSide(extent, error, lattice, bits) ||
             fitAmongOutliers(extent, error, lattice, bits);
    }
    bits = unitBitsFor(semantic == Semantic::kColor ? 2 * error : error);
    lattice = unitLattice(bits);
    return true;
  }

  /// Unit vectors get the bits of the writer's own grids. Others get a lattice that keeps within
  /// the angle for the shortest of them, unless that needs more bits than vectors can have.
  bool fitVectors(const AttributePlan& attribute, const Extent& extent, Lattice& lattice,
                  uint8_t& bits) const {
    constexpr double kShortestTangent = 0.56;  // see octahedralBitsFor()
    const Lengths lengths = lengthsOf(attribute);
    bits = octahedralBitsFor(errors_.radians);
    if (attribute.format.semantic == Semantic::kTangent) {
      return fitTangents(extent, bits, lattice) && lengths.shortest >= kShortestTangent;
    }
    if (lengths.are_unit) return fitLattice(extent, bits, lattice);
    const double error = errors_.radians * lengths.shortest / std::sqrt(3.0);
    const bool fits = fitError(extent, error, lattice, bits) && bits <= kMaxUnitBits;
    bits = std::max<uint8_t>(bits, kMinUnitBits);
    return fits;
  }

  /// Deltas are on lattices through 0, so that what does not move stays where it is. Those of
  /// positions use the step of the positions.
  bool fitDelta(const PiecePlan& piece, const AttributePlan& attribute, const Extent& extent,
                Tally& tally, Lattice& lattice, uint8_t& bits) {
    const AttributePlan& base = piece.attributes[0];
    double step = 0;
    switch (attribute.format.semantic) {
      case Semantic::kPosition:
        step = base.has_lattice
                   ? double{base.lattice.step}
                   : kMargin * (2 * errors_.share * extent.farthest() / std::sqrt(3.0));
        break;
      case Semantic::kNormal:
      case Semantic::kTangent: step = kMargin * (2 * errors_.radians / std::sqrt(3.0)); break;
      default: step = kMargin * (2 * errorOf(piece, attribute, extent, tally));
    }
    if (extent.farthest() == 0) step = 1;
    return fitAroundZero(extent, static_cast<float>(step), lattice, bits);
  }

  /// Adds a note when triangles that have an area have none on the lattice.
  void noteLostTriangles(const PiecePlan& piece) {
    if (piece.attributes.empty() || !piece.attributes[0].has_lattice) return;
    const AttributePlan& position = piece.attributes[0];
    uint64_t lost = 0;
    uint64_t all = 0;
    for (const PartPlan& part : piece.parts) {
      all += part.triangles.size() / 3;
      for (size_t i = 0; i + 2 < part.triangles.size(); i += 3) {
        if (isLost(position, &part.triangles[i])) ++lost;
      }
    }
    if (lost == 0) return;
    notes_.push_back(
        sentence(piece.parts[0].users[0].path(), ": ", lost, " of ", all,
                 " triangles are so small that no area is left of them; a larger quality keeps "
                 "more of them"));
  }

  static bool isLost(const AttributePlan& position, const uint32_t* corners) {
    std::array<std::array<double, 3>, 3> source{};
    std::array<std::array<double, 3>, 3> point{};
    for (size_t k = 0; k < 3; ++k) {
      for (uint32_t c = 0; c < 3; ++c) {
        const float value = floatAt(position, corners[k], c);
        source[k][c] = value;
        point[k][c] = latticePoint(value, position.lattice.origin[c], position.lattice.step);
      }
    }
    return !isFlat(source) && isFlat(point);
  }

  /// Whether three points are on a line. Exact for points of a lattice, which are whole numbers
  /// below 2^25.
  static bool isFlat(const std::array<std::array<double, 3>, 3>& p) {
    for (size_t c = 0; c < 3; ++c) {
      const size_t d = (c + 1) % 3;
      const double first = (p[1][c] - p[0][c]) * (p[2][d] - p[0][d]);
      const double second = (p[1][d] - p[0][d]) * (p[2][c] - p[0][c]);
      if (first != second) return false;
    }
    return true;
  }

  std::string whyOf(Semantic semantic, const Tally& tally) const {
    static constexpr const char* kOwners[] = {"of its mesh", "of all meshes", "of its primitive"};
    switch (semantic) {
      case Semantic::kPosition:
        return "nothing moves farther than 1/" + numberText(options_.quality) +
               " of the longest side " + kOwners[static_cast<size_t>(options_.grid)];
      case Semantic::kNormal: return "at most " + degreesText();
      case Semantic::kTangent: return "at most " + degreesText() + " around the normal";
      case Semantic::kTexcoord: return texelText(tally);
      case Semantic::kColor: return "half a step of 255";
      case Semantic::kWeights: return "at most 1/" + numberText(1 / errors_.weight);
      case Semantic::kJoints:
      case Semantic::kCustom: break;
    }
    return "";
  }

  std::string degreesText() const {
    const std::string number = numberText(errors_.radians * 180 / std::numbers::pi);
    return number + (number == "1" ? " degree" : " degrees");
  }

  static std::string texelText(const Tally& tally) {
    if (!std::isfinite(tally.least_texels)) return "no value is finite";
    std::string text = "a quarter of a texel of textures that count as ";
    if (tally.least_texels != tally.most_texels) text += numberText(tally.least_texels) + " to ";
    text += numberText(tally.most_texels) + " texels";
    return text + (tally.has_pixel ? ", or of a pixel" : "");
  }

  const ConvertOptions& options_;
  const StatedErrors errors_;
  const TextureUses textures_;
  std::vector<PayloadPlan>& payloads_;
  std::vector<std::string>& notes_;
  std::map<std::tuple<Semantic, bool, std::string>, Tally> tallies_;
};

}  // namespace

void planQuality(const Document& document, const ConvertOptions& options,
                 std::vector<PayloadPlan>& payloads, std::vector<std::string>& notes,
                 std::vector<QualityChoice>& choices) {
  QualityPlanner planner(document, options, payloads, notes);
  planner.run();
  choices = planner.choices();
}

}  // namespace mcc::gltf
