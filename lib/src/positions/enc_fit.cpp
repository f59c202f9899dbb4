// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "positions/enc_fit.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

#include "base/enc_exceptions.h"
#include "base/lanes.h"
#include "entropy/enc_coder.h"
#include "format/predictors.h"
#include "positions/enc_prices.h"
#include "positions/enc_recording.h"
#include "positions/vertex.h"

namespace mcc {
namespace {

using Kind = PositionRecording::Kind;

constexpr size_t kLargePalette = 1u << 16;  ///< from this many vertices on, a palette is large
constexpr uint32_t kRunLength = 1024;       ///< consecutive vertices in one run of a sample
constexpr uint32_t kTrialVertices = 6000;
constexpr double kManyParts = 8;          ///< samples of less than 1/8 are replayed twice
constexpr uint32_t kFitVertices = 14000;  ///< about as many are fitted to
constexpr uint32_t kFewestToFit = 32;     ///< vertices; with fewer, fitted tables cost too much
/// Up to here, the trained weights are tried as well. With more, fitted ones are better.
constexpr uint64_t kTrainedVertices = 500;

uint64_t visitCount(std::span<const PositionCandidate> pieces) {
  uint64_t count = 0;
  for (const PositionCandidate& piece : pieces) count += piece.recording->visits().size();
  return count;
}

PredictorWeights trainedWeights(const FeatureSet& without) {
  PredictorWeights weights = kUniversalWeights;
  for (auto& w : weights.w) {
    if (without.has(Feature::kBeyondWeights)) w[2] = 0;
    if (without.has(Feature::kDegreeWeights)) w[3] = w[4] = 0;
  }
  return weights;
}

// --- sampling ------------------------------------------------------------------------------------

/// The visits of one piece that a trial replays, in coding order. Entries that are not `counted`
/// are replayed only because others need their residuals; their cost is ignored.
struct Sample {
  struct Entry {
    uint32_t visit;
    bool counted;
  };
  std::vector<Entry> entries;
  uint32_t counted = 0;
  std::vector<uint32_t> looked_at;  ///< vertices whose records a replay reads; empty means all
};

Sample takeSample(const PositionRecording& recording, uint64_t counted_of_all, uint64_t all) {
  const std::vector<PositionRecording::Visit>& visits = recording.visits();
  Sample sample;
  if (counted_of_all >= all) {
    for (uint32_t i = 0; i < visits.size(); ++i) sample.entries.push_back({i, true});
    sample.counted = static_cast<uint32_t>(visits.size());
    return sample;
  }
  // Counts the middle one of every `period` runs.
  const uint64_t period = (all + counted_of_all - 1) / counted_of_all;
  const uint32_t run =
      std::clamp<uint32_t>(static_cast<uint32_t>(visits.size() / period), 1, kRunLength);
  std::vector<uint8_t> needed(visits.size(), 0);
  std::vector<uint8_t> counted(visits.size(), 0);
  for (uint32_t i = 0; i < visits.size(); ++i) {
    if ((i / run) % period != period / 2) continue;
    counted[i] = 1;
    needed[visits[i].vertex] = 1;
    recording.forNeighbours(visits[i], [&](uint32_t v) { needed[v] = 1; });
    ++sample.counted;
  }
  // Bit 1 of the same bytes says that a replay reads the record.
  std::vector<uint8_t>& looked_at = needed;
  for (uint32_t i = 0; i < visits.size(); ++i) {
    if ((needed[visits[i].vertex] & 1) == 0) continue;
    sample.entries.push_back({i, counted[i] != 0});
    recording.forAll(visits[i], [&](uint32_t v) { looked_at[v] |= 2; });
  }
  if (!looked_at.empty()) looked_at[0] |= 2;  // record 0 stands in for vertices that do not exist
  for (uint32_t v = 0; v < looked_at.size(); ++v) {
    if ((looked_at[v] & 2) != 0) sample.looked_at.push_back(v);
  }
  return sample;
}

// --- trials --------------------------------------------------------------------------------------

/// An Io that neither writes nor counts.
class SilentIo {
 public:
  static constexpr bool kEncoding = true;
  template <uint32_t kState>
  uint32_t token(TokenRow&, const TokenSchedule&, uint32_t truth) {
    return truth;
  }
  uint32_t raw(uint32_t, uint32_t truth) { return truth; }
  uint32_t magnitude(uint32_t, uint32_t, bool, uint32_t truth, uint32_t&) { return truth; }
};

/// Replays the pieces with different choices. Trials may run at the same time.
class Trials {
 public:
  Trials(std::span<const PositionCandidate> pieces, uint32_t max_vertices) : pieces_(pieces) {
    all_ = visitCount(pieces);
    for (const PositionCandidate& piece : pieces) {
      samples_.push_back(takeSample(*piece.recording, max_vertices, all_));
      counted_ += samples_.back().counted;
    }
    palette_bits_ = paletteBits();
  }

