// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// KHR_mesh_collapse_compression for programs that load and save with tinygltf. Include
// <tiny_gltf.h> first, in the same way as the rest of the program; this header has only functions,
// which call the libraries the program links.
//
//   load(), decode()  need gltf-mcc::reader
//   encode()          needs gltf-mcc::gltf; it is left out where only the reader is installed
//
// Limitations of tinygltf, as of 2.7, that concern this extension and others:
// - It refuses primitives whose indices have no buffer view, as all compressed ones do:
//   "accessor[0] invalid bufferView". load() works around that. Versions of 2024 and later load
//   such primitives, and decode() is enough.
// - It refuses a .glb whose second buffer has no URI, as is the case for the placeholder of
//   EXT_meshopt_compression.
// - Saving drops extensions of accessors and buffer views, empty objects, and integers beyond 32
//   bits.
// - Saving as .glb stores buffer 0 in the file and all others as base64, which is a third larger.
//   decode() therefore leaves geometry in the buffer that had it, and encode() merges all buffers
//   into one.
// - With TINYGLTF_ENABLE_DRACO it decodes Draco's primitives itself and leaves
//   "KHR_draco_mesh_compression" in extensionsRequired.
#ifndef MCC_TINYGLTF_H_
#define MCC_TINYGLTF_H_

#include <algorithm>
#include <atomic>
#include <cctype>
#include <climits>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <span>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "mcc/decoded_limit.h"
#include "mcc/reader.h"

#if __has_include("mcc/glb.h")
#include "mcc/glb.h"
#define MCC_TINYGLTF_HAS_ENCODE 1
#endif

namespace mcc::tinygltf {

/// The extension's key in Primitive::extensions.
inline constexpr char kExtension[] = "KHR_mesh_collapse_compression";

/// Result of decode() and encode(): `what` is empty on success, else it reads like
/// "/meshes/0/primitives/1: what is wrong".
struct [[nodiscard]] Result {
  std::string what;

  /// Whether all went well.
  bool ok() const { return what.empty(); }
};

/// Options of decode().
struct DecodeOptions {
  /// Threads that work at the same time, on several payloads or on the blocks of one. The result
  /// does not depend on it.
  uint32_t thread_count = 1;
  /// Bounds of each payload.
  Limits limits;
  /// How much all payloads together may decode to, see decodedLimit(), which takes the model's
  /// buffers as the file; 0: the default. Checked before memory is taken.
  uint64_t max_decoded_bytes = 0;
};

/// Implementation; not for callers.
namespace detail {

using ::tinygltf::Accessor;
using ::tinygltf::Model;
using ::tinygltf::Primitive;
using ::tinygltf::Value;

struct Failure {
  std::string what;
};

[[noreturn]] inline void fail(const std::string& where, const std::string& what) {
  throw Failure{where + ": " + what};
}

inline void check(const Status& status, const std::string& where) {
  if (status.ok()) return;
  std::string what = status.what;
  if (status.offset_bytes != Status::kNoOffset) {
    what += " (byte " + std::to_string(status.offset_bytes) + " of the payload)";
  }
  fail(where, what);
}

/// Runs jobs on up to `thread_count` threads in all, those of nested calls included.
class Threads {
 public:
  explicit Threads(uint32_t thread_count) : spare_(thread_count == 0 ? 0 : thread_count - 1) {}

  /// Runs job(0) … job(count - 1), which must not throw.
  void run(size_t count, const std::function<void(size_t)>& job) {
    std::atomic<size_t> next = 0;
    const auto work = [&] {
      for (size_t i = next++; i < count; i = next++) job(i);
    };
    const auto work_and_leave = [&] {
      work();
      ++spare_;
    };
    std::vector<std::thread> threads;
    for (size_t i = 1; i < count && take(); ++i) {
      try {
        threads.emplace_back(work_and_leave);
      } catch (const std::exception&) {  // continue with the threads there are
        ++spare_;
        break;
      }
    }
    work();
    for (std::thread& thread : threads) thread.join();
  }

  /// The same for the reader, which borrows this object.
  JobRunner runner() {
    return {
        [](void* self, size_t count, void (*job)(void* job_user, size_t index), void* job_user) {
          static_cast<Threads*>(self)->run(count, [=](size_t i) { job(job_user, i); });
        },
        this};
  }

 private:
  bool take() {
    uint32_t spare = spare_;
    while (spare != 0 && !spare_.compare_exchange_weak(spare, spare - 1)) {
    }
    return spare != 0;
  }

