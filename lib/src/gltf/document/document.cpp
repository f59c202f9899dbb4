// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/document.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "gltf/document/package.h"
#include "mcc/decoded_limit.h"
#include "mcc/glb.h"

namespace mcc::gltf {
namespace {

constexpr uint64_t kMaxCount = uint64_t{1} << 53;
constexpr uint64_t kMaxAccessorCount = 0xffffffffu;
constexpr uint64_t kMaxStride = 65536;

struct TypeName {
  std::string_view name;
  uint32_t columns;
  uint32_t rows;
};
constexpr TypeName kTypeNames[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4},
                                   {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

bool componentTypeOf(uint64_t gl_type, ComponentType& type) {
  const auto found = std::find(std::begin(kGlTypes), std::end(kGlTypes), gl_type);
  if (found == std::end(kGlTypes)) return false;
  type = static_cast<ComponentType>(found - std::begin(kGlTypes));
  return true;
}

Result readString(const Json& object, const char* key, const std::string& path, std::string& text) {
  const Json* member = findMember(object, key);
  if (member == nullptr || !member->is_string()) {
    return error(path, "\"", key, "\" is missing or not a string");
  }
  text = member->get<std::string>();
  return {};
}

/// Checks the types of the objects and arrays that are read everywhere.
Result checkShape(const Json& json) {
  if (!json.is_object()) return error("JSON", "this is not a glTF file: the JSON is not an object");
  const Json* asset = findMember(json, "asset");
  const Json* version = asset != nullptr ? findMember(*asset, "version") : nullptr;
  if (isTileset(json)) {
    return error("JSON", "this is a tileset of 3D Tiles, not a glTF file; see gltf-mcc tiles");
  }
  if (version == nullptr || !version->is_string()) {
    return error("/asset/version", "this is not a glTF file: it has no version");
  }
  const std::string number = version->get<std::string>();
  if (!number.starts_with("2.")) {
    return error("/asset/version", "glTF ", number, " is not supported; only glTF 2.0 is");
  }
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    const Json* list = findMember(json, key);
    if (list != nullptr && !list->is_array()) return error(at("", key), "must be an array");
  }
  for (const char* key : {"accessors", "animations", "bufferViews", "buffers", "images", "meshes",
                          "nodes", "skins"}) {
    const Json* list = findMember(json, key);
    if (list == nullptr) continue;
    if (!list->is_array()) return error(at("", key), "must be an array");
    for (size_t i = 0; i < list->size(); ++i) {
      if (!(*list)[i].is_object()) return error(at(at("", key), i), "must be an object");
    }
  }
  return {};
}

/// Returns the object by which an extension codes a view, or marks a buffer whose bytes need not
/// exist; null if there is none.
const Json* codingOf(const Json& view_or_buffer, std::string& extension) {
  for (const char* name : kViewExtensions) {
    extension = name;
    if (const Json* coding = extensionOf(view_or_buffer, name)) return coding;
  }
  return nullptr;
}

bool isPlaceholder(const Json& buffer) {
  std::string ignored;
  const Json* flag = findMember(codingOf(buffer, ignored), "fallback");
  return flag != nullptr && *flag == true;
}

/// Fetches the bytes of a buffer or an image, when they are needed.
Result fetchUri(const std::string& uri, const std::string& where, const FileReader& read_file,
                std::vector<uint8_t>& bytes) {
  if (isDataUri(uri)) return decodeDataUri(uri, where, bytes);
  std::string path;
  MCC_GLTF_TRY(relativePathOf(uri, where, path));
  if (!read_file) {
    return error(where, "the file \"", path, "\" is needed; convert from a path, not from memory");
  }
  return read_file(path, where, bytes);
}

/// Loads the buffers. A file that several buffers name is read once.
class BufferLoader {
 public:
  /// `glb` is null for a .gltf.
  BufferLoader(const GlbFile* glb, const FileReader& read_file, Document& document)
      : glb_(glb), read_file_(read_file), document_(document) {}