  /// Returns the expected cost of all positions and their tables, in bits.
  double cost(const PositionParameters& p) {
    CostIo io;
    const double parts =
        counted_ == 0 ? 1 : static_cast<double>(all_) / static_cast<double>(counted_);
    // The models learn only once, so the parts that are not in the sample are charged the cost of
    // the second pass.
    const uint32_t passes = parts > kManyParts ? 2 : 1;
    uint64_t spent = 0;
    uint64_t last_pass = 0;
    replayAll(
        io, p, passes, [](uint32_t, const Prediction&, const VertexRecord&) {},
        [&] {
          last_pass = io.cost() - spent;
          spent = io.cost();
        });
    return (static_cast<double>(spent - last_pass) +
            static_cast<double>(last_pass) * (passes == 1 ? parts : parts - 1)) /
               kCostOne +
           tableBits(p) + (p.has(position_mode::kPalette) ? palette_bits_ : 0) +
           (p.has(position_mode::kPlanes) ? planeBits() : 0);
  }

  /// Calls use(plain, prediction, record) after every counted vertex, except seeds.
  template <class Use>
  void observe(const PositionParameters& p, Use use) {
    SilentIo io;
    replayAll(io, p, 1, use, [] {});
  }

 private:
  /// The memory that a replay writes to.
  struct Scratch {
    std::unique_ptr<PositionRows> rows{new PositionRows};  // not zeroed: it is large
    /// By piece; only the records that are looked at are set.
    std::vector<Array<VertexRecord>> records;
  };

  /// Returns a scratch that no other trial uses.
  std::unique_ptr<Scratch> takeScratch() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<Scratch> scratch = std::move(free_.back());
        free_.pop_back();
        return scratch;
      }
    }
    auto scratch = std::make_unique<Scratch>();
    for (size_t i = 0; i < pieces_.size(); ++i) {
      const VertexRecord* from = pieces_[i].recording->records();
      const size_t count = pieces_[i].recording->visits().size();
      Array<VertexRecord>& records = scratch->records.emplace_back(Allocator{});
      if (!records.resize(count)) throwBadAlloc();
      if (samples_[i].looked_at.empty()) std::copy(from, from + count, records.data());
      for (const uint32_t v : samples_[i].looked_at) records[v] = from[v];
    }
    return scratch;
  }

  /// Calls end_pass() after each pass over the sample; the models stay.
  template <class Io, class Use, class EndPass>
  void replayAll(Io& io, const PositionParameters& p, uint32_t passes, Use use, EndPass end_pass) {
    std::unique_ptr<Scratch> scratch = takeScratch();
    // Only what prepare() looks at is reset. To clear all rows would take longer than a small
    // trial.
    PositionRows* rows = ::new (static_cast<void*>(scratch->rows.get())) PositionRows;
    rows->prepare(p.modes);
    for (uint32_t pass = 0; pass < passes; ++pass) {
      for (size_t i = 0; i < pieces_.size(); ++i) replayPiece(io, p, i, *scratch, use);
      end_pass();
    }
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(scratch));
  }

  template <class Io, class Use>
  void replayPiece(Io& io, const PositionParameters& p, size_t piece, Scratch& scratch, Use use) {
    PositionParameters of_piece = p;
    of_piece.bits = pieces_[piece].bits;
    std::copy(pieces_[piece].palettes, pieces_[piece].palettes + 3, of_piece.palette);
    const GridPlanes planes = planesOf(pieces_[piece]);
    of_piece.planes = &planes;
    replay(io, of_piece, piece, scratch, use);
  }

  static double tableBits(const PositionParameters& p) {
    CostIo io;
    PositionTables tables;
    PositionParameters copy = p;
    (void)codePositionTables(io, tables, copy);  // fitted tables are in range
    return static_cast<double>(io.cost()) / kCostOne;
  }

  double paletteBits() const {
    CostIo io;
    PaletteModels models;
    for (const PositionCandidate& piece : pieces_) {
      (void)PositionPalettes(Allocator{}).code(io, models, piece.palettes, ~0u, Mirrors{});
    }
    return static_cast<double>(io.cost()) / kCostOne;
  }

  double planeBits() const { return static_cast<double>(pieces_.size()) * 6 * AxisPlanes::kBits; }

  static GridPlanes planesOf(const PositionCandidate& piece) {
    const AxisPlanes none[3];
    return GridPlanes(piece.planes != nullptr ? piece.planes : none);
  }

  template <class Io, class Use>
  void replay(Io& io, const PositionParameters& p, size_t piece, Scratch& scratch, Use use) const {
    const PositionRecording& recording = *pieces_[piece].recording;
    VertexRecord* records = scratch.records[piece].data();
    PositionRows& rows = *scratch.rows;
    SilentIo silent;
    VertexCoder<Io, kAnyModes> coder(rows, p, records, pieces_[piece].truth);
    VertexCoder<SilentIo, kAnyModes> silent_coder(rows, p, records, pieces_[piece].truth);
    for (const Sample::Entry& entry : samples_[piece].entries) {
      const PositionRecording::Visit& visit = recording.visits()[entry.visit];
      const uint32_t v = visit.vertex;
      if (visit.kind == static_cast<uint32_t>(Kind::kSeed)) {
        coder.codeSeed(io, v, recording.seedNeighbour(records, visit));
        continue;
      }
      const bool plain = visit.kind == static_cast<uint32_t>(Kind::kPlain);
      const auto code = [&](const auto& with, auto& into, Prediction& prediction) {
        if (plain) {
          PlainFan fan;
          Beyond beyond;
          recording.plain(records, visit, fan, beyond);
          with.codePlain(into, v, fan, &beyond, prediction);
        } else {
          AnyFan fan;
          recording.any(records, visit, fan);
          with.codeAny(into, v, fan, prediction);
        }
      };
      Prediction prediction;
      if (!entry.counted) {
        code(silent_coder, silent, prediction);
        continue;
      }
      code(coder, io, prediction);
      use(plain ? 1u : 0u, prediction, records[v]);
    }
  }

  std::span<const PositionCandidate> pieces_;
  std::vector<Sample> samples_;
  std::mutex mutex_;  ///< guards free_
  std::vector<std::unique_ptr<Scratch>> free_;
  uint64_t all_ = 0;
  uint64_t counted_ = 0;
  double palette_bits_ = 0;
};

