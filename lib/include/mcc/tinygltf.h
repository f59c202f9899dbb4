// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// KHR_mesh_collapse_compression for programs that load and save with tinygltf: a thin layer over
// glb.h and files.h. Include <tiny_gltf.h> first, in the same way as the rest of the program; this
// header has only functions, which call tinygltf and gltf-mcc::gltf.
//
// Limitations of tinygltf, as of 2.7, that concern this extension and others:
// - It refuses primitives whose indices have no buffer view, as all compressed ones do:
//   "accessor[0] invalid bufferView". load() decodes a file before tinygltf sees it. Versions of
//   2024 and later load such primitives, and decode() is enough.
// - It refuses a .glb whose second buffer has no URI, as is the case for the placeholder of
//   EXT_meshopt_compression.
// - Saving drops extensions of accessors and buffer views, empty objects, and integers beyond 32
//   bits.
// - Saving as .glb stores buffer 0 in the file and all others as base64, which is a third larger.
//   decode() and encode() therefore merge all buffers into one.
// - With TINYGLTF_ENABLE_DRACO it decodes Draco's primitives itself and leaves
//   "KHR_draco_mesh_compression" in extensionsRequired.
#ifndef MCC_TINYGLTF_H_
#define MCC_TINYGLTF_H_

#include <algorithm>
#include <cctype>
#include <climits>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "mcc/files.h"
#include "mcc/glb.h"

namespace mcc::tinygltf {

/// The extension's key in Primitive::extensions.
inline constexpr const char* kExtension = gltf::kExtensionName;

using gltf::DecodeOptions;
using gltf::Result;

/// Implementation; not for callers.
namespace detail {

using ::tinygltf::Accessor;
using ::tinygltf::Model;
using ::tinygltf::Primitive;

inline constexpr int kNoView = -1;

/// Finds places in the JSON of a glTF file without parsing all of it. In text that is not JSON the
/// places are wrong or missing; this does no harm, because tinygltf refuses such text in any case.
class JsonPlaces {
 public:
  explicit JsonPlaces(const std::string& json) {
    for (size_t i = 0; i < json.size(); ++i) {
      switch (json[i]) {
        case '"': i = readString(json, i); break;
        case '{':
        case '[': open(i); break;
        case '}':
        case ']': close(i); break;
        default: break;
      }
    }
  }

  std::vector<size_t> accessors_without_view;  ///< offsets just after their opening braces
  size_t views_end = std::string::npos;        ///< the closing bracket of bufferViews
  int view_count = 0;

 private:
  size_t readString(const std::string& json, size_t begin) {
    size_t end = begin + 1;
    while (end < json.size() && json[end] != '"') end += json[end] == '\\' ? 2 : 1;
    const std::string text = json.substr(begin + 1, end - begin - 1);
    size_t next = end + 1;
    while (next < json.size() && std::isspace(static_cast<unsigned char>(json[next]))) ++next;
    if (next < json.size() && json[next] == ':') {
      if (depth_ == 1) key_ = text;
      if (depth_ == 3 && text == "bufferView") has_view_ = true;
    }
    return end;
  }

  void open(size_t at) {
    if (++depth_ != 3) return;
    element_ = at + 1;
    has_view_ = false;
  }

  void close(size_t at) {
    --depth_;
    if (depth_ == 2 && key_ == "accessors" && !has_view_)
      accessors_without_view.push_back(element_);
    if (depth_ == 2 && key_ == "bufferViews") ++view_count;
    if (depth_ == 1 && key_ == "bufferViews") views_end = at;
  }

  int depth_ = 0;
  std::string key_;  ///< the current member of the root object
  size_t element_ = 0;
  bool has_view_ = false;
};

/// Gives accessors without a buffer view a dummy one, which restore() removes after loading.
/// Returns its number, or kNoView where nothing had to be inserted.
inline int makeLoadable(std::string& json) {
  const JsonPlaces places(json);
  if (places.accessors_without_view.empty() || places.view_count == 0 ||
      places.views_end == std::string::npos) {
    return kNoView;
  }
  std::vector<std::pair<size_t, std::string>> insertions;
  const std::string reference = "\"bufferView\":" + std::to_string(places.view_count) + ",";
  for (const size_t at : places.accessors_without_view) insertions.emplace_back(at, reference);
  insertions.emplace_back(places.views_end, R"(,{"buffer":0,"byteLength":1})");
  std::sort(insertions.begin(), insertions.end());
  std::string edited;
  size_t done = 0;
  for (const auto& [at, text] : insertions) {
    edited.append(json, done, at - done).append(text);
    done = at;
  }
  json = edited.append(json, done);
  return places.view_count;
}

inline void restore(int dummy, Model& model) {
  if (dummy == kNoView) return;
  // With TINYGLTF_ENABLE_DRACO, views of what it decoded come after the dummy, which then stays.
  const auto number = static_cast<size_t>(dummy);
  if (model.bufferViews.size() == number + 1) model.bufferViews.pop_back();
  for (Accessor& accessor : model.accessors) {
    if (accessor.bufferView == dummy) accessor.bufferView = kNoView;
  }
}

inline uint32_t readU32(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) {
    value |= uint32_t{static_cast<unsigned char>(bytes[at + i])} << 8 * i;
  }
  return value;
}

inline void writeU32(std::string& bytes, size_t at, size_t value) {
  for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> 8 * i & 0xff);
}

