// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "bench/measure.h"

#include <algorithm>
#include <ctime>
#include <exception>

#include "bench/memory_count.h"
#include "host/parallel.h"

namespace mcc::bench {
namespace {

/// Small files are decoded more often than requested, until this much time was spent per codec.
constexpr double kDecodeSeconds = .05;
constexpr uint32_t kMaxDecodeRuns = 200;

class FileMeasurer {
 public:
  FileMeasurer(const Geometry& geometry, const MeasureOptions& options, FileFigures& figures)
      : geometry_(geometry), options_(options), figures_(figures) {}

  Outcome run() {
    for (const Codec codec : options_.codecs) figures_.codecs[indexOf(codec)].is_asked = true;
    encodeAll();
    decodeAll();
    forEachCodec(options_.codecs, [&](Codec codec) {
      if (figures_.of(codec).ok()) noteFailure(codec, examine(codec));
    });
    const CodecFigures& ours = figures_.of(Codec::kMcc);
    return ours.failure.empty() ? Outcome{} : foreign::failure(ours.failure);
  }

 private:
  void tell(const std::string& what) const {
    if (options_.progress) options_.progress(figures_.name + ": " + what);
  }

  void noteFailure(Codec codec, const Outcome& outcome) {
    if (!outcome.ok()) figures_.codecs[indexOf(codec)].failure = outcome.message;
  }

  /// Each codec touches its own figures only.
  template <typename Job>
  void forEachCodec(const std::vector<Codec>& codecs, const Job& job) {
    const gltf::Result done =
        gltf::runParallel(codecs.size(), options_.thread_count, [&](size_t i) -> gltf::Result {
          job(codecs[i]);
          return {};
        });
    if (!done.ok()) noteFailure(Codec::kMcc, foreign::failure(done.message()));
  }

  /// In rounds over the codecs, so that a disturbance does not hit one of them alone.
  void encodeAll() {
    std::array<double, kCodecCount> spent = {};
    for (uint32_t round = 0; round < std::max(options_.run_count, 1u); ++round) {
      std::vector<Codec> due;
      for (const Codec codec : options_.codecs) {
        const bool has_time = round == 0 || spent[indexOf(codec)] < options_.encode_seconds;
        if (has_time && figures_.of(codec).ok()) due.push_back(codec);
      }
      forEachCodec(due, [&](Codec codec) {
        CodecFigures& figures = figures_.codecs[indexOf(codec)];
        tell(std::string("encode with ") + codecName(codec));
        const double start = threadSeconds();
        noteFailure(codec, encodeFile(geometry_, codec, encoded_[indexOf(codec)]));
        const double seconds = threadSeconds() - start;
        spent[indexOf(codec)] += seconds;
        if (round == 0 || seconds < figures.encode_seconds) figures.encode_seconds = seconds;
        ++figures.encode_runs;
      });
    }
  }

  void decodeAll() {
    std::array<double, kCodecCount> spent = {};
    for (uint32_t round = 0; round < kMaxDecodeRuns; ++round) {
      bool is_done = round >= options_.run_count;
      for (const Codec codec : options_.codecs) {
        CodecFigures& figures = figures_.codecs[indexOf(codec)];
        if (!figures.ok()) continue;
        if (round >= options_.run_count && spent[indexOf(codec)] >= kDecodeSeconds) continue;
        is_done = false;
        if (round < options_.run_count) {
          tell("decode " + std::to_string(round + 1) + " of " + std::to_string(options_.run_count));
        }
        const double seconds = timeDecode(codec);
        spent[indexOf(codec)] += seconds;
        if (round == 0 || seconds < figures.decode_seconds) figures.decode_seconds = seconds;
        ++figures.decode_runs;
      }
      if (is_done) return;
    }
  }

