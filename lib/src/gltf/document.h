// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A loaded glTF file: its JSON as it was, its buffers, and typed tables of the JSON's buffer views
// and accessors, all of whose ranges were checked.
#ifndef MCC_GLTF_DOCUMENT_H_
#define MCC_GLTF_DOCUMENT_H_

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gltf/decoded_bytes.h"
#include "gltf/glb.h"
#include "gltf/json.h"
#include "mcc/types.h"

namespace mcc::gltf {

/// How an extension codes the elements of a buffer view.
struct ViewCoding {
  std::string
      extension;  ///< "EXT_meshopt_compression" or its successor; empty: the view is not coded
  std::string mode;
  std::string filter;
  uint64_t count = 0;
  uint32_t stride = 0;
  uint64_t length = 0;       ///< of the elements
  uint32_t decoded = kNone;  ///< Document::storage that has them; kNone: not decoded
};

struct BufferView {
  uint32_t buffer = 0;  ///< these three say where its bytes are, coded or not
  uint64_t offset = 0;
  uint64_t length = 0;
  uint64_t stride = 0;  ///< 0: tight
  ViewCoding coding;

  bool isCoded() const { return !coding.extension.empty(); }
  /// Bytes that accessors may use.
  uint64_t elementsLength() const { return isCoded() ? coding.length : length; }
};

/// Values that replace some elements of an accessor.
struct Sparse {
  uint64_t count = 0;  ///< 0: the accessor is not sparse
  uint32_t index_view = 0;
  uint64_t index_offset = 0;
  ComponentType index_type = ComponentType::kUint16;
  uint32_t value_view = 0;
  uint64_t value_offset = 0;
};

struct Accessor {
  uint32_t view = kNone;  ///< kNone: zeros, apart from `sparse`
  uint64_t offset = 0;
  uint64_t count = 0;
  ComponentType component_type = ComponentType::kFloat32;
  bool is_known_type = true;  ///< false: a type of some extension; nothing else is filled in
  uint32_t columns = 1;       ///< above 1: a matrix
  uint32_t rows = 1;          ///< components of a vector or of a matrix column
  bool normalized = false;
  Sparse sparse;
  /// Of one that an extension of primitives fills: Document::storage with its tight elements, and the view they came from.
  uint32_t decoded = kNone;
  uint32_t decoded_from = kNone;

  uint32_t componentCount() const { return columns * rows; }
  uint32_t tightBytes() const { return componentCount() * componentBytes(component_type); }
  /// Bytes between the columns of a matrix: glTF starts each at a multiple of four.
  uint32_t columnBytes() const {
    const uint32_t bytes = rows * componentBytes(component_type);
    return columns == 1 ? bytes : (bytes + 3) & ~3u;
  }
  /// Bytes of an element in a buffer.
  uint32_t elementBytes() const { return columns * columnBytes(); }
};

struct Document {
  Json json;
  bool is_glb = false;
  std::vector<std::span<const uint8_t>> buffers;
  /// By buffer: the longest of those that are the same file, whose bytes are there once; the number of others is their own.
  /// Empty: all are different. Views say this number.
  std::vector<uint32_t> same_buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<GlbChunk> other_chunks;
  uint64_t source_bytes = 0;  ///< of the file and the files its buffers came from
  /// What of it is decoded from other bytes than those of our payloads; without a limit unless one was set after loading.
  DecodedBytes decoded;
  std::vector<std::string> notes;
  /// Owns the buffers that are not part of the file, and what was decoded.
  std::vector<std::vector<uint8_t>> storage;
};

/// Fetches a file by a path that relativePathOf() found harmless.
using FileReader =
    std::function<Result(const std::string& path, const std::string& where, std::vector<uint8_t>&)>;

/// Loads a GLB or the JSON of a .gltf. `file` must outlive the document.
/// read_file   fetches buffers; null: every buffer must be inside the file.
Result loadDocument(std::span<const uint8_t> file, const FileReader& read_file, Document& document);

/// Puts the image files of a .gltf into buffer views, so that a GLB elsewhere still finds them.
/// Images inside data URIs stay as they are. Does nothing to a GLB.
Result embedImages(const FileReader& read_file, Document& document);

/// Makes a document of parts that are already in memory: JSON with at most one buffer and its
/// bytes.
Result adoptDocument(Json json, std::vector<uint8_t> bin, Document& document);

/// Parses one accessor; its views must be in `document.views`. Errors carry the path /accessors/N.
Result parseAccessor(const Document& document, const Json& json, const std::string& path,
                     Accessor& accessor);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_H_
