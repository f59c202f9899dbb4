// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Cuts a piece into blocks, codes each as a piece of its own with the choices made for one of them,
// and finds which wedges they share.
#include "writer/blocks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "container/enc_payload.h"
#include "prepare/enc_blocks.h"
#include "writer/choices.h"
#include "writer/code_piece.h"

namespace mcc {
namespace {

/// Blocks that nobody asked for must not repeat more of the wedges than one in this many.
constexpr uint64_t kWedgesPerRepeated = 16;
/// With more exceptions than one for so many wedges, a payload has no blocks.
constexpr uint64_t kWedgesPerException = 64;
constexpr uint64_t kFreeExceptions = 1000;
/// So many blocks are taken out of the piece while choices are made for another.
constexpr uint32_t kEarlyBlocks = 2;

/// Returns why a piece has no blocks, or null.
const char* whyWhole(const Plan& whole, const EncodeSettings& options) {
  if (options.keep_vertex_order || options.keep_triangle_order) return "an order is kept";
  if (whole.attributes.empty()) return "the payload has no attributes";
  return nullptr;
}

/// Sums of the corners' positions, for each proper triangle. Positions that are not finite count as
/// 0.
std::vector<float> centroidSums(const Plan& whole) {
  const QuantizedAttribute& position = whole.attributes[0];
  const auto coordinate = [&](size_t wedge, size_t s) {
    const int32_t q = position.values[3 * wedge + s];
    if (!isExact(position.info.coding)) return static_cast<float>(q);
    const float value = std::bit_cast<float>(bitsFromOrdered(q));
    return std::fabs(value) < 1e37f ? value : 0.0f;
  };
  std::vector<float> sums(whole.triangles.wedges.size());
  for (size_t t = 0; t < sums.size(); t += 3) {
    for (size_t s = 0; s < 3; ++s) {
      sums[t + s] = coordinate(whole.triangles.wedges[t], s) +
                    coordinate(whole.triangles.wedges[t + 1], s) +
                    coordinate(whole.triangles.wedges[t + 2], s);
    }
  }
  return sums;
}

/// Numbers values in the order in which they are first met.
class Renumbering {
 public:
  explicit Renumbering(size_t expected) : slots_(std::bit_ceil(2 * expected + 2), kNone) {}

  uint32_t operator()(uint32_t value) {
    size_t slot = (value * 0x9e3779b97f4a7c15ull) >> 32 & (slots_.size() - 1);
    for (;; slot = (slot + 1) & (slots_.size() - 1)) {
      if (slots_[slot] == kNone) {
        slots_[slot] = static_cast<uint32_t>(values_.size());
        values_.push_back(value);
        if (2 * values_.size() > slots_.size()) grow();
        return static_cast<uint32_t>(values_.size()) - 1;
      }
      if (values_[slots_[slot]] == value) return slots_[slot];
    }
  }
  std::vector<uint32_t>& values() { return values_; }

 private:
  void grow() {
    Renumbering larger(slots_.size());
    for (const uint32_t value : values_) larger(value);
    *this = std::move(larger);
  }

  std::vector<uint32_t> slots_;
  std::vector<uint32_t> values_;
};

/// Triangles apart from the surface, by block.
struct Leftovers {
  std::vector<uint32_t> duplicates;             ///< proper triangles of the whole piece
  std::vector<SortedTriangles::Listed> listed;  ///< with wedges of the whole piece
};

/// Gives each of the triangles that have a wedge twice to a block that has both wedges. Returns
/// false if one has none.
bool placeListed(const Plan& whole, const BlockCut& cut, std::vector<Leftovers>& leftovers) {
  const std::vector<SortedTriangles::Listed>& listed = whole.triangles.listed;
  if (listed.empty()) return true;
  std::vector<uint8_t> is_listed(whole.header.wedge_count, 0);
  for (const SortedTriangles::Listed& t : listed) {
    for (const uint32_t w : t.wedge) is_listed[w] = 1;
  }
  std::vector<std::pair<uint32_t, uint32_t>> blocks_of;  // wedge, block
  for (const uint32_t w : whole.triangles.isolated) {
    if (is_listed[w] != 0) blocks_of.emplace_back(w, 0);
  }
  for (uint32_t b = 0; b < cut.blockCount(); ++b) {
    for (const uint32_t t : cut.trianglesOf(b)) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t w = whole.triangles.wedges[3 * size_t{t} + k];
        if (is_listed[w] != 0) blocks_of.emplace_back(w, b);
      }
    }
  }
  std::sort(blocks_of.begin(), blocks_of.end());
  for (const SortedTriangles::Listed& t : listed) {
    const auto hasAll = [&](uint32_t block) {
      return std::all_of(std::begin(t.wedge), std::end(t.wedge), [&](uint32_t w) {
        return std::binary_search(blocks_of.begin(), blocks_of.end(), std::pair(w, block));
      });
    };
    auto it = std::lower_bound(blocks_of.begin(), blocks_of.end(), std::pair(t.wedge[0], 0u));
    while (it != blocks_of.end() && it->first == t.wedge[0] && !hasAll(it->second)) ++it;
    if (it == blocks_of.end() || it->first != t.wedge[0]) return false;
    leftovers[it->second].listed.push_back(t);
  }
  return true;
}

