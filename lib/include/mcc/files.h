// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What glb.h does, for files: adds KHR_mesh_collapse_compression to .glb and .gltf files, and
// removes it again. No exception leaves these functions; they use no globals and may run in
// parallel.
#ifndef MCC_FILES_H_
#define MCC_FILES_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "mcc/export.h"
#include "mcc/glb.h"
#include "mcc/result.h"

namespace mcc::gltf {

/// Where a document comes from.
struct Source {
  std::filesystem::path path;  ///< a .glb or .gltf file, next to its buffers and images
  /// The document itself when it is in memory; `path` is then only its name in messages. A .gltf in
  /// memory needs its buffers in data URIs. Borrowed.
  std::optional<std::span<const uint8_t>> bytes;
  /// Whether `bytes` are what the caller read from `path`. Everything is then as if only `path` was
  /// given, except that the file is not read again.
  bool is_read = false;
};

/// Where a document goes to.
struct Sink {
  /// NAME.gltf gets its buffer next to it, in NAME.<hash>.bin; any other name is that of a GLB.
  std::filesystem::path path;
  std::vector<uint8_t>* bytes = nullptr;  ///< when not null: receives a GLB, and no file is written
};

/// The files of a conversion. A list is empty where the document came from memory or went to it.
struct FilesInUse {
  std::vector<std::filesystem::path> input;         ///< counted in input_bytes, the main one first
  std::vector<std::filesystem::path> other_input;   ///< images that stay separate files
  std::vector<std::filesystem::path> output;        ///< counted in output_bytes, the main one first
  std::vector<std::filesystem::path> other_output;  ///< the fallback
};

/// Like convertGlb(), for files. The output is a copy of the source when compression gains nothing,
/// unless they differ in their container (GLB or .gltf). Where `files` is not null, it receives
/// which files were read and written.
///
/// Files are written under temporary names, read back, checked, and renamed together: after an
/// error, existing files are as they were. Source and output may be the same file. The buffer and
/// the fallback of an output have names that contain a hash of their bytes; those of the output
/// that was replaced are removed. Images of a .gltf that are separate files move into a GLB; when
/// the output is a .gltf they stay files, and are copied where it lies in another folder. Absolute
/// URIs, URIs that lead out of the folder of the source, and files above 4 GiB are refused. A pipe
/// or a device as the source is read no farther than the length in a GLB's header.
///
/// After an error the bytes of a sink in memory are unspecified, and `report` holds what was known
/// when it occurred. Safe for untrusted input. Deterministic. Inverse: decode().
/// Tests: tests/gltf/, tests/cli/.
MCC_API Result convert(const Source& source, const Sink& sink, const ConvertOptions& options,
                       ConvertReport& report, FilesInUse* files = nullptr);
/// The same, from file to file.
MCC_API Result convertFile(const std::filesystem::path& source, const std::filesystem::path& output,
                           const ConvertOptions& options, ConvertReport& report);

/// Like decodeGlb(), for files, which are treated as by convert(). Inverse: convert().
/// Tests: tests/gltf/, tests/cli/.
MCC_API Result decode(const Source& source, const Sink& sink, DecodeReport& report,
                      const DecodeOptions& options = {}, FilesInUse* files = nullptr);
/// The same, from file to file.
MCC_API Result decodeFile(const std::filesystem::path& source, const std::filesystem::path& output,
                          DecodeReport& report, const DecodeOptions& options = {});

/// Like inspectGlb(), for a file.
MCC_API Result inspectFile(const std::filesystem::path& source, bool count_codes,
                           InspectReport& report);

/// Like validateGlb(), for a file.
MCC_API Result validate(const Source& source, const ValidateOptions& options,
                        ValidationReport& report);

}  // namespace mcc::gltf

#endif  // MCC_FILES_H_
