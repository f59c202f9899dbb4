// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The reader's part of the C API. The writer's part is writer/c_api.cpp, that for documents
// gltf/api/c_api.cpp.
#include "mcc/c_api.h"

#include <algorithm>
#include <cstdio>
#include <new>
#include <utility>

#include "base/c_struct.h"
#include "base/memory.h"
#include "mcc/meshlets.h"
#include "mcc/reader.h"

struct mcc_payload {
  mcc::Payload payload;
  mcc::Allocator allocator;
};

namespace mcc {
namespace {

static_assert(MCC_ERROR_CANCELLED == static_cast<int>(Error::kCancelled));
static_assert(MCC_CUSTOM == static_cast<int>(Semantic::kCustom));
static_assert(MCC_FLOAT32 == static_cast<int>(ComponentType::kFloat32));
static_assert(MCC_CODING_GRID == static_cast<int>(AttributeCoding::kGrid));
static_assert(MCC_MESHLETS_IN_ORDER == static_cast<int>(MeshletShape::kInOrder));
static_assert(sizeof(mcc_meshlet) == sizeof(Meshlet));
static_assert(MCC_NO_OFFSET == Status::kNoOffset);

/// Converts an allocator, of which one function alone would be called with memory of the other's.
Status fromC(const mcc_allocator& allocator, Allocator& out) {
  if ((allocator.allocate == nullptr) != (allocator.release == nullptr)) {
    return fail(Error::kBadArgument,
                "an allocator has only one of its two functions; set both, or neither");
  }
  out = {allocator.allocate, allocator.release, allocator.user};
  return {};
}

mcc_attribute_format formatToC(const AttributeFormat& format) {
  return {static_cast<uint32_t>(format.semantic),
          format.set_index,
          static_cast<uint32_t>(format.component_type),
          format.component_count,
          format.normalized ? 1u : 0u,
          format.morph_target};
}

mcc_open_options defaultOpenOptions() {
  const Limits limits;
  return {
      sizeof(mcc_open_options), limits.max_vertices,   limits.max_triangles, limits.max_elements,
      limits.max_output_bytes,  limits.max_attributes, limits.max_pieces,    {}};
}

Limits limitsOf(const mcc_open_options& options) {
  Limits limits;
  limits.max_vertices = options.max_vertices;
  limits.max_triangles = options.max_triangles;
  limits.max_elements = options.max_elements;
  limits.max_output_bytes = options.max_output_bytes;
  limits.max_attributes = options.max_attributes;
  limits.max_pieces = options.max_pieces;
  return limits;
}

mcc_decode_options defaultDecodeOptions() {
  return {sizeof(mcc_decode_options), {}, nullptr, nullptr, nullptr, nullptr};
}

const PieceInfo* pieceOf(const mcc_payload* payload, uint32_t piece) {
  if (payload == nullptr || piece >= payload->payload.info().pieces.size()) return nullptr;
  return &payload->payload.info().pieces[piece];
}

std::span<const BlockInfo> blocksOf(const mcc_payload* payload) {
  const PieceInfo* piece = pieceOf(payload, 0);
  return piece == nullptr ? std::span<const BlockInfo>{} : piece->blocks;
}

/// Refuses bytes that cannot be there: none, or so many that they would go beyond all addresses.
Status checkBytes(const void* bytes, size_t byte_count) {
  if (bytes == nullptr && byte_count != 0) return fail(Error::kBadArgument, "bytes is null");
  if (!canBeInMemory(bytes, byte_count, 1, 1))
    return fail(Error::kBadArgument, "byte_count is more than memory has");
  return {};
}

/// The targets of all pieces in the form the reader needs, each array in one block of memory.
class Targets {
 public:
  explicit Targets(const Allocator& allocator)
      : pieces_(allocator), attributes_(allocator), parts_(allocator) {}