  std::atomic<uint32_t> spare_;
};

/// Reads an index. Returns `absent` when there is no such member, unless that is kNone: then it
/// must be there.
inline uint32_t indexOf(const Value& object, const char* key, const std::string& where,
                        uint32_t absent = kNone) {
  if (!object.Has(key)) {
    if (absent == kNone) fail(where, std::string("has no ") + key);
    return absent;
  }
  const Value& value = object.Get(key);
  if (!value.IsInt() || value.GetNumberAsInt() < 0) fail(where + "/" + key, "is not an index");
  return static_cast<uint32_t>(value.GetNumberAsInt());
}

/// The type of an accessor in the codec's terms, and how its elements lie in a buffer.
struct Layout {
  AttributeFormat format;  ///< type and count only
  uint32_t columns = 1;
  uint32_t column_bytes = 0;  ///< matrices: a multiple of 4

  uint32_t tightBytes() const { return elementBytes(format); }
  uint32_t elementBytesPadded() const { return (columns * column_bytes + 3) & ~3u; }
};

inline Layout layoutOf(const Accessor& accessor, const std::string& where) {
  Layout layout;
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: layout.format.component_type = ComponentType::kInt8; break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      layout.format.component_type = ComponentType::kUint8;
      break;
    case TINYGLTF_COMPONENT_TYPE_SHORT: layout.format.component_type = ComponentType::kInt16; break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      layout.format.component_type = ComponentType::kUint16;
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      layout.format.component_type = ComponentType::kUint32;
      break;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      layout.format.component_type = ComponentType::kFloat32;
      break;
    default: fail(where, "the component type is unknown");
  }
  switch (accessor.type) {
    case TINYGLTF_TYPE_MAT2: layout.columns = 2; break;
    case TINYGLTF_TYPE_MAT3: layout.columns = 3; break;
    case TINYGLTF_TYPE_MAT4: layout.columns = 4; break;
    default: break;
  }
  const int count = ::tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  if (count <= 0) fail(where, "the type is unknown");
  layout.format.component_count = static_cast<uint8_t>(count);
  layout.format.normalized = accessor.normalized;
  layout.column_bytes = layout.tightBytes() / layout.columns;
  if (layout.columns > 1) layout.column_bytes = (layout.column_bytes + 3) & ~3u;
  return layout;
}

/// One accessor that a payload fills.
struct Filled {
  uint32_t piece = 0;
  uint32_t id = 0;  ///< of the attribute or part
  bool is_part = false;

  auto operator<=>(const Filled&) const = default;
};

/// Where the decoded elements of a Filled go in the new bytes.
struct Place {
  Layout layout;
  uint64_t offset = 0;
  uint64_t count = 0;
  uint32_t stride = 0;
  std::vector<uint8_t> tight;  ///< the elements of matrices before their columns are padded
  uint32_t user_count = 0;     ///< number of accessors that refer to it
  int view = -1;               ///< the buffer view it becomes

  bool isPadded() const { return layout.columns * layout.column_bytes != layout.tightBytes(); }
};

/// A payload, and everything that is decoded from it.
struct Job {
  std::vector<uint32_t> views;  ///< all referenced buffer views that hold its bytes
  std::string where;
  Payload payload;
  std::map<Filled, Place> places;
};

class Decoder {
 public:
  Decoder(Model& model, const DecodeOptions& options) : model_(model), options_(options) {}

  void run() {
    for (size_t m = 0; m < model_.meshes.size(); ++m) {
      for (size_t p = 0; p < model_.meshes[m].primitives.size(); ++p) {
        const Primitive& primitive = model_.meshes[m].primitives[p];
        const auto found = primitive.extensions.find(kExtension);
        if (found == primitive.extensions.end()) continue;
        addPrimitive(primitive, found->second,
                     "/meshes/" + std::to_string(m) + "/primitives/" + std::to_string(p));
      }
    }
    if (jobs_.empty()) return;
    checkDecodedBytes();
    layOut();
    decodeAll();
    store();
  }