/// Loads a GLB, and leaves compressed primitives compressed.
inline bool loadCompressed(::tinygltf::TinyGLTF& loader, Model& model, std::string* error,
                           std::string* warning, std::string file) {
  constexpr size_t kHeaderBytes = 20;  // of the file and of its first chunk
  const size_t json_bytes = file.size() < kHeaderBytes ? 0 : readU32(file, 12);
  int dummy = kNoView;
  if (json_bytes != 0 && json_bytes <= file.size() - kHeaderBytes) {
    std::string json = file.substr(kHeaderBytes, json_bytes);
    dummy = makeLoadable(json);
    json.append((4 - json.size() % 4) % 4, ' ');
    file.replace(kHeaderBytes, json_bytes, json);
    writeU32(file, 8, file.size());
    writeU32(file, 12, json.size());
  }
  if (!loader.LoadBinaryFromMemory(&model, error, warning,
                                   reinterpret_cast<const unsigned char*>(file.data()),
                                   static_cast<unsigned>(file.size()))) {
    return false;
  }
  restore(dummy, model);
  return true;
}

/// Returns a copy of everything that refers to buffers or geometry, without the pixels of images.
/// All buffers are merged into one.
inline Result geometryOf(const Model& model, Model& geometry, std::vector<size_t>& images) {
  geometry.accessors = model.accessors;
  geometry.bufferViews = model.bufferViews;
  geometry.meshes = model.meshes;
  geometry.nodes = model.nodes;
  geometry.skins = model.skins;
  geometry.scenes = model.scenes;
  geometry.defaultScene = model.defaultScene;
  geometry.cameras = model.cameras;
  geometry.materials = model.materials;
  geometry.extensionsUsed = model.extensionsUsed;
  geometry.extensionsRequired = model.extensionsRequired;
  geometry.extensions = model.extensions;
  geometry.extras = model.extras;
  geometry.asset = model.asset;
  for (const ::tinygltf::Animation& animation : model.animations) {
    // An animation without channels would be saved as "animations": null.
    if (!animation.channels.empty()) geometry.animations.push_back(animation);
  }
  for (size_t i = 0; i < model.images.size(); ++i) {
    if (model.images[i].bufferView < 0) continue;
    ::tinygltf::Image image;
    image.bufferView = model.images[i].bufferView;
    image.mimeType = "image/png";  // required by tinygltf, but never used
    geometry.images.push_back(image);
    images.push_back(i);
  }
  std::vector<size_t> begins;
  ::tinygltf::Buffer all;
  for (const ::tinygltf::Buffer& buffer : model.buffers) {
    all.data.resize((all.data.size() + 7) & ~size_t{7});
    begins.push_back(all.data.size());
    all.data.insert(all.data.end(), buffer.data.begin(), buffer.data.end());
  }
  for (size_t i = 0; i < geometry.bufferViews.size(); ++i) {
    ::tinygltf::BufferView& view = geometry.bufferViews[i];
    const std::string where = "/bufferViews/" + std::to_string(i);
    if (!view.extensions.empty()) return {where, "has extensions, which tinygltf would lose"};
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= begins.size()) {
      return {where, "has no buffer"};
    }
    view.byteOffset += begins[static_cast<size_t>(view.buffer)];
    view.buffer = 0;
  }
  if (!all.data.empty()) geometry.buffers.push_back(std::move(all));
  return {};
}