  Result load(const Json& json, uint32_t number) {
    const std::string path = at("/buffers", number);
    uint64_t length = 0;
    MCC_GLTF_TRY(readUnsigned(json, "byteLength", path, kMaxCount, length));
    size_t chunk = kNoChunk;
    MCC_GLTF_TRY(findChunk(json, path, number, chunk));
    document_.buffers.emplace_back();
    document_.same_buffers.push_back(number);
    document_.missing_buffers.push_back(false);
    if (isPlaceholder(json)) return {};  // its views are decoded from other buffers
    if (chunk == kNoChunk && findMember(json, "uri") == nullptr) {
      document_.missing_buffers.back() = true;
      return {};
    }
    std::span<const uint8_t> bytes;
    std::string file;
    if (chunk != kNoChunk) {
      bytes = glb_->chunks[chunk].bytes;
    } else {
      MCC_GLTF_TRY(fetch(json, path, file, bytes));
    }
    if (length > bytes.size()) {
      return error(path + "/byteLength", length, " bytes are announced but only ", bytes.size(),
                   " are there");
    }
    document_.buffers.back() = bytes.first(length);
    if (chunk != kNoChunk || !file.empty()) users_[{chunk, file}].push_back(number);
    return {};
  }

  /// Finds buffers of the same file or chunk, after all were loaded.
  void findSame() {
    const auto isShorter = [&](uint32_t a, uint32_t b) {
      return document_.buffers[a].size() < document_.buffers[b].size();
    };
    for (const auto& [place, users] : users_) {
      const uint32_t longest = *std::max_element(users.begin(), users.end(), isShorter);
      for (const uint32_t user : users) document_.same_buffers[user] = longest;
    }
  }

  /// Returns the numbers of the chunks with buffers.
  std::set<size_t> usedChunks() const {
    std::set<size_t> used;
    for (const auto& [place, users] : users_) used.insert(place.first);
    return used;
  }

 private:
  static constexpr size_t kNoChunk = ~size_t{0};

  /// Finds the chunk of a GLB that holds a buffer: the one it names, or that of the first buffer.
  Result findChunk(const Json& json, const std::string& path, uint32_t number,
                   size_t& chunk) const {
    const bool has_uri = findMember(json, "uri") != nullptr;
    if (findMember(json, "chunk") == nullptr) {
      const bool is_bin = !has_uri && number == 0 && glb_ != nullptr && glb_->has_bin;
      chunk = is_bin ? glb_->bin_chunk : kNoChunk;
      return {};
    }
    uint64_t named = 0;
    MCC_GLTF_TRY(readUnsigned(json, "chunk", path, kMaxCount, named));
    const std::string where = path + "/chunk";
    if (has_uri) return error(where, "the buffer has a URI, too");
    if (glb_ == nullptr) return error(where, "only a GLB has chunks");
    if (named >= glb_->chunks.size()) {
      return error(where, "there is no chunk ", named);
    }
    if (glb_->chunks[named].type != kBinChunk) {
      return error(where, "chunk ", named, " is not a BIN chunk");
    }
    chunk = named;
    return {};
  }

  /// Fetches the bytes of a buffer. `file` stays empty for a data URI.
  Result fetch(const Json& json, const std::string& path, std::string& file,
               std::span<const uint8_t>& bytes) {
    std::string uri;
    MCC_GLTF_TRY(readString(json, "uri", path, uri));
    if (!isDataUri(uri)) {
      MCC_GLTF_TRY(relativePathOf(uri, path + "/uri", file));
      file = withoutDots(file);  // "a.bin" and "./a.bin" are one file
    }
    if (const auto known = files_.find(file); known != files_.end()) {
      bytes = known->second;
      return {};
    }
    document_.storage.emplace_back();
    MCC_GLTF_TRY(fetchUri(uri, path + "/uri", read_file_, document_.storage.back()));
    bytes = document_.storage.back();
    if (file.empty()) return {};
    files_[file] = bytes;
    document_.source_bytes += bytes.size();
    return {};
  }