 private:
  void addPrimitive(const Primitive& primitive, const Value& extension, const std::string& path) {
    const std::string where = path + "/extensions/" + kExtension;
    if (!extension.IsObject()) fail(where, "must be an object");
    // tinygltf stores -1 where the JSON has no mode.
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) {
      fail(path + "/mode", "must be 4 (triangles) in a compressed primitive");
    }
    const uint32_t view = indexOf(extension, "bufferView", where);
    Job& job = *jobs_[openPayload(view, where)];
    const PayloadInfo& info = job.payload.info();
    const uint32_t piece = indexOf(extension, "piece", where, 0);
    if (piece >= info.pieces.size()) fail(where + "/piece", "the payload has no such piece");
    const uint32_t part = indexOf(extension, "part", where, 0);
    if (part >= info.pieces[piece].parts.size())
      fail(where + "/part", "the piece has no such part");
    view_ = view;
    addIndices(job, info.pieces[piece], {piece, part, true}, primitive.indices, path + "/indices");
    addMap(job, piece, extension, primitive.attributes, 0, where + "/attributes");
    addTargets(job, piece, extension, primitive, where + "/targets");
  }

  /// Returns the number of the job of a buffer view. Buffer views of the same bytes share one job.
  size_t openPayload(uint32_t view, const std::string& where) {
    const auto [found, is_new] = by_view_.try_emplace(view, jobs_.size());
    if (!is_new) return found->second;
    const std::span<const uint8_t> bytes = bytesOf(view, where + "/bufferView");
    const auto [same, is_other] = by_bytes_.try_emplace({bytes.data(), bytes.size()}, jobs_.size());
    found->second = same->second;
    if (is_other) {
      auto job = std::make_unique<Job>();
      job->where = where + "/bufferView";
      check(job->payload.open(bytes, options_.limits), job->where);
      jobs_.push_back(std::move(job));
    }
    jobs_[found->second]->views.push_back(view);
    return found->second;
  }

  void checkDecodedBytes() const {
    uint64_t decoded = 0;
    for (const auto& job : jobs_) {
      for (const PieceInfo& piece : job->payload.info().pieces) {
        for (const AttributeInfo& attribute : piece.attributes) {
          decoded += uint64_t{piece.wedge_count} * elementBytes(attribute.format);
        }
        for (const PartInfo& part : piece.parts) decoded += uint64_t{12} * part.triangle_count;
      }
    }
    uint64_t file_bytes = 0;
    for (const ::tinygltf::Buffer& buffer : model_.buffers) file_bytes += buffer.data.size();
    const uint64_t limit = decodedLimit(options_.max_decoded_bytes, file_bytes);
    if (decoded <= limit) return;
    fail("/buffers", "their " + std::to_string(file_bytes) + " bytes ask for " +
                         std::to_string(decoded) + " bytes of decoded geometry; the limit is " +
                         std::to_string(limit) + ", which max_decoded_bytes raises");
  }

