// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The writer's part of the C API.
#include <algorithm>
#include <exception>
#include <memory>
#include <vector>

#include "base/c_struct.h"
#include "mcc/c_api.h"
#include "mcc/writer.h"

struct mcc_encoding {
  mcc::EncodeResult result;
};

namespace mcc {
namespace {

mcc_encode_options defaultEncodeOptions() {
  return {sizeof(mcc_encode_options), 0,       0,      MCC_PREFER_BALANCED,
          MCC_BLOCKS_BY_PREFERENCE,   nullptr, nullptr};
}

/// Wraps a hook of the C API, which may be null.
RunJobs runJobsOf(mcc_run_jobs run_jobs, void* user) {
  if (run_jobs == nullptr) return {};
  return [run_jobs, user](size_t count, const std::function<void(size_t)>& job) {
    run_jobs(
        user, count,
        [](void* of_job, size_t index) {
          (*static_cast<const std::function<void(size_t)>*>(of_job))(index);
        },
        const_cast<void*>(static_cast<const void*>(&job)));
  };
}

/// Refuses arrays of structures that cannot be there.
template <class Struct>
Status checkArray(const Struct* first, size_t count) {
  if (canBeInMemory(first, count, sizeof(Struct), sizeof(Struct))) return {};
  return fail(Error::kBadArgument, "a count is larger than memory");
}

/// Converts a format. Numbers that do not fit are refused, not truncated.
Status fromC(const mcc_attribute_format& format, AttributeFormat& out) {
  if (!isFormat(format)) {
    return fail(Error::kBadArgument, "the format of an attribute has a number out of range");
  }
  out.semantic = static_cast<Semantic>(format.semantic);
  out.set_index = static_cast<uint8_t>(format.set_index);
  out.component_type = static_cast<ComponentType>(format.component_type);
  out.component_count = static_cast<uint8_t>(format.component_count);
  out.normalized = format.normalized != 0;
  out.morph_target = static_cast<uint16_t>(format.morph_target);
  return {};
}

/// A piece with the arrays that its spans refer to.
struct Piece {
  std::vector<AttributeView> attributes;
  std::vector<Lattice> lattices;
  std::vector<PartView> parts;
};

Status readPiece(const mcc_piece_view& view, Piece& piece) {
  if ((view.attributes == nullptr && view.attribute_count != 0) ||
      (view.parts == nullptr && view.part_count != 0)) {
    return fail(Error::kBadArgument, "attributes or parts of a piece are null");
  }
  MCC_TRY(checkArray(view.attributes, view.attribute_count));
  MCC_TRY(checkArray(view.parts, view.part_count));
  piece.lattices.resize(view.attribute_count);
  for (size_t i = 0; i < view.attribute_count; ++i) {
    const mcc_attribute_view& from = view.attributes[i];
    AttributeView to;
    MCC_TRY(fromC(from.format, to.format));
    if (from.quantization_bits > 0xff) {
      return fail(Error::kBadArgument, "quantization_bits is out of range");
    }
    to.data = from.data;
    to.stride_bytes = from.stride_bytes;
    to.quantization_bits = static_cast<uint8_t>(from.quantization_bits);
    if (from.lattice != nullptr) {
      std::copy_n(from.lattice->origin, 4, piece.lattices[i].origin);
      piece.lattices[i].step = from.lattice->step;
      to.lattice = &piece.lattices[i];
    }
    piece.attributes.push_back(to);
  }
  for (size_t i = 0; i < view.part_count; ++i) {
    if (view.parts[i].indices == nullptr && view.parts[i].index_count != 0) {
      return fail(Error::kBadArgument, "the indices of a part are null");
    }
    piece.parts.push_back({{view.parts[i].indices, view.parts[i].index_count}});
  }
  return {};
}

Status encodeViews(const mcc_piece_view* views, size_t count, const mcc_encode_options* given,
                   EncodeResult& result) {
  mcc_encode_options options;
  MCC_TRY(readStruct(given, defaultEncodeOptions(), options));
  MCC_TRY(checkFlags({options.keep_vertex_order, options.keep_triangle_order}));
  if (options.prefer > MCC_PREFER_SPEED)
    return fail(Error::kBadArgument, "prefer is not 0, 1 or 2");
  EncodeOptions encode_options;
  encode_options.keep_vertex_order = options.keep_vertex_order != 0;
  encode_options.keep_triangle_order = options.keep_triangle_order != 0;
  encode_options.prefer = static_cast<Preference>(options.prefer);
  encode_options.block_triangles = options.block_triangles;
  encode_options.run_jobs = runJobsOf(options.run_jobs, options.run_jobs_user);
  MCC_TRY(checkArray(views, count));
  std::vector<Piece> pieces(count);
  std::vector<PieceView> piece_views;
  for (size_t i = 0; i < count; ++i) {
    MCC_TRY(readPiece(views[i], pieces[i]));
    piece_views.push_back({views[i].wedge_count, pieces[i].attributes, pieces[i].parts});
  }
  return encode(piece_views, encode_options, result);
}

}  // namespace
}  // namespace mcc

void mcc_encode_options_init(mcc_encode_options* options, size_t struct_bytes) {
  mcc::initStruct(options, struct_bytes, mcc::defaultEncodeOptions());
}

mcc_status mcc_encode(const mcc_piece_view* pieces, size_t piece_count,
                      const mcc_encode_options* options, mcc_encoding** encoding) try {
  if (encoding == nullptr) return mcc::badArgument("encoding is null");
  *encoding = nullptr;
  if (pieces == nullptr && piece_count != 0) return mcc::badArgument("pieces is null");
  auto made = std::make_unique<mcc_encoding>();
  const mcc::Status status = mcc::encodeViews(pieces, piece_count, options, made->result);
  if (status.ok()) *encoding = made.release();
  return mcc::toC(status);
} catch (const std::exception&) {
  return mcc::toC(mcc::fail(mcc::Error::kOutOfMemory, "no memory to encode"));
}

const uint8_t* mcc_encoding_payload(const mcc_encoding* encoding, size_t* byte_count) {
  const size_t count = encoding == nullptr ? 0 : encoding->result.payload.size();
  if (byte_count != nullptr) *byte_count = count;
  return encoding == nullptr ? nullptr : encoding->result.payload.data();
}

const uint32_t* mcc_encoding_source_wedges(const mcc_encoding* encoding, size_t piece,
                                           size_t* wedge_count) {
  const bool is_there = encoding != nullptr && piece < encoding->result.pieces.size();
  if (wedge_count != nullptr) {
    *wedge_count = is_there ? encoding->result.pieces[piece].source_wedge.size() : 0;
  }
  return is_there ? encoding->result.pieces[piece].source_wedge.data() : nullptr;
}

void mcc_encoding_release(mcc_encoding* encoding) { delete encoding; }