  Status read(const mcc_piece_target* targets, size_t count) {
    size_t attribute_count = 0;
    size_t part_count = 0;
    for (size_t i = 0; i < count; ++i) {
      attribute_count += targets[i].attribute_count;
      part_count += targets[i].part_count;
    }
    if (!pieces_.reserve(count) || !attributes_.reserve(attribute_count) ||
        !parts_.reserve(part_count)) {
      return fail(Error::kOutOfMemory, "no memory for the targets");
    }
    for (size_t i = 0; i < count; ++i) MCC_TRY(add(targets[i]));
    return {};
  }

  std::span<const PieceTarget> all() const { return {pieces_.data(), pieces_.size()}; }

 private:
  /// Adds the targets of a piece. The arrays must have been reserved, so that spans of them stay
  /// valid.
  Status add(const mcc_piece_target& target) {
    if ((target.attributes == nullptr && target.attribute_count != 0) ||
        (target.parts == nullptr && target.part_count != 0)) {
      return fail(Error::kBadArgument, "a target is null");
    }
    const size_t first_attribute = attributes_.size();
    for (size_t i = 0; i < target.attribute_count; ++i) {
      (void)attributes_.push_back({target.attributes[i].data, target.attributes[i].stride_bytes});
    }
    const size_t first_part = parts_.size();
    for (size_t i = 0; i < target.part_count; ++i) {
      const uint32_t bytes = target.parts[i].index_bytes;
      if (bytes != 1 && bytes != 2 && bytes != 4) {
        return fail(Error::kBadArgument, "index_bytes is not 1, 2 or 4");
      }
      (void)parts_.push_back({target.parts[i].indices, static_cast<IndexType>(bytes)});
    }
    (void)pieces_.push_back({{attributes_.data() + first_attribute, target.attribute_count},
                             {parts_.data() + first_part, target.part_count}});
    return {};
  }