  const GlbFile* glb_;
  const FileReader& read_file_;
  Document& document_;
  std::map<std::string, std::span<const uint8_t>> files_;  ///< bytes by path
  /// Numbers of buffers by the chunk or the path of the file that holds them.
  std::map<std::pair<size_t, std::string>, std::vector<uint32_t>> users_;
};

/// Parses where the bytes of a view are, and finds the part of them that exists. `json` is the
/// view, or the object that codes it.
Result parseBytes(const Document& document, const Json& json, const std::string& path,
                  BufferView& view) {
  uint64_t buffer = 0;
  MCC_GLTF_TRY(readUnsigned(json, "buffer", path, kMaxCount, buffer));
  if (buffer >= document.buffers.size()) {
    return error(path + "/buffer", "there is no buffer ", buffer);
  }
  view.buffer = static_cast<uint32_t>(buffer);
  MCC_GLTF_TRY(readOptionalUnsigned(json, "byteOffset", path, kMaxCount, view.offset));
  MCC_GLTF_TRY(readUnsigned(json, "byteLength", path, kMaxCount, view.length));
  const uint64_t available = document.buffers[buffer].size();
  if (view.offset > available || view.length > available - view.offset) {
    view.fault = document.isMissing(view.buffer)
                     ? error(path, "buffer ", buffer, " has neither a URI nor a BIN chunk")
                     : error(path, "bytes ", view.offset, " to ", view.offset + view.length,
                             " are outside buffer ", buffer, " of ", available, " bytes");
    view.offset = std::min(view.offset, available);
    view.length = std::min(view.length, available - view.offset);
  }
  if (!document.same_buffers.empty()) view.buffer = document.same_buffers[buffer];
  return {};
}

Result parseCoding(const Json& json, const std::string& path, uint64_t length, ViewCoding& coding,
                   Result& fault) {
  MCC_GLTF_TRY(readUnsigned(json, "count", path, kMaxAccessorCount, coding.count));
  uint64_t stride = 0;
  MCC_GLTF_TRY(readUnsigned(json, "byteStride", path, kMaxStride, stride));
  MCC_GLTF_TRY(readString(json, "mode", path, coding.mode));
  coding.filter = "NONE";
  if (findMember(json, "filter") != nullptr) {
    MCC_GLTF_TRY(readString(json, "filter", path, coding.filter));
  }
  coding.stride = static_cast<uint32_t>(stride);
  coding.length = coding.count * stride;
  if (coding.length != length && fault.ok()) {
    fault = error(path, "codes ", coding.length, " bytes, but the view has ", length);
  }
  return {};
}

Result parseView(const Document& document, const Json& json, const std::string& path,
                 BufferView& view) {
  MCC_GLTF_TRY(readOptionalUnsigned(json, "byteStride", path, kMaxStride, view.stride));
  std::string extension;
  const Json* coded = codingOf(json, extension);
  if (coded == nullptr) return parseBytes(document, json, path, view);
  const std::string coded_path = path + "/extensions/" + extension;
  uint64_t length = 0;
  MCC_GLTF_TRY(readUnsigned(json, "byteLength", path, kMaxCount, length));
  MCC_GLTF_TRY(parseBytes(document, *coded, coded_path, view));
  MCC_GLTF_TRY(parseCoding(*coded, coded_path, length, view.coding, view.fault));
  view.coding.extension = extension;
  return {};
}

/// Checks that `bytes` from an offset on lie inside a view.
Result checkRange(const Document& document, uint32_t view, uint64_t offset, uint64_t bytes,
                  const std::string& path) {
  if (bytes == 0) return {};
  // There are fewer than 2^32 elements, their stride is at most 2^16, and the offset at most 2^53,
  // so this cannot wrap.
  const uint64_t end = offset + bytes;
  const BufferView& from = document.views[view];
  const uint64_t available = from.isCoded() ? from.coding.length : from.length;
  if (end <= available) return {};
  if (document.isMissing(from.buffer)) return from.fault;
  return error(path, "needs ", end, " bytes of bufferView ", view, ", which has ", available);
}

/// Reads which view has some elements, and where they begin in it.
Result readPlace(const Document& document, const Json& json, const std::string& path,
                 uint32_t& view, uint64_t& offset) {
  uint64_t index = 0;
  MCC_GLTF_TRY(readUnsigned(json, "bufferView", path, kMaxCount, index));
  if (index >= document.views.size()) {
    return error(path + "/bufferView", "there is no bufferView ", index);
  }
  view = static_cast<uint32_t>(index);
  return readOptionalUnsigned(json, "byteOffset", path, kMaxCount, offset);
}

Result parseSparse(const Document& document, const Json& json, const std::string& path,
                   const Accessor& accessor, Sparse& sparse) {
  uint64_t count = 0;
  MCC_GLTF_TRY(readUnsigned(json, "count", path, accessor.count, count));
  const Json* indices = findMember(json, "indices");
  const Json* values = findMember(json, "values");
  if (indices == nullptr) return error(path, "\"indices\" is missing");
  if (values == nullptr) return error(path, "\"values\" is missing");
  uint64_t gl_type = 0;
  MCC_GLTF_TRY(readUnsigned(*indices, "componentType", path + "/indices", kMaxCount, gl_type));
  if (!componentTypeOf(gl_type, sparse.index_type) || (gl_type & 1) == 0) {
    return error(path + "/indices/componentType", gl_type, " is not an index type");
  }
  MCC_GLTF_TRY(
      readPlace(document, *indices, path + "/indices", sparse.index_view, sparse.index_offset));
  MCC_GLTF_TRY(
      readPlace(document, *values, path + "/values", sparse.value_view, sparse.value_offset));
  MCC_GLTF_TRY(checkRange(document, sparse.index_view, sparse.index_offset,
                          count * componentBytes(sparse.index_type), path + "/indices"));
  MCC_GLTF_TRY(checkRange(document, sparse.value_view, sparse.value_offset,
                          accessor.rangeBytes(count, 0), path + "/values"));
  sparse.count = count;
  return {};
}

Result parseType(const Json& json, const std::string& path, Accessor& accessor) {
  accessor.is_known_type = false;
  std::string type;
  MCC_GLTF_TRY(readString(json, "type", path, type));
  uint64_t gl_type = 0;
  MCC_GLTF_TRY(readUnsigned(json, "componentType", path, kMaxCount, gl_type));
  for (const TypeName& name : kTypeNames) {
    if (name.name != type) continue;
    accessor.columns = name.columns;
    accessor.rows = name.rows;
    accessor.is_known_type = componentTypeOf(gl_type, accessor.component_type);
  }
  return {};
}

/// An error concerns only this accessor.
Result parseAccessor(const Document& document, const Json& json, const std::string& path,
                     Accessor& accessor) {
  MCC_GLTF_TRY(parseType(json, path, accessor));
  MCC_GLTF_TRY(readUnsigned(json, "count", path, kMaxAccessorCount, accessor.count));
  if (findMember(json, "bufferView") != nullptr) {
    MCC_GLTF_TRY(readPlace(document, json, path, accessor.view, accessor.offset));
  }
  if (!accessor.is_known_type) return {};
  if (const Json* flag = findMember(json, "normalized"); flag != nullptr) {
    if (!flag->is_boolean()) return error(path + "/normalized", "must be true or false");
    accessor.normalized = flag->get<bool>();
  }
  if (accessor.view != kNone) {
    const uint64_t stride = document.views[accessor.view].stride;
    const uint64_t bytes = accessor.elementBytes();
    if (stride != 0 && stride < bytes) {
      return error(path, "elements of ", bytes, " bytes do not fit the stride ", stride,
                   " of bufferView ", accessor.view);
    }
    MCC_GLTF_TRY(checkRange(document, accessor.view, accessor.offset,
                            accessor.rangeBytes(accessor.count, stride), path));
  }
  if (const Json* sparse = findMember(json, "sparse"); sparse != nullptr) {
    MCC_GLTF_TRY(parseSparse(document, *sparse, path + "/sparse", accessor, accessor.sparse));
  }
  return {};
}

/// Finds the primitives, and who uses which view and accessor.
class UseFinder {
 public:
  explicit UseFinder(Document& document) : document_(document), root_(document.json) {}

