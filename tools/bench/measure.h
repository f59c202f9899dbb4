// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Sizes, times, memory and errors of the codecs on one file, in one process.
#ifndef MCC_TOOLS_BENCH_MEASURE_H_
#define MCC_TOOLS_BENCH_MEASURE_H_

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/codecs.h"
#include "bench/measure_load.h"

namespace mcc::bench {

struct MeasureOptions {
  std::vector<Codec> codecs = {kAllCodecs.begin(), kAllCodecs.end()};
  uint32_t run_count = 5;     ///< decodes per codec, at least
  double encode_seconds = 0;  ///< encodes are repeated, up to run_count times, while they took less
  /// Codecs that encode, or are examined after decoding, at the same time. Decoding is timed alone.
  uint32_t thread_count = 1;
  bool with_errors = false;
  bool with_memory = false;  ///< peak memory and cache misses
  /// Told what is being done now: "a_bunny: decode 3 of 5". By any of the threads.
  std::function<void(const std::string&)> progress;
};

/// What was measured of one codec. Times are CPU seconds of the thread.
struct CodecFigures {
  bool is_asked = false;
  std::string failure;  ///< why there are no figures
  uint64_t bytes = 0;
  std::vector<Stream> streams;
  uint64_t triangle_count = 0;  ///< after decoding
  uint64_t vertex_count = 0;    ///< after decoding, as the codec counts
  uint64_t lost_wedges = 0;     ///< see measureErrors()
  double encode_seconds = 0;    ///< least; from accessors in memory to the payload
  double decode_seconds = 0;    ///< least; from payloads in memory to final arrays
  uint32_t encode_runs = 0;
  uint32_t decode_runs = 0;
  uint64_t array_bytes = 0;  ///< final float and index arrays
  /// Most memory in use above the arrays while a unit (a payload of ours, a primitive) is decoded.
  uint64_t peak_bytes = 0;
  double acmr = 0;  ///< vertex cache misses per triangle of the decoded order: FIFO of 16
  std::vector<NamedError> errors;

  bool ok() const { return is_asked && failure.empty(); }
};

struct FileFigures {
  std::string name;  ///< name of the file, without folder and extension
  uint64_t triangle_count = 0;
  uint64_t wedge_count = 0;   ///< glTF vertices
  uint64_t vertex_count = 0;  ///< distinct positions
  uint64_t primitive_count = 0;
  std::array<CodecFigures, kCodecCount> codecs;
  /// Our bytes with morph targets and everything else Draco does not support; the figures above are
  /// without them.
  bool has_left_out = false;
  uint64_t full_bytes = 0;
  std::vector<Stream> full_streams;
  std::vector<Stream> left_out;  ///< those of full_streams that are left out
  std::vector<std::string> notes;
  LoadFigures load;  ///< filled in by measureLoad()

  const CodecFigures& of(Codec codec) const { return codecs[indexOf(codec)]; }
};

/// Measures all codecs on the geometry of a file. A codec that fails has a message in its figures;
/// only when ours fails does the call.
Outcome measureFile(const std::string& name, const Geometry& geometry,
                    const MeasureOptions& options, FileFigures& figures);

/// Draco's best: the smaller of its speeds 0 and 5 over the whole file, as far as they worked and
/// were measured; Codec::kMcc when there is none.
Codec bestDraco(const FileFigures& figures);

/// CPU seconds of this thread.
double threadSeconds();

}  // namespace mcc::bench

#endif  // MCC_TOOLS_BENCH_MEASURE_H_