  Array<PieceTarget> pieces_;
  Array<AttributeTarget> attributes_;
  Array<PartTarget> parts_;
};

struct ProgressOfC {
  int (*function)(void* user, double done);
  void* user;
};

bool callProgress(void* user, double done) {
  const auto* progress = static_cast<const ProgressOfC*>(user);
  return progress->function(progress->user, done) != 0;
}

/// Checks the counts before the arrays of the targets are read, since wrong counts could lead
/// anywhere.
Status checkCounts(std::span<const PieceInfo> pieces, const mcc_piece_target* targets,
                   size_t target_count) {
  if (target_count != pieces.size())
    return fail(Error::kBadArgument, "the number of targets is not the number of pieces");
  for (size_t i = 0; i < target_count; ++i) {
    if (targets[i].attribute_count != pieces[i].attributes.size() ||
        targets[i].part_count != pieces[i].parts.size()) {
      return fail(Error::kBadArgument, "a target does not have the shape of its piece");
    }
  }
  return {};
}

/// Reads targets and options, and calls `decode` with the reader's.
template <class Decode>
Status withTargets(std::span<const PieceInfo> pieces, const mcc_piece_target* targets,
                   size_t target_count, const mcc_decode_options* given, const Decode& decode) {
  mcc_decode_options options;
  MCC_TRY(readStruct(given, defaultDecodeOptions(), options));
  if (targets != nullptr) MCC_TRY(checkCounts(pieces, targets, target_count));
  DecodeOptions decode_options;
  MCC_TRY(fromC(options.allocator, decode_options.allocator));
  Targets read(decode_options.allocator);
  MCC_TRY(read.read(targets, target_count));
  decode_options.run_jobs = {options.run_jobs, options.run_jobs_user};
  ProgressOfC progress{options.progress, options.progress_user};
  if (options.progress != nullptr) {
    decode_options.progress = callProgress;
    decode_options.progress_user = &progress;
  }
  return decode(read.all(), decode_options);
}

Status open(const void* bytes, size_t byte_count, uint64_t payload_bytes,
            const mcc_open_options* given, mcc_payload*& opened) {
  MCC_TRY(checkBytes(bytes, byte_count));
  mcc_open_options options;
  MCC_TRY(readStruct(given, defaultOpenOptions(), options));
  Allocator allocator;
  MCC_TRY(fromC(options.allocator, allocator));
  Payload payload;
  MCC_TRY(payload.openPrefix({static_cast<const uint8_t*>(bytes), byte_count}, payload_bytes,
                             limitsOf(options), allocator));
  void* memory = allocateBytes(allocator, sizeof(mcc_payload));
  if (memory == nullptr) return fail(Error::kOutOfMemory, "no memory for the payload object");
  opened = new (memory) mcc_payload{std::move(payload), allocator};
  return {};
}

mcc_meshlet_options defaultMeshletOptions() {
  const MeshletOptions options;
  return {sizeof(mcc_meshlet_options),
          options.max_vertices,
          options.max_triangles,
          static_cast<uint32_t>(options.shape),
          {}};
}

Status meshletOptionsOf(const mcc_meshlet_options* given, MeshletOptions& options) {
  mcc_meshlet_options read;
  MCC_TRY(readStruct(given, defaultMeshletOptions(), read));
  if (read.shape > MCC_MESHLETS_IN_ORDER)
    return fail(Error::kBadArgument, "shape is none of MCC_MESHLETS_…");
  options.max_vertices = read.max_vertices;
  options.max_triangles = read.max_triangles;
  options.shape = static_cast<MeshletShape>(read.shape);
  return fromC(read.allocator, options.allocator);
}

Status checkTarget(const mcc_meshlet_target& target) {
  const mcc_meshlet_sizes& sizes = target.sizes;
  if (canBeInMemory(target.meshlets, sizes.meshlet_count, sizeof(Meshlet), sizeof(Meshlet)) &&
      canBeInMemory(target.vertices, sizes.vertex_count, sizeof(uint32_t), sizeof(uint32_t)) &&
      canBeInMemory(target.triangles, sizes.triangle_bytes, 1, 1)) {
    return {};
  }
  return fail(Error::kBadArgument, "an array for meshlets is longer than memory");
}

Status meshletsOf(const mcc_triangle_list& list, const mcc_meshlet_target& target,
                  mcc_meshlet_sizes& used, const mcc_meshlet_options* given) {
  MeshletOptions options;
  MCC_TRY(meshletOptionsOf(given, options));
  if (list.index_bytes != 1 && list.index_bytes != 2 && list.index_bytes != 4)
    return fail(Error::kBadArgument, "index_bytes is not 1, 2 or 4");
  MCC_TRY(checkTarget(target));
  MeshletSizes sizes;
  MCC_TRY(buildMeshlets({list.indices, static_cast<IndexType>(list.index_bytes),
                         list.triangle_count, list.vertex_count},
                        {{reinterpret_cast<Meshlet*>(target.meshlets), target.sizes.meshlet_count},
                         {target.vertices, target.sizes.vertex_count},
                         {target.triangles, target.sizes.triangle_bytes}},
                        sizes, options));
  used = {sizes.meshlet_count, sizes.vertex_count, sizes.triangle_bytes};
  return {};
}

}  // namespace
}  // namespace mcc

const char* mcc_version(void) { return MCC_VERSION; }

size_t mcc_status_text(mcc_status status, char* text, size_t text_bytes) {
  if (text == nullptr) text_bytes = 0;
  const char* what = status.what == nullptr || *status.what == 0 ? "ok" : status.what;
  const int length = status.offset_bytes == MCC_NO_OFFSET
                         ? std::snprintf(text, text_bytes, "%s", what)
                         : std::snprintf(text, text_bytes, "%s (byte %llu)", what,
                                         static_cast<unsigned long long>(status.offset_bytes));
  return length < 0 ? 0 : static_cast<size_t>(length);
}

size_t mcc_element_bytes(const mcc_attribute_format* format) {
  if (format == nullptr || !mcc::isFormat(*format)) return 0;
  return mcc::componentBytes(static_cast<mcc::ComponentType>(format->component_type)) *
         format->component_count;
}

void mcc_open_options_init(mcc_open_options* options, size_t struct_bytes) {
  mcc::initStruct(options, struct_bytes, mcc::defaultOpenOptions());
}