  void run() {
    document_.foreign = findForeignReferences(root_);
    for (const uint64_t index : document_.foreign.accessors) {
      if (index < document_.accessors.size()) document_.accessors[index].is_foreign = true;
    }
    for (const Json& mesh : arrayOf(root_, "meshes")) addPrimitives(mesh);
    addScene();
    addViews();
  }

 private:
  Accessor* accessorOf(const Json& number) {
    const uint32_t index = indexOf(&number, document_.accessors.size());
    return index == kNone ? nullptr : &document_.accessors[index];
  }

  void addPrimitives(const Json& mesh) {
    PrimitiveRef ref = {static_cast<uint32_t>(document_.first_primitive_of.size()), 0};
    document_.first_primitive_of.push_back(static_cast<uint32_t>(document_.primitives.size()));
    for (const Json& json : arrayOf(mesh, "primitives")) {
      Primitive& primitive = document_.primitives.emplace_back();
      primitive.ref = ref;
      primitive.json = &json;
      const Json* const mode = findMember(json, "mode");
      if (mode != nullptr && !asUnsigned(*mode, primitive.mode)) primitive.mode = 0;
      addAccessors(json, primitive);
      addExtensions(json);
      ++ref.primitive;
    }
    for (const std::string_view path : kMeshExtensionAccessors) {
      visitPath(&mesh, path, [&](const Json& number) {
        if (Accessor* accessor = accessorOf(number)) ++accessor->extension_uses;
      });
    }
  }