/// A block before it is coded.
struct LocalBlock {
  Plan plan;
  std::vector<uint32_t> source_wedge;  ///< in the whole piece, by wedge of the plan
};

/// Takes the triangles of a block, with the wedges and classes that they use, out of a piece.
LocalBlock takeBlock(const Plan& whole, std::span<const uint32_t> triangles,
                     const Leftovers& leftovers, bool is_first, const EncodeOptions& options) {
  LocalBlock block;
  Plan& plan = block.plan;
  Renumbering wedges(triangles.size());
  const bool has_parts = whole.parts.size() > 1;
  plan.triangles.wedges.reserve(3 * triangles.size());
  plan.triangles.part.reserve(triangles.size());
  plan.parts.resize(whole.parts.size());
  const auto count = [&](uint32_t part) { ++plan.parts[part].triangle_count; };
  for (const uint32_t t : triangles) {
    for (size_t k = 0; k < 3; ++k)
      plan.triangles.wedges.push_back(wedges(whole.triangles.wedges[3 * size_t{t} + k]));
    plan.triangles.part.push_back(has_parts ? whole.triangles.part[t] : 0);
    count(plan.triangles.part.back());
  }
  for (const uint32_t t : leftovers.duplicates) {
    const auto at = std::lower_bound(triangles.begin(), triangles.end(), t);
    plan.triangles.duplicates.push_back(static_cast<uint32_t>(at - triangles.begin()));
    count(whole.triangles.part[t]);
  }
  for (uint32_t i = 0; is_first && i < whole.triangles.isolated.size(); ++i)
    plan.triangles.isolated.push_back(wedges(whole.triangles.isolated[i]));
  for (const SortedTriangles::Listed& t : leftovers.listed) {
    plan.triangles.listed.push_back(
        {{wedges(t.wedge[0]), wedges(t.wedge[1]), wedges(t.wedge[2])}, t.part});
    count(t.part);
  }
  block.source_wedge = std::move(wedges.values());
  Renumbering classes(block.source_wedge.size());
  for (const uint32_t w : block.source_wedge)
    plan.classes.class_of_wedge.push_back(classes(whole.classes.class_of_wedge[w]));
  plan.classes.class_count = static_cast<uint32_t>(classes.values().size());
  for (const QuantizedAttribute& a : whole.attributes) {
    QuantizedAttribute& local = plan.attributes.emplace_back();
    local.info = a.info;
    local.components = a.components;
    if (a.values.empty()) continue;
    local.values.reserve(block.source_wedge.size() * a.components);
    for (const uint32_t w : block.source_wedge) {
      const auto value = a.values.begin() + static_cast<ptrdiff_t>(size_t{w} * a.components);
      local.values.insert(local.values.end(), value, value + a.components);
    }
  }
  plan.header.wedge_count = static_cast<uint32_t>(block.source_wedge.size());
  describePiece(plan, options);
  return block;
}

/// A block after it is coded.
struct CodedBlock {
  PieceHeader header;
  std::vector<PartInfo> parts;
  EncoderIo::Streams streams;
  uint64_t cost = 0;
  CodedBox box;
  std::vector<uint32_t> source_wedge;  ///< in the whole piece, by decoded wedge
  Rim rim{Allocator{}};                ///< without tuples
  EncodeResult result;                 ///< sizes and a piece
};

