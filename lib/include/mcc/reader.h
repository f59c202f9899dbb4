// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reader of KHR_mesh_collapse_compression payloads. It has no dependencies and uses no exceptions,
// no RTTI and no globals.
#ifndef MCC_READER_H_
#define MCC_READER_H_

#include <cstdint>
#include <span>
#include <string_view>

#include "mcc/allocator.h"
#include "mcc/export.h"
#include "mcc/job_runner.h"
#include "mcc/status.h"
#include "mcc/types.h"

namespace mcc {

/// Bounds that are checked before anything is allocated. The format's own bounds apply as well.
struct Limits {
  uint64_t max_vertices = uint64_t{1} << 28;   ///< wedges and topological vertices of a payload
  uint64_t max_triangles = uint64_t{1} << 28;  ///< triangles of a payload
  uint32_t max_attributes = 1024;              ///< attributes of a payload, morph targets included
  uint32_t max_pieces = 65536;
  /// Bounds the work: the specification's elements (A.2.6), to which time and working memory are
  /// proportional. A vertex takes about 10, and 5 more for each of its attributes of three
  /// components. A payload has at most 1024 elements for each of its bytes.
  uint64_t max_elements = ~uint64_t{0};
  /// Bounds the outputs: the bytes of all attributes, and of indices of 32 bits.
  uint64_t max_output_bytes = ~uint64_t{0};
};

/// A triangle list on the wedges of a piece: one primitive of glTF.
struct PartInfo {
  uint32_t triangle_count = 0;
};

/// How an attribute is coded; for reports, and for callers that compute error bounds.
enum class AttributeCoding : uint8_t {
  /// float32 on a lattice of `bits` bits. Each component is off by at most half a step. WEIGHTS are
  /// off by at most one step: tuples that sum to 1 (over all sets) still do, because weights are
  /// rounded down and the rest goes to the largest remainders.
  kLattice = 0,
  kInteger = 1,     ///< integer components, exact
  kExactFloat = 2,  ///< float32 components, every bit pattern kept
  /// Unit vectors on an octahedral grid of `bits` bits; TANGENT also has a sign.
  kOctahedral = 3,
  /// TANGENT as an angle of `bits` bits in the plane of the decoded normal, and a sign. The decoded
  /// tangent is perpendicular to the decoded normal. It differs from the source by at most half a
  /// step (180 / 2^bits degrees), plus the error of the normal (that of its kOctahedral grid), plus
  /// the source's own deviation from perpendicular (writers allow 0.12 degrees).
  kTangentAngle = 4,
  kAlias = 5,  ///< equal to attribute `alias_of` of the piece, whose coding applies
  kGrid = 6,   ///< float32 components, exact: values on a regular grid or close to one
};

/// The type of an attribute and how it is coded.
struct AttributeInfo {
  AttributeFormat format;
  AttributeCoding coding = AttributeCoding::kLattice;
  uint8_t bits = 0;       ///< of kLattice, kOctahedral, kTangentAngle and kGrid
  Lattice lattice;        ///< of kLattice
  uint8_t predictor = 0;  ///< the predictor byte, whose meaning depends on the coding [A.10]
  uint32_t alias_of = 0;  ///< of kAlias
  uint8_t grid = 0;       ///< of kGrid: the byte that gives its steps
  /// With kGrid, whether values have bits below the steps of the grid, and how those are coded.
  uint8_t tails = 0;
};

/// How the surface of a piece is coded.                                                     [A.2.2]
enum class SurfaceCoding : uint8_t {
  kManifold,        ///< every umbrella is a vertex of its own
  kBoundaryCopies,  ///< cut into a manifold and stitched; copies lie only on boundaries
  kCopies,          ///< cut into a manifold and stitched; copies lie anywhere
  kPivots,          ///< not cut: faces are coded vertex by vertex
};

/// A block: a part of a large surface that is coded apart from the others, so that several threads
/// can decode them. Border vertices are in several blocks. [A.11]
struct BlockInfo {
  uint32_t wedge_count = 0;     ///< of the block alone
  uint32_t repeated_count = 0;  ///< how many of them blocks before this one have too
  uint32_t triangle_count = 0;
  std::span<const PartInfo> parts;  ///< one for each part of the piece: its triangles in the block
  uint64_t offset_bytes = 0;        ///< where its streams begin in the payload
  uint64_t stream_bytes = 0;
  /// The smallest box of its positions, in the units of the accessor.
  float low[3] = {};
  float high[3] = {};
};

/// A set of wedges (vertices of glTF) with attributes and parts.
struct PieceInfo {
  uint32_t wedge_count = 0;   ///< glTF vertices, i.e. accessor.count
  uint32_t vertex_count = 0;  ///< before stitching: those at cuts and at blocks' borders repeat
  SurfaceCoding surface = SurfaceCoding::kManifold;
  std::span<const AttributeInfo> attributes;  ///< empty: the payload has only the triangles
  std::span<const PartInfo> parts;
  bool keeps_vertex_order = false;  ///< wedges are numbered as in the source
  /// Triangles come as in the source, in their order and with the first corner of each.
  bool keeps_triangle_order = false;
  std::span<const BlockInfo> blocks;  ///< empty: the piece is coded as a whole
};

/// Returns the format that a glTF attribute has in a payload: its name decides semantic and set,
/// where its type allows that.                                                             [A.2.4]
/// type       gives component type, component count, normalisation and morph target; the rest is
///            ignored.
/// is_matrix  says that the accessor is of a matrix type; matrices are always kCustom.
/// An accessor may be filled from an attribute of a payload only when this equals its
/// AttributeInfo::format.
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

/// What the header of a payload says. The counts have been checked against the limits.
struct PayloadInfo {
  uint8_t version_major = 0;
  uint8_t version_minor = 0;
  bool single_coder = false;
  std::span<const PieceInfo> pieces;  ///< owned by the Payload
  uint64_t codes_bytes = 0;           ///< chunk sizes
  uint64_t tokens_bytes = 0;
  uint64_t raw_bits_bytes = 0;
  uint64_t header_bytes = 0;
};

/// Where one attribute of a piece goes. When `data` is null, the attribute is decoded, since others
/// may need it, and dropped.
/// Numbers are stored in the host's byte order; a big-endian host swaps them before they go into a
/// glTF buffer.
struct AttributeTarget {
  void* data = nullptr;     ///< wedge_count elements of the attribute's component type and count
  size_t stride_bytes = 0;  ///< at least elementBytes(format)
};

/// Where the triangles of one part go: 3 * triangle_count indices of wedges of the piece, aligned
/// for their type, into which wedge_count - 1 must fit. When `indices` is null, the triangles are
/// decoded and dropped.
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

/// The resources and callbacks of decode().
struct DecodeOptions {
  Allocator allocator;
  /// Called after every stage of every piece or block with the share of the work that is done,
  /// which rises to 1, on the thread of decode(); with run_jobs on any of its threads, one call at
  /// a time. Returning false makes decode() end with kCancelled. A stage takes at most a few
  /// hundred nanoseconds per vertex.
  bool (*progress)(void* user, double done) = nullptr;
  void* progress_user = nullptr;
  CodeHistogram* histogram = nullptr;  ///< filled when not null
  /// Called after every piece, once for each of its mc-edges in decoding order; the writer
  /// contracted along them in the opposite order. `vertex` was created, or met again, along its
  /// edge from the vertex `from`. Each of the two is given as one wedge of the vertex, numbered as
  /// in the indices. Edges to dummies are left out.
  void (*mc_edge)(void* user, uint32_t piece, uint32_t vertex, uint32_t from) = nullptr;
  void* mc_edge_user = nullptr;
  /// Called after the stages of every piece with the number of bits they read, correct to within a
  /// few bits. `attribute` is the attribute's number in the piece, for kAttribute only. The bits of
  /// WEIGHTS are counted with those of JOINTS where both are coded together.
  void (*stage_bits)(void* user, uint32_t piece, DecodeStage stage, uint32_t attribute,
                     uint64_t bits) = nullptr;
  void* stage_bits_user = nullptr;
  /// Decodes the blocks of a payload on several threads. The reader starts none itself; when null,
  /// everything runs on the caller's thread. The result does not depend on it. The allocator must
  /// then be safe to use by several threads. With `histogram`, `mc_edge` or `stage_bits`, blocks
  /// are decoded one after another on the caller's thread.
  JobRunner run_jobs;
};

/// An opened payload: its parsed and checked header. Move-only; keeps a reference to the bytes.
class Payload {
 public:
  Payload() = default;
  /// A move leaves an empty payload, which is like one that was never opened.
  MCC_API Payload(Payload&& other) noexcept;
  /// Swaps: what this payload had opened goes to `other`.
  MCC_API Payload& operator=(Payload&& other) noexcept;
  MCC_API ~Payload();

