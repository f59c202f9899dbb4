// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Implements the part of the C API that works on documents.
#include "mcc/c_api.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <memory>

#include "base/c_struct.h"
#include "gltf/api/convert.h"
#include "gltf/inspect/report.h"
#include "json/json.h"
#include "mcc/files.h"

struct mcc_document {
  std::vector<uint8_t> bytes;
  std::string message;
};

namespace mcc::gltf {
namespace {

static_assert(MCC_GRID_PRIMITIVE == static_cast<int>(Grid::kPrimitive));
static_assert(MCC_PREVIEWS_BY_SHARE == kPreviewsByShare);

mcc_convert_options defaultConvertOptions() {
  const ConvertOptions defaults;
  mcc_convert_options options = {};
  options.struct_bytes = sizeof(options);
  options.position_bits = defaults.position_bits;
  options.normal_bits = defaults.normal_bits;
  options.texcoord_bits = defaults.texcoord_bits;
  options.color_bits = defaults.color_bits;
  options.tangent_bits = defaults.tangent_bits;
  options.weight_bits = defaults.weight_bits;
  options.thread_count = defaults.thread_count;
  options.block_triangles = defaults.block_triangles;
  return options;
}

mcc_decode_glb_options defaultDecodeOptions() {
  return {sizeof(mcc_decode_glb_options), 0, 1, 0, 0};
}

/// Stores a number in a type that it may be too large for; checkOptions() refuses what it becomes
/// then.
template <class Small>
Small clampedTo(uint32_t number) {
  return static_cast<Small>(std::min<uint32_t>(number, UINT8_MAX));
}

Status fromC(const mcc_convert_options& options, ConvertOptions& out) {
  MCC_TRY(checkFlags({options.lossless, options.is_error_relative, options.indices_only,
                      options.keep_vertex_order, options.keep_triangle_order, options.drop_unused,
                      options.allow_larger}));
  out.position_bits = clampedTo<uint8_t>(options.position_bits);
  out.normal_bits = clampedTo<uint8_t>(options.normal_bits);
  out.texcoord_bits = clampedTo<uint8_t>(options.texcoord_bits);
  out.color_bits = clampedTo<uint8_t>(options.color_bits);
  out.tangent_bits = clampedTo<uint8_t>(options.tangent_bits);
  out.weight_bits = clampedTo<uint8_t>(options.weight_bits);
  out.lossless = options.lossless != 0;
  out.grid = clampedTo<Grid>(options.grid);
  out.max_position_error = options.max_position_error;
  out.is_error_relative = options.is_error_relative != 0;
  out.indices_only = options.indices_only != 0;
  out.drop_unused = options.drop_unused != 0;
  out.keep_vertex_order = options.keep_vertex_order != 0;
  out.keep_triangle_order = options.keep_triangle_order != 0;
  out.prefer = clampedTo<Preference>(options.prefer);
  out.thread_count = options.thread_count;
  out.block_triangles = options.block_triangles;
  out.max_decoded_bytes = options.max_decoded_bytes;
  out.glb_version = static_cast<GlbVersion>(options.glb_version);
  out.step = options.step;
  out.quality = options.quality;
  out.preview_triangles = options.preview_triangles;
  out.allow_larger = options.allow_larger != 0;
  if (options.position_lattice != nullptr) {
    Lattice& lattice = out.position_lattice.emplace();
    std::copy_n(options.position_lattice->origin, 4, lattice.origin);
    lattice.step = options.position_lattice->step;
  }
  return checkOptions(out);
}

/// Runs a conversion of `glb` into a new document, if the options are `checked` and ok. The
/// document gets a message in any case.
mcc_status makeDocument(const Status& checked, const void* glb, size_t byte_count,
                        mcc_document** document,
                        const std::function<Result(Source, Sink)>& convert) try {
  if (document != nullptr) *document = nullptr;
  if (!checked.ok()) return toC(checked);
  if (document == nullptr) return badArgument("document is null");
  if (glb == nullptr && byte_count != 0) return badArgument("glb is null");
  if (!canBeInMemory(glb, byte_count, 1, 1))
    return badArgument("byte_count is more than memory has");
  auto made = std::make_unique<mcc_document>();
  Source source;
  source.bytes = std::span(static_cast<const uint8_t*>(glb), byte_count);
  Sink sink;
  sink.bytes = &made->bytes;
  const Result result = convert(source, sink);
  if (!result.ok()) {
    made->bytes = {};
    made->message = result.message();
  }
  *document = made.release();
  if (result.ok()) return toC({});
  // The message dies with the document, and what a status says never does.
  return {MCC_ERROR_DOCUMENT, "the document was refused; mcc_document_message() says why",
          MCC_NO_OFFSET};
} catch (const std::exception&) {
  return toC(fail(Error::kOutOfMemory, "no memory for the document"));
}

}  // namespace
}  // namespace mcc::gltf