CodedBox boxOf(const Plan& plan) {
  const std::vector<int32_t>& positions =
      plan.exact_positions.empty() ? plan.positions : plan.exact_positions;
  CodedBox box;
  std::fill_n(box.low, 3, std::numeric_limits<int32_t>::max());
  std::fill_n(box.high, 3, std::numeric_limits<int32_t>::min());
  for (size_t i = 0; i < positions.size(); ++i) {
    box.low[i % 3] = std::min(box.low[i % 3], positions[i]);
    box.high[i % 3] = std::max(box.high[i % 3], positions[i]);
  }
  return box;
}

Status codeBlock(LocalBlock block, StageModels& models, CodedBlock& coded) {
  EncoderIo io(true, false);
  MCC_TRY(codePiece(block.plan, io, models, 0, coded.result, &coded.rim));
  coded.cost = io.cost();
  coded.streams = io.finish();
  coded.header = block.plan.header;
  coded.parts = block.plan.parts;
  coded.box = boxOf(block.plan);
  coded.source_wedge = std::move(coded.result.pieces[0].source_wedge);
  for (uint32_t& w : coded.source_wedge) w = block.source_wedge[w];
  return {};
}

/// Finds which wedges blocks share, and what the table of blocks says of that.
class WedgeGluing {
 public:
  WedgeGluing(const Plan& whole, PayloadHeader& header, EncodeResult& result)
      : whole_(whole),
        header_(header),
        source_wedge_(result.pieces[0].source_wedge),
        number_of_source_(whole.header.wedge_count, kNone) {}

  void add(CodedBlock& block) {
    BlockHeader row;
    row.box = block.box;
    row.first_wedge = static_cast<uint32_t>(source_wedge_.size());
    row.first_exception = static_cast<uint32_t>(header_.exceptions.size());
    collectTuples(block);
    const std::vector<BlockException> exceptions = findExceptions(block);
    for (const BlockException& e : exceptions) {
      if (!header_.exceptions.push_back(e)) throwBadAlloc();
    }
    row.exception_count = static_cast<uint32_t>(exceptions.size());
    Array<uint32_t> numbers;
    if (!numberWedges(table_, block.rim, exceptions, row.first_wedge, block.header.wedge_count,
                      numbers, row.repeated_count))
      throwBadAlloc();
    for (uint32_t w = 0; w < block.header.wedge_count; ++w) {
      if (numbers[w] < row.first_wedge) continue;
      number_of_source_[block.source_wedge[w]] = numbers[w];
      source_wedge_.push_back(block.source_wedge[w]);
    }
    repeated_count_ += row.repeated_count;
    if (!header_.blocks.push_back(row)) throwBadAlloc();
  }

  uint64_t repeatedCount() const { return repeated_count_; }

 private:
  void collectTuples(CodedBlock& block) {
    Rim& rim = block.rim;
    for (const QuantizedAttribute& a : whole_.attributes)
      rim.tuple_words += a.values.empty() ? 0 : a.components;
    if (!rim.tuples.resize(rim.wedges.size() * rim.tuple_words)) throwBadAlloc();
    int32_t* to = rim.tuples.data();
    for (size_t i = 0; i < rim.wedges.size(); ++i) {
      const size_t source = block.source_wedge[rim.wedges[i]];
      for (const QuantizedAttribute& a : whole_.attributes) {
        if (!a.values.empty()) to = std::copy_n(&a.values[source * a.components], a.components, to);
      }
    }
  }

  /// Lists the wedges for which the rule is wrong.
  std::vector<BlockException> findExceptions(const CodedBlock& block) const {
    std::vector<BlockException> exceptions;
    size_t i = 0;
    for (uint32_t w = 0; w < block.header.wedge_count; ++w) {
      uint32_t found = kNone;
      if (i < block.rim.wedges.size() && block.rim.wedges[i] == w)
        found = table_.find(block.rim.tuple(i++));
      const uint32_t number = number_of_source_[block.source_wedge[w]];
      if (found != number) exceptions.push_back({w, number});
    }
    return exceptions;
  }

  const Plan& whole_;
  PayloadHeader& header_;
  std::vector<uint32_t>& source_wedge_;  ///< by number
  std::vector<uint32_t> number_of_source_;
  RimTable table_{Allocator{}};
  uint64_t repeated_count_ = 0;
};

/// Codes the blocks of a piece.
class BlocksEncoder {
 public:
  BlocksEncoder(const Plan& whole, const EncodeSettings& options, const Jobs& jobs)
      : whole_(whole), options_(options), jobs_(jobs) {}