  /// Parses the header, and checks the checksum and all counts against `limits` and the format's
  /// bounds.
  /// `bytes` must outlive the Payload and be exactly the buffer view: a trailing byte is an error.
  /// Returns kTruncated, kBadMagic, kUnsupportedVersion, kBadChecksum, kBadHeader, kTrailingBytes,
  /// kLimit, kOutOfMemory; the Payload is then empty. Safe for untrusted input. Time and memory are
  /// O(bytes).
  /// allocator  provides the memory of the parsed header, a few bytes per piece, part and
  ///            attribute.
  /// Tests: tests/unit/, tests/robustness/.
  MCC_API Status open(std::span<const uint8_t> bytes, const Limits& limits = {},
                      const Allocator& allocator = {});

  /// Opens a payload of which only the beginning is there yet, for reading blocks while the others
  /// are loading. Works like open(). Returns kTruncated when the header, or a payload without
  /// blocks, is not complete yet: call it again with more bytes.
  /// bytes          the beginning of the payload; must outlive the Payload, or the next extend()
  /// payload_bytes  the size of the whole payload, which is that of the buffer view
  MCC_API Status openPrefix(std::span<const uint8_t> bytes, uint64_t payload_bytes,
                            const Limits& limits = {}, const Allocator& allocator = {});

