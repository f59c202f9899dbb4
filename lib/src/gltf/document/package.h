// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A document as the files it is stored in: one GLB, or a .gltf with its buffer next to it; either
// may have a fallback file. The URIs and names of these files.
#ifndef MCC_GLTF_DOCUMENT_PACKAGE_H_
#define MCC_GLTF_DOCUMENT_PACKAGE_H_

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/document/document.h"

namespace mcc::gltf {

bool isDataUri(const std::string& uri);

/// Decodes "data:TYPE;base64,…" (or percent-encoded text without ";base64").
Result decodeDataUri(const std::string& uri, const std::string& where, std::vector<uint8_t>& bytes);

/// Turns a relative URI of a file at or below the model's folder into a relative path with '/'.
/// Refuses everything else: schemes, absolute paths, drive letters, `..` that leaves the folder,
/// control characters, and on Windows bytes that are not UTF-8. Percent encoding is resolved before
/// the test.
Result relativePathOf(const std::string& uri, const std::string& where, std::string& path);

/// Returns a path that relativePathOf() has accepted without its parts "." and "..".
std::string withoutDots(const std::string& path);

/// Whether every part of a relative path is the name of a file on Windows. There "NUL", "com1.bin"
/// and "CON .png" are devices in every folder, "a.bin:b" is a hidden stream of "a.bin", dots and
/// spaces at the end of a name are dropped, and bytes that are not UTF-8 name nothing.
bool isPathOnWindows(const std::string& path);

/// Whether names of files are those of Windows.
#if defined(_WIN32)
inline constexpr bool kIsWindows = true;
#else
inline constexpr bool kIsWindows = false;
#endif

/// Returns the percent-encoded URI of a file next to the model, from which relativePathOf() returns
/// the file.
std::string uriOf(const std::string& name);

/// A file next to the main one, whose JSON names it.
struct SideFile {
  enum class Kind : uint8_t {
    kBuffer,    ///< the buffer of a .gltf, made by writePackage()
    kFallback,  ///< the fallback
    kCopy,      ///< a copy of a file next to the source
  };
  Kind kind = Kind::kBuffer;
  std::string path;  ///< relative to the main file, with '/'
  std::vector<uint8_t> bytes;
};

struct Package {
  std::vector<uint8_t> main;
  std::vector<SideFile> beside;

  /// Returns the bytes of the document: main file and buffer.
  uint64_t documentBytes() const;
};

/// How a document is stored.
struct Container {
  bool is_gltf = false;
  std::string file_name;                       ///< of the main file; empty in memory
  std::string stem;                            ///< the same without its extension
  uint32_t glb_version = kSmallestGlbVersion;  ///< of a GLB; see writeGlb()
};

/// Returns the name of the buffer or the fallback of a document: x.0123456789abcdef.bin or
/// x.0123456789abcdef.fallback.bin. The digits are a hash of the bytes and of the name of the main
/// file, so that a new document can be stored beside the one that it replaces. See uriOf().
std::string nameOfMade(const Container& container, SideFile::Kind kind,
                       std::span<const uint8_t> bytes);

/// Whether a file next to the main one may have been made with it, by its name: one that
/// nameOfMade() returns, or x.bin or x.fallback.bin.
bool isNameOfMade(const Container& container, std::string_view name);

/// Finds the container of a file by its name: x.gltf has its buffer next to it, all others are
/// GLBs. Errors: a file next to it would have a name that no URI can express.
Result containerOf(const std::string& file_name, Container& container);

/// Checks that a URI can name a file next to the main one.
Result checkName(const std::string& name, const std::string& where);

/// Buffer 0 of a document.
struct BufferContent {
  uint64_t byte_count = 0;
  /// Stores its bytes, in memory that has zeros.
  std::function<Result(std::span<uint8_t> buffer)> fill;
};

/// Stores a document; buffers other than buffer 0 must have a URI already. Each byte of buffer 0 is
/// written once, at its place in the file. Other chunks of a GLB cannot be stored in a .gltf and
/// are left out, and so are those of version 3 that version 2 cannot hold.
Result writePackage(const Container& container, Json json, const BufferContent& buffer,
                    const std::vector<GlbChunk>& other_chunks, Package& package);

/// Adds the files next to the source that the JSON names: images, and buffers if `with_buffers`.
/// The author of the source chose their names and contents, so an image is copied only if its first
/// bytes are those of an image, and hidden files are never copied. A file that is not copied is
/// noted. A URI that relativePathOf() refuses is an error.
Result addCopies(const Json& json, bool with_buffers, const FileReader& read_file, Package& package,
                 std::vector<std::string>& notes);

/// Whether all files of the buffers may be copied under their names: none is hidden, and each has
/// the extension of a buffer (.bin, .glbin, .glbuf).
bool canCopyBuffers(const Json& json);

/// Whether JSON is that of a tileset of 3D Tiles, which users take for a glTF file.
bool isTileset(const Json& json);

/// Reads the JSON of a GLB or .gltf.
Result readJson(std::span<const uint8_t> file, Json& json);

/// Returns the relative paths of the files in one list, "buffers" or "images". Refused URIs are
/// left out.
std::vector<std::string> filesOf(const Json& json, const char* list);

/// Returns the files in both lists.
std::vector<std::string> filesBeside(const Json& json);

/// Returns the media type of an image by its first bytes, for the types of glTF and of its
/// extensions for textures (PNG, JPEG, KTX 2, WebP, AVIF, DDS, Basis), and an empty string for
/// everything else. What the JSON or the name of a file says does not count.
std::string imageTypeOf(std::span<const uint8_t> bytes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_PACKAGE_H_