/// Removes bounds of integer accessors that do not fit an int, since tinygltf saves them as int.
/// Returns for each accessor whether its bounds were removed.
inline std::vector<bool> removeLargeBounds(Model& geometry) {
  std::vector<bool> is_removed;
  for (Accessor& accessor : geometry.accessors) {
    bool is_large = false;
    for (const auto* bounds : {&accessor.minValues, &accessor.maxValues}) {
      for (const double bound : *bounds) is_large |= !(bound <= INT_MAX && bound >= INT_MIN);
    }
    is_large &= accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (is_large) accessor.minValues = accessor.maxValues = {};
    is_removed.push_back(is_large);
  }
  return is_removed;
}

inline bool keepNoImage(::tinygltf::Image*, const int, std::string*, std::string*, int, int,
                        const unsigned char*, int, void*) {
  return true;
}

/// Copies what compressing or decoding changed into the model.
inline void takeOver(Model&& coded, const std::vector<size_t>& images,
                     const std::vector<bool>& has_large_bounds, Model& model) {
  const size_t old_count = model.accessors.size();
  model.accessors.resize(coded.accessors.size());
  for (size_t i = 0; i < coded.accessors.size(); ++i) {
    Accessor& from = coded.accessors[i];
    if (i < old_count) {  // keep what tinygltf does not save
      Accessor& to = model.accessors[i];
      if (has_large_bounds[i])
        std::tie(from.minValues, from.maxValues) = std::tie(to.minValues, to.maxValues);
      from.extensions = to.extensions;
      from.extras = to.extras;
      from.extensions_json_string = to.extensions_json_string;
      from.extras_json_string = to.extras_json_string;
    }
    model.accessors[i] = std::move(from);
  }
  for (size_t m = 0; m < model.meshes.size(); ++m) {
    for (size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      Primitive& from = coded.meshes[m].primitives[p];
      Primitive& to = model.meshes[m].primitives[p];
      to.attributes = std::move(from.attributes);
      to.targets = std::move(from.targets);
      to.indices = from.indices;
      to.mode = from.mode;
      // These extensions hold numbers of buffer views, which may have changed.
      for (const char* name : {kExtension, "KHR_draco_mesh_compression"}) {
        to.extensions.erase(name);
        const auto extension = from.extensions.find(name);
        if (extension != from.extensions.end()) to.extensions.insert(*extension);
      }
    }
  }
  for (size_t i = 0; i < images.size(); ++i) {
    model.images[images[i]].bufferView = coded.images[i].bufferView;
  }
  model.buffers = std::move(coded.buffers);
  model.bufferViews = std::move(coded.bufferViews);
  model.extensionsUsed = std::move(coded.extensionsUsed);
  model.extensionsRequired = std::move(coded.extensionsRequired);
}

/// Passes a model to change(source, output, is_copy) as a GLB, and takes over what that returns.
template <typename Change>
Result changeGeometry(Model& model, const Change& change) {
  Model geometry;
  std::vector<size_t> images;
  Result result = geometryOf(model, geometry, images);
  if (!result.ok()) return result;
  const std::vector<bool> has_large_bounds = removeLargeBounds(geometry);
  ::tinygltf::TinyGLTF codec;
  codec.SetImageLoader(keepNoImage, nullptr);
  codec.SetImageWriter(nullptr, nullptr);
  std::ostringstream stream;
  if (!codec.WriteGltfSceneToStream(&geometry, stream, false, true))
    return {"", "tinygltf cannot save the model"};
  const std::string source = std::move(stream).str();
  std::vector<uint8_t> output;
  bool is_copy = false;
  result =
      change({reinterpret_cast<const uint8_t*>(source.data()), source.size()}, output, is_copy);
  if (!result.ok() || is_copy) return result;
  Model changed;
  std::string error;
  std::string warning;
  if (!loadCompressed(codec, changed, &error, &warning, {output.begin(), output.end()}))
    return {"", "tinygltf cannot load the changed model: " + error};
  takeOver(std::move(changed), images, has_large_bounds, model);
  return {};
}

/// Loads a decoded GLB.
inline bool loadDecoded(::tinygltf::TinyGLTF& loader, Model* model, std::string* error,
                        std::string* warning, std::span<const uint8_t> glb,
                        const std::string& base_dir) {
  if (glb.size() > UINT_MAX) {  // tinygltf stores sizes in 32 bits
    if (error != nullptr) *error += "tinygltf cannot load files of 4 GB or more";
    return false;
  }
  return loader.LoadBinaryFromMemory(model, error, warning, glb.data(),
                                     static_cast<unsigned>(glb.size()), base_dir);
}

}  // namespace detail