  /// Tells an open payload that more of its bytes are there. They begin with those it was opened
  /// with, and may be in another place in memory. Must not run during other calls.
  /// Returns kBadArgument if `bytes` are fewer than before or more than the payload has.
  MCC_API Status extend(std::span<const uint8_t> bytes);

  /// Returns for how many blocks, from the first on, all streams are there; 0 without blocks. O(log
  /// blocks).
  MCC_API uint32_t loadedBlockCount() const;

  /// Decodes block 0 and keeps the models with which all others begin, some hundred kilobytes. May
  /// be called again. Must not run during other calls.
  /// target  where to store the block as decodeBlock() does, or null
  /// Returns what decodeBlock() returns.
  MCC_API Status prime(const PieceTarget* target, const DecodeOptions& options = {});

  /// Decodes one block for itself, in any order, into memory of the caller: for drawing what has
  /// been loaded, or what is in view. The block has BlockInfo::wedge_count wedges of its own
  /// numbers, those that it shares with other blocks included, and the attributes of the piece.
  /// Every block except 0 needs prime() first.
  /// target   like that of a piece, with the counts of the BlockInfo
  /// options  `run_jobs` is not used; `progress` counts what decode() would have to do
  /// Returns the errors of decode(), and kBadChecksum when the streams of the block are damaged,
  /// kTruncated when they are not all there, kBadArgument without prime() or such a block. Safe for
  /// untrusted input, and to be called by several threads. Work and memory are linear in the counts
  /// of the BlockInfo. Tests: tests/roundtrip/.                                           [A.11.5]
  MCC_API Status decodeBlock(uint32_t block, const PieceTarget& target,
                             const DecodeOptions& options = {}) const;

  /// Returns counts and types. Valid until the payload is closed, moved or opened again; all zeros
  /// for an empty payload.
  MCC_API const PayloadInfo& info() const;

  /// Decodes all pieces into memory the caller owns, see PieceTarget for its shape. `targets` has
  /// one entry per piece. After an error the targets hold unspecified bytes, and nothing was
  /// written outside them.
  /// Returns kTruncated, kBadChecksum (of a block), kBadConnectivity, kBadStitch, kBadAttribute,
  /// kTrailingBytes, kLimit, kOutOfMemory, kBadArgument, kCancelled. Safe for untrusted input. Work
  /// and memory are linear in the counts of info(); with blocks, memory in those of a block. There
  /// are no globals, so different Payloads may be decoded in parallel, and one Payload several
  /// times. The result is the same on every platform. Inverse: encode(). Tests: tests/roundtrip/,
  /// tests/conformance/, tests/robustness/.
  MCC_API Status decode(std::span<const PieceTarget> targets,
                        const DecodeOptions& options = {}) const;

 private:
  struct State;
  State* state_ = nullptr;
};

}  // namespace mcc

#endif  // MCC_READER_H_
