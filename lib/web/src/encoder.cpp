// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the WebAssembly encoder exports; encoder.mjs is the only caller. An instance does one
// conversion: allocate() bytes for the GLB, fill them, set the options, convert(), take the
// outputs. Where the caller has a decoder of meshoptimizer, findCodedViews() and the elements of
// those views come before convert().
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "coded_views.h"
#include "gltf/inspect/report.h"
#include "json/json.h"
#include "mcc/glb.h"

#define MCC_EXPORT(name) extern "C" __attribute__((export_name(name), used))

namespace {

using mcc::gltf::ConvertOptions;

ConvertOptions options;
std::vector<uint8_t> glb;
std::string text;  // the report, the list of coded views, or the error message
mcc::web::CodedViews coded_views;

std::string printed(const mcc::gltf::Json& json) { return json.dump(-1); }

}  // namespace

MCC_EXPORT("allocate") void* mccAllocate(size_t bytes) { return std::malloc(bytes); }

/// Sets the bits, in the order of encoder.mjs, which has checked the values.
MCC_EXPORT("setBits")
void mccSetBits(uint32_t position, uint32_t normal, uint32_t texcoord, uint32_t color,
                uint32_t tangent, uint32_t weight) {
  const auto bits = [](uint32_t value) { return static_cast<uint8_t>(value); };
  static_cast<mcc::gltf::QuantizationBits&>(options) = {
      bits(position), bits(normal), bits(texcoord), bits(color), bits(tangent), bits(weight)};
}

MCC_EXPORT("setModes")
void mccSetModes(uint32_t lossless, uint32_t indices_only, uint32_t grid,
                 uint32_t keep_vertex_order, uint32_t keep_triangle_order, uint32_t prefer,
                 uint32_t allow_larger, uint32_t drop_unused) {
  options.lossless = lossless != 0;
  options.indices_only = indices_only != 0;
  options.grid = static_cast<mcc::gltf::Grid>(grid);
  options.keep_vertex_order = keep_vertex_order != 0;
  options.keep_triangle_order = keep_triangle_order != 0;
  options.prefer = static_cast<mcc::Preference>(prefer);
  options.allow_larger = allow_larger != 0;
  options.drop_unused = drop_unused != 0;
}

/// Without a call, what the other options say decides about blocks.
MCC_EXPORT("setBlocks") void mccSetBlocks(uint32_t triangles) {
  options.block_triangles = triangles;
}

MCC_EXPORT("setMaxError") void mccSetMaxError(double error, uint32_t is_relative) {
  options.max_position_error = error;
  options.is_error_relative = is_relative != 0;
}

MCC_EXPORT("setLattice") void mccSetLattice(float x, float y, float z, float step) {
  options.position_lattice = mcc::Lattice{{x, y, z, 0}, step};
}

MCC_EXPORT("setStep") void mccSetStep(double step) { options.step = step; }
MCC_EXPORT("setGlbVersion") void mccSetGlbVersion(uint32_t version) {
  options.glb_version = static_cast<mcc::gltf::GlbVersion>(version);
}
MCC_EXPORT("setPreviewTriangles") void mccSetPreviewTriangles(uint32_t count) {
  options.preview_triangles = count;
}
MCC_EXPORT("setQuality") void mccSetQuality(double pixels) { options.quality = pixels; }

/// Finds the buffer views that meshoptimizer compressed and that triangles need. Returns 1 on
/// success; text() is then what CodedViews::list() says. On failure it returns 0, and text() is the
/// error message. The bytes must stay where they are until convert() has returned.
MCC_EXPORT("findCodedViews") uint32_t mccFindCodedViews(const uint8_t* bytes, size_t size) {
  const mcc::gltf::Result result = coded_views.find({bytes, size});
  text = result.ok() ? printed(coded_views.list()) : result.message();
  return result.ok() ? 1 : 0;
}

/// Returns 1 on success; text() is then the report. On failure it returns 0, and text() is the
/// error message.
MCC_EXPORT("convert") uint32_t mccConvert(const uint8_t* bytes, size_t size) {
  options.decoders.view = [](const mcc::gltf::CodedView& view, std::vector<uint8_t>& elements) {
    return coded_views.elementsOf(view, elements);
  };
  mcc::gltf::ConvertReport report;
  const mcc::gltf::Result result = mcc::gltf::convertGlb({bytes, size}, options, glb, report);
  text = result.ok() ? printed(mcc::gltf::reportJson(report, options)) : result.message();
  return result.ok() ? 1 : 0;
}

MCC_EXPORT("text") const char* mccText() { return text.data(); }
MCC_EXPORT("textBytes") size_t mccTextBytes() { return text.size(); }
MCC_EXPORT("glb") const uint8_t* mccGlb() { return glb.data(); }
MCC_EXPORT("glbBytes") size_t mccGlbBytes() { return glb.size(); }
