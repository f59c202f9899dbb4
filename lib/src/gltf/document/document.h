// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A loaded glTF file: its JSON as it was, its buffers, and typed tables of the JSON's buffer views,
// accessors and primitives, with who uses which. The ranges of all views and accessors have been
// checked. What is wrong with one of them is its `fault`, and concerns only who needs it; what is
// wrong with the file as a whole keeps it from being loaded.
#ifndef MCC_GLTF_DOCUMENT_DOCUMENT_H_
#define MCC_GLTF_DOCUMENT_DOCUMENT_H_

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/document/glb.h"
#include "gltf/document/references.h"
#include "host/result.h"
#include "json/json.h"
#include "mcc/status.h"
#include "mcc/types.h"

namespace mcc::gltf {

/// How an extension codes the elements of a buffer view.
struct ViewCoding {
  /// "EXT_meshopt_compression" or "KHR_meshopt_compression"; empty: the view is not coded.
  std::string extension;
  std::string mode;
  std::string filter;
  uint64_t count = 0;
  uint32_t stride = 0;
  uint64_t length = 0;       ///< bytes of all elements
  uint32_t decoded = kNone;  ///< index into Document::storage; kNone: not decoded
};

/// Who needs a buffer view.
enum class ViewUse : uint8_t {
  kReferred,  ///< only places that glTF and the extensions on our list define refer to it
  kUnknown,   ///< something we do not understand may refer to it, so its bytes are kept
  /// Nothing refers to it. It only keeps a number in use that was freed before others which must
  /// stay; its one byte belongs to another view. Nobody else makes such views, so the number can be
  /// used again.
  kFree,
};

struct BufferView {
  uint32_t buffer = 0;  ///< `buffer`, `offset` and `length` locate its bytes, coded or not
  uint64_t offset = 0;
  uint64_t length = 0;
  uint64_t stride = 0;  ///< 0: elements are packed
  ViewCoding coding;
  /// Why its bytes cannot be used as the JSON says. The range above is then the part of them that
  /// exists, which may be empty.
  Result fault;
  ViewUse use = ViewUse::kReferred;

  bool isCoded() const { return !coding.extension.empty(); }
};

/// The numbers that glTF gives the component types, in the order of ComponentType.
inline constexpr uint32_t kGlTypes[] = {5120, 5121, 5122, 5123, 5125, 5126, 5124};

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
  uint32_t view = kNone;  ///< kNone: all elements are zero, apart from `sparse`
  uint64_t offset = 0;
  uint64_t count = 0;
  ComponentType component_type = ComponentType::kFloat32;
  bool is_known_type = true;  ///< false: a type of some extension; nothing else is set
  uint32_t columns = 1;       ///< above 1: a matrix
  uint32_t rows = 1;          ///< components of a vector or of a matrix column
  bool normalized = false;
  Sparse sparse;
  /// For an accessor that an extension of primitives fills: the index into Document::storage of its
  /// packed elements, and the view they came from.
  uint32_t decoded = kNone;
  uint32_t decoded_from = kNone;
  /// Why its elements cannot be read. What the JSON says may then not fit its view, and what could
  /// not be parsed has the value above.
  Result fault;
  // Who names it.
  uint32_t primitive_uses = 0;  ///< attributes, morph targets and indices of primitives
  uint32_t extension_uses = 0;  ///< members of the extensions of meshes and primitives
  bool is_filled = false;       ///< a payload of ours fills it
  bool is_in_scene = false;     ///< a skin, an animation or instances of a node
  bool is_foreign = false;      ///< perhaps something that we do not understand

  /// Returns the buffer views that it reads, of which there may be none.
  std::vector<uint32_t> views() const;
  bool isUsedOutsideMeshes() const { return is_in_scene || is_foreign; }
  uint32_t componentCount() const { return columns * rows; }
  uint32_t tightBytes() const { return componentCount() * componentBytes(component_type); }
  /// Bytes between the columns of a matrix: glTF starts each at a multiple of four.
  uint32_t columnBytes() const {
    const uint32_t bytes = rows * componentBytes(component_type);
    return columns == 1 ? bytes : (bytes + 3) & ~3u;
  }
  /// Bytes of an element in a buffer.
  uint32_t elementBytes() const { return columns * columnBytes(); }
  /// Bytes from the first element to the end of the last one. `stride` 0: elements are packed.
  uint64_t rangeBytes(uint64_t element_count, uint64_t stride) const {
    if (element_count == 0) return 0;
    // The last element may lack the padding of its last column.
    const uint32_t last = (columns - 1) * columnBytes() + rows * componentBytes(component_type);
    return (element_count - 1) * (stride == 0 ? elementBytes() : stride) + last;
  }
};