  void addAccessors(const Json& json, Primitive& primitive) {
    if (const Json* attributes = findMember(json, "attributes")) {
      addMap(*attributes, "attributes", kNone, primitive);
    } else {
      note("", "\"attributes\" is missing", primitive);
    }
    if (const Json* targets = findMember(json, "targets")) addTargets(*targets, primitive);
    if (const Json* indices = findMember(json, "indices")) {
      primitive.indices = numberOf(*indices, "indices", primitive);
    }
  }

  void addMap(const Json& map, const std::string& path, uint32_t target, Primitive& primitive) {
    if (!map.is_object()) return note(path, "must be an object", primitive);
    for (const auto& [name, value] : map.items()) {
      primitive.attributes.push_back({name, target, numberOf(value, at(path, name), primitive)});
    }
  }

  void addTargets(const Json& targets, Primitive& primitive) {
    if (!targets.is_array()) return note("targets", "must be an array", primitive);
    primitive.target_count = static_cast<uint32_t>(targets.size());
    for (uint32_t i = 0; i < targets.size(); ++i)
      addMap(targets[i], at("targets", i), i, primitive);
  }

  uint32_t numberOf(const Json& json, const std::string& path, Primitive& primitive) {
    uint64_t index = 0;
    if (!asUnsigned(json, index)) {
      note(path, "must be the number of an accessor", primitive);
    } else if (index >= document_.accessors.size()) {
      note(path, "there is no accessor " + std::to_string(index), primitive);
    } else {
      ++document_.accessors[index].primitive_uses;
      return static_cast<uint32_t>(index);
    }
    return kNone;
  }

