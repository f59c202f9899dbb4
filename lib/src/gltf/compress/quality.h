// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What ConvertOptions::quality stands for: an error for each kind of attribute, the bits that keep
// within an angle, and the choice of bits and lattices from them. Texture coordinates are as
// accurate as the textures that they look up.
#ifndef MCC_GLTF_COMPRESS_QUALITY_H_
#define MCC_GLTF_COMPRESS_QUALITY_H_

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "gltf/compress/plan.h"
#include "gltf/document/document.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// Pixels of an image; 0: unknown.
struct ImageSize {
  uint32_t width = 0;
  uint32_t height = 0;
};

/// Reads the size of a PNG, JPEG, WebP or KTX 2 image from its header. Unknown for other bytes, and
/// for a JPEG with a thousand segments before its size. Safe for untrusted input; takes constant
/// time.
ImageSize imageSizeOf(std::span<const uint8_t> bytes);

/// Textures of a document. Borrows it. Takes time proportional to its JSON and its data URIs.
class TextureUses {
 public:
  /// What is taken for a texture whose size is not known: its image is a file of its own or of
  /// another format.
  static constexpr double kUsualTexels = 4096;

  explicit TextureUses(const Document& document);

  /// Returns the texels along the longer side of the largest texture that the materials of a
  /// primitive look up by TEXCOORD_<set>, times the scale of its KHR_texture_transform; 0: there is
  /// no such texture. Materials are also those of KHR_materials_variants.
  double texels(const PrimitiveRef& primitive, uint32_t set) const;

 private:
  using BySet = std::map<uint64_t, double>;  ///< texels

  void addTextures(const Json& json, BySet& texels) const;
  void findTextureSizes();
  double imageTexels(const Json& image) const;

  const Document& document_;
  std::vector<double> texture_texels_;
  std::vector<BySet> of_material_;
};

/// Sizes on the screen that ConvertOptions::quality takes. Float32 holds positions a few times as
/// accurately as the last; at the first a model is hardly more than a dot.
inline constexpr double kLeastPixels = 16;
inline constexpr double kMostPixels = 1 << 20;

/// The errors that nothing exceeds when a model is drawn `pixels` pixels large.
struct StatedErrors {
  explicit StatedErrors(double pixels);

  /// How far a vertex may move, as a share of the model's size: this is a pixel of its picture.
  double share;
  /// How far normals may turn, and tangents around their normals. Shading does not depend on the
  /// size on the screen as positions do: an error of `share` on a smooth surface turns its normals
  /// by something like the root of it, so four times the pixels halve the angle. At 4,096 pixels it
  /// is a quarter of a degree, about one of the 256 steps of brightness.
  double radians;
  /// How far a colour from 0 to 1 may change: half a step of the 255 that a screen has.
  double color = 0.5 / 255;
  /// How far a weight may change. A vertex moves by this error times the distance between the
  /// places to which two joints would move it, of which half the model's size is a lot.
  double weight;

  /// Returns how far texture coordinates may move: a quarter of a texel or, when that is more, of a
  /// pixel on the screen. Nobody would see what less than the larger of the two gains.
  /// texels  along the longer side of the largest texture that they look up, see countedTexels().
  /// range   of the coordinates. It is taken for the whole model; where textures repeat, it is not
  ///         more than one of them.
  double texcoord(double texels, double range) const;
  /// Whether it is the pixel that counts.
  bool isPixel(double texels, double range) const;

  /// Returns what a texture counts as. Small ones are palettes as often as not and count as 1024;
  /// 0, no texture, counts as 4096.
  static double countedTexels(double texels);
};

/// Returns the largest angle, in radians, between a unit vector and the nearest point of an
/// octahedral grid.
double octahedralBound(uint32_t bits);

/// Returns the fewest bits of an octahedral grid that keep within an angle. As many bits of an
/// angle around a normal do so, too, and as many of each component of a vector that is longer than
/// a half.
uint8_t octahedralBitsFor(double radians);
/// Returns the fewest bits of the lattice from 0 to 1 that have no longer step.
uint8_t unitBitsFor(double step);

/// Returns a number with at most six digits, spelt as in JSON whatever the locale of the program
/// is.
std::string numberText(double value);

/// Does for options.quality, which is not 0, what planQuantization() does for bits: chooses those
/// of every float attribute, and lattices that keep within the errors that the quality stands for.
/// Notes say what stays exact, and which triangles lose their area. `choices` says what was chosen.
/// Takes linear time.
void planQuality(const Document& document, const ConvertOptions& options,
                 std::vector<PayloadPlan>& payloads, std::vector<std::string>& notes,
                 std::vector<QualityChoice>& choices);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_COMPRESS_QUALITY_H_
