// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Adds KHR_mesh_collapse_compression to glTF 2.0 documents in memory, and removes it again; files.h
// does so for files. No exception leaves these functions; they use no globals and may run in
// parallel.
#ifndef MCC_GLB_H_
#define MCC_GLB_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mcc/decoded_limit.h"
#include "mcc/export.h"
#include "mcc/reader.h"
#include "mcc/result.h"
#include "mcc/types.h"

namespace mcc::gltf {

/// The key of the extension objects.
inline constexpr char kExtensionName[] = "KHR_mesh_collapse_compression";

/// Which primitives share one lattice of positions. No cracks can open between those that do.
enum class Grid : uint8_t {
  kMesh,       ///< all primitives of a mesh
  kScene,      ///< all primitives of the file (in mesh coordinates)
  kPrimitive,  ///< every piece has its own lattice
};

/// Bits per component of float attributes; 0 keeps every bit. Integer attributes, joints and
/// custom attributes are always exact.
struct QuantizationBits {
  uint8_t position_bits = 14;  ///< 0..24; also the lattice of POSITION morph deltas
  uint8_t normal_bits = 10;    ///< 0 or 2..16, octahedral
  uint8_t texcoord_bits = 12;  ///< 0..24
  uint8_t color_bits = 8;      ///< 0..24
  uint8_t tangent_bits = 12;   ///< 0 or 2..16
  uint8_t weight_bits = 12;    ///< 0..24
};

/// A buffer view compressed by EXT_meshopt_compression or KHR_meshopt_compression, as its extension
/// object describes it.
struct CodedView {
  std::span<const uint8_t> bytes;
  uint64_t count = 0;  ///< elements of `stride_bytes` each; at most 256 bytes per coded byte
  uint32_t stride_bytes = 0;
  std::string mode;    ///< "ATTRIBUTES", "TRIANGLES", "INDICES" or another
  std::string filter;  ///< "NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL" or another
};

/// A primitive compressed by KHR_draco_mesh_compression, and what its accessors claim.
struct CodedMesh {
  /// An attribute, named by its unique id in the Draco data.
  struct Attribute {
    uint32_t id = 0;
    ComponentType component_type = ComponentType::kFloat32;
    uint32_t component_count = 0;
  };
  std::span<const uint8_t> bytes;
  uint64_t vertex_count = 0;
  uint64_t triangle_count = 0;  ///< at most 4096 per coded byte; so is vertex_count
  std::vector<Attribute> attributes;
};

/// What ForeignDecoders::mesh returns for a CodedMesh.
struct DecodedMesh {
  std::vector<uint32_t> indices;                 ///< 3 * triangle_count, each below vertex_count
  std::vector<std::vector<uint8_t>> attributes;  ///< as in CodedMesh: vertex_count packed elements
};

/// Decoders of other projects' codecs, for sources that those compressed. They get untrusted bytes,
/// must not throw, and may be called in parallel. Where a function is null, the views or primitives
/// it would decode stay as they are.
struct ForeignDecoders {
  /// Decodes a buffer view: `elements` becomes count * stride_bytes bytes.
  std::function<Result(const CodedView& view, std::vector<uint8_t>& elements)> view;
  /// Decodes a primitive. Must also fail when the counts or types differ from those claimed, if
  /// possible before it takes memory for them.
  std::function<Result(const CodedMesh& coded, DecodedMesh& mesh)> mesh;
};

/// A list of triangles, to be simplified.
struct TriangleList {
  std::span<const float> positions;     ///< 3 for each vertex, from 0 to 1
  std::span<const uint32_t> triangles;  ///< 3 vertices for each triangle; all exist
};

/// Simplifies a list of triangles for a preview: `simplified` becomes one on the same vertices with
/// about `triangle_count` triangles, which is less than the list has. Vertices with the same
/// position may have different attributes. Must not throw, must be deterministic, and may be called
/// in parallel.
using Simplify = std::function<Result(const TriangleList& list, uint64_t triangle_count,
                                      std::vector<uint32_t>& simplified)>;

/// Values of ConvertOptions::preview_triangles.
inline constexpr uint32_t kNoPreviews = 0;
inline constexpr uint32_t kPreviewsByShare = 0xffffffffu;  ///< 2 % of the triangles of a primitive
/// Primitives with fewer triangles get no preview.
inline constexpr uint32_t kMinPreviewedTriangles = 100000;

/// The version of the container of a GLB that is written.
enum class GlbVersion : uint32_t {
  kSmallest = 0,  ///< 2, or 3 for more than 4 GiB; a source that is copied keeps its own
  k2 = 2,         ///< that of glTF 2.0; files of more than 4 GiB are an error
  k3 = 3,         ///< that of the draft of glTF 2.1, which few programs read; see docs/gltf-2.1.md
};

/// How convertGlb() compresses.
struct ConvertOptions : QuantizationBits {
  bool lossless = false;  ///< every float keeps every bit; all bits are ignored
  /// When not 0: no decoded POSITION, and no POSITION delta of a morph target, is farther from its
  /// source than this distance in the coordinates of the mesh; `position_bits` is ignored. The
  /// written file is checked for it.
  double max_position_error = 0;
  /// max_position_error is a fraction of the largest side of the bounding box of all primitives
  /// that share the lattice.
  bool is_error_relative = false;
  /// When set: the lattice of every float POSITION, so that tiles converted separately fit
  /// together; `grid`, `position_bits` and max_position_error are ignored.
  std::optional<Lattice> position_lattice;
  /// When not 0: the step of a position_lattice through the origin, so that whatever was converted
  /// with the same step, parts and files of one project, fits together without further agreement. A
  /// power of two from 2^-126 to 2^127: the points of such a lattice are floats, and decoding
  /// rounds nothing. Positions farther than 2^24 steps from the origin stay exact, with a note.
  /// Cannot be combined with lossless, max_position_error and position_lattice.
  double step = 0;
  /// When not 0, 16 to 2^20: how large a mesh is drawn, in pixels, from which the bits of every
  /// float attribute follow; those of QuantizationBits are ignored. No position, and no delta of
  /// one, is farther from its source than a pixel: 1 / quality of the longest side of the box
  /// around what shares the lattice (see `grid`), apart from a few far outliers, which do not count
  /// for that size. Normals and tangents turn by at most a quarter of a degree at 4096, and by half
  /// as much for four times the pixels; texture coordinates move by at most a quarter of a texel of
  /// the largest texture that uses them, or of a pixel where that is more; colours by half a step
  /// of 255, weights by 2 / quality. ConvertReport::quality_choices says what was chosen. Cannot be
  /// combined with lossless, max_position_error, position_lattice and step.
  double quality = 0;
  /// Compresses only the triangles. Attributes stay accessors and keep every bit, in the order of
  /// the payload. Where something else refers to them they stay untouched, and the payload holds
  /// the order.
  bool indices_only = false;
  /// Leaves out vertices that no triangle uses, where nothing can refer to them. Cannot be combined
  /// with indices_only.
  bool drop_unused = false;
  Grid grid = Grid::kMesh;
  /// Vertices, or triangles with the first corner of each, come back in the source's order. This is
  /// always so where a mesh or primitive has an extension that may refer to them by number: one
  /// that this library does not know, or one that counts triangles. Numbers of vertices in
  /// CESIUM_primitive_outline and CESIUM_tile_edges are translated.
  bool keep_vertex_order = false;
  bool keep_triangle_order = false;
  /// Also writes the decoded geometry, uncompressed, to a second file next to the output,
  /// NAME.<hash>.fallback.bin, for loaders that do not know the extension. The extension is then
  /// used but not required.
  bool fallback = false;
  /// Threads that work at the same time, on several payloads or on the trials of one. The result
  /// does not depend on it.
  uint32_t thread_count = 1;
  Preference prefer = Preference::kBalanced;       ///< smaller payloads, or ones faster to decode
  uint32_t block_triangles = kBlocksByPreference;  ///< see EncodeOptions::block_triangles
  ForeignDecoders decoders;                        ///< for sources that other codecs compressed
  /// Puts a coarse version of each large primitive in front of everything else, for loaders to show
  /// while the rest is on its way. About how many triangles it has. Cannot be combined with
  /// indices_only.
  uint32_t preview_triangles = kNoPreviews;
  Simplify simplify;  ///< of previews; null: vertices in one cell of a grid are merged
  /// How much a compressed source may decode to, see decodedLimit(); 0: the default. All accessors
  /// that have no bytes in the file may take a 32nd of it together; primitives that would need more
  /// stay as they are.
  uint64_t max_decoded_bytes = 0;
  /// Called from time to time to report progress to a user: the current stage, and the share of its
  /// triangles that is done, or -1 when unknown. There is one call at a time, on any of the
  /// threads. Must not throw. May be empty.
  std::function<void(const char* stage, double share)> progress;
  /// Compresses even where that makes the file larger.
  bool allow_larger = false;
  GlbVersion glb_version = GlbVersion::kSmallest;
};

/// How accurately one attribute was coded. Errors are in degrees for unit vectors, else in units of
/// the accessor (for normalised integers those of the stored integer).
struct AttributeReport {
  std::string name;  ///< "POSITION", "TEXCOORD_1", "target 0 NORMAL"
  AttributeCoding coding = AttributeCoding::kExactFloat;
  uint8_t bits = 0;  ///< of the lattice, octahedral grid or angle; 0: exact
  uint32_t component_count = 0;
  uint32_t vertex_count = 0;
  double coded_bits = 0;         ///< bits in the payload; for POSITION without the triangles
  bool is_angle = false;         ///< errors are in degrees
  double promised_error = 0;     ///< no value is farther from its source than this
  double max_error = 0;          ///< measured on the file that was written
  double median_error = 0;       ///< measured, for angles only
  double promised_distance = 0;  ///< for positions under max_position_error, else 0
  double max_distance = 0;       ///< measured where a distance was promised
  double extent = 0;  ///< for positions: the longest side of the box around the decoded ones
  std::vector<std::string> primitives;  ///< JSON paths of the primitives it belongs to
};

/// What ConvertOptions::quality chose for the float attributes of one name, in all meshes.
struct QualityChoice {
  std::string name;              ///< "POSITION", "TEXCOORD_1", of morph targets "target NORMAL"
  uint32_t attribute_count = 0;  ///< an attribute that several primitives share counts once
  uint32_t exact_count = 0;      ///< those of them that stay exact; notes say why
  uint8_t fewest_bits = 0;       ///< of the others
  uint8_t most_bits = 0;
  std::string why;  ///< the error that is kept, in words
};

/// Bits of one stream of a payload.
struct StreamReport {
  std::string name;  ///< "connectivity", "stitching", "leftovers", "seams", "order", "header"
  double bits = 0;
};

/// A payload that convertGlb() wrote.
struct PayloadReport {
  uint32_t mesh = 0;           ///< the first mesh it belongs to
  uint64_t payload_bytes = 0;  ///< in the file
  /// An earlier payload, whose bytes and view it shares, so that it takes none and has no streams:
  /// index into ConvertReport::payloads; kNone: it has bytes of its own.
  uint32_t same_as = kNone;
  uint64_t freed_bytes = 0;   ///< buffer bytes that the payload replaces
  uint64_t wedge_count = 0;   ///< glTF vertices
  uint64_t vertex_count = 0;  ///< topological vertices (distinct positions)
  uint64_t triangle_count = 0;
  uint64_t component_count = 0;
  uint64_t hole_count = 0;
  uint64_t cut_copy_count = 0;
  uint64_t leftover_triangle_count = 0;
  uint32_t piece_count = 0;
  uint32_t block_count = 0;   ///< 0: not cut into blocks
  std::string whole_because;  ///< why not, if blocks were asked for
  std::vector<StreamReport> streams;
  /// Attributes of several pieces are merged where mesh, name, coding and bits are the same.
  std::vector<AttributeReport> attributes;
};

/// What became of a primitive.
struct PrimitiveReport {
  uint32_t mesh = 0;
  uint32_t primitive = 0;
  bool compressed = false;
  uint32_t payload = kNone;  ///< index into ConvertReport::payloads
  uint64_t triangle_count = 0;
  uint64_t wedge_count = 0;
  uint64_t preview_triangle_count = 0;  ///< 0: it has no preview
  std::string note;  ///< why it was left uncompressed; empty when it was compressed
};

/// What the bytes of a document and its buffers are for. The four sums add up to its size.
struct Contents {
  uint64_t geometry_bytes = 0;    ///< attributes, indices and morph targets of meshes, coded or not
  uint64_t image_bytes = 0;       ///< images inside of the document
  uint64_t animation_bytes = 0;   ///< samplers of animations, and matrices of skins
  uint64_t other_bytes = 0;       ///< the JSON, padding, and everything else
  uint32_t image_count = 0;       ///< images inside of the document
  uint32_t image_file_count = 0;  ///< images in files of their own, which no sum contains
  uint32_t animation_count = 0;
};

/// What convertGlb() did.
struct ConvertReport {
  uint64_t input_bytes = 0;     ///< with all buffers
  uint64_t output_bytes = 0;    ///< with all buffers, without the fallback
  uint64_t fallback_bytes = 0;  ///< size of the fallback file
  Contents input_contents;
  Contents output_contents;
  bool copied = false;   ///< compression gained nothing, so the output is the input
  bool checked = false;  ///< the output was decoded and compared with the source
  double encode_seconds = 0;
  double decode_seconds = 0;  ///< of all payloads, added up over the threads
  double check_seconds = 0;   ///< for comparing what was decoded, and the written file
  std::vector<PayloadReport> payloads;
  uint64_t preview_bytes = 0;               ///< of the payloads that hold previews
  std::vector<PrimitiveReport> primitives;  ///< all primitives of the file, in file order
  /// Empty without ConvertOptions::quality. Of all that was planned, even if it did not become
  /// smaller and stayed as it was.
  std::vector<QualityChoice> quality_choices;
  /// What the user may want to do something about: "/meshes/0/primitives/1: why".
  std::vector<std::string> notes;
  std::vector<std::string> remarks;  ///< the same for facts that ask nothing of anybody
};

/// What quantised attributes become when a file is decoded.
enum class DecodeTo : uint8_t {
  kFloats,  ///< floats, as in the source
  /// Integers with KHR_mesh_quantization, which take less memory on graphics cards. Positions
  /// become points of their lattice; the lattice goes into a new child node of each node with a
  /// mesh, or into the inverse bind matrices of a skin. Positions move by float rounding at most.
  /// Other values move by at most half a step of an integer type whose steps are not coarser than
  /// those of the coded grid. What cannot become integer stays float, with a note.
  kIntegers,
};

/// How decodeGlb() decodes.
struct DecodeOptions {
  DecodeTo decode_to = DecodeTo::kFloats;
  uint32_t thread_count = 1;  ///< the result does not depend on it
  /// How much the file may decode to, see decodedLimit(); 0: the default. Checked before memory is
  /// taken.
  uint64_t max_decoded_bytes = 0;
  GlbVersion glb_version = GlbVersion::kSmallest;
};

/// What decodeGlb() did.
struct DecodeReport {
  uint64_t input_bytes = 0;
  uint64_t output_bytes = 0;
  bool copied = false;         ///< nothing was compressed, so the output is the input
  uint32_t payload_count = 0;  ///< distinct payloads: views of the same bytes hold one
  uint32_t primitive_count = 0;
  uint64_t triangle_count = 0;
  uint64_t wedge_count = 0;
  double decode_seconds = 0;
  std::vector<std::string> notes;
};

/// Facts about an attribute that are derived from the payload.
struct InspectAttribute {
  std::string name;       ///< as in the JSON; "(unused)" when no primitive names it
  std::string predictor;  ///< the writer's choice, in the specification's words: "fitted, sheared"
  double coded_bits = 0;  ///< bits in the payload, to within a few; only when codes are counted
  /// No component is farther from its source than this, apart from float32 rounding, if this
  /// library wrote the payload: its writer chooses the nearest point of the grid. 0: exact.
  double error_bound = 0;
  bool is_angle = false;  ///< error_bound is in degrees
};

/// A block of an inspected piece, see BlockInfo.
struct InspectBlock {
  uint32_t wedge_count = 0;
  uint32_t repeated_count = 0;
  uint32_t triangle_count = 0;
  uint64_t stream_bytes = 0;
  float low[3] = {};
  float high[3] = {};
};

/// A piece of an inspected payload.
struct InspectPiece {
  uint32_t wedge_count = 0;
  uint32_t vertex_count = 0;
  uint64_t triangle_count = 0;
  uint32_t part_count = 0;
  SurfaceCoding surface = SurfaceCoding::kManifold;
  std::vector<AttributeInfo> attributes;
  std::vector<InspectAttribute> details;  ///< one for each of `attributes`
  std::vector<InspectBlock> blocks;       ///< empty: coded as a whole
  std::string whole_because;  ///< why a large piece is coded as a whole, as far as a file shows it
};

/// A payload as its header describes it.
struct InspectPayload {
  uint32_t buffer_view = 0;
  uint64_t payload_bytes = 0;
  uint8_t version_major = 0;
  uint8_t version_minor = 0;
  uint64_t header_bytes = 0;
  uint64_t codes_bytes = 0;
  uint64_t tokens_bytes = 0;
  uint64_t raw_bits_bytes = 0;
  std::vector<std::string> primitives;  ///< JSON paths of the primitives that use it
  bool is_preview = false;              ///< it holds nothing but previews of these primitives
  std::vector<InspectPiece> pieces;
  bool single_coder = false;
  bool has_codes = false;
  CodeHistogram codes;  ///< only when codes are counted
  /// Also only when codes are counted: the streams of ConvertReport that are not attributes.
  /// Together with InspectAttribute::coded_bits they add up to the payload.
  std::vector<StreamReport> streams;
};

/// All payloads of a file.
struct InspectReport {
  uint64_t input_bytes = 0;
  std::vector<InspectPayload> payloads;
  std::vector<std::string> extensions_used;
  uint32_t mesh_count = 0;
  uint32_t primitive_count = 0;
};

/// Numbered as in the reports of Khronos' glTF validator.
enum class Severity : uint8_t { kError = 0, kWarning = 1, kInfo = 2, kHint = 3 };

/// One finding of validateGlb(): an error, or something worth knowing.
struct ValidationIssue {
  Severity severity = Severity::kError;
  std::string code;     ///< "COUNT_MISMATCH"; tools/gltf-mcc/README.md lists them
  std::string message;  ///< one line, no full stop
  std::string pointer;  ///< JSON pointer (RFC 6901); empty where the issue has no place in the JSON
};

/// Bounds of validateGlb().
struct ValidateOptions {
  Limits limits;                   ///< of each payload
  uint64_t max_decoded_bytes = 0;  ///< of the file, see decodedLimit(); 0: the default
  uint32_t max_issues = 1000;      ///< further issues are counted but not listed; 0: all are listed
};

/// What validateGlb() found.
struct ValidationReport {
  std::vector<ValidationIssue> issues;  ///< in the order they were found
  uint64_t issue_counts[4] = {};        ///< by severity; all issues, listed or not
  bool is_truncated = false;            ///< some issues are not listed
  // Facts about the file, as far as it could be loaded.
  bool is_glb = false;
  std::string version;    ///< of glTF
  std::string generator;  ///< as stated in the file
  std::vector<std::string> extensions_used;
  std::vector<std::string> extensions_required;
  uint64_t input_bytes = 0;
  uint32_t primitive_count = 0;             ///< all primitives of the file
  uint32_t compressed_primitive_count = 0;  ///< primitives with the extension
  uint32_t payload_count = 0;               ///< distinct payloads
  uint64_t triangle_count = 0;              ///< in the payloads that decode
  uint64_t wedge_count = 0;                 ///< in the payloads that decode