// --- least squares -------------------------------------------------------------------------------

/// Normal equations of up to 8 unknowns. They use only + - * / in one fixed order, so that every
/// machine finds the same solution.
struct NormalEquations {
  double matrix[kMostWeights][kMostWeights] = {};
  double right[kMostWeights] = {};

  void add(const double* x, double y, double weight, uint32_t n) {
    for (uint32_t i = 0; i < n; ++i) {
      const double scaled = weight * x[i];
      for (uint32_t k = 0; k <= i; ++k) matrix[i][k] += scaled * x[k];
      right[i] += scaled * y;
    }
  }

  /// Makes the solution for an unknown 0.
  void leaveOut(uint32_t unknown) {
    for (uint32_t k = 0; k < kMostWeights; ++k) matrix[unknown][k] = matrix[k][unknown] = 0;
    right[unknown] = 0;
  }

  /// Solves the symmetric system by Gaussian elimination. Unknowns that nothing depends on become
  /// 0.
  void solve(uint32_t n, double ridge, double* solution) const {
    double a[kMostWeights][kMostWeights + 1];
    for (uint32_t i = 0; i < n; ++i) {
      for (uint32_t k = 0; k < n; ++k) a[i][k] = i >= k ? matrix[i][k] : matrix[k][i];
      a[i][n] = right[i];
      a[i][i] += ridge * a[i][i];
    }
    for (uint32_t i = 0; i < n; ++i) {
      if (!(a[i][i] > 1e-9)) {
        for (uint32_t k = 0; k <= n; ++k) a[i][k] = 0;
        a[i][i] = 1;
      }
      for (uint32_t row = i + 1; row < n; ++row) {
        const double factor = a[row][i] / a[i][i];
        for (uint32_t k = i; k <= n; ++k) a[row][k] -= factor * a[i][k];
      }
    }
    for (uint32_t i = n; i-- != 0;) {
      double sum = a[i][n];
      for (uint32_t k = i + 1; k < n; ++k) sum -= a[i][k] * solution[k];
      solution[i] = sum / a[i][i];
    }
  }
};

/// One number for each weight, and zeros that fill the lanes.
struct Features {
  static constexpr uint32_t kParts = (kMostWeights + 3) / 4;
  Lanes<float> part[kParts] = {};

