// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Subtrees of the implicit tilings of 3D Tiles 1.1 and of 3DTILES_implicit_tiling: which tiles,
// contents and further subtrees there are.
#ifndef MCC_TILES_SUBTREE_H_
#define MCC_TILES_SUBTREE_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "json/json.h"
#include "mcc/result.h"

namespace mcc::tiles {

/// The place of a tile in an implicit tiling.
struct ImplicitPlace {
  uint32_t level = 0;
  uint64_t x = 0;
  uint64_t y = 0;
  uint64_t z = 0;  ///< 0 in a quadtree

  /// Returns the place `levels` below this one with a Morton index. dimensions: 2 or 3.
  ImplicitPlace below(uint32_t levels, uint64_t morton, uint32_t dimensions) const;
  /// Puts the place into a template: {level}, {x}, {y} and {z}.
  std::string uriOf(const std::string& uri_template) const;
};

/// One bit for each of a number of tiles.
class Availability {
 public:
  Availability() = default;
  explicit Availability(bool constant) : constant_(constant) {}
  explicit Availability(std::span<const uint8_t> bits) : bits_(bits) {}

  bool isNothing() const { return bits_.empty() && !constant_; }
  bool operator[](uint64_t bit) const {
    return bits_.empty() ? constant_ : (bits_[bit / 8] >> (bit % 8) & 1) != 0;
  }

 private:
  std::span<const uint8_t> bits_;  ///< empty: all are `constant_`
  bool constant_ = false;
};

/// What a schema says about the geometric errors of tiles.
struct ErrorSchema {
  std::string class_name;  ///< empty: no class has them
  std::string property;
  bool is_double = false;
  std::string unknown_because;  ///< not empty: it has them in a form that is not read
};

/// Looks for a property with the semantic TILE_GEOMETRIC_ERROR.
ErrorSchema errorSchemaOf(const gltf::Json& schema);

/// A subtree that has been read.
class Subtree {
 public:
  /// How many levels a subtree has at most: then its tiles have 24 bits.
  static constexpr uint32_t kMostLevels[] = {0, 0, 12, 8};  ///< by dimensions

  using BufferReader =
      std::function<gltf::Result(const std::string& uri, std::vector<uint8_t>& bytes)>;

  /// Reads a subtree, binary or JSON. `file` and what `read_buffer` returns are kept.
  /// dimensions  2 for a quadtree, 3 for an octree.
  /// levels      in 1..kMostLevels
  /// Errors name the byte or the JSON path. Safe for untrusted input.
  gltf::Result read(std::vector<uint8_t> file, uint32_t dimensions, uint32_t levels,
                    const ErrorSchema& schema, const BufferReader& read_buffer);

  /// Availability by level and, within a level, by Morton index.
  const Availability& tiles() const { return tiles_; }
  const std::vector<Availability>& contents() const { return contents_; }
  /// Availability of the subtrees below, by Morton index.
  const Availability& children() const { return children_; }
  /// Returns the geometric error of the tile that `rank` available ones come before, if stated.
  std::optional<double> errorOf(uint64_t rank) const;

 private:
  gltf::Result readJsonPart(std::span<const uint8_t>& json, std::span<const uint8_t>& binary) const;
  gltf::Result readBuffers(const BufferReader& read_buffer, std::span<const uint8_t> binary);
  gltf::Result viewAt(const std::string& where, const gltf::Json& number,
                      std::span<const uint8_t>& bytes) const;
  gltf::Result readAvailability(const gltf::Json* json, const std::string& where,
                                uint64_t bit_count, Availability& availability) const;
  gltf::Result readErrors(const ErrorSchema& schema);

  std::vector<uint8_t> file_;
  gltf::Json json_;  ///< only while read() works
  std::vector<std::vector<uint8_t>> loaded_;
  std::vector<std::span<const uint8_t>> buffers_;
  Availability tiles_;
  std::vector<Availability> contents_;
  Availability children_;
  std::span<const uint8_t> errors_;
  bool is_double_ = false;
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_SUBTREE_H_