  /// tinygltf does not check the ranges of buffer views.
  std::span<const uint8_t> bytesOf(uint32_t number, const std::string& where) const {
    if (number >= model_.bufferViews.size()) fail(where, "there is no such buffer view");
    const ::tinygltf::BufferView& view = model_.bufferViews[number];
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model_.buffers.size()) {
      fail(where, "the buffer view has no buffer");
    }
    const auto& data = model_.buffers[static_cast<size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
      fail(where, "the buffer view leaves its buffer");
    }
    return {data.data() + view.byteOffset, view.byteLength};
  }

  const Accessor& accessorOf(int number, const std::string& where) const {
    if (number < 0 || static_cast<size_t>(number) >= model_.accessors.size()) {
      fail(where, "there is no such accessor");
    }
    return model_.accessors[static_cast<size_t>(number)];
  }

  void addIndices(Job& job, const PieceInfo& piece, const Filled& filled, int number,
                  const std::string& where) {
    const Accessor& accessor = accessorOf(number, where);
    const Layout layout = layoutOf(accessor, where);
    const uint64_t largest = layout.format.component_type == ComponentType::kUint8    ? 0xff
                             : layout.format.component_type == ComponentType::kUint16 ? 0xffff
                             : layout.format.component_type == ComponentType::kUint32 ? 0xffffffff
                                                                                      : 0;
    // The largest value of a type is not a valid index: it restarts strips.
    if (layout.format.component_count != 1 || accessor.normalized || piece.wedge_count > largest) {
      fail(where, "the accessor must be SCALAR of an unsigned type that holds all indices");
    }
    const uint64_t count = uint64_t{3} * piece.parts[filled.id].triangle_count;
    addPlace(job, filled, number, layout, count, layout.tightBytes(), where);
  }

  void addMap(Job& job, uint32_t piece, const Value& object, const std::map<std::string, int>& own,
              uint32_t target, const std::string& where) {
    const size_t slash = where.find_last_of('/');
    const Value& ids = target == 0 ? object.Get(where.substr(slash + 1)) : object;
    if (target == 0 && ids.Type() == ::tinygltf::NULL_TYPE) return;
    if (!ids.IsObject()) fail(where, "must be an object");
    for (const std::string& name : ids.Keys()) {
      const std::string at = where + "/" + name;
      const auto found = own.find(name);
      if (found == own.end()) fail(at, "the primitive has no attribute of this name");
      const uint32_t id = indexOf(ids, name.c_str(), where);
      addAttribute(job, {piece, id, false}, name, found->second, target, at);
    }
  }

  void addTargets(Job& job, uint32_t piece, const Value& extension, const Primitive& primitive,
                  const std::string& where) {
    const Value& targets = extension.Get("targets");
    if (targets.Type() == ::tinygltf::NULL_TYPE) return;
    if (!targets.IsArray() || targets.ArrayLen() != primitive.targets.size()) {
      fail(where, "must be an array of as many targets as the primitive has");
    }
    for (size_t i = 0; i < primitive.targets.size(); ++i) {
      const auto target = static_cast<uint32_t>(i + 1);
      // An empty object of the JSON is null in tinygltf.
      const Value& ids = targets.Get(static_cast<int>(i));
      if (ids.Type() == ::tinygltf::NULL_TYPE) continue;
      addMap(job, piece, ids, primitive.targets[i], target, where + "/" + std::to_string(i));
    }
  }

  void addAttribute(Job& job, const Filled& filled, const std::string& name, int number,
                    uint32_t target, const std::string& where) {
    const PieceInfo& piece = job.payload.info().pieces[filled.piece];
    if (filled.id >= piece.attributes.size()) fail(where, "the piece has no such attribute");
    Layout layout = layoutOf(accessorOf(number, where), where);
    layout.format.morph_target = static_cast<uint16_t>(target);
    const AttributeFormat named = namedFormat(name, layout.format, layout.columns > 1);
    const bool is_position = target == 0 && name == "POSITION";
    if (piece.attributes[filled.id].format != named || (is_position && filled.id != 0)) {
      fail(where, "accessor " + std::to_string(number) +
                      " does not have the type of the payload's " + "attribute " +
                      std::to_string(filled.id));
    }
    addPlace(job, filled, number, layout, piece.wedge_count, layout.elementBytesPadded(), where);
  }

  void addPlace(Job& job, const Filled& filled, int number, const Layout& layout, uint64_t count,
                uint32_t stride, const std::string& where) {
    if (accessorOf(number, where).count != count) {
      fail(where, "accessor " + std::to_string(number) + " does not have the payload's count, " +
                      std::to_string(count));
    }
    const auto [claim, is_new] = claims_.try_emplace(number, std::pair(view_, filled));
    if (claim->second != std::pair(view_, filled)) {
      fail(where, "accessor " + std::to_string(number) + " is filled from two places of payloads");
    }
    Place& place = job.places[filled];
    // A part is written once, so all its accessors must have types of the same size.
    if (place.count != 0 && place.stride != stride)
      fail(where, "two types of accessors for one part");
    place.layout = layout;
    place.count = count;
    place.stride = stride;
    place.user_count += is_new ? 1 : 0;
  }

  /// Assigns offsets to everything that is decoded, each a multiple of four.
  void layOut() {
    uint64_t end = 0;
    for (const auto& job : jobs_) {
      for (auto& [filled, place] : job->places) {
        place.offset = end;
        end += (place.count * place.stride + 3) & ~uint64_t{3};
        if (place.isPadded()) place.tight.resize(place.count * place.layout.tightBytes());
      }
    }
    bytes_.resize(end);
  }

  void decodeAll() {
    std::vector<Status> statuses(jobs_.size());
    Threads threads(options_.thread_count);
    threads.run(jobs_.size(), [&](size_t i) { statuses[i] = decodeJob(*jobs_[i], threads); });
    for (size_t i = 0; i < jobs_.size(); ++i) check(statuses[i], jobs_[i]->where);
  }

  /// Decodes one payload. Must not throw, since it may run on any thread.
  Status decodeJob(Job& job, Threads& threads) try {
    const std::span<const PieceInfo> infos = job.payload.info().pieces;
    std::vector<std::vector<AttributeTarget>> attributes(infos.size());
    std::vector<std::vector<PartTarget>> parts(infos.size());
    std::vector<PieceTarget> targets(infos.size());
    for (size_t i = 0; i < infos.size(); ++i) {
      attributes[i].resize(infos[i].attributes.size());
      parts[i].resize(infos[i].parts.size());
      targets[i] = {attributes[i], parts[i]};
    }
    for (auto& [filled, place] : job.places) {
      uint8_t* data = bytes_.data() + place.offset;
      if (filled.is_part) {
        parts[filled.piece][filled.id] = {data, static_cast<IndexType>(place.stride)};
      } else if (place.isPadded()) {
        attributes[filled.piece][filled.id] = {place.tight.data(), place.layout.tightBytes()};
      } else {
        attributes[filled.piece][filled.id] = {data, place.stride};
      }
    }
    mcc::DecodeOptions options;
    if (options_.thread_count > 1) options.run_jobs = threads.runner();
    const Status status = job.payload.decode(targets, options);
    if (status.ok()) padMatrices(job);
    return status;
  } catch (const std::bad_alloc&) {
    return mcc::fail(mcc::Error::kOutOfMemory, "no memory for the targets");
  }

  void padMatrices(Job& job) {
    for (auto& [filled, place] : job.places) {
      if (!place.isPadded()) continue;
      const uint32_t tight_column = place.layout.tightBytes() / place.layout.columns;
      for (uint64_t i = 0; i < place.count * place.layout.columns; ++i) {
        const uint64_t element = i / place.layout.columns;
        const uint64_t column = i % place.layout.columns;
        std::memcpy(bytes_.data() + place.offset + element * place.stride +
                        column * place.layout.column_bytes,
                    place.tight.data() + i * tight_column, tight_column);
      }
    }
  }

  /// Changes the model. Nothing fails from here on, so a model is changed as a whole or not at all.
  void store() {
    const int buffer = model_.bufferViews[jobs_[0]->views[0]].buffer;
    removePayloads();
    auto& data = model_.buffers[static_cast<size_t>(buffer)].data;
    const uint64_t begin = (data.size() + 3) & ~size_t{3};
    if (begin == 0) {
      data = std::move(bytes_);
    } else {
      data.resize(begin);
      data.insert(data.end(), bytes_.begin(), bytes_.end());
    }
    for (const auto& job : jobs_) storeJob(*job, buffer, begin);
    for (const auto& [number, claim] : claims_) {
      Accessor& accessor = model_.accessors[static_cast<size_t>(number)];
      accessor.bufferView = jobs_[by_view_.at(claim.first)]->places.at(claim.second).view;
      accessor.byteOffset = 0;
      accessor.sparse.isSparse = false;
    }
    for (::tinygltf::Mesh& mesh : model_.meshes) {
      for (Primitive& primitive : mesh.primitives) primitive.extensions.erase(kExtension);
    }
    for (auto* list : {&model_.extensionsUsed, &model_.extensionsRequired}) {
      list->erase(std::remove(list->begin(), list->end(), kExtension), list->end());
    }
  }

  /// A range of bytes in a buffer. If `job` is not null, the range is its payload, to be cut out.
  struct Range {
    int buffer = 0;
    size_t begin = 0;
    size_t end = 0;
    Job* job = nullptr;
  };

  /// Cuts the bytes of payloads out of their buffers where no other view refers to them. Their
  /// views become views of decoded elements, so that no number changes and no view is left over.
  void removePayloads() {
    for (const ::tinygltf::BufferView& view : model_.bufferViews) {
      if (!view.extensions.empty()) return;  // an extension may have offsets of its own
    }
    std::vector<Range> ranges = rangesInUse();
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) {
      return std::tie(a.buffer, a.begin, a.end) < std::tie(b.buffer, b.begin, b.end);
    });
    std::vector<Range> cuts;
    size_t end = 0;  // the largest end of the ranges so far in this buffer
    for (size_t i = 0; i < ranges.size(); ++i) {
      const Range& range = ranges[i];
      if (i == 0 || ranges[i - 1].buffer != range.buffer) end = 0;
      const bool is_before_next = i + 1 == ranges.size() || ranges[i + 1].buffer != range.buffer ||
                                  ranges[i + 1].begin >= range.end;
      if (range.job != nullptr && end <= range.begin && is_before_next) cuts.push_back(range);
      end = std::max(end, range.end);
    }
    removeBytes(cuts);
  }

  /// Lists each payload once, and all other views.
  std::vector<Range> rangesInUse() const {
    std::vector<Range> ranges;
    for (const auto& job : jobs_) {
      const ::tinygltf::BufferView& cut = model_.bufferViews[job->views[0]];
      // Cuts are whole words, so that what follows keeps its alignment, and include padding after a
      // payload.
      const auto& data = model_.buffers[static_cast<size_t>(cut.buffer)].data;
      const size_t end = std::min(data.size(), (cut.byteOffset + cut.byteLength + 3) & ~size_t{3});
      const size_t length =
          end == data.size() ? end - cut.byteOffset : (end - cut.byteOffset) & ~size_t{3};
      ranges.push_back({cut.buffer, cut.byteOffset, cut.byteOffset + length, job.get()});
    }
    for (size_t i = 0; i < model_.bufferViews.size(); ++i) {
      if (by_view_.contains(static_cast<uint32_t>(i))) continue;
      const ::tinygltf::BufferView& view = model_.bufferViews[i];
      ranges.push_back({view.buffer, view.byteOffset, view.byteOffset + view.byteLength, nullptr});
    }
    return ranges;
  }

  /// Removes bytes from buffers. `cuts` are in the order of buffers and offsets, and do not
  /// overlap.
  void removeBytes(const std::vector<Range>& cuts) {
    std::vector<size_t> removed = {0};  // bytes removed by the cuts before this one
    for (size_t i = 0; i < cuts.size(); ++i) {
      const bool is_first = i == 0 || cuts[i - 1].buffer != cuts[i].buffer;
      removed.push_back((is_first ? 0 : removed.back()) + cuts[i].end - cuts[i].begin);
      for (const uint32_t view : cuts[i].job->views) model_.bufferViews[view].byteLength = 0;
    }
    const auto cutsBefore = [&](int buffer, size_t offset) {
      const auto above = std::partition_point(cuts.begin(), cuts.end(), [&](const Range& cut) {
        return std::tie(cut.buffer, cut.begin) < std::tie(buffer, offset);
      });
      const auto count = static_cast<size_t>(above - cuts.begin());
      return count != 0 && cuts[count - 1].buffer == buffer ? removed[count] : 0;
    };
    for (::tinygltf::BufferView& view : model_.bufferViews) {
      view.byteOffset -= cutsBefore(view.buffer, view.byteOffset);
    }
    for (size_t i = 0; i < cuts.size();) {
      auto& data = model_.buffers[static_cast<size_t>(cuts[i].buffer)].data;
      size_t kept = cuts[i].begin;
      const int buffer = cuts[i].buffer;
      for (; i < cuts.size() && cuts[i].buffer == buffer; ++i) {
        const bool is_last = i + 1 == cuts.size() || cuts[i + 1].buffer != buffer;
        const size_t next = is_last ? data.size() : cuts[i + 1].begin;
        std::memmove(data.data() + kept, data.data() + cuts[i].end, next - cuts[i].end);
        kept += next - cuts[i].end;
      }
      data.resize(kept);
    }
  }

  void storeJob(Job& job, int buffer, uint64_t begin) {
    size_t used_views = 0;
    for (auto& [filled, place] : job.places) {
      ::tinygltf::BufferView view;
      view.buffer = buffer;
      view.byteOffset = begin + place.offset;
      view.byteLength = place.count * place.stride;
      const bool is_tight = place.stride == place.layout.columns * place.layout.column_bytes;
      // glTF requires a stride where several vertex attributes share a view.
      const bool has_stride = !filled.is_part && (!is_tight || place.user_count > 1);
      view.byteStride = has_stride ? place.stride : 0;
      view.target =
          filled.is_part ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER;
      if (used_views < job.views.size()) {
        place.view = static_cast<int>(job.views[used_views++]);
        model_.bufferViews[static_cast<size_t>(place.view)] = view;
      } else {
        place.view = static_cast<int>(model_.bufferViews.size());
        model_.bufferViews.push_back(view);
      }
    }
    // A view that is left over must still be valid, so it repeats the first one.
    for (; used_views < job.views.size(); ++used_views) {
      model_.bufferViews[job.views[used_views]] = model_.bufferViews[job.views[0]];
    }
  }

  Model& model_;
  const DecodeOptions& options_;
  std::vector<std::unique_ptr<Job>> jobs_;
  std::map<uint32_t, size_t> by_view_;                            ///< buffer view -> job
  std::map<std::pair<const uint8_t*, size_t>, size_t> by_bytes_;  ///< bytes -> job
  uint32_t view_ = 0;  ///< the buffer view of the current primitive's payload
  std::map<int, std::pair<uint32_t, Filled>> claims_;  ///< accessor -> (buffer view, what fills it)
  std::vector<unsigned char> bytes_;                   ///< everything that is decoded
};