  static Features load(const float* from) {
    Features f;
    for (uint32_t i = 0; i < kParts; ++i) f.part[i] = loadLanes<float>(from + 4 * i);
    return f;
  }
  float times(const Features& o) const {
    Lanes<float> sum = part[0] * o.part[0];
    for (uint32_t i = 1; i < kParts; ++i) sum += part[i] * o.part[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
};

/// One vertex of a fit. The target is in lattice steps, with the prediction of the average
/// subtracted; the features are scaled such that weights of 1 (128 in the format) add up to it.
struct FitRow {
  uint32_t predictor_class[2];  ///< [with tip selection]
  float length;
  float target[3];
  float feature[3][4 * Features::kParts];
};

/// Adds the three components of a vertex to normal equations, for a few vertices at once in
/// float32.
class FitSums {
 public:
  static constexpr uint32_t kMostRows = 64;

  void add(const Features (&f)[3], const float (&residual)[3], float weight, uint32_t n) {
    for (uint32_t s = 0; s < 3; ++s) {
      Features weighted;
      for (uint32_t h = 0; h < Features::kParts; ++h) {
        weighted.part[h] = f[s].part[h] * weight;
        right_.part[h] += weighted.part[h] * residual[s];
      }
      for (uint32_t i = 0; i < n; ++i) {
        const float x = f[s].part[i / 4][i % 4];
        for (uint32_t h = 0; h <= i / 4; ++h) matrix_[i].part[h] += weighted.part[h] * x;
      }
    }
  }
  void addTo(NormalEquations& equations, uint32_t n) {
    for (uint32_t i = 0; i < n; ++i) {
      equations.right[i] += double{right_.part[i / 4][i % 4]};
      for (uint32_t k = 0; k <= i; ++k)
        equations.matrix[i][k] += double{matrix_[i].part[k / 4][k % 4]};
    }
    *this = FitSums();
  }

 private:
  Features matrix_[kMostWeights];
  Features right_;
};

void gatherRows(const PositionCandidate& piece, uint32_t stride, std::vector<FitRow>& rows) {
  const PositionRecording& recording = *piece.recording;
  // Steps of random length, `stride` on average, because steps of equal length would see only some
  // columns of a grid.
  uint32_t random = 1;
  const auto step = [&] {
    random = random * 1664525 + 1013904223;
    return 1 + (random >> 8) % (2 * stride - 1);
  };
  for (size_t i = step() - 1; i < recording.visits().size(); i += step()) {
    const PositionRecording::Visit& visit = recording.visits()[i];
    const uint32_t v = visit.vertex;
    FitRow row{};
    FinePoint at;  ///< the average of the tips
    if (visit.kind == static_cast<uint32_t>(Kind::kPlain)) {
      PlainFan fan;
      Beyond beyond;
      recording.plain(recording.records(), visit, fan, beyond);
      const uint32_t degree = recording.records()[v].degree();
      const PlainClass c = classifyPlain(true, fan, beyond, degree);
      row.predictor_class[0] = classifyPlain(false, fan, beyond, degree).predictor_class;
      row.predictor_class[1] = c.predictor_class;
      const PlainFeatures f = plainFeatures(fan, beyond, true);
      const float skew = static_cast<float>(c.degree_skew);
      const float better = static_cast<float>(c.better);
      at = middleOfTips(fan);
      for (int s = 0; s < 3; ++s) {
        const float features[kMostWeights] = {f.f0[s],
                                              f.f1[s],
                                              f.fy[s],
                                              f.fd[s] * skew,
                                              f.f0[s] * static_cast<float>(c.degree_sum),
                                              f.tips[s] * better,
                                              f.x[s] * better,
                                              f.y[s] * better};
        for (uint32_t k = 0; k < kMostWeights; ++k) row.feature[s][k] = 0.5f * features[k];
        row.length += std::fabs(f.f1[s]);
      }
    } else if (visit.kind == static_cast<uint32_t>(Kind::kAny)) {
      AnyFan fan;
      recording.any(recording.records(), visit, fan);
      Lanes<float> spread{};
      Lanes<float> normal{};
      const AnyFeatures f = anyFeatures(fan, spread, normal);
      row.predictor_class[0] = row.predictor_class[1] = f.predictor_class;
      at = {f.from, fractionOf(256 * f.tips)};
      for (int s = 0; s < 3; ++s) {
        row.feature[s][0] = f.mean[s];
        row.length += std::fabs(2 * f.mean[s]);
      }
    } else {
      continue;
    }
    const Lanes<float> rest = at.rest();
    for (int s = 0; s < 3; ++s) {
      const uint32_t truth =
          static_cast<uint32_t>(piece.truth[3 * size_t{v} + static_cast<size_t>(s)]);
      row.target[s] = static_cast<float>(static_cast<int32_t>(truth - at.step[s])) - rest[s];
    }
    rows.push_back(row);
  }
}

/// Returns approximately log2(x) for x >= 1, from the bits of the float: the same on every machine.
double roughLog2(float x) {
  return static_cast<double>(std::bit_cast<uint32_t>(x)) * (1.0 / (1 << 23)) - 127;
}

/// The rows of one class.
using ClassRows = std::vector<const FitRow*>;

/// Estimates how many bits the residuals of a class take with these weights.
double residualBits(const ClassRows& rows, const int16_t* w, uint32_t n) {
  constexpr float kFarthest = 1 << 30;
  float weight[4 * Features::kParts] = {};
  for (uint32_t i = 0; i < n; ++i) weight[i] = w[i] * (1.0f / 128);
  const Features weights = Features::load(weight);
  double bits = 0;
  for (const FitRow* row : rows) {
    for (uint32_t s = 0; s < 3; ++s) {
      const float predicted = Features::load(row->feature[s]).times(weights);
      const float residual = std::min(std::fabs(row->target[s] - predicted) + 0.5f, kFarthest);
      bits += roughLog2(static_cast<float>(1 + 2 * int64_t{static_cast<int32_t>(residual)}));
    }
  }
  return bits;
}

/// Adds the rows, weighted by their residuals with the weights `solution`. The unknowns are changes
/// of the weights `start`.
NormalEquations weighRows(const ClassRows& rows, const Features& solution, const Features& start,
                          uint32_t n, bool robust) {
  NormalEquations equations;
  FitSums sums;
  uint32_t in_sums = 0;
  for (const FitRow* row : rows) {
    const Features f[3] = {Features::load(row->feature[0]), Features::load(row->feature[1]),
                           Features::load(row->feature[2])};
    float residual[3];
    float size = 0;
    for (uint32_t s = 0; s < 3; ++s) {
      size += std::fabs(row->target[s] - solution.times(f[s]));
      residual[s] = row->target[s] - start.times(f[s]);
    }
    const float near = size + 0.02f * row->length + (robust ? 1.0f : 0.5f);
    sums.add(f, residual, robust ? 1 / (near * near) : 1 / ((row->length + 1) * near), n);
    if (++in_sums % FitSums::kMostRows == 0) sums.addTo(equations, n);
  }
  sums.addTo(equations, n);
  return equations;
}

/// How classes are fitted.
struct FitChoice {
  bool select;  ///< with the classes of tip selection
  bool robust;  ///< weighs residuals by 1 / size^2 instead of by 1 / size
};

/// Fits one class by re-weighted least squares, starting from the weights `w`. Returns false if
/// there are too few vertices.
bool fitClass(const ClassRows& rows, uint32_t n, const FitChoice& choice, int16_t* w) {
  constexpr uint32_t kRounds = 4;
  constexpr float kOne = 128;
  if (rows.size() < 2 * n) return false;
  float solution[4 * Features::kParts] = {};
  for (uint32_t i = 0; i < n; ++i) solution[i] = w[i] / kOne;
  const Features start = Features::load(solution);
  for (uint32_t round = 0; round < kRounds; ++round) {
    const NormalEquations equations =
        weighRows(rows, Features::load(solution), start, n, choice.robust);
    double change[kMostWeights] = {};
    equations.solve(n, 1e-3 + 3.0 / static_cast<double>(rows.size()), change);
    for (uint32_t i = 0; i < n; ++i) solution[i] = static_cast<float>(w[i] / kOne + change[i]);
  }
  for (uint32_t i = 0; i < n; ++i) {
    w[i] = static_cast<int16_t>(std::clamp(std::floor(solution[i] * kOne + 0.5f), -255.0f, 255.0f));
  }
  return true;
}

/// Keeps the best of no weights, the trained weights `w` and fitted weights. Each row stands for
/// `stride` vertices.
void chooseWeights(const ClassRows& rows, uint32_t predictor_class, double stride,
                   const FitChoice& choice, int16_t* w) {
  constexpr double kBitsOfWeight = 9;
  const uint32_t n = weightCount(predictor_class);
  int16_t fitted[kMostWeights];
  std::copy_n(w, kMostWeights, fitted);
  double best = residualBits(rows, w, n) * stride + 1.5 * n;
  if (fitClass(rows, n, choice, fitted)) {
    const double bits = residualBits(rows, fitted, n) * stride + kBitsOfWeight * n;
    if (bits < best) {
      best = bits;
      std::copy_n(fitted, kMostWeights, w);
    }
  }
  constexpr int16_t kNone[kMostWeights] = {};
  if (residualBits(rows, kNone, n) * stride <= best) std::copy_n(kNone, kMostWeights, w);
}

/// A sample of the vertices of all pieces.
struct FitRows {
  std::vector<FitRow> rows;
  uint32_t stride;  ///< each stands for so many vertices
};

FitRows gatherFitRows(std::span<const PositionCandidate> pieces, uint32_t max_vertices,
                      const FeatureSet& without) {
  FitRows fit;
  fit.stride = static_cast<uint32_t>(visitCount(pieces) / max_vertices + 1);
  for (const PositionCandidate& piece : pieces) gatherRows(piece, fit.stride, fit.rows);
  for (FitRow& row : fit.rows) {
    for (auto& feature : row.feature) {
      if (without.has(Feature::kBeyondWeights)) feature[2] = 0;
      if (without.has(Feature::kDegreeWeights)) feature[3] = feature[4] = 0;
    }
  }
  return fit;
}

/// Fits the classes of plain fans, or those of other fans.
void fitToRows(const FitRows& fit, bool plain, const FitChoice& choice, PredictorWeights& weights) {
  ClassRows rows_of[kPredictorClasses];
  for (const FitRow& row : fit.rows) {
    rows_of[row.predictor_class[choice.select ? 1 : 0]].push_back(&row);
  }
  for (uint32_t c = plain ? kClassPlain : 0; c < (plain ? kPredictorClasses : kClassPlain); ++c) {
    chooseWeights(rows_of[c], c, fit.stride, choice, weights.w[c]);
  }
}

/// The terms that the scale of a component is computed from, and the size of its residual.
struct ScaleRow {
  float neighbours;
  float spread;
  float third;
  float size;
};

/// Fits |residual| by weighted least squares with non-negative coefficients.
void fitCoefficients(const std::vector<ScaleRow>& rows, uint16_t* coefficients) {
  if (rows.size() < 200) return;
  constexpr uint32_t kCount = 4;
  double c[kCount];
  for (uint32_t i = 0; i < kCount; ++i) c[i] = coefficients[i] / 64.0;
  for (uint32_t round = 0; round < 4; ++round) {
    NormalEquations equations;
    for (const ScaleRow& row : rows) {
      const double x[kCount] = {double{row.neighbours}, double{row.spread}, 1, double{row.third}};
      const double estimate = c[0] * x[0] + c[1] * x[1] + c[2] + c[3] * x[3];
      const double target = std::min(16 * double{row.size}, 6 * estimate + 16);
      equations.add(x, target, 1 / ((estimate + 8) * (estimate + 8)), kCount);
    }
    // A term whose coefficient would be negative is left out.
    bool used[kCount] = {true, true, true, true};
    for (uint32_t attempt = 0; attempt < kCount; ++attempt) {
      NormalEquations reduced = equations;
      for (uint32_t i = 0; i < kCount; ++i) {
        if (!used[i]) reduced.leaveOut(i);
      }
      reduced.solve(kCount, 1e-6, c);
      bool negative = false;
      for (uint32_t i = 0; i < kCount; ++i) {
        if (c[i] >= 0) continue;
        used[i] = false;
        c[i] = 0;
        negative = true;
      }
      if (!negative) break;
    }
  }
  for (uint32_t i = 0; i < kCount; ++i) {
    coefficients[i] = static_cast<uint16_t>(
        std::clamp(std::floor(c[i] * 64 + 0.5), 0.0, static_cast<double>(kMaxCoefficient)));
  }
}

/// Fits the scale coefficients of plain and of other fans, per component.
void fitScale(Trials& trials, const Jobs& jobs, PositionParameters& p) {
  std::vector<ScaleRow> rows[2][3];
  trials.observe(p, [&](uint32_t plain, const Prediction& prediction, const VertexRecord& r) {
    const uint8_t* axis =
        p.has(position_mode::kShear) ? makeShear(prediction.normal).axis : kFileOrder;
    for (uint32_t s = 0; s < 3; ++s) {
      rows[plain][s].push_back({prediction.magnitudes[s], prediction.spread[axis[s]],
                                prediction.third[axis[s]], static_cast<float>(r.magnitude[s])});
    }
  });
  jobs.run(6, [&](size_t i) { fitCoefficients(rows[i / 3][i % 3], p.scale[i / 3][i % 3].c); });
  p.modes |= position_mode::kOwnScale;
}

// --- choice --------------------------------------------------------------------------------------

class Chooser {
 public:
  Chooser(std::span<const PositionCandidate> pieces, double surface_bits,
          const PositionSettings& settings, const Jobs& jobs)
      : pieces_(pieces),
        jobs_(jobs),
        surface_bits_(surface_bits),
        price_(settings.prefer),
        without_(settings.without),
        palette_values_(paletteValues(pieces)),
        vertices_(visitCount(pieces)),
        trials_(pieces, kTrialVertices) {}

  PositionParameters run() {
    findClearKind();
    tryPredictors();
    if (clear_kind_ == 0) tryKinds();
    // What is tried next decides between those that are about equal.
    std::stable_sort(candidates_.begin(), candidates_.end());
    if (candidates_.size() > kMostTied) candidates_.resize(kMostTied);
    while (candidates_.back().cost > kTie * candidates_[0].cost) candidates_.pop_back();
    jobs_.run(candidates_.size(), [&](size_t i) { improve(candidates_[i]); });
    return std::min_element(candidates_.begin(), candidates_.end())->parameters;
  }

 private:
  struct Candidate {
    PositionParameters parameters;
    double cost;
    bool operator<(const Candidate& o) const { return cost < o.cost; }
  };

  /// Tries the plain average, without and with a palette or planes. If one of these is far better,
  /// nothing is tried without it.
  void findClearKind() {
    std::vector<PositionParameters> all(1);
    const auto add = [&](bool may, uint8_t kind, Feature feature) {
      if (may && !without_.has(feature)) all.push_back(withMode({}, kind));
    };
    add(palette_values_ > 0, position_mode::kPalette, Feature::kPalette);
    add(anyPlanes(), position_mode::kPlanes, Feature::kPlanes);
    candidates_ = tryAll(std::move(all));
    const double clear = kClear * candidates_[0].cost;
    const Candidate best = *std::min_element(candidates_.begin(), candidates_.end());
    if (best.cost < clear) {
      clear_kind_ = best.parameters.modes;
      candidates_ = {best};
    } else {
      average_with_kind_.assign(candidates_.begin() + 1, candidates_.end());
      candidates_.resize(1);
    }
  }

  /// Tries weights, fitted without and with tip selection, and the trained weights where trials are
  /// cheap.
  void tryPredictors() {
    using namespace position_mode;
    if (without_.has(Feature::kWeights)) return;
    std::vector<PositionParameters> all;
    if (vertices_ >= kFewestToFit) {
      all.push_back(withMode({}, kWeights));
      if (!without_.has(Feature::kTipSelection)) all.push_back(withMode({}, kWeights | kSelect));
      fitAll(all);
    }
    if (vertices_ <= kTrainedVertices) {
      all.push_back(withMode({}, kWeights));
      all.back().weights = trainedWeights(without_);
    }
    for (PositionParameters& p : all) p.modes |= clear_kind_;
    const std::vector<Candidate> tried = tryAll(std::move(all));
    candidates_.insert(candidates_.end(), tried.begin(), tried.end());
    std::stable_sort(candidates_.begin(), candidates_.end());
    while (candidates_.back().cost > kOutOfRace * candidates_[0].cost) candidates_.pop_back();
  }

  /// Fits the weights without and with tip selection, which have the classes of other fans in
  /// common.
  void fitAll(std::vector<PositionParameters>& all) const {
    const FitRows rows = gatherFitRows(pieces_, kFitVertices, without_);
    PredictorWeights weights = trainedWeights(without_);
    fitToRows(rows, false, {false, true}, weights);
    jobs_.run(all.size(), [&](size_t i) {
      all[i].weights = weights;
      fitToRows(rows, true, {all[i].has(position_mode::kSelect), true}, all[i].weights);
    });
  }

  /// Tries palette, planes and shear, which exclude each other: first with the best predictor, and
  /// then with the others if that was promising, since the best predictor differs between them.
  void tryKinds() {
    const std::vector<Candidate> plain = candidates_;
    const auto tryKind = [&](uint8_t kind, Feature feature, double promising) {
      if (without_.has(feature)) return;
      std::vector<PositionParameters> with;
      for (const Candidate& candidate : plain) with.push_back(withMode(candidate.parameters, kind));
      const Candidate first = tryOnce(with[0]);
      if (first.cost >= promising * plain[0].cost) return;
      candidates_.push_back(first);
      with.erase(with.begin());
      const std::vector<Candidate> tried = tryAll(std::move(with));
      candidates_.insert(candidates_.end(), tried.begin(), tried.end());
    };
    if (palette_values_ > 0) tryKind(position_mode::kPalette, Feature::kPalette, kPromising);
    if (anyPlanes()) tryKind(position_mode::kPlanes, Feature::kPlanes, kPromising);
    // Whether shear pays depends on the surface, not on the predictor.
    tryKind(position_mode::kShear, Feature::kShear, 1);
  }

  /// Tries one, unless findClearKind() has.
  Candidate tryOnce(const PositionParameters& p) {
    for (const Candidate& known : average_with_kind_) {
      if (known.parameters.modes == p.modes) return known;
    }
    return tryAll({p})[0];
  }
  std::vector<Candidate> tryAll(std::vector<PositionParameters> all) {
    std::vector<Candidate> tried(all.size());
    jobs_.run(all.size(), [&](size_t i) {
      setUniversalScale(all[i]);
      tried[i] = {all[i], costOf(all[i])};
    });
    return tried;
  }

  /// Tries the modes that can be combined with others, and keeps what pays.
  void improve(Candidate& best) {
    const auto tryMode = [&](uint8_t mode, Feature feature) {
      const PositionParameters p = withMode(best.parameters, mode);
      if (!without_.has(feature) && position_mode::goTogether(p.modes)) offer(p, best);
    };
    tryMode(position_mode::kSplit, Feature::kSplit);
    tryOwnScale(best);
    tryMode(position_mode::kFold, Feature::kFold);
  }

  void tryOwnScale(Candidate& best) {
    PositionParameters p = best.parameters;
    if (without_.has(Feature::kOwnScale) || p.has(position_mode::kPlanes)) return;
    if (vertices_ < kFewestToFit) return;
    fitScale(trials_, jobs_, p);
    offer(p, best);
  }

  void offer(const PositionParameters& p, Candidate& best) {
    best = std::min(best, {p, costOf(p)});
  }

  static PositionParameters withMode(PositionParameters p, uint8_t mode) {
    p.modes |= mode;
    return p;
  }

  /// Returns the number of values in all palettes, per vertex.
  static double paletteValues(std::span<const PositionCandidate> pieces) {
    uint64_t values = 0;
    for (const PositionCandidate& piece : pieces) {
      for (const AxisPalette& palette : piece.palettes) values += palette.count;
    }
    return static_cast<double>(values) /
           static_cast<double>(std::max<uint64_t>(visitCount(pieces), 1));
  }

  /// Pieces share the choice, so all of them must have planes.
  bool anyPlanes() const {
    return std::all_of(pieces_.begin(), pieces_.end(),
                       [](const PositionCandidate& piece) { return piece.planes != nullptr; });
  }

  /// Returns the bits of connectivity and positions, plus a surcharge for what takes time to
  /// decode.
  double costOf(const PositionParameters& p) {
    const double bits = surface_bits_ + trials_.cost(p);
    return bits + price_.surcharge(bits, timeOf(p, palette_values_));
  }

  static constexpr double kClear = 0.9;
  static constexpr double kOutOfRace = 1.25;
  static constexpr double kPromising = 1.1;
  static constexpr double kTie = 1.01;
  static constexpr size_t kMostTied = 2;

  std::span<const PositionCandidate> pieces_;
  const Jobs& jobs_;
  const double surface_bits_;
  const TimePrice price_;
  const FeatureSet without_;
  const double palette_values_;
  const uint64_t vertices_;
  Trials trials_;
  uint8_t clear_kind_ = 0;
  std::vector<Candidate> average_with_kind_;
  std::vector<Candidate> candidates_;
};

}  // namespace

PredictorWeights fitWeights(std::span<const PositionCandidate> pieces, bool select, bool robust,
                            uint32_t max_vertices, const FeatureSet& without) {
  const FitRows rows = gatherFitRows(pieces, max_vertices, without);
  PredictorWeights weights = trainedWeights(without);
  for (const bool plain : {false, true}) fitToRows(rows, plain, {select, robust}, weights);
  return weights;
}

namespace {

/// Sorts and removes duplicates; uses a bitmap where the values lie as close together as those of a
/// lattice.
void sortDistinct(std::vector<int32_t>& values) {
  if (values.empty()) return;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  const int64_t first = *lowest;
  const uint64_t range = static_cast<uint64_t>(*highest - first) + 1;
  if (range > 8 * uint64_t{values.size()}) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return;
  }
  std::vector<uint8_t> marks(range, 0);
  for (const int32_t value : values) marks[static_cast<size_t>(value - first)] = 1;
  values.clear();
  for (size_t i = 0; i < range; ++i) {
    if (marks[i] != 0) values.push_back(static_cast<int32_t>(first + static_cast<int64_t>(i)));
  }
}

}  // namespace

