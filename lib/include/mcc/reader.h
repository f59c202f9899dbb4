// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reader of KHR_mesh_collapse_compression payloads. No dependencies, exceptions, RTTI or globals.
#ifndef MCC_READER_H_
#define MCC_READER_H_

#include <cstdint>
#include <span>
#include <string_view>

#include "mcc/export.h"
#include "mcc/status.h"
#include "mcc/types.h"

namespace mcc {

/// Where the reader takes memory from. Null members mean malloc and free. `allocate` returns memory aligned as malloc's;
/// `release` gets the size it was asked for. Called on the threads of open(), decode() and of the Payload's destructor.
/// Compiled with MCC_COMPACT the reader has malloc and free alone.
#if defined(MCC_COMPACT)
struct Allocator {};
#else
struct Allocator {
  void* (*allocate)(void* user, size_t bytes) = nullptr;  ///< may return null: kOutOfMemory
  void (*release)(void* user, void* memory, size_t bytes) = nullptr;
  void* user = nullptr;
};
#endif

/// Bounds that hold before anything is allocated. The format's own bounds hold besides.
struct Limits {
  uint64_t max_vertices = uint64_t{1} << 28;   ///< wedges and topological vertices of a payload
  uint64_t max_triangles = uint64_t{1} << 28;  ///< triangles of a payload
  uint32_t max_attributes = 1024;              ///< attributes of a payload, morph targets included
  uint32_t max_pieces = 65536;
  /// The work: the specification's elements (A.2.6), to which time and working memory are in proportion; about 10 for each
  /// vertex, 5 more for each of its attributes of three components. A payload has 1024 for each of its bytes at most.
  uint64_t max_elements = ~uint64_t{0};
  /// What the caller would take for the outputs: all attributes, and indices of 32 bits.
  uint64_t max_output_bytes = ~uint64_t{0};
};

/// A triangle list on the wedges of a piece: one primitive of glTF.
struct PartInfo {
  uint32_t triangle_count = 0;
};

/// How an attribute is coded; for reports, and for callers that compute error bounds.
enum class AttributeCoding : uint8_t {
  /// float32 on a lattice of `bits` bits. Each component is off by at most half a step, but WEIGHTS by at most one: tuples
  /// that sum to 1 (over all sets) still do, for they are rounded down and the rest goes to the largest remainders.
  kLattice = 0,
  kInteger = 1,     ///< integer components, exact
  kExactFloat = 2,  ///< float32 components, every bit pattern kept
  kOctahedral = 3,  ///< unit vectors, octahedral grid of `bits` bits; of TANGENT besides a sign
  /// TANGENT as an angle of `bits` bits in the plane of the decoded normal, and a sign. The decoded tangent is perpendicular
  /// to the decoded normal; it differs from the source by at most half a step (180 / 2^bits degrees) plus the error of the
  /// normal (that of its kOctahedral grid) plus what the source was off perpendicular (writers allow 0.12 degrees).
  kTangentAngle = 4,
  kAlias = 5,  ///< equal to attribute `alias_of` of the piece, whose coding holds
  kGrid = 6,   ///< float32 components, exact: on a grid or near one, see attributes/exact_grid.h
};

/// The type of an attribute and how it is coded.
struct AttributeInfo {
  AttributeFormat format;
  AttributeCoding coding = AttributeCoding::kLattice;
  uint8_t bits = 0;       ///< of kLattice, kOctahedral, kTangentAngle, kGrid
  Lattice lattice;        ///< of kLattice
  uint8_t predictor = 0;  ///< the coding's own choice, see the specification
  uint32_t alias_of = 0;  ///< of kAlias
  uint8_t grid = 0;       ///< of kGrid: its steps
  uint8_t tails = 0;  ///< of kGrid: whether values have bits below them, and how those are coded
};

/// How the surface of a piece is coded.                                                      [A.2.2]
enum class SurfaceCoding : uint8_t {
  kManifold,        ///< every umbrella is a vertex of its own
  kBoundaryCopies,  ///< cut to a manifold and stitched; copies lie on boundaries alone
  kCopies,          ///< the same, copies anywhere
  kPivots,          ///< not cut: faces vertex by vertex
};

/// A set of wedges (vertices of glTF) with attributes and parts.
struct PieceInfo {
  uint32_t wedge_count = 0;   ///< glTF vertices, i.e. accessor.count
  uint32_t vertex_count = 0;  ///< topological vertices before re-stitching
  SurfaceCoding surface = SurfaceCoding::kManifold;
  std::span<const AttributeInfo> attributes;  ///< none: the payload has the triangles alone
  std::span<const PartInfo> parts;
  bool keeps_vertex_order = false;  ///< wedges are numbered as in the source
  bool keeps_triangle_order =
      false;  ///< triangles, with each one's first corner, come as in the source
};

/// What a glTF attribute is to this codec: its name decides semantic and set, as far as the type fits.         [A.2.4]
/// type       component type and count, normalisation and morph target; the rest is ignored.
/// is_matrix  of a matrix, which is always kCustom.
/// An accessor may be filled from an attribute of a payload only when this equals its AttributeInfo::format.
/// Allocates nothing. Tests: tests/tinygltf/, tests/gltf/.
MCC_API AttributeFormat namedFormat(std::string_view name, const AttributeFormat& type,
                                    bool is_matrix);

/// Symbols of the mesh collapse code as the paper's table 1 counts them.
struct CodeHistogram {
  uint64_t start = 0;         ///< S
  uint64_t end = 0;           ///< E
  uint64_t handle = 0;        ///< M
  uint64_t dummy = 0;         ///< contractions of dummy vertices (holes)
  uint64_t degree[256] = {};  ///< [d]: contractions of degree d; [255] collects all above
};

/// What the header of a payload says. Its counts were checked against the limits.
struct PayloadInfo {
  uint8_t version_major = 0;
  uint8_t version_minor = 0;
  bool single_coder = false;
  uint32_t context_set = 0;
  std::span<const PieceInfo> pieces;  ///< owned by the Payload
  uint64_t codes_bytes = 0;           ///< chunk sizes
  uint64_t tokens_bytes = 0;
  uint64_t raw_bits_bytes = 0;
  uint64_t header_bytes = 0;
};

/// Where one attribute of a piece goes. `data` null: the attribute is decoded (others may need it) and dropped.
struct AttributeTarget {
  void* data =
      nullptr;  ///< wedge_count elements, component type and count of the attribute's format
  size_t stride_bytes = 0;  ///< at least elementBytes(format)
};

/// Where the triangles of one part go: 3 * triangle_count indices of wedges of the piece.
struct PartTarget {
  void* indices = nullptr;
  IndexType index_type = IndexType::kUint32;
};

/// Where a piece goes. Targets must not overlap.
struct PieceTarget {
  std::span<const AttributeTarget> attributes;  ///< one per attribute of the piece
  std::span<const PartTarget> parts;            ///< one per part of the piece
};

/// What the bits of a payload are for.
enum class DecodeStage : uint8_t {
  kConnectivity,
  kStitching,
  kPositions,
  kSeams,
  kLeftovers,  ///< duplicate and degenerate triangles, parts
  kOrders,
  kAttribute,
};

/// What decode() may use, and whom it tells.
struct DecodeOptions {
  Allocator allocator;
  /// Called behind every stage of every piece with the work done, rising to 1, on the thread of decode(); returning false
  /// ends that with kCancelled. A stage takes a few hundred nanoseconds per vertex at most.
  bool (*progress)(void* user, double done) = nullptr;
  void* progress_user = nullptr;
  CodeHistogram* histogram = nullptr;  ///< filled when not null
  /// Called behind every piece for its mc-edges, in decoding order: the writer contracted along them in the opposite one.
  /// `vertex` was made, or met again, at its edge to `from`; both are a wedge of their vertex, numbered as in the indices.
  /// Edges to dummies are left out. Compiled with MCC_COMPACT the reader tells none.
  void (*mc_edge)(void* user, uint32_t piece, uint32_t vertex, uint32_t from) = nullptr;
  void* mc_edge_user = nullptr;
  /// Called behind the stages of every piece with the bits they read, right to a few bits; `attribute` is its number in the
  /// piece, of kAttribute alone. JOINTS take those of WEIGHTS along.
  void (*stage_bits)(void* user, uint32_t piece, DecodeStage stage, uint32_t attribute,
                     uint64_t bits) = nullptr;
  void* stage_bits_user = nullptr;
};

/// An opened payload: its parsed and checked header. Move-only; keeps a reference to the bytes.
class Payload {
 public:
  Payload() = default;
  /// Moves leave an empty payload behind, which is as one that was never opened.
  MCC_API Payload(Payload&& other) noexcept;
  /// As above; what this had opened goes to `other`.
  MCC_API Payload& operator=(Payload&& other) noexcept;
  MCC_API ~Payload();