mcc_status mcc_payload_open(const void* bytes, size_t byte_count, const mcc_open_options* options,
                            mcc_payload** payload) {
  return mcc_payload_open_prefix(bytes, byte_count, byte_count, options, payload);
}

mcc_status mcc_payload_open_prefix(const void* bytes, size_t byte_count, uint64_t payload_bytes,
                                   const mcc_open_options* options, mcc_payload** payload) {
  if (payload == nullptr) return mcc::badArgument("payload is null");
  *payload = nullptr;
  return mcc::toC(mcc::open(bytes, byte_count, payload_bytes, options, *payload));
}

mcc_status mcc_payload_extend(mcc_payload* payload, const void* bytes, size_t byte_count) {
  if (payload == nullptr) return mcc::badArgument("payload is null");
  const mcc::Status status = mcc::checkBytes(bytes, byte_count);
  if (!status.ok()) return mcc::toC(status);
  return mcc::toC(payload->payload.extend({static_cast<const uint8_t*>(bytes), byte_count}));
}

uint32_t mcc_payload_loaded_block_count(const mcc_payload* payload) {
  return payload == nullptr ? 0 : payload->payload.loadedBlockCount();
}

void mcc_payload_close(mcc_payload* payload) {
  if (payload == nullptr) return;
  const mcc::Allocator allocator = payload->allocator;
  payload->~mcc_payload();
  mcc::releaseBytes(allocator, payload, sizeof(mcc_payload));
}

uint32_t mcc_payload_piece_count(const mcc_payload* payload) {
  return payload == nullptr ? 0 : static_cast<uint32_t>(payload->payload.info().pieces.size());
}

mcc_status mcc_payload_piece(const mcc_payload* payload, uint32_t piece, mcc_piece_info* info) {
  const mcc::PieceInfo* found = mcc::pieceOf(payload, piece);
  if (found == nullptr || info == nullptr) return mcc::badArgument("there is no such piece");
  mcc_piece_info filled = {};
  filled.wedge_count = found->wedge_count;
  filled.vertex_count = found->vertex_count;
  filled.attribute_count = static_cast<uint32_t>(found->attributes.size());
  filled.part_count = static_cast<uint32_t>(found->parts.size());
  return mcc::toC(mcc::writeStruct(filled, info));
}

mcc_status mcc_payload_attribute(const mcc_payload* payload, uint32_t piece, uint32_t attribute,
                                 mcc_attribute_info* info) {
  const mcc::PieceInfo* found = mcc::pieceOf(payload, piece);
  if (found == nullptr || attribute >= found->attributes.size() || info == nullptr) {
    return mcc::badArgument("there is no such attribute");
  }
  const mcc::AttributeInfo& from = found->attributes[attribute];
  mcc_attribute_info filled = {};
  filled.format = mcc::formatToC(from.format);
  filled.coding = static_cast<uint32_t>(from.coding);
  filled.bits = from.bits;
  for (size_t i = 0; i < 4; ++i) filled.lattice.origin[i] = from.lattice.origin[i];
  filled.lattice.step = from.lattice.step;
  return mcc::toC(mcc::writeStruct(filled, info));
}

mcc_status mcc_payload_part(const mcc_payload* payload, uint32_t piece, uint32_t part,
                            uint32_t* triangle_count) {
  const mcc::PieceInfo* found = mcc::pieceOf(payload, piece);
  if (found == nullptr || part >= found->parts.size() || triangle_count == nullptr) {
    return mcc::badArgument("there is no such part");
  }
  *triangle_count = found->parts[part].triangle_count;
  return mcc::toC({});
}

uint32_t mcc_payload_block_count(const mcc_payload* payload) {
  return static_cast<uint32_t>(mcc::blocksOf(payload).size());
}