  /// Returns false if a triangle belongs to no block.
  bool cut(uint32_t block_triangles) {
    const std::vector<uint32_t> corner_class = classesOfCorners(whole_);
    cut_ = cutIntoBlocks(centroidSums(whole_), corner_class, whole_.classes.class_count,
                         block_triangles, jobs_);
    leftovers_.resize(cut_.blockCount());
    std::vector<uint32_t> block_of;
    if (!whole_.triangles.duplicates.empty()) {
      block_of.resize(whole_.triangles.part.size());
      for (uint32_t b = 0; b < cut_.blockCount(); ++b) {
        for (const uint32_t t : cut_.trianglesOf(b)) block_of[t] = b;
      }
    }
    for (const uint32_t t : whole_.triangles.duplicates)
      leftovers_[block_of[t]].duplicates.push_back(t);
    return placeListed(whole_, cut_, leftovers_);
  }

  uint32_t blockCount() const { return cut_.blockCount(); }

  /// Codes block 0 and then the others.
  Status code() {
    coded_.resize(blockCount());
    taken_.resize(blockCount());
    MCC_TRY(jobs_.tryAll(2, [&](size_t i) -> Status {
      if (i == 0) return chooseForAll();
      for (uint32_t early = 0; early < kEarlyBlocks && early < sample(); ++early)
        taken_[early] = take(early);
      return {};
    }));
    StageModels primed;
    MCC_TRY(codeBlock(takeChosen(0), primed, coded_[0]));
    return jobs_.tryAll(blockCount() - 1, [&](size_t i) -> Status {
      const uint32_t index = static_cast<uint32_t>(i) + 1;
      StageModels models;
      models.copyFrom(primed);
      return codeBlock(takeChosen(index), models, coded_[index]);
    });
  }

  /// Writes the payload, unless it has too many exceptions or, if nobody asked for these blocks,
  /// repeats too many wedges.
  void write(bool was_asked, EncodeResult& result) {
    EncodeResult written;
    PayloadHeader header{Allocator{}};
    header.flags = payload_flag::kBlocks;
    for (const AttributeInfo& info : chosen_.attributes) {
      if (!header.attributes.push_back(info)) throwBadAlloc();
    }
    written.pieces.emplace_back();
    WedgeGluing gluing(whole_, header, written);
    std::vector<Streams> streams;
    for (CodedBlock& block : coded_) {
      addPiece(block, header);
      gluing.add(block);
      streams.push_back({block.streams.codes, block.streams.tokens, block.streams.raw});
    }
    const uint64_t wedges = whole_.header.wedge_count;
    if (header.exceptions.size() > kFreeExceptions + wedges / kWedgesPerException) {
      result.whole_because = "too many wedges of its blocks have equal attributes";
      return;
    }
    if (!was_asked && gluing.repeatedCount() > wedges / kWedgesPerRepeated) {
      result.whole_because = "its blocks would share too many vertices";
      return;
    }
    written.payload = writeBlocks(header, streams);
    written.block_count = blockCount();
    written.notes = std::move(result.notes);
    sumUp(header, written);
    result = std::move(written);
  }

 private:
  /// What is chosen for one block and holds for all.
  struct Choices {
    std::vector<AttributeInfo> attributes;
    PositionParameters positions;
    AxisPlanes planes[3];
    uint32_t flags = 0;
  };
  static Choices choicesOf(const Plan& plan) {
    Choices choices;
    for (const QuantizedAttribute& a : plan.attributes) choices.attributes.push_back(a.info);
    choices.positions = plan.positions_as;
    std::copy_n(plan.planes, 3, choices.planes);
    choices.flags = plan.header.flags & piece_flag::kCreases;
    return choices;
  }

  /// The block for which all choices are made: one of full size in the middle.
  uint32_t sample() const { return blockCount() / 2; }

  Status chooseForAll() {
    taken_[sample()] = take(sample());
    std::vector<Plan> plans(1);
    std::swap(plans[0], taken_[sample()]->plan);
    // A block may have too few vertices to see planes in them.
    findPlanesOf(plans[0], whole_.attributes[0].values);
    Variation variation(options_.variation);
    EncodeSettings options = options_;
    options.without.add(Feature::kMirrors);  // blocks have neither
    options.without.add(Feature::kAnchors);
    options.without.add(Feature::kMates);
    MCC_TRY(variation.active() ? varyAll(plans, variation, options.without)
                               : chooseAll(plans, options, jobs_));
    chosen_ = choicesOf(plans[0]);
    std::swap(plans[0], taken_[sample()]->plan);
    return {};
  }