/// What makeLoadable() inserted into a file.
struct Dummy {
  int view = -1;  ///< number of the inserted buffer view; -1: nothing was inserted
};

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
inline Dummy makeLoadable(std::string& json) {
  const JsonPlaces places(json);
  if (places.accessors_without_view.empty() || places.view_count == 0 ||
      places.views_end == std::string::npos) {
    return {};
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
  return {places.view_count};
}

inline void restore(const Dummy& dummy, Model& model) {
  if (dummy.view < 0) return;
  // With TINYGLTF_ENABLE_DRACO, views of what it decoded come after the dummy, which then stays.
  const auto number = static_cast<size_t>(dummy.view);
  if (model.bufferViews.size() == number + 1) model.bufferViews.pop_back();
  for (Accessor& accessor : model.accessors) {
    if (accessor.bufferView == dummy.view) accessor.bufferView = -1;
  }
}

/// tinygltf stores sizes in 32 bits. The margin leaves room for the dummy.
inline constexpr size_t kMaxFileBytes = UINT_MAX - (size_t{1} << 20);

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

/// Loads a GLB or the JSON of a .gltf, and leaves compressed primitives compressed.
inline bool loadCompressed(::tinygltf::TinyGLTF& loader, Model& model, std::string* error,
                           std::string* warning, std::string file, const std::string& base_dir) {
  constexpr size_t kHeaderBytes = 20;  // of the file and of its first chunk
  Dummy dummy;
  bool is_loaded = false;
  if (file.compare(0, 4, "glTF") != 0) {
    dummy = makeLoadable(file);
    is_loaded = loader.LoadASCIIFromString(&model, error, warning, file.data(),
                                           static_cast<unsigned>(file.size()), base_dir);
  } else {
    const size_t json_bytes = file.size() < kHeaderBytes ? 0 : readU32(file, 12);
    if (json_bytes != 0 && json_bytes <= file.size() - kHeaderBytes) {
      std::string json = file.substr(kHeaderBytes, json_bytes);
      dummy = makeLoadable(json);
      json.append((4 - json.size() % 4) % 4, ' ');
      file.replace(kHeaderBytes, json_bytes, json);
      writeU32(file, 8, file.size());
      writeU32(file, 12, json.size());
    }
    is_loaded = loader.LoadBinaryFromMemory(&model, error, warning,
                                            reinterpret_cast<const unsigned char*>(file.data()),
                                            static_cast<unsigned>(file.size()), base_dir);
  }
  if (is_loaded) restore(dummy, model);
  return is_loaded;
}

}  // namespace detail

