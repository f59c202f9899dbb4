// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The codecs that are compared, each over all triangle primitives of a file.
#ifndef MCC_TOOLS_BENCH_CODECS_H_
#define MCC_TOOLS_BENCH_CODECS_H_

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bench/geometry.h"
#include "foreign/draco_codec.h"
#include "foreign/foreign_mesh.h"
#include "foreign/meshopt_codec.h"
#include "mcc/reader.h"

namespace mcc::bench {

using foreign::Outcome;

enum class Codec : uint8_t { kMcc, kDraco0, kDraco3, kDraco5, kMeshopt };
inline constexpr size_t kCodecCount = 5;
inline constexpr std::array<Codec, kCodecCount> kAllCodecs = {
    Codec::kMcc, Codec::kDraco0, Codec::kDraco3, Codec::kDraco5, Codec::kMeshopt};

constexpr size_t indexOf(Codec codec) { return static_cast<size_t>(codec); }
constexpr bool isDraco(Codec codec) { return codec >= Codec::kDraco0 && codec <= Codec::kDraco5; }
const char* codecName(Codec codec);  ///< "mcc", "draco 0"
const char* codecKey(Codec codec);   ///< "mcc", "draco_0": in JSON and CSV

/// Bits of one stream. The streams of a codec add up to its bytes * 8.
struct Stream {
  std::string name;  ///< "connectivity", "seams", "header", …, or an attribute's label
  double bits = 0;
};

void addStream(std::vector<Stream>& streams, const std::string& name, double bits);
double streamBits(const std::vector<Stream>& streams, const std::string& name);

/// A file as one codec has it: a unit is a payload of ours (one per glTF mesh), or one primitive.
struct EncodedFile {
  Codec codec = Codec::kMcc;
  std::vector<EncodeResult> payloads;                  ///< kMcc
  std::vector<foreign::DracoEncoded> draco;            ///< kDraco*
  std::vector<foreign::MeshoptEncoded> meshoptimizer;  ///< kMeshopt

  size_t unitCount() const { return payloads.size() + draco.size() + meshoptimizer.size(); }
  uint64_t bytes() const;
};

/// Encodes everything in `geometry.inputs`, from accessors in memory. Fails with the codec's own
/// words and the number of the primitive.
Outcome encodeFile(const Geometry& geometry, Codec codec, EncodedFile& encoded);

/// How our encoder treats large surfaces, see EncodeOptions.
struct OurBlocks {
  uint32_t block_triangles = kBlocksByPreference;
  RunJobs run_jobs;
};

/// The same for our codec, with blocks of a given size and several threads.
Outcome encodeOurs(const Geometry& geometry, const OurBlocks& blocks, EncodedFile& encoded);

/// Bytes of all units by stream. Draco's triangles are "connectivity" as measured alone, on the
/// mesh welded by position without seams, and "seams", what they take more in the file.
/// meshoptimizer's streams are those before zstd, and "zstd" what it saves, a negative number.
Outcome streamsOf(const Geometry& geometry, const EncodedFile& encoded,
                  std::vector<Stream>& streams);

/// The streams of `geometry.payloads`: ours, with what is left out of the comparison.
void fullStreams(const Geometry& geometry, std::vector<Stream>& streams);

struct DecodedPiece {
  std::vector<std::unique_ptr<std::byte[]>> attributes;
  std::vector<std::unique_ptr<uint32_t[]>> parts;
};

/// The final arrays of a unit: what glTF's accessors hold, indices as uint32.
struct DecodedUnit {
  std::vector<DecodedPiece> pieces;  ///< kMcc
  foreign::DecodedMesh mesh;         ///< the others
  uint64_t triangle_count = 0;
  uint64_t vertex_count = 0;
  uint64_t array_bytes = 0;  ///< of all arrays
};

/// Decodes one unit from bytes in memory into arrays it allocates.
/// allocator  where our reader takes its working memory from
/// run_jobs   the threads on which our reader decodes blocks
Outcome decodeUnit(const EncodedFile& encoded, size_t unit, const Allocator& allocator,
                   DecodedUnit& decoded, const RunJobs& run_jobs = {});

/// Vertex cache misses of the decoded triangles of a unit: a FIFO of 16 vertices, per primitive.
double cacheMisses(const EncodedFile& encoded, size_t unit, const DecodedUnit& decoded);

/// Error of one attribute, all primitives together.
struct NamedError {
  std::string name;
  bool is_angle = false;
  double maximum = 0;
  double median = 0;  ///< of several primitives the mean of theirs, weighted by vertices
  uint64_t measured_count = 0;
};

/// What decoding did to the values, against the source accessors. All attributes have an entry.
/// decoded       all units of `encoded`.
/// lost_wedges   glTF vertices in use by triangles of the source, but by none of the decoded ones.
Outcome measureErrors(const Geometry& geometry, const EncodedFile& encoded,
                      const std::vector<DecodedUnit>& decoded, std::vector<NamedError>& errors,
                      uint64_t& lost_wedges);

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_CODECS_H_