  double timeDecode(Codec codec) {
    const EncodedFile& encoded = encoded_[indexOf(codec)];
    std::vector<DecodedUnit> units(encoded.unitCount());
    Outcome done;
    const double start = threadSeconds();
    for (size_t i = 0; i < units.size() && done.ok(); ++i)
      done = decodeUnit(encoded, i, {}, units[i]);
    const double seconds = threadSeconds() - start;
    noteFailure(codec, done);
    return seconds;  // the arrays are freed after the clock was read
  }

  /// Does everything that is not timed.
  Outcome examine(Codec codec) {
    CodecFigures& figures = figures_.codecs[indexOf(codec)];
    const EncodedFile& encoded = encoded_[indexOf(codec)];
    tell(std::string("examine ") + codecName(codec));
    figures.bytes = encoded.bytes();
    if (Outcome done = streamsOf(geometry_, encoded, figures.streams); !done.ok()) return done;
    std::vector<DecodedUnit> units(encoded.unitCount());
    double misses = 0;
    for (size_t i = 0; i < units.size(); ++i) {
      Outcome done = options_.with_memory ? decodeCounted(encoded, i, units[i], figures)
                                          : decodeUnit(encoded, i, {}, units[i]);
      if (!done.ok()) return done;
      figures.triangle_count += units[i].triangle_count;
      figures.vertex_count += units[i].vertex_count;
      figures.array_bytes += units[i].array_bytes;
      if (options_.with_memory) misses += cacheMisses(encoded, i, units[i]);
    }
    const auto triangles = static_cast<double>(figures.triangle_count);
    if (triangles > 0) figures.acmr = misses / triangles;
    if (!options_.with_errors) return {};
    return measureErrors(geometry_, encoded, units, figures.errors, figures.lost_wedges);
  }

  static Outcome decodeCounted(const EncodedFile& encoded, size_t unit, DecodedUnit& decoded,
                               CodecFigures& figures) {
    MemoryCount count;
    Outcome done = decodeUnit(encoded, unit, countedAllocator(), decoded);
    const uint64_t peak = count.peakBytes();
    const uint64_t above = peak > decoded.array_bytes ? peak - decoded.array_bytes : 0;
    figures.peak_bytes = std::max(figures.peak_bytes, above);
    return done;
  }

  const Geometry& geometry_;
  const MeasureOptions& options_;
  FileFigures& figures_;
  std::array<EncodedFile, kCodecCount> encoded_;
};

void addLeftOut(const Geometry& geometry, FileFigures& figures) {
  figures.has_left_out = geometry.has_left_out;
  fullStreams(geometry, figures.full_streams);
  for (const gltf::EncodedPayload& payload : geometry.payloads) {
    figures.full_bytes += payload.result.payload.size();
    const std::vector<double>& bits = payload.result.sizes.attribute_bits;
    size_t next = 0;
    for (const gltf::PiecePlan& piece : payload.plan.pieces) {
      for (const gltf::AttributePlan& attribute : piece.attributes) {
        if (isLeftOut(attribute.format) && next < bits.size()) {
          addStream(figures.left_out, attribute.label(), bits[next]);
        }
        ++next;
      }
    }
  }
}

}  // namespace

Outcome measureFile(const std::string& name, const Geometry& geometry,
                    const MeasureOptions& options, FileFigures& figures) {
  figures = {};
  figures.name = name;
  figures.triangle_count = geometry.triangle_count;
  figures.wedge_count = geometry.wedge_count;
  figures.vertex_count = geometry.vertex_count;
  figures.primitive_count = primitivesOf(geometry).size();
  figures.notes = geometry.notes;
  addLeftOut(geometry, figures);
  return FileMeasurer(geometry, options, figures).run();
}

Codec bestDraco(const FileFigures& figures) {
  const CodecFigures& fast = figures.of(Codec::kDraco5);
  const CodecFigures& small = figures.of(Codec::kDraco0);
  if (!small.ok()) return fast.ok() ? Codec::kDraco5 : Codec::kMcc;
  return fast.ok() && fast.bytes < small.bytes ? Codec::kDraco5 : Codec::kDraco0;
}

double threadSeconds() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace mcc::bench