/// Decodes all compressed primitives of a loaded model: accessors get buffer views with plain
/// elements, and the extension is removed from primitives, extensionsUsed and extensionsRequired.
/// The bytes of payloads are removed. Numbers of buffer views, accessors and buffers do not change;
/// new buffer views are appended. `min` and `max` of accessors are left as they are, since they
/// describe the decoded values already. A payload is decoded once, however many primitives and
/// views name its bytes; accessors of the same elements share a buffer view. A model without the
/// extension stays as it is.
/// Errors: the extension or a payload contradicts itself, the model or options.limits, or all
/// payloads together exceed options.max_decoded_bytes; the model is then as it was.
/// Safe for untrusted models. May throw std::bad_alloc. Inverse: encode(). Tests: tests/tinygltf/.
inline Result decode(::tinygltf::Model& model, const DecodeOptions& options = {}) try {
  detail::Decoder(model, options).run();
  return {};
} catch (const detail::Failure& failure) {
  return {failure.what};
}

/// Loads the bytes of a .glb or .gltf and decodes them. Use it instead of
/// loader.LoadBinaryFromMemory() and LoadASCIIFromString(). `base_dir` is the folder of the buffers
/// and images of a .gltf. Otherwise like load().
inline bool loadFromMemory(::tinygltf::TinyGLTF& loader, ::tinygltf::Model* model,
                           std::string* error, std::string* warning,
                           std::span<const unsigned char> file, const std::string& base_dir = "",
                           const DecodeOptions& options = {}) {
  std::string own_error;
  std::string own_warning;
  if (error == nullptr) error = &own_error;
  if (warning == nullptr) warning = &own_warning;
  if (file.size() > detail::kMaxFileBytes) {
    *error += "tinygltf cannot load files of 4 GB or more";
    return false;
  }
  if (!detail::loadCompressed(loader, *model, error, warning, std::string(file.begin(), file.end()),
                              base_dir)) {
    return false;
  }
  const Result result = decode(*model, options);
  *error += result.what;
  return result.ok();
}