  /// Parses the header, checks the checksum, all counts against `limits` and the format's bounds.
  /// `bytes` must outlive the Payload and be exactly the buffer view (a trailing byte is an error).
  /// Returns kTruncated, kBadMagic, kUnsupportedVersion, kBadChecksum, kBadHeader, kTrailingBytes,
  /// kLimit, kOutOfMemory; the Payload is then empty. Safe for untrusted input. Time and memory O(bytes).
  /// allocator  for the header, of a few bytes per piece, part and attribute. Tests: tests/unit/, tests/robustness/.
  MCC_API Status open(std::span<const uint8_t> bytes, const Limits& limits = {},
                      const Allocator& allocator = {});

  /// Counts and types of what is opened, valid as long as it is; of an empty payload zeros.
  MCC_API const PayloadInfo& info() const;

  /// Decodes all pieces into memory the caller owns, see PieceTarget for shapes. `targets` has one entry
  /// per piece. On an error the targets hold unspecified bytes; nothing is written outside them.
  /// Returns kTruncated, kBadConnectivity, kBadStitch, kBadAttribute, kTrailingBytes, kLimit,
  /// kOutOfMemory, kBadArgument, kCancelled. Safe for untrusted input; work and memory are linear in the
  /// counts of info(); no globals, so different Payloads may be decoded in parallel, and one Payload several times; same
  /// bytes on every platform. Inverse: encode(). Tests: tests/roundtrip/, tests/conformance/, tests/robustness/.
  MCC_API Status decode(std::span<const PieceTarget> targets,
                        const DecodeOptions& options = {}) const;

 private:
  struct State;
  State* state_ = nullptr;
};

}  // namespace mcc

#endif  // MCC_READER_H_