  static void note(std::string where, std::string what, Primitive& primitive) {
    if (primitive.fault.ok()) primitive.fault = error(std::move(where), std::move(what));
  }

  void addExtensions(const Json& json) {
    visitExtensionAccessors(json, [&](const Json& number, ExtensionAccessor) {
      if (Accessor* accessor = accessorOf(number)) ++accessor->extension_uses;
    });
    if (const Json* extension = extensionOf(json, kExtensionName)) {
      visitFilledAccessors(json, *extension, [&](uint64_t index) {
        if (index < document_.accessors.size()) document_.accessors[index].is_filled = true;
      });
    }
  }

  void addScene() {
    const auto add = [&](const Json& number) {
      if (Accessor* accessor = accessorOf(number)) accessor->is_in_scene = true;
    };
    for (const std::string_view path : kAnimationAccessors) visitPath(&root_, path, add);
    visitPath(&root_, kInstanceAccessors, add);
  }

  void addViews() {
    std::vector<BufferView>& views = document_.views;
    std::vector<bool> is_referred(views.size(), false);
    visitViewReferences(root_, [&](const Json& number, uint32_t) {
      const uint32_t view = indexOf(&number, views.size());
      if (view != kNone) is_referred[view] = true;
    });
    std::set<std::pair<uint32_t, uint64_t>> begins;
    for (size_t i = 0; i < views.size(); ++i) {
      if (is_referred[i]) begins.emplace(views[i].buffer, views[i].offset);
    }
    const Json& json = arrayOf(root_, "bufferViews");
    for (size_t i = 0; i < views.size(); ++i) {
      if (document_.foreign.views.contains(i)) {
        views[i].use = ViewUse::kUnknown;
      } else if (!is_referred[i]) {
        const bool is_free =
            isOneByte(json[i]) && begins.contains({views[i].buffer, views[i].offset});
        views[i].use = is_free ? ViewUse::kFree : ViewUse::kUnknown;
      }
    }
  }

  static bool isOneByte(const Json& view) {
    uint64_t length = 0;
    if (!asUnsigned(findMember(view, "byteLength"), length) || length != 1) return false;
    for (const char* key : {"byteStride", "target", "extensions"}) {
      if (findMember(view, key) != nullptr) return false;
    }
    return true;
  }