/// Loads a .glb or .gltf and decodes it. Use it instead of loader.LoadBinaryFromFile() and
/// LoadASCIIFromFile(), with their arguments. It works with every version of tinygltf, and is
/// needed with those that refuse compressed primitives, see the top of this file. `error` and
/// `warning` may be null. As safe for untrusted input as tinygltf is. Tests: tests/tinygltf/.
inline bool load(::tinygltf::TinyGLTF& loader, ::tinygltf::Model* model, std::string* error,
                 std::string* warning, const std::string& path, const DecodeOptions& options = {}) {
  std::ifstream stream(path, std::ios::binary);
  const std::vector<unsigned char> file{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) {
    if (error != nullptr) *error += "cannot read " + path;
    return false;
  }
  const size_t slash = path.find_last_of("/\\");
  const std::string base_dir = slash == std::string::npos ? "" : path.substr(0, slash);
  return loadFromMemory(loader, model, error, warning, file, base_dir, options);
}

#ifdef MCC_TINYGLTF_HAS_ENCODE

namespace detail {

/// Returns a copy of everything that refers to buffers or geometry, without the pixels of images.
/// All buffers are merged into one.
inline Model geometryOf(const Model& model, std::vector<size_t>& images) {
  Model geometry;
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
    if (!view.extensions.empty()) fail(where, "has extensions, which tinygltf would lose");
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= begins.size()) {
      fail(where, "has no buffer");
    }
    view.byteOffset += begins[static_cast<size_t>(view.buffer)];
    view.buffer = 0;
  }
  if (!all.data.empty()) geometry.buffers.push_back(std::move(all));
  return geometry;
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