  LocalBlock take(uint32_t index) const {
    LocalBlock block =
        takeBlock(whole_, cut_.trianglesOf(index), leftovers_[index], index == 0, options_);
    prepareConnectivity(block.plan, kNone);
    return block;
  }

  /// Takes a block, unless that is done, and makes the choices for it.
  LocalBlock takeChosen(uint32_t index) {
    LocalBlock block = taken_[index].has_value() ? std::move(*taken_[index]) : take(index);
    taken_[index].reset();
    if (index == sample()) return block;
    Plan& plan = block.plan;
    for (size_t a = 0; a < plan.attributes.size(); ++a)
      plan.attributes[a].info = chosen_.attributes[a];
    plan.positions_as = chosen_.positions;
    std::copy_n(chosen_.planes, 3, plan.planes);
    plan.finds_coordinates = chosen_.positions.has(position_mode::kPalette);
    if (plan.header.has(piece_flag::kSeams)) plan.header.flags |= chosen_.flags;
    return block;
  }

  void addPiece(CodedBlock& block, PayloadHeader& header) const {
    block.header.first_attribute = 0;
    block.header.first_part = static_cast<uint32_t>(header.parts.size());
    for (const PartInfo& part : block.parts) {
      if (!header.parts.push_back(part)) throwBadAlloc();
    }
    if (!header.pieces.push_back(block.header)) throwBadAlloc();
  }

  /// Adds up what the blocks cost and what is known of them.
  void sumUp(const PayloadHeader& header, EncodeResult& written) const {
    StreamSizes& sizes = written.sizes;
    PieceResult& piece = written.pieces[0];
    sizes.attribute_bits.resize(header.attributes.size(), 0);
    uint64_t cost = 0;
    uint64_t stream_bytes = 0;
    for (size_t b = 0; b < coded_.size(); ++b) {
      const StreamSizes& of_block = coded_[b].result.sizes;
      sizes.connectivity_bits += of_block.connectivity_bits;
      sizes.stitch_bits += of_block.stitch_bits;
      sizes.leftover_bits += of_block.leftover_bits;
      sizes.seam_bits += of_block.seam_bits;
      sizes.position_bits += of_block.position_bits;
      for (size_t a = 0; a < sizes.attribute_bits.size(); ++a)
        sizes.attribute_bits[a] += of_block.attribute_bits[a];
      const PieceResult& known = coded_[b].result.pieces[0];
      piece.cut_copy_count += known.cut_copy_count;
      piece.hole_count += known.hole_count;
      piece.component_count += known.component_count;
      piece.leftover_triangle_count += known.leftover_triangle_count;
      cost += coded_[b].cost;
      stream_bytes += header.blocks[b].streamBytes();
    }
    sizes.piece_position_bits = {sizes.position_bits};
    std::vector<uint8_t> is_used(whole_.classes.class_count, 0);
    for (const uint32_t w : whole_.triangles.wedges) is_used[whole_.classes.class_of_wedge[w]] = 1;
    piece.topological_vertex_count =
        static_cast<uint32_t>(std::count(is_used.begin(), is_used.end(), 1));
    accountHeader(static_cast<double>(cost) / kCostOne, stream_bytes, written);
  }

  const Plan& whole_;
  const EncodeSettings& options_;
  const Jobs& jobs_;
  BlockCut cut_;
  std::vector<Leftovers> leftovers_;              ///< by block
  std::vector<std::optional<LocalBlock>> taken_;  ///< before they are coded
  Choices chosen_;
  std::vector<CodedBlock> coded_;
};

}  // namespace

Status encodeBlocks(const Plan& whole, const EncodeSettings& options, const Jobs& jobs,
                    EncodeResult& result) {
  const uint32_t block_triangles =
      blockTriangles(options.block_triangles, options.prefer, whole.triangles.part.size());
  if (block_triangles == 0) return {};
  if (const char* why = whyWhole(whole, options)) {
    result.whole_because = why;
    return {};
  }
  BlocksEncoder encoder(whole, options, jobs);
  if (!encoder.cut(block_triangles)) {
    result.whole_because = "a degenerate triangle would join two blocks";
    return {};
  }
  if (encoder.blockCount() < 2) {
    result.whole_because = "its triangles are all in one place";
    return {};
  }
  MCC_TRY(encoder.code());
  encoder.write(options.block_triangles != kBlocksByPreference, result);
  return {};
}

}  // namespace mcc
