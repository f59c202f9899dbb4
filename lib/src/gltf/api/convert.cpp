// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Implements the public functions: load, compress or decompress, write, check.
#include "gltf/api/convert.h"
#include "gltf/inspect/report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <set>

#include "format/codings.h"
#include "gltf/check/check.h"
#include "gltf/check/prove.h"
#include "gltf/compress/compress.h"
#include "gltf/compress/quality.h"
#include "gltf/decompress/coded_input.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/layout.h"
#include "gltf/document/package.h"
#include "gltf/files/destination.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"
#include "host/text.h"

namespace mcc::gltf {
namespace {

namespace fs = std::filesystem;

class Stopwatch {
 public:
  double seconds() const {
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
    return time.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool isFile(const Input& input) { return input.read_file != nullptr; }

/// Loads the document. A .gltf may be replaced after it was read, and its old buffer removed: then
/// the new one is loaded.
Result load(Input& input, Document& document) {
  constexpr int kMostTries = 10;
  Result loaded;
  for (int i = 0; i < kMostTries; ++i) {
    document = {};
    loaded = loadDocument(input.bytes, input.read_file, document);
    std::vector<uint8_t> now;
    if (loaded.ok() || !isFile(input) || !readFile(input.path, now).ok() ||
        std::equal(now.begin(), now.end(), input.bytes.begin(), input.bytes.end()))
      break;
    input.owned = std::move(now);
    input.bytes = input.owned;
  }
  return loaded;
}

/// Where the result goes: to a file with others next to it, or to memory.
struct Output {
  std::vector<uint8_t>* bytes = nullptr;
  std::unique_ptr<Destination> destination;  ///< null for an output in memory
  FilesInUse* files = nullptr;               ///< null: nobody asks
  Container container;

  Result open(const ListedSink& listed, bool with_fallback, GlbVersion glb_version) {
    const Sink& sink = listed.sink;
    bytes = sink.bytes;
    files = listed.files;
    if (files != nullptr) *files = {};
    if (bytes != nullptr && with_fallback) {
      return error("", "a fallback is a second file; name a file for the output");
    }
    if (bytes == nullptr) {
      destination = std::make_unique<Destination>(sink.path, listed.temporaries);
      MCC_GLTF_TRY(destination->check(with_fallback));
      container = destination->container();
    }
    container.glb_version = static_cast<uint32_t>(glb_version);
    return {};
  }

  Result write(Package package) {
    if (destination) return destination->write(package);
    *bytes = std::move(package.main);
    return {};
  }

  Result commit() {
    if (destination == nullptr) return {};
    MCC_GLTF_TRY(destination->commit());
    if (files != nullptr) destination->listFiles(*files);
    return {};
  }
};

/// Lists the files of a source. `images` are the image files that it names; those that the document
/// still names were not embedded.
void listInput(const Input& input, const Document& document, const std::vector<std::string>& images,
               FilesInUse& files) {
  const fs::path folder = folderOf(input.path);
  files.input = {input.path};
  files.other_input.clear();
  for (const std::string& path : filesOf(document.json, "buffers")) {
    files.input.push_back(folder / pathOf(path));
  }
  const std::vector<std::string> left = filesOf(document.json, "images");
  const std::set<std::string> apart(left.begin(), left.end());
  for (const std::string& path : images) {
    (apart.contains(path) ? files.other_input : files.input).push_back(folder / pathOf(path));
  }
}

/// Loads the source for an output. For a GLB, image files move into its buffers.
Result loadFor(const Output& output, Input& input, Document& document) {
  MCC_GLTF_TRY(load(input, document));
  if (isFile(input) && output.destination) {
    MCC_GLTF_TRY(output.destination->checkSource(input.path, document.json));
  }
  const std::vector<std::string> images = filesOf(document.json, "images");
  if (!output.container.is_gltf) MCC_GLTF_TRY(embedImages(input.read_file, document));
  if (isFile(input) && output.files != nullptr) {
    listInput(input, document, images, *output.files);
  }
  return {};
}

/// Adds the files that the JSON still names, which must be where a loader of the output looks for
/// them.
Result addFilesBeside(const Json& json, bool with_buffers, const Input& input, const Output& output,
                      Package& package, std::vector<std::string>& notes) {
  if (isFile(input) && output.destination) {
    if (output.destination->isBeside(input.path)) return {};
    return addCopies(json, with_buffers, input.read_file, package, notes);
  }
  for (const std::string& path : filesBeside(json)) {
    notes.push_back("\"" + path + "\" stays a separate file; put it next to the output");
  }
  return {};
}

/// The buffer of a layout that borrows everything it holds.
BufferContent contentOf(const Layout& layout) {
  return {layout.byte_count, [&layout](std::span<uint8_t> buffer) {
            layout.copyTo(buffer);
            return Result();
          }};
}

/// Stores an edited document and adds its other files.
Result packageDocument(const Document& document, Json json, const BufferContent& buffer,
                       const Input& input, const Output& output, Package& package,
                       std::vector<std::string>& notes) {
  MCC_GLTF_TRY(addFilesBeside(json, false, input, output, package, notes));
  if (output.container.is_gltf && !document.other_chunks.empty()) {
    notes.push_back("the GLB has chunks that a .gltf cannot hold; they are left out");
  }
  MCC_GLTF_TRY(
      writePackage(output.container, std::move(json), buffer, document.other_chunks, package));
  const auto& others = document.other_chunks;
  const bool is_glb2 = !output.container.is_gltf && glbVersion(package.main) == 2;
  if (is_glb2 && !std::all_of(others.begin(), others.end(), fitsGlb2)) {
    notes.push_back(
        "the GLB has further JSON or BIN chunks, which no buffer names and version 2 cannot hold; "
        "they are left out (glb_version 3, --glb-version 3 keep them)");
  }
  return {};
}

/// Used when nothing was compressed or decompressed: stores the source itself, or its contents in
/// the other container.
Result packageSource(const Document& document, const Input& input, const Output& output,
                     Package& package, std::vector<std::string>& notes, bool& is_copy) {
  package = {};
  const bool moves = output.destination && !output.destination->isBeside(input.path);
  const uint32_t version = output.container.glb_version;
  const bool is_container =
      document.is_glb ? !output.container.is_gltf &&
                            (version == kSmallestGlbVersion || version == document.glb_version)
                      : output.container.is_gltf;
  is_copy = is_container && (!isFile(input) || !moves || canCopyBuffers(document.json));
  if (is_copy) {
    package.main.assign(input.bytes.begin(), input.bytes.end());
    return addFilesBeside(document.json, true, input, output, package, notes);
  }
  Json json = document.json;
  const Layout layout = layOut(document, {}, json);
  return packageDocument(document, std::move(json), contentOf(layout), input, output, package,
                         notes);
}

/// Checks that existing payloads decode, because they are kept. Nothing of them is stored.
Result checkOldPayloads(const Document& document, uint32_t thread_count) {
  PayloadDecoder decoder(document, PayloadDecoder::Views::kShared);
  MCC_GLTF_TRY(decoder.open());
  return decoder.decode(thread_count, nullptr);
}

/// One conversion of a loaded document. The check comes later, on the bytes that were stored.
struct Conversion {
  Document document;
  Compressed compressed;
  std::vector<PayloadProof> proofs;  ///< of the payloads
  Package package;
};

Result packageFallback(const Container& container, Compressed& compressed, Package& package,
                       uint64_t& fallback_bytes) {
  SideFile file;
  file.kind = SideFile::Kind::kFallback;
  std::vector<uint8_t> bin(compressed.layout.byte_count);
  compressed.layout.copyTo(bin);
  MCC_GLTF_TRY(addFallback(bin, compressed.json, file.bytes));
  file.path = nameOfMade(container, file.kind, file.bytes);
  Json& buffers = compressed.json["buffers"];
  buffers[buffers.size() - 1]["uri"] = uriOf(file.path);
  fallback_bytes = file.bytes.size();
  package.beside.push_back(std::move(file));
  return {};
}

void forgetPayloads(ConvertReport& report) {
  for (PrimitiveReport& primitive : report.primitives) {
    primitive.compressed = false;
    primitive.payload = kNone;
    primitive.preview_triangle_count = 0;
  }
  report.preview_bytes = 0;
}

void tell(const ConvertOptions& options, const char* stage) {
  if (options.progress) options.progress(stage, -1);
}

Result convertInput(Input& input, const Output& output, const ConvertOptions& options,
                    Conversion& conversion, ConvertReport& report) {
  report = {};
  const Stopwatch watch;
  Document& document = conversion.document;
  Compressed& compressed = conversion.compressed;
  Package& package = conversion.package;
  tell(options, "reading");
  MCC_GLTF_TRY(loadFor(output, input, document));
  document.decoded = DecodedBytes(options.max_decoded_bytes, document.source_bytes);
  report.input_contents = contentsOf(document);
  Result refused;
  MCC_GLTF_TRY(decodeViews(options.decoders, document, nullptr, &refused));
  // With indices_only, decoded attributes would have to be stored again next to the payload.
  if (!options.indices_only) MCC_GLTF_TRY(decodeMeshes(options.decoders, document, &refused));
  report.input_bytes = document.source_bytes;
  report.notes = document.notes;
  MCC_GLTF_TRY(checkOldPayloads(document, options.thread_count));
  tell(options, "encoding");
  MCC_GLTF_TRY(compressDocument(document, options, compressed));
  // What another codec compressed and ours cannot read is no reason to refuse the rest.
  if (compressed.payloads.empty() && !refused.ok()) return refused;
  tell(options, "proving");
  const Stopwatch proving;
  MCC_GLTF_TRY(
      provePayloads(document, options.thread_count, compressed.payloads, conversion.proofs));
  std::vector<PayloadProof> proofs_of_previews;
  MCC_GLTF_TRY(
      provePayloads(document, options.thread_count, compressed.previews, proofs_of_previews));
  const double proof_seconds = proving.seconds();
  if (!compressed.payloads.empty()) storePayloads(document, compressed);
  report.notes.insert(report.notes.end(), compressed.notes.begin(), compressed.notes.end());
  report.remarks = std::move(compressed.remarks);
  report.quality_choices = std::move(compressed.quality_choices);
  addPrimitives(document, compressed, report);
  if (!compressed.payloads.empty()) {
    if (options.fallback) {
      MCC_GLTF_TRY(packageFallback(output.container, compressed, package, report.fallback_bytes));
    }
    MCC_GLTF_TRY(packageDocument(document, std::exchange(compressed.json, {}),
                                 contentOf(compressed.layout), input, output, package,
                                 report.notes));
  }
  const bool is_larger = document.is_glb != output.container.is_gltf && !options.allow_larger &&
                         package.documentBytes() >= document.source_bytes;
  if (compressed.payloads.empty() || is_larger) {
    compressed.payloads.clear();
    compressed.previews.clear();
    MCC_GLTF_TRY(packageSource(document, input, output, package, report.notes, report.copied));
    forgetPayloads(report);
    report.fallback_bytes = 0;
    if (report.copied) {
      report.remarks.push_back("nothing becomes smaller; the output is a copy of the input");
    }
  }
  for (const PayloadProof& proof : conversion.proofs) report.decode_seconds += proof.decode_seconds;
  report.encode_seconds = watch.seconds() - proof_seconds;
  // With several threads, decoding may add up to more than the clock says.
  report.check_seconds = std::max(proof_seconds - report.decode_seconds, 0.0);
  report.output_bytes = report.copied ? document.source_bytes : package.documentBytes();
  return {};
}

/// Returns the contents of the output alone: a fallback holds geometry, too.
Contents withoutFallback(Contents contents, const ConvertReport& report) {
  contents.geometry_bytes -= std::min(contents.geometry_bytes, report.fallback_bytes);
  const uint64_t known = contents.geometry_bytes + contents.image_bytes + contents.animation_bytes;
  contents.other_bytes = report.output_bytes - std::min(report.output_bytes, known);
  return contents;
}

/// Checks the stored output and completes the report.
Result checkOutput(Conversion& conversion, const ConvertOptions& options,
                   std::span<const uint8_t> stored, const FileReader& read_file,
                   ConvertReport& report) {
  if (!report.copied) {
    const Stopwatch watch;
    tell(options, "checking");
    CheckResult checked;
    const std::vector<EncodedPayload>& payloads = conversion.compressed.payloads;
    MCC_GLTF_TRY(checkConversion(conversion.document, conversion.compressed, options.decoders,
                                 stored, read_file, options.thread_count, checked));
    if (checked.decoded_bytes > decodedLimit(0, report.output_bytes)) {
      report.notes.push_back(sentence(
          "its geometry decodes to ", checked.decoded_bytes,
          " bytes, more than decoders accept by default for a file this small; they need a larger "
          "max_decoded_bytes (--max-decoded-bytes)"));
    }
    report.check_seconds += watch.seconds();
    report.output_contents = withoutFallback(checked.contents, report);
    addPayloads(payloads, conversion.proofs, report);
  }
  if (report.copied) report.output_contents = report.input_contents;
  report.checked = true;
  return {};
}

Result decodeInput(Input& input, const Output& output, const DecodeOptions& options,
                   Package& package, DecodeReport& report) {
  report = {};
  const Stopwatch watch;
  Document document;
  MCC_GLTF_TRY(loadFor(output, input, document));
  report.input_bytes = document.source_bytes;
  report.notes = document.notes;
  Decompressed decompressed;
  document.decoded = DecodedBytes(options.max_decoded_bytes, document.source_bytes);
  MCC_GLTF_TRY(decompressDocument(document, options, decompressed));
  report.notes.insert(report.notes.end(), decompressed.notes.begin(), decompressed.notes.end());
  const PayloadDecoder::Counts& counts = decompressed.decoder->counts();
  report.payload_count = static_cast<uint32_t>(counts.payloads);
  report.primitive_count = static_cast<uint32_t>(decompressed.decoder->uses().size());
  report.triangle_count = counts.triangles;
  report.wedge_count = counts.wedges;
  if (report.payload_count != 0) {
    const BufferContent buffer = {decompressed.layout.byte_count, [&](std::span<uint8_t> bytes) {
                                    return decompressed.fill(options.thread_count, bytes);
                                  }};
    MCC_GLTF_TRY(packageDocument(document, std::move(decompressed.json), buffer, input, output,
                                 package, report.notes));
  } else {
    MCC_GLTF_TRY(packageSource(document, input, output, package, report.notes, report.copied));
    if (report.copied) {
      report.notes.push_back("nothing in it is compressed; the output is a copy of the input");
    }
  }
  report.decode_seconds = watch.seconds();
  report.output_bytes = report.copied ? document.source_bytes : package.documentBytes();
  return {};
}

/// Makes notes printable, since names in them come from the file and they go to terminals.
void cleanNotes(std::vector<std::string>& notes) {
  for (std::string& note : notes) note = printable(note);
}

/// Adds the name of the input to a result. A source in memory may have no name.
Result inInput(const Input& input, Result result) {
  return input.path.empty() ? result : inFile(input.path, std::move(result));
}

/// Whether all of these bits are 0 or in a range.
bool areBits(std::initializer_list<uint8_t> all, uint32_t from, uint32_t to) {
  return std::all_of(all.begin(), all.end(),
                     [&](uint8_t bits) { return bits == 0 || (bits >= from && bits <= to); });
}

/// Whether a number is a power of two that float32 holds with all its bits.
bool isStep(double step) {
  int exponent = 0;
  return step >= 0x1p-126 && step <= 0x1p127 && std::frexp(step, &exponent) == 0.5;
}

}  // namespace

Status checkGlbVersion(GlbVersion version) {
  switch (version) {
    case GlbVersion::kSmallest:
    case GlbVersion::k2:
    case GlbVersion::k3: return {};
  }
  return fail(Error::kBadArgument, "glb_version is not 0, 2 or 3");
}

Status checkOptions(const ConvertOptions& options) {
  if (const Status checked = checkGlbVersion(options.glb_version); !checked.ok()) return checked;
  const bool has_error = options.max_position_error > 0;
  const bool has_lattice = options.position_lattice.has_value();
  const bool is_precise = options.lossless || has_error || has_lattice;
  const struct {
    bool is_refused;
    const char* why;
  } rules[] = {
      {!areBits(
           {options.position_bits, options.texcoord_bits, options.color_bits, options.weight_bits},
           1, kMaxLatticeBits),
       "the bits of positions, texture coordinates, colours and weights are 0 to 24"},
      {!areBits({options.normal_bits, options.tangent_bits}, kMinUnitBits, kMaxUnitBits),
       "the bits of normals and tangents are 0, or 2 to 16"},
      {options.grid > Grid::kPrimitive, "grid is not one of the grids"},
      {options.prefer > Preference::kSpeed, "prefer is not one of the preferences"},
      {!(options.max_position_error >= 0) || !std::isfinite(options.max_position_error),
       "max_position_error is negative or not a finite number"},
      {has_lattice && !isValidLattice(*options.position_lattice, 3),
       "the lattice of positions needs finite numbers, and a step that is greater than 0"},
      {options.step != 0 && !isStep(options.step),
       "step is not a power of two from 2^-126 to 2^127"},
      {options.step != 0 && is_precise,
       "step excludes lossless, max_position_error and position_lattice"},
      {options.quality != 0 && !(options.quality >= kLeastPixels && options.quality <= kMostPixels),
       "quality is not from 16 to 1048576 pixels"},
      {options.quality != 0 && (is_precise || options.step != 0),
       "quality excludes lossless, max_position_error, position_lattice and step"},
      {options.indices_only && options.drop_unused,
       "attributes that are not compressed keep all their vertices: unused ones can be dropped "
       "only without indices_only"},
      {options.preview_triangles != kNoPreviews && options.indices_only,
       "a preview holds attributes, too: it can be made only without indices_only"},
  };
  for (const auto& [is_refused, why] : rules) {
    if (is_refused) return fail(Error::kBadArgument, why);
  }
  return {};
}

Result convertTo(const ListedSink& sink, const Source& source, const ConvertOptions& options,
                 ConvertReport& report, const fs::path& within) {
  const Result result = guarded([&]() -> Result {
    if (const Status checked = checkOptions(options); !checked.ok()) return error("", checked.what);
    Input input;
    Output output;
    MCC_GLTF_TRY(input.open(source, within));
    MCC_GLTF_TRY(output.open(sink, options.fallback, options.glb_version));
    Conversion conversion;
    MCC_GLTF_TRY(inInput(input, convertInput(input, output, options, conversion, report)));
    MCC_GLTF_TRY(output.write(std::move(conversion.package)));
    std::vector<uint8_t> stored;
    FileReader read_file;
    if (output.destination) {
      MCC_GLTF_TRY(output.destination->readBack(stored));
      read_file = output.destination->reader();
    }
    const std::span<const uint8_t> written = output.destination ? stored : *output.bytes;
    MCC_GLTF_TRY(inInput(input, checkOutput(conversion, options, written, read_file, report)));
    return output.commit();
  });
  cleanNotes(report.notes);
  cleanNotes(report.remarks);
  for (QualityChoice& choice : report.quality_choices) choice.name = printable(choice.name);
  for (PrimitiveReport& primitive : report.primitives) {
    primitive.note = printable(primitive.note);
  }
  return result;
}

Result decodeTo(const ListedSink& sink, const Source& source, const DecodeOptions& options,
                DecodeReport& report) {
  const Result result = guarded([&]() -> Result {
    if (const Status checked = checkGlbVersion(options.glb_version); !checked.ok()) {
      return error("", checked.what);
    }
    Input input;
    Output output;
    MCC_GLTF_TRY(input.open(source));
    MCC_GLTF_TRY(output.open(sink, false, options.glb_version));
    Package package;
    MCC_GLTF_TRY(inInput(input, decodeInput(input, output, options, package, report)));
    MCC_GLTF_TRY(output.write(std::move(package)));
    return output.commit();
  });
  cleanNotes(report.notes);
  return result;
}

Result convert(const Source& source, const Sink& sink, const ConvertOptions& options,
               ConvertReport& report, FilesInUse* files) {
  return convertTo({sink, nullptr, files}, source, options, report);
}

Result decode(const Source& source, const Sink& sink, DecodeReport& report,
              const DecodeOptions& options, FilesInUse* files) {
  return decodeTo({sink, nullptr, files}, source, options, report);
}

Result convertGlb(std::span<const uint8_t> source, const ConvertOptions& options,
                  std::vector<uint8_t>& output, ConvertReport& report) {
  return convert({{}, source}, {{}, &output}, options, report);
}

Result convertFile(const fs::path& source, const fs::path& output, const ConvertOptions& options,
                   ConvertReport& report) {
  return convert({source, {}}, {output, nullptr}, options, report);
}

Result decodeGlb(std::span<const uint8_t> source, std::vector<uint8_t>& output,
                 DecodeReport& report, const DecodeOptions& options) {
  return decode({{}, source}, {{}, &output}, report, options);
}

Result decodeFile(const fs::path& source, const fs::path& output, DecodeReport& report,
                  const DecodeOptions& options) {
  return decode({source, {}}, {output, nullptr}, report, options);
}

}  // namespace mcc::gltf