/// Copies what compression changed into the model.
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
        const auto extension = from.extensions.find(name);
        if (extension != from.extensions.end()) to.extensions[name] = extension->second;
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

inline Result encode(Model& model, const gltf::ConvertOptions& options,
                     gltf::ConvertReport& report) {
  std::vector<size_t> images;
  Model geometry = geometryOf(model, images);
  const std::vector<bool> has_large_bounds = removeLargeBounds(geometry);
  ::tinygltf::TinyGLTF codec;
  codec.SetImageLoader(keepNoImage, nullptr);
  codec.SetImageWriter(nullptr, nullptr);
  std::ostringstream stream;
  if (!codec.WriteGltfSceneToStream(&geometry, stream, false, true))
    return {"tinygltf cannot save the model"};
  const std::string source = std::move(stream).str();
  std::vector<uint8_t> output;
  const gltf::Result result = gltf::convertGlb(
      {reinterpret_cast<const uint8_t*>(source.data()), source.size()}, options, output, report);
  if (!result.ok()) return {result.message()};
  if (report.copied) return {};
  Model coded;
  std::string error;
  std::string warning;
  if (!loadCompressed(codec, coded, &error, &warning, std::string(output.begin(), output.end()),
                      "")) {
    return {"tinygltf cannot load the compressed model: " + error};
  }
  takeOver(std::move(coded), images, has_large_bounds, model);
  return {};
}

}  // namespace detail

/// Compresses the triangle primitives of a model before it is saved. Choices and payloads are the
/// same as for files in gltf-mcc::gltf, and the result is decoded and compared with the source in
/// the same way. All buffers become one. Where compression gains nothing the model stays as it is,
/// and report.copied is set. Images keep their pixels; nodes, meshes, accessors, images and the
/// buffer views of unknown extensions keep their numbers. options.fallback and options.decoders
/// have no effect.
/// Errors: the model is not valid glTF, or has extensions on buffer views; it is then as it was.
/// May throw std::bad_alloc.
/// Inverse: decode(). Tests: tests/tinygltf/.
inline Result encode(::tinygltf::Model& model, const gltf::ConvertOptions& options,
                     gltf::ConvertReport& report) try {
  gltf::ConvertOptions own = options;
  own.fallback = false;
  own.decoders = {};
  return detail::encode(model, own, report);
} catch (const detail::Failure& failure) {
  return {failure.what};
}

/// Like encode() above, without a report.
inline Result encode(::tinygltf::Model& model, const gltf::ConvertOptions& options = {}) {
  gltf::ConvertReport report;
  return encode(model, options, report);
}

#endif  // MCC_TINYGLTF_HAS_ENCODE

}  // namespace mcc::tinygltf

#endif  // MCC_TINYGLTF_H_