  Document& document_;
  const Json& root_;
};

/// Says once how many views are not whole; images in them have no other note.
void noteFaults(Document& document) {
  const auto isFaulty = [](const BufferView& view) { return !view.fault.ok(); };
  const auto first = std::find_if(document.views.begin(), document.views.end(), isFaulty);
  const auto count = std::count_if(document.views.begin(), document.views.end(), isFaulty);
  if (count == 0) return;
  document.notes.push_back(
      first->fault.message() + "; what needs " +
      (count == 1 ? "it" : "such buffer views, of which there are " + std::to_string(count) + ",") +
      " is left as it was");
}

Result loadTables(Document& document) {
  const Json& views = arrayOf(document.json, "bufferViews");
  document.views.resize(views.size());
  for (size_t i = 0; i < views.size(); ++i) {
    MCC_GLTF_TRY(parseView(document, views[i], at("/bufferViews", i), document.views[i]));
  }
  const Json& accessors = arrayOf(document.json, "accessors");
  document.accessors.resize(accessors.size());
  for (size_t i = 0; i < accessors.size(); ++i) {
    Accessor& accessor = document.accessors[i];
    accessor.fault = parseAccessor(document, accessors[i], at("/accessors", i), accessor);
  }
  noteFaults(document);
  UseFinder(document).run();
  return {};
}

/// Returns the accessors that payloads fill, according to the extension objects of the primitives.
std::set<uint64_t> compressedAccessors(const Json& root) {
  std::set<uint64_t> compressed;
  visitPrimitives(root, [&](const PrimitiveRef&, const Json& primitive) {
    const Json* extension = extensionOf(primitive, kExtensionName);
    if (extension == nullptr) return;
    visitFilledAccessors(primitive, *extension,
                         [&](uint64_t accessor) { compressed.insert(accessor); });
  });
  return compressed;
}

bool isAt(const Json& object, const char* key, uint64_t number) {
  uint64_t value = 0;
  return asUnsigned(findMember(object, key), value) && value == number;
}

/// Removes a fallback from a document whose buffer `number` does not exist. Returns false, and
/// changes nothing, when anything but compressed accessors may need that buffer.
bool removeFallback(size_t number, Json& json) {
  const Json& buffers = arrayOf(json, "buffers");
  if (number + 1 != buffers.size()) return false;  // the others would get new numbers
  const Json& views = arrayOf(json, "bufferViews");
  size_t view_count = views.size();
  while (view_count != 0 && isAt(views[view_count - 1], "buffer", number)) --view_count;
  if (view_count == views.size()) return false;
  for (size_t i = 0; i < view_count; ++i) {
    if (isAt(views[i], "buffer", number)) return false;
  }
  if (findForeignReferences(json).keep_numbers) return false;
  const std::set<uint64_t> compressed = compressedAccessors(json);
  bool is_needed = false;
  visitViewReferences(json, [&](const Json& reference, uint32_t accessor) {
    is_needed |= indexOf(&reference, view_count) == kNone && !compressed.contains(accessor);
  });
  if (is_needed) return false;
  if (!compressed.empty() && *compressed.rbegin() >= arrayOf(json, "accessors").size()) {
    return false;
  }
  Json* const accessors = compressed.empty() ? nullptr : &json["accessors"];
  for (const uint64_t index : compressed) {
    Json& accessor = (*accessors)[index];
    uint64_t view = 0;
    if (!asUnsigned(findMember(accessor, "bufferView"), view) || view < view_count) continue;
    for (const char* key : {"bufferView", "byteOffset", "sparse"}) accessor.erase(key);
  }
  json["bufferViews"].erase(json["bufferViews"].begin() + static_cast<ptrdiff_t>(view_count),
                            json["bufferViews"].end());
  json["buffers"].erase(&json["buffers"][number]);
  return true;
}

struct ImageFile {
  std::span<const uint8_t> bytes;
  uint32_t view = kNone;  ///< the view it became, for all images that name it
  bool is_missing = false;
};

void addView(ImageFile& file, Document& document) {
  const size_t buffer = document.buffers.size();
  document.source_bytes += file.bytes.size();
  document.buffers.push_back(file.bytes);
  document.json["buffers"].push_back({{"byteLength", file.bytes.size()}});
  document.json["bufferViews"].push_back({{"buffer", buffer}, {"byteLength", file.bytes.size()}});
  file.view = static_cast<uint32_t>(document.views.size());
  document.views.push_back({static_cast<uint32_t>(buffer), 0, file.bytes.size(), 0, {}, {}, {}});
}

Result embedImage(const FileReader& read_file, size_t index,
                  std::map<std::string, ImageFile>& files, Document& document) {
  const std::string path = at("/images", index);
  const Json& image = document.json["images"][index];
  std::string uri;
  MCC_GLTF_TRY(readString(image, "uri", path, uri));
  if (isDataUri(uri)) return {};
  std::string name;
  MCC_GLTF_TRY(relativePathOf(uri, path + "/uri", name));
  const auto [found, is_new] = files.try_emplace(name);
  ImageFile& file = found->second;
  if (is_new) {
    document.storage.emplace_back();
    const Result read = fetchUri(uri, path + "/uri", read_file, document.storage.back());
    if (!read.ok()) document.notes.push_back(read.message() + "; it stays a separate file");
    file.is_missing = !read.ok();
    file.bytes = document.storage.back();
  }
  if (file.is_missing) return {};
  const std::string type = imageTypeOf(file.bytes);
  if (type.empty()) {
    document.notes.push_back(path + ": is not a known type of image; it stays a separate file");
    return {};
  }
  if (file.view == kNone) addView(file, document);
  // The reference from before may be invalid, because the root may have got new members.
  Json& moved = document.json["images"][index];
  moved.erase("uri");
  moved["bufferView"] = file.view;
  if (findMember(moved, "mimeType") == nullptr) moved["mimeType"] = type;
  return {};
}

}  // namespace

std::vector<uint32_t> Accessor::views() const {
  std::vector<uint32_t> views;
  if (view != kNone) views.push_back(view);
  if (sparse.count != 0) views.insert(views.end(), {sparse.index_view, sparse.value_view});
  return views;
}

DecodedBytes::DecodedBytes(uint64_t max_decoded_bytes, uint64_t file_bytes)
    : limit_(decodedLimit(max_decoded_bytes, file_bytes)), file_bytes_(file_bytes) {}

void DecodedBytes::add(uint64_t bytes) {
  total_ = bytes > ~uint64_t{0} - total_ ? ~uint64_t{0} : total_ + bytes;
}

Result DecodedBytes::check() const {
  if (total_ <= limit_) return {};
  return error("", "its ", file_bytes_, " bytes ask for ", total_,
               " bytes of decoded geometry; the limit is ", limit_,
               ", which max_decoded_bytes (--max-decoded-bytes) raises");
}

Result toResult(const Status& status, const std::string& where) {
  if (status.ok()) return {};
  std::string what = status.what;
  if (what.empty()) what = "error " + std::to_string(static_cast<int>(status.error));
  if (status.offset_bytes != Status::kNoOffset) {
    what += " (byte " + std::to_string(status.offset_bytes) + " of the payload)";
  }
  return error(where, what);
}

Result loadDocument(std::span<const uint8_t> file, const FileReader& read_file,
                    Document& document) {
  document = {};
  document.source_bytes = file.size();
  if (file.empty()) return error("", "the file is empty");
  document.is_glb = isGlb(file);
  GlbFile glb;
  if (document.is_glb) {
    MCC_GLTF_TRY(readGlb(file, glb));
    document.glb_version = glb.version;
    if (glb.has_trailing_bytes) {
      document.notes.push_back("bytes after the end of the GLB were ignored");
    }
  } else {
    if (!isJsonText(file)) {
      return error("byte 0", "this is not a glTF file: neither a GLB nor JSON");
    }
    glb.json = file;
  }
  MCC_GLTF_TRY(parseJson(glb.json, document.json));
  MCC_GLTF_TRY(checkShape(document.json));
  const Json& buffers = arrayOf(document.json, "buffers");
  BufferLoader loader(document.is_glb ? &glb : nullptr, read_file, document);
  for (uint32_t i = 0; i < buffers.size(); ++i) {
    Result loaded = loader.load(buffers[i], i);
    const bool is_missing = loaded.ok() && document.missing_buffers[i];
    if (loaded.ok() && !is_missing) continue;
    if (removeFallback(i, document.json)) {
      if (is_missing) loaded = error(at("/buffers", i), "has neither a URI nor a BIN chunk");
      document.notes.push_back(loaded.message() + "; this fallback is not needed");
      break;
    }
    if (!is_missing) return loaded;
  }
  loader.findSame();
  document.other_chunks = glb.otherChunks(loader.usedChunks());
  return loadTables(document);
}

Result embedImages(const FileReader& read_file, Document& document) {
  if (document.is_glb) return {};
  std::map<std::string, ImageFile> files;
  const size_t image_count = arrayOf(document.json, "images").size();
  for (size_t i = 0; i < image_count; ++i) {
    if (findMember(document.json["images"][i], "uri") != nullptr) {
      MCC_GLTF_TRY(embedImage(read_file, i, files, document));
    }
  }
  return {};
}

}  // namespace mcc::gltf