void DistinctCoordinates::find(std::span<const int32_t> truth, bool is_exact) {
  const size_t vertices = truth.size() / 3;
  for (uint32_t s = 0; s < 3; ++s) {
    std::vector<int32_t>& values = axis[s];
    values.clear();
    for (size_t i = 0; i < vertices; ++i) values.push_back(truth[3 * i + s]);
    sortDistinct(values);
    // Searching a large palette misses the cache at every step, so it must save more.
    const size_t limit = is_exact && vertices < kLargePalette ? 3 * vertices / 4 : vertices / 2;
    if (values.size() > std::min<size_t>(limit, kMaxPalette)) values.clear();
    // A palette cannot begin with INT32_MIN (a NaN that keeps its bits), because signedGolomb()
    // cannot code it. [A.3.5]
    if (!values.empty() && values[0] == std::numeric_limits<int32_t>::min()) values.clear();
    if (values.empty()) continue;
    const PaletteCells index(values.data(), static_cast<uint32_t>(values.size()));
    shift[s] = index.shift;
    cells[s].resize(index.cell_count);
    index.fill(cells[s].data());
  }
}

PositionParameters choosePositionParameters(std::span<const PositionCandidate> pieces,
                                            double surface_bits, const PositionSettings& settings,
                                            const Jobs& jobs) {
  return Chooser(pieces, surface_bits, settings, jobs).run();
}

}  // namespace mcc