  /// Whether there are no errors.
  bool isValid() const { return issue_counts[static_cast<size_t>(Severity::kError)] == 0; }
};

/// Compresses the triangle primitives of a glTF document: a GLB, or a .gltf with its buffers in
/// data URIs. The output is a GLB. Everything except mesh geometry is preserved unchanged. When
/// compression gains nothing, a GLB is copied byte for byte. Geometry that other codecs compressed
/// is decoded by options.decoders and compressed again. The output is decoded and compared with the
/// source before the call returns.
///
/// After an error `output` is unspecified, and `report` holds what was known when it occurred. Safe
/// for untrusted input. Deterministic. Inverse: decodeGlb(). Tests: tests/gltf/, tests/cli/.
MCC_API Result convertGlb(std::span<const uint8_t> source, const ConvertOptions& options,
                          std::vector<uint8_t>& output, ConvertReport& report);

/// Turns compressed primitives into ordinary accessors again; a GLB without any is copied. A
/// payload is decoded once, however many primitives and buffer views name its bytes; accessors of
/// the same elements share a buffer view. Safe for untrusted input: a document that asks for more
/// than options.max_decoded_bytes is refused before memory is taken. Inverse: convertGlb(). Tests:
/// tests/gltf/, tests/cli/.
MCC_API Result decodeGlb(std::span<const uint8_t> source, std::vector<uint8_t>& output,
                         DecodeReport& report, const DecodeOptions& options = {});

/// Lists the payloads of a document. With `count_codes` the payloads are also decoded, to count
/// their codes and the bits of their streams. Safe for untrusted input: decoding is bounded by the
/// default of decodedLimit().
MCC_API Result inspectGlb(std::span<const uint8_t> source, bool count_codes, InspectReport& report);

/// Checks a document against every rule of the extension for loaders and writers: the extension
/// objects, the accessors they fill, the lists of extensions, fallbacks, and the payloads, which
/// are decoded. Continues after an issue wherever that is possible. It does not check whether the
/// rest of the document is valid glTF, except that it can be loaded; use a general glTF validator
/// for that.
/// Errors: the document cannot be read. Everything that is wrong inside of it goes to `report`.
/// Safe for untrusted input. Deterministic. Tests: tests/gltf/validate_test.cpp,
/// tests/cli/validate_test.cpp.
MCC_API Result validateGlb(std::span<const uint8_t> source, const ValidateOptions& options,
                           ValidationReport& report);

}  // namespace mcc::gltf

#endif  // MCC_GLB_H_
