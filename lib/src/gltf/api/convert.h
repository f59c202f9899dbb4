// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// convert() and decode() for a program that removes its temporary files when a signal ends it, and
// the check of their options for all callers.
#ifndef MCC_GLTF_API_CONVERT_H_
#define MCC_GLTF_API_CONVERT_H_

#include "host/temporary_files.h"
#include "mcc/files.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// A sink that lists its temporary files and new folders while they exist.
struct ListedSink {
  Sink sink;
  TemporaryFiles* temporaries = nullptr;  ///< null: nothing is listed. Borrowed
  FilesInUse* files = nullptr;  ///< receives which files were read and written, see convert()
};

/// Checks options before any work is done for them: numbers of bits, enumerators, and what cannot
/// be combined. Whoever calls the library, from C++, from C or by the program, is refused in these
/// words.
Status checkOptions(const ConvertOptions& options);

/// Checks that a version is one of the enumerators, which callers in C may miss.
Status checkGlbVersion(GlbVersion version);

/// Like convert() and decode(), apart from the list.
/// within  a folder that contains that of the source, as NamedFile::open() takes it: the files that
///         the source names may be links to anything in it.
Result convertTo(const ListedSink& sink, const Source& source, const ConvertOptions& options,
                 ConvertReport& report, const std::filesystem::path& within = {});
Result decodeTo(const ListedSink& sink, const Source& source, const DecodeOptions& options,
                DecodeReport& report);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_API_CONVERT_H_