mcc_status mcc_payload_block(const mcc_payload* payload, uint32_t block, mcc_block_info* info) {
  const std::span<const mcc::BlockInfo> blocks = mcc::blocksOf(payload);
  if (block >= blocks.size() || info == nullptr) return mcc::badArgument("there is no such block");
  const mcc::BlockInfo& found = blocks[block];
  mcc_block_info filled = {};
  filled.wedge_count = found.wedge_count;
  filled.repeated_count = found.repeated_count;
  filled.triangle_count = found.triangle_count;
  filled.offset_bytes = found.offset_bytes;
  filled.stream_bytes = found.stream_bytes;
  std::copy_n(found.low, 3, filled.low);
  std::copy_n(found.high, 3, filled.high);
  return mcc::toC(mcc::writeStruct(filled, info));
}

mcc_status mcc_payload_block_part(const mcc_payload* payload, uint32_t block, uint32_t part,
                                  uint32_t* triangle_count) {
  const std::span<const mcc::BlockInfo> blocks = mcc::blocksOf(payload);
  if (block >= blocks.size() || part >= blocks[block].parts.size() || triangle_count == nullptr)
    return mcc::badArgument("there is no such block or part");
  *triangle_count = blocks[block].parts[part].triangle_count;
  return mcc::toC({});
}

void mcc_decode_options_init(mcc_decode_options* options, size_t struct_bytes) {
  mcc::initStruct(options, struct_bytes, mcc::defaultDecodeOptions());
}

mcc_status mcc_payload_decode(const mcc_payload* payload, const mcc_piece_target* targets,
                              size_t target_count, const mcc_decode_options* options) {
  if (payload == nullptr || (targets == nullptr && target_count != 0)) {
    return mcc::badArgument("payload or targets is null");
  }
  return mcc::toC(mcc::withTargets(
      payload->payload.info().pieces, targets, target_count, options,
      [payload](std::span<const mcc::PieceTarget> all, const mcc::DecodeOptions& decode_options) {
        return payload->payload.decode(all, decode_options);
      }));
}

mcc_status mcc_payload_prime(mcc_payload* payload, const mcc_piece_target* target,
                             const mcc_decode_options* options) {
  if (payload == nullptr) return mcc::badArgument("payload is null");
  return mcc::toC(mcc::withTargets(
      payload->payload.info().pieces, target, target == nullptr ? 0 : 1, options,
      [payload](std::span<const mcc::PieceTarget> all, const mcc::DecodeOptions& decode_options) {
        return payload->payload.prime(all.empty() ? nullptr : &all[0], decode_options);
      }));
}

mcc_status mcc_payload_decode_block(const mcc_payload* payload, uint32_t block,
                                    const mcc_piece_target* target,
                                    const mcc_decode_options* options) {
  if (payload == nullptr || target == nullptr) return mcc::badArgument("payload or target is null");
  return mcc::toC(mcc::withTargets(
      payload->payload.info().pieces, target, 1, options,
      [&](std::span<const mcc::PieceTarget> all, const mcc::DecodeOptions& decode_options) {
        return payload->payload.decodeBlock(block, all[0], decode_options);
      }));
}

void mcc_meshlet_options_init(mcc_meshlet_options* options, size_t struct_bytes) {
  mcc::initStruct(options, struct_bytes, mcc::defaultMeshletOptions());
}

mcc_meshlet_sizes mcc_meshlet_bound(uint32_t triangle_count, const mcc_meshlet_options* options) {
  mcc::MeshletOptions read;
  if (!mcc::meshletOptionsOf(options, read).ok()) return {};
  const mcc::MeshletSizes bound = mcc::meshletBound(triangle_count, read);
  return {bound.meshlet_count, bound.vertex_count, bound.triangle_bytes};
}

mcc_status mcc_build_meshlets(const mcc_triangle_list* list, const mcc_meshlet_target* target,
                              mcc_meshlet_sizes* used, const mcc_meshlet_options* options) {
  if (list == nullptr || target == nullptr || used == nullptr)
    return mcc::badArgument("list, target or used is null");
  *used = {};
  return mcc::toC(mcc::meshletsOf(*list, *target, *used, options));
}