/// Decodes all compressed primitives of a model. Their accessors then refer to plain elements, and
/// the extension is removed from primitives, extensionsUsed and extensionsRequired. All buffers
/// become one, without the payloads. Nodes, meshes, accessors and images keep their numbers. A
/// payload is decoded once, however many primitives and views name its bytes; accessors of the same
/// elements share a buffer view. A model without the extension stays as it is.
/// Errors: those of gltf::decodeGlb(), and extensions on buffer views; the model is then as it was.
/// Safe for untrusted models. May throw std::bad_alloc. Inverse: encode(). Tests: tests/tinygltf/.
inline Result decode(::tinygltf::Model& model, const DecodeOptions& options = {}) {
  const auto is_coded = [](const ::tinygltf::Primitive& primitive) {
    return primitive.extensions.contains(kExtension);
  };
  const auto has_coded = [&](const ::tinygltf::Mesh& mesh) {
    return std::any_of(mesh.primitives.begin(), mesh.primitives.end(), is_coded);
  };
  if (std::none_of(model.meshes.begin(), model.meshes.end(), has_coded)) return {};
  return detail::changeGeometry(
      model, [&](std::span<const uint8_t> source, std::vector<uint8_t>& output, bool&) {
        gltf::DecodeReport report;
        return gltf::decodeGlb(source, output, report, options);
      });
}

namespace detail {

/// tinygltf reads no other version of the container.
inline DecodeOptions withGlb2(DecodeOptions options) {
  options.glb_version = gltf::GlbVersion::k2;
  return options;
}

}  // namespace detail

/// Decodes a .glb in memory and loads it. Use it instead of loader.LoadBinaryFromMemory().
/// `base_dir` is the folder of its images. Otherwise like load().
inline bool loadFromMemory(::tinygltf::TinyGLTF& loader, ::tinygltf::Model* model,
                           std::string* error, std::string* warning,
                           std::span<const unsigned char> file, const std::string& base_dir = "",
                           const DecodeOptions& options = {}) {
  std::vector<uint8_t> glb;
  gltf::DecodeReport report;
  const Result result = gltf::decodeGlb(file, glb, report, detail::withGlb2(options));
  if (!result.ok() && error != nullptr) *error += result.message();
  return result.ok() && detail::loadDecoded(loader, model, error, warning, glb, base_dir);
}

/// Decodes a .glb or .gltf and loads it. Use it instead of loader.LoadBinaryFromFile() and
/// LoadASCIIFromFile(), with their arguments. It works with every version of tinygltf, and is
/// needed with those that refuse compressed primitives, see the top of this file. Buffers and
/// images of a .gltf become parts of one buffer. `error` and `warning` may be null. As safe for
/// untrusted input as tinygltf is. Tests: tests/tinygltf/.
inline bool load(::tinygltf::TinyGLTF& loader, ::tinygltf::Model* model, std::string* error,
                 std::string* warning, const std::string& path, const DecodeOptions& options = {}) {
  std::vector<uint8_t> glb;
  gltf::DecodeReport report;
  const std::filesystem::path source = path;
  const Result result =
      gltf::decode({source, {}}, {"decoded.glb", &glb}, report, detail::withGlb2(options));
  if (!result.ok() && error != nullptr) *error += result.message();
  const std::string base_dir = source.parent_path().string();
  return result.ok() && detail::loadDecoded(loader, model, error, warning, glb, base_dir);
}

/// Compresses the triangle primitives of a model before it is saved. Choices and payloads are the
/// same as for files in gltf-mcc::gltf, and the result is decoded and compared with the source in
/// the same way. All buffers become one. Where compression gains nothing the model stays as it is,
/// and report.copied is set. Images keep their pixels; nodes, meshes, accessors, images and the
/// buffer views of unknown extensions keep their numbers. options.fallback and options.decoders
/// have no effect.
/// Errors: the model is not valid glTF, or has extensions on buffer views; it is then as it was.
/// May throw std::bad_alloc. Inverse: decode(). Tests: tests/tinygltf/.
inline Result encode(::tinygltf::Model& model, const gltf::ConvertOptions& options,
                     gltf::ConvertReport& report) {
  gltf::ConvertOptions own = options;
  own.fallback = false;
  own.decoders = {};
  return detail::changeGeometry(
      model, [&](std::span<const uint8_t> source, std::vector<uint8_t>& output, bool& is_copy) {
        const Result result = gltf::convertGlb(source, own, output, report);
        is_copy = report.copied;
        return result;
      });
}

/// Like encode() above, without a report.
inline Result encode(::tinygltf::Model& model, const gltf::ConvertOptions& options = {}) {
  gltf::ConvertReport report;
  return encode(model, options, report);
}

}  // namespace mcc::tinygltf

#endif  // MCC_TINYGLTF_H_