/// A primitive of a mesh.
struct Primitive {
  struct Attribute {
    std::string_view name;
    uint32_t target = kNone;    ///< morph target it belongs to; kNone: the base mesh
    uint32_t accessor = kNone;  ///< kNone: there is no such accessor
  };
  PrimitiveRef ref;
  const Json* json = nullptr;         ///< in Document::json
  std::vector<Attribute> attributes;  ///< those of the base mesh first, in the order of the JSON
  uint32_t target_count = 0;
  uint32_t indices = kNone;  ///< accessor; kNone: there is none
  uint64_t mode = 4;         ///< 0 if it is no number
  /// What is wrong with the numbers of its accessors. Its place begins at the primitive.
  Result fault;
};

/// Adds up the bytes that decoding a document takes, before memory is taken for them.
class DecodedBytes {
 public:
  /// Counts without a limit.
  DecodedBytes() = default;
  /// Sets the limit from max_decoded_bytes and file_bytes, see decodedLimit().
  DecodedBytes(uint64_t max_decoded_bytes, uint64_t file_bytes);

  /// Adds to the sum without a check. The sum saturates.
  void add(uint64_t bytes);
  /// Fails when the sum is above the limit. The message states both and says how to raise the
  /// limit.
  Result check() const;

  uint64_t total() const { return total_; }
  /// Returns how much of the limit accessors may take that have no bytes in the file. They need a
  /// bound of their own, because a file can claim them at no cost.
  uint64_t zeroLimit() const { return limit_ / 32; }

 private:
  uint64_t limit_ = ~uint64_t{0};
  uint64_t file_bytes_ = 0;
  uint64_t total_ = 0;
};

struct Document {
  Json json;
  bool is_glb = false;
  uint32_t glb_version = 2;  ///< of a GLB
  std::vector<std::span<const uint8_t>> buffers;
  /// Marks the buffers without a URI whose bytes are not in the file, either. glTF allows them,
  /// because extensions may provide the bytes. They have no bytes here.
  std::vector<bool> missing_buffers;
  /// For each buffer, the number of the longest buffer that comes from the same file or chunk,
  /// which may be itself. Buffer views refer to that number, so that the bytes are kept once.
  /// Empty: no file is used twice.
  std::vector<uint32_t> same_buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<Primitive> primitives;         ///< in the order of the JSON
  std::vector<uint32_t> first_primitive_of;  ///< number of the first primitive of each mesh
  ForeignReferences foreign;
  std::vector<GlbChunk> other_chunks;  ///< that are neither the JSON nor a buffer
  uint64_t source_bytes = 0;           ///< size of the file and of the files its buffers came from
  /// The bytes that were decoded, apart from our own payloads. There is no limit unless one is set
  /// after loading.
  DecodedBytes decoded;
  std::vector<std::string> notes;
  /// Owns the buffers that are not part of the file, and everything that was decoded.
  std::vector<std::vector<uint8_t>> storage;

  const Primitive& primitive(const PrimitiveRef& ref) const {
    return primitives[first_primitive_of[ref.mesh] + ref.primitive];
  }
  bool isMissing(uint32_t buffer) const {
    return buffer < missing_buffers.size() && missing_buffers[buffer];
  }
};

/// Converts a codec status to a result.
Result toResult(const Status& status, const std::string& where);

/// Fetches a file. The path must be one that relativePathOf() has accepted.
using FileReader =
    std::function<Result(const std::string& path, const std::string& where, std::vector<uint8_t>&)>;

/// Loads a GLB or the JSON of a .gltf. `file` must outlive the document. Errors: it is no GLB or
/// JSON, its arrays do not have the types of glTF, or a file that it names cannot be read.
/// read_file  fetches buffers; null: every buffer must be inside the file.
Result loadDocument(std::span<const uint8_t> file, const FileReader& read_file, Document& document);

/// Moves the image files of a .gltf into buffer views, so that a GLB in another folder still has
/// them. Images in data URIs stay as they are. Does nothing to a GLB.
Result embedImages(const FileReader& read_file, Document& document);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_DOCUMENT_H_