void mcc_convert_options_init(mcc_convert_options* options, size_t struct_bytes) {
  mcc::initStruct(options, struct_bytes, mcc::gltf::defaultConvertOptions());
}

mcc_status mcc_convert_glb(const void* glb, size_t byte_count, const mcc_convert_options* options,
                           mcc_document** document) {
  mcc_convert_options read;
  mcc::Status status = mcc::readStruct(options, mcc::gltf::defaultConvertOptions(), read);
  mcc::gltf::ConvertOptions convert_options;
  if (status.ok()) status = mcc::gltf::fromC(read, convert_options);
  return mcc::gltf::makeDocument(status, glb, byte_count, document,
                                 [&](const auto& source, const auto& sink) {
                                   mcc::gltf::ConvertReport report;
                                   return mcc::gltf::convert(source, sink, convert_options, report);
                                 });
}

void mcc_decode_glb_options_init(mcc_decode_glb_options* options, size_t struct_bytes) {
  mcc::initStruct(options, struct_bytes, mcc::gltf::defaultDecodeOptions());
}

mcc_status mcc_decode_glb(const void* glb, size_t byte_count, const mcc_decode_glb_options* options,
                          mcc_document** document) {
  mcc_decode_glb_options read;
  mcc::Status status = mcc::readStruct(options, mcc::gltf::defaultDecodeOptions(), read);
  if (status.ok()) status = mcc::checkFlags({read.decode_to});
  const auto glb_version = static_cast<mcc::gltf::GlbVersion>(read.glb_version);
  if (status.ok()) status = mcc::gltf::checkGlbVersion(glb_version);
  mcc::gltf::DecodeOptions decode_options;
  decode_options.decode_to = static_cast<mcc::gltf::DecodeTo>(read.decode_to);
  decode_options.thread_count = read.thread_count;
  decode_options.max_decoded_bytes = read.max_decoded_bytes;
  decode_options.glb_version = glb_version;
  return mcc::gltf::makeDocument(status, glb, byte_count, document,
                                 [&](const auto& source, const auto& sink) {
                                   mcc::gltf::DecodeReport report;
                                   return mcc::gltf::decode(source, sink, report, decode_options);
                                 });
}

mcc_status mcc_inspect_glb(const void* glb, size_t byte_count, const char* name,
                           mcc_document** document) {
  return mcc::gltf::makeDocument(
      {}, glb, byte_count, document, [=](const auto& source, const auto& sink) {
        mcc::gltf::InspectReport report;
        mcc::gltf::Result result = mcc::gltf::inspectGlb(*source.bytes, true, report);
        if (!result.ok()) return result;
        // Names in the JSON of a file need not be UTF-8; dump() must not throw for them.
        const std::string text =
            mcc::gltf::inspectJson(name == nullptr ? "" : name, report).dump(2);
        sink.bytes->assign(text.begin(), text.end());
        return result;
      });
}

const uint8_t* mcc_document_bytes(const mcc_document* document, size_t* byte_count) {
  const bool has_bytes = document != nullptr && !document->bytes.empty();
  if (byte_count != nullptr) *byte_count = has_bytes ? document->bytes.size() : 0;
  return has_bytes ? document->bytes.data() : nullptr;
}

const char* mcc_document_message(const mcc_document* document) {
  return document == nullptr ? "there is no document" : document->message.c_str();
}

void mcc_document_release(mcc_document* document) { delete document; }
