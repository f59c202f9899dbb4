// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A document as the files it is stored in: one GLB, or a .gltf with its buffer beside it; either with
// a fallback beside it.
#ifndef MCC_GLTF_PACKAGE_H_
#define MCC_GLTF_PACKAGE_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/document.h"

namespace mcc::gltf {

/// A file beside the main one, whose JSON names it.
struct SideFile {
  enum class Kind : uint8_t {
    kBuffer,    ///< of a .gltf; made here
    kFallback,  ///< made here
    kCopy,      ///< of a file beside the source
  };
  Kind kind = Kind::kBuffer;
  std::string path;  ///< relative to the main file, with '/'
  std::vector<uint8_t> bytes;
};

struct Package {
  std::vector<uint8_t> main;
  std::vector<SideFile> beside;

  /// Bytes of the document: main file and buffer.
  uint64_t documentBytes() const;
};

/// How a document is stored. The names are those of files beside the main one; see uriOf().
struct Container {
  bool is_gltf = false;
  std::string buffer_name;    ///< of a .gltf
  std::string fallback_name;  ///< empty where there can be none
};

/// The container of a file by its name: x.gltf has x.bin beside it, all others are GLBs. Errors: a
/// file beside it would have a name that a URI cannot have.
Result containerOf(const std::string& file_name, Container& container);

/// Stores a document whose buffer (number 0; others have a URI already) is `bin`.
/// Other chunks of a GLB have no place in a .gltf and are left out.
Result writePackage(const Container& container, Json json, std::vector<uint8_t> bin,
                    const std::vector<GlbChunk>& other_chunks, Package& package);

/// How files beside a source are fetched to be copied.
struct CopyReaders {
  FileReader buffer;
  FileReader image;  ///< fails for what lies outside of the folder of the source
};

/// Adds the files beside the source that the JSON names: those of images, of buffers, or both. Whoever made the source
/// chose the names and the contents, so only what is an image by its first bytes is copied as one, and nothing that is
/// hidden. What is not copied is noted; a URI that relativePathOf() refuses is an error.
Result addCopies(const Json& json, bool with_buffers, const CopyReaders& readers, Package& package,
                 std::vector<std::string>& notes);

/// Whether all files of the buffers may be copied under their names: none is hidden, and each is called like a buffer
/// (.bin, .glbin, .glbuf).
bool canCopyBuffers(const Json& json);

/// The JSON of a GLB or .gltf.
Result readJson(std::span<const uint8_t> file, Json& json);

/// Relative paths of the files of one list, "buffers" or "images". Refused URIs are left out.
std::vector<std::string> filesOf(const Json& json, const char* list);

/// Those of both lists.
std::vector<std::string> filesBeside(const Json& json);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_PACKAGE_H_
