// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/layout.h"

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "gltf/document/package.h"

namespace mcc::gltf {
namespace {

/// A run of source bytes that is kept together.
struct Block {
  ByteRange source;
  uint64_t target = 0;  ///< where it begins in the new buffer
};

class LayoutBuilder {
 public:
  LayoutBuilder(const Document& document, std::span<const NewView> new_views, Json& json)
      : document_(document),
        new_views_(new_views),
        json_(json),
        ranges_(document.views.size()),
        kept_(document.views.size()),
        is_whole_(document.views.size(), false) {}

  Layout run() {
    findLiveViews();
    layout_.offsets.resize(new_views_.size());
    placeNewViews(true);
    placeBlocks();
    moveAccessors();
    numberViews();
    placeNewViews(false);
    writeViews();
    writeBuffers();
    return std::move(layout_);
  }

 private:
  /// Whether the bytes of a view are in none of the files.
  bool isMissing(size_t view) const { return document_.isMissing(document_.views[view].buffer); }

  void keep(uint32_t view, const ByteRange& range) {
    ByteRange& kept = kept_[view];
    if (ranges_[view].empty()) kept = range;
    kept.begin = std::min(kept.begin, range.begin);
    kept.end = std::max(kept.end, range.end);
    ranges_[view].push_back(range);
  }

  void keepWhole(uint32_t view) {
    is_whole_[view] = true;
    keep(view, viewRange(document_, view));
  }

  void findLiveViews() {
    for (uint32_t view = 0; view < document_.views.size(); ++view) {
      const ViewUse use = document_.views[view].use;
      const bool stays_free = use == ViewUse::kFree && new_views_.empty();
      if (use == ViewUse::kUnknown || stays_free) keepWhole(view);
    }
    std::vector<bool> is_referred(document_.views.size(), false);
    visitViewReferences(std::as_const(json_), [&](const Json& number, uint32_t accessor) {
      const uint32_t view = indexOf(&number, document_.views.size());
      if (view == kNone) return;
      is_referred[view] = true;
      const bool is_old = accessor < document_.accessors.size();
      if (!is_old || document_.foreign.keep_numbers || document_.views[view].isCoded() ||
          !document_.accessors[accessor].is_known_type ||
          !document_.accessors[accessor].fault.ok() || document_.accessors[accessor].count == 0) {
        keepWhole(view);
        return;
      }
      const ByteRange whole = viewRange(document_, view);
      for (const ByteRange& range : accessorRanges(document_, accessor, false)) {
        const bool is_inside =
            range.buffer == whole.buffer && range.begin >= whole.begin && range.end <= whole.end;
        if (is_inside) keep(view, range);
      }
    });
    // An accessor that uses none of its bytes, such as a sparse one of 0 elements, still needs its
    // view.
    for (uint32_t view = 0; view < ranges_.size(); ++view) {
      if (is_referred[view] && ranges_[view].empty()) keepWhole(view);
    }
  }

  void placeBlocks() {
    std::vector<ByteRange> live;
    for (size_t view = 0; view < ranges_.size(); ++view) {
      if (isMissing(view)) continue;
      live.insert(live.end(), ranges_[view].begin(), ranges_[view].end());
    }
    std::sort(live.begin(), live.end());
    // Runs with gaps smaller than the alignment stay together, so that an untouched buffer does not
    // change.
    const uint64_t alignment = document_.foreign.alignment();
    for (const ByteRange& range : live) {
      Block* last = blocks_.empty() ? nullptr : &blocks_.back();
      if (last != nullptr && last->source.buffer == range.buffer &&
          range.begin < last->source.end + alignment) {
        last->source.end = std::max(last->source.end, range.end);
      } else {
        blocks_.push_back({range, 0});
      }
    }
    uint64_t& end = layout_.byte_count;
    if (end != 0) end = (end + alignment - 1) & ~(alignment - 1);  // after views in front
    for (Block& block : blocks_) {
      const auto [buffer, begin, source_end] = block.source;
      block.target = end + (begin - end) % alignment;
      end = block.target + (source_end - begin);
      layout_.runs.push_back(
          {block.target, document_.buffers[buffer].subspan(begin, source_end - begin)});
    }
  }

  /// Places the new views that are in front of the bytes of the source, or those that follow them.
  void placeNewViews(bool in_front) {
    for (size_t k = 0; k < new_views_.size(); ++k) {
      const NewView& view = new_views_[k];
      if (view.is_in_front != in_front) continue;
      layout_.byte_count = aligned(layout_.byte_count);
      layout_.offsets[k] = layout_.byte_count;
      if (view.bytes != nullptr) {
        const std::span<const uint8_t> bytes(view.bytes, static_cast<size_t>(view.byte_count));
        layout_.runs.push_back({layout_.byte_count, bytes});
      }
      layout_.byte_count += view.byte_count;
    }
    // EXT_structural_metadata demands that the BIN chunk of a GLB ends at a multiple of 8, too.
    if (document_.foreign.has_tables) layout_.byte_count = (layout_.byte_count + 7) & ~uint64_t{7};
  }

  static uint64_t aligned(uint64_t offset) { return (offset + 3) & ~uint64_t{3}; }

  /// Returns the new place of a source byte that is kept.
  uint64_t moved(uint32_t buffer, uint64_t offset) const {
    const auto above =
        std::upper_bound(blocks_.begin(), blocks_.end(), std::pair(buffer, offset),
                         [](const auto& key, const Block& block) {
                           return key < std::pair(block.source.buffer, block.source.begin);
                         });
    if (above == blocks_.begin()) return 0;  // happens for empty ranges only
    const Block& block = *(above - 1);
    return block.target + (offset - block.source.begin);
  }

  void moveOffset(Json& object, uint64_t old_offset) {
    const uint32_t view = indexOf(findMember(object, "bufferView"), document_.views.size());
    if (view == kNone || ranges_[view].empty() || is_whole_[view]) return;
    const BufferView& from = document_.views[view];
    const uint64_t begin = kept_[view].begin;
    const uint64_t offset =
        moved(from.buffer, from.offset + old_offset) - moved(from.buffer, begin);
    if (offset != old_offset) object["byteOffset"] = offset;
  }

  void moveAccessors() {
    if (document_.accessors.empty()) return;
    Json& accessors = json_["accessors"];
    for (uint32_t i = 0; i < document_.accessors.size(); ++i) {
      Json& accessor = accessors[i];
      moveOffset(accessor, document_.accessors[i].offset);
      const bool is_sparse = document_.accessors[i].sparse.count != 0;
      if (!is_sparse || findMember(accessor, "sparse") == nullptr) continue;
      moveOffset(accessor["sparse"]["indices"], document_.accessors[i].sparse.index_offset);
      moveOffset(accessor["sparse"]["values"], document_.accessors[i].sparse.value_offset);
    }
  }

  void numberViews() {
    const size_t old_count = document_.views.size();
    numbers_.assign(old_count + new_views_.size(), kNone);
    std::vector<uint32_t> free_numbers;
    for (uint32_t view = 0; view < old_count; ++view) {
      const bool is_kept = !ranges_[view].empty();
      if (is_kept || document_.foreign.keep_numbers) numbers_[view] = view_count_++;
      if (!is_kept && document_.foreign.keep_numbers) free_numbers.push_back(view);
    }
    for (size_t k = 0; k < new_views_.size(); ++k) {
      numbers_[old_count + k] = k < free_numbers.size() ? free_numbers[k] : view_count_++;
    }
    // Free numbers that are left over at the end need not be kept in use.
    for (size_t k = free_numbers.size(); k > new_views_.size(); --k) {
      if (free_numbers[k - 1] + 1 != view_count_) break;
      numbers_[free_numbers[k - 1]] = kNone;
      --view_count_;
    }
    visitViewReferences(json_, [&](Json& number, uint32_t) {
      uint64_t view = 0;
      if (!asUnsigned(number, view)) return;
      const bool is_new = view >= kFirstNewView && view - kFirstNewView < new_views_.size();
      if (is_new || view < old_count) {
        number = numbers_[is_new ? view - kFirstNewView + old_count : view];
      } else if (view < view_count_) {
        number = kNone;  // it named no view, and shall not name one of ours
      }
    });
  }

  static void setRange(Json& view, uint64_t offset, uint64_t length) {
    view["buffer"] = 0;
    if (offset != 0) {
      view["byteOffset"] = offset;
    } else {
      view.erase("byteOffset");  // 0 is the default
    }
    view["byteLength"] = length;
  }

  /// Returns what says where the bytes of a view are: the object that codes it, or the view itself.
  static Json& placeOf(Json& view, const ViewCoding& coding) {
    return coding.extension.empty() ? view : view["extensions"][coding.extension];
  }

  /// The own range of a coded view lies in a placeholder buffer without bytes.
  void setPlaceholder(Json& view, const ViewCoding& coding) {
    view["buffer"] = 1;
    view["byteOffset"] = placeholder_bytes_;
    placeholder_bytes_ += (coding.length + 3) & ~uint64_t{3};
    coded_extensions_.insert(coding.extension);
  }

  void writeViews() {
    const size_t old_count = document_.views.size();
    const uint64_t first_new = new_views_.empty() ? 0 : layout_.offsets[0];
    std::vector<Json> views(view_count_);
    const Json& old_views = arrayOf(json_, "bufferViews");
    for (uint32_t view = 0; view < old_count; ++view) {
      if (numbers_[view] == kNone) continue;
      Json& json = views[numbers_[view]];
      json = old_views[view];
      if (ranges_[view].empty()) {  // a number that must stay in use; see ViewUse::kFree
        eraseViewExtensions(json);
        json.erase("byteStride");
        json.erase("target");
        setRange(json, first_new, 1);
        continue;
      }
      const ViewCoding& coding = document_.views[view].coding;
      if (isMissing(view)) {
        // It keeps its place in its buffer, whose number is not known yet.
        missing_views_.push_back(view);
      } else {
        const auto [buffer, begin, end] = kept_[view];
        const uint64_t offset = moved(buffer, begin);
        const uint64_t length = end == begin ? 0 : moved(buffer, end - 1) + 1 - offset;
        setRange(placeOf(json, coding), offset, length);
        names_first_ = true;
      }
      if (!coding.extension.empty()) setPlaceholder(json, coding);
    }
    for (size_t k = 0; k < new_views_.size(); ++k) {
      views[numbers_[old_count + k]] = new_views_[k].json(0, layout_.offsets[k]);
    }
    if (views.empty()) {
      json_.erase("bufferViews");
    } else {
      json_["bufferViews"] = std::move(views);
    }
  }

  void writeBuffers() {
    const Json old_buffers = arrayOf(json_, "buffers");
    Json buffers = Json::array();
    // What codes views is required, since their bytes exist nowhere else.
    for (const char* name : kViewExtensions)
      listExtension(json_, name, coded_extensions_.contains(name));
    const bool has_first = layout_.byte_count != 0 || names_first_ || !coded_extensions_.empty();
    if (has_first) buffers.push_back(firstBuffer(old_buffers));
    if (!coded_extensions_.empty()) {
      Json placeholder = {{"byteLength", placeholder_bytes_}};
      for (const std::string& name : coded_extensions_) {
        placeholder["extensions"][name]["fallback"] = true;
      }
      buffers.push_back(std::move(placeholder));
    }
    appendMissingBuffers(old_buffers, buffers);
    if (buffers.empty()) {
      json_.erase("buffers");
    } else {
      json_["buffers"] = std::move(buffers);
    }
  }

  /// Returns the buffer that is laid out, with what the first buffer of the source says about
  /// itself.
  Json firstBuffer(const Json& old_buffers) const {
    Json first = Json::object();
    for (uint32_t i = 0; i < old_buffers.size(); ++i) {
      if (document_.isMissing(i)) continue;
      first = old_buffers[i];
      break;
    }
    first.erase("uri");
    first.erase("chunk");
    eraseViewExtensions(first);
    first["byteLength"] = layout_.byte_count;
    return first;
  }

  /// Keeps the buffers whose bytes are missing, and tells their views where they are now.
  void appendMissingBuffers(const Json& old_buffers, Json& buffers) {
    std::vector<size_t> numbers(old_buffers.size(), kNone);
    for (uint32_t i = 0; i < old_buffers.size(); ++i) {
      if (!document_.isMissing(i)) continue;
      numbers[i] = buffers.size();
      buffers.push_back(old_buffers[i]);
    }
    if (missing_views_.empty()) return;
    Json& views = json_["bufferViews"];
    for (const uint32_t view : missing_views_) {
      const BufferView& from = document_.views[view];
      placeOf(views[numbers_[view]], from.coding)["buffer"] = numbers[from.buffer];
    }
  }

  static void eraseViewExtensions(Json& object) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return;
    for (const char* name : kViewExtensions) extensions->erase(name);
    if (extensions->empty()) object.erase("extensions");
  }

  const Document& document_;
  const std::span<const NewView> new_views_;
  Json& json_;
  Layout layout_;
  std::vector<std::vector<ByteRange>> ranges_;  ///< ranges of each old view that are kept
  std::vector<ByteRange> kept_;                 ///< the hull of each old view's ranges
  std::vector<bool> is_whole_;
  std::vector<Block> blocks_;            ///< ascending in buffer and begin
  std::vector<uint32_t> numbers_;        ///< final numbers of old and new views
  std::vector<uint32_t> missing_views_;  ///< old views that are kept without bytes
  uint32_t view_count_ = 0;
  bool names_first_ = false;  ///< whether a kept view names the first buffer, maybe without bytes
  uint64_t placeholder_bytes_ = 0;          ///< size of the buffer that coded views claim to be in
  std::set<std::string> coded_extensions_;  ///< extensions of the views that are still coded
};

}  // namespace

ByteRange viewRange(const Document& document, uint64_t view) {
  const BufferView& from = document.views[view];
  return {from.buffer, from.offset, from.offset + from.length};
}

std::vector<ByteRange> accessorRanges(const Document& document, uint32_t index, bool whole_views) {
  const Accessor& accessor = document.accessors[index];
  if (accessor.decoded_from != kNone) return {viewRange(document, accessor.decoded_from)};
  std::vector<ByteRange> ranges;
  const auto add = [&](uint32_t view, uint64_t offset, uint64_t bytes) {
    if (whole_views || !accessor.is_known_type || !accessor.fault.ok() ||
        document.views[view].isCoded()) {
      ranges.push_back(viewRange(document, view));
    } else if (bytes != 0) {
      const BufferView& from = document.views[view];
      ranges.push_back({from.buffer, from.offset + offset, from.offset + offset + bytes});
    }
  };
  if (accessor.view != kNone && accessor.count != 0) {
    add(accessor.view, accessor.offset,
        accessor.rangeBytes(accessor.count, document.views[accessor.view].stride));
  }
  const Sparse& sparse = accessor.sparse;
  if (sparse.count != 0) {
    add(sparse.index_view, sparse.index_offset, sparse.count * componentBytes(sparse.index_type));
    add(sparse.value_view, sparse.value_offset, accessor.rangeBytes(sparse.count, 0));
  }
  return ranges;
}

Json NewView::json(uint64_t buffer, uint64_t offset) const {
  Json json = {{"buffer", buffer}};
  if (offset != 0) json["byteOffset"] = offset;  // 0 is the default
  json["byteLength"] = byte_count;
  if (stride_bytes != 0) json["byteStride"] = stride_bytes;
  if (target != 0) json["target"] = target;
  return json;
}

void Layout::copyTo(std::span<uint8_t> buffer) const {
  for (const Run& run : runs) {
    std::copy(run.bytes.begin(), run.bytes.end(),
              buffer.begin() + static_cast<ptrdiff_t>(run.offset));
  }
}

Layout layOut(const Document& document, std::span<const NewView> new_views, Json& json) {
  return LayoutBuilder(document, new_views, json).run();
}

void OwnedRanges::add(const ByteRange& range, size_t owner) {
  edges_.push_back({range.buffer, range.begin, true, owner});
  edges_.push_back({range.buffer, range.end, false, owner});
}

void OwnedRanges::visit(const std::function<void(uint64_t, const Owners&)>& visit) {
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.buffer, a.offset, b.is_begin) < std::tie(b.buffer, b.offset, a.is_begin);
  });
  Owners open;
  for (size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    uint32_t& count = open[edge.owner];
    count += edge.is_begin ? 1 : ~0u;
    if (count == 0) open.erase(edge.owner);
    if (open.empty()) continue;  // else there is another edge
    const uint64_t bytes = edges_[i + 1].offset - edge.offset;
    if (bytes != 0) visit(bytes, open);
  }
}

namespace {

class ContentsWalk {
 public:
  explicit ContentsWalk(const Document& document) : document_(document) {}

  Contents run() {
    addGeometry();
    owner_ = kImages;
    addImages();
    owner_ = kAnimations;
    addAnimations();
    uint64_t bytes[kOwnerCount] = {};
    ranges_.visit([&](uint64_t count, const OwnedRanges::Owners& owners) {
      bytes[owners.begin()->first] += count;
    });
    result_.geometry_bytes = bytes[kGeometry];
    result_.image_bytes = bytes[kImages] + data_uri_bytes_;
    result_.animation_bytes = bytes[kAnimations];
    // Buffers in data URIs take a third more than their bytes, which counts as JSON.
    const uint64_t used = result_.geometry_bytes + result_.image_bytes + result_.animation_bytes;
    result_.other_bytes = document_.source_bytes - std::min(used, document_.source_bytes);
    return result_;
  }

 private:
  /// Bytes that several of them use belong to the first.
  enum Owner : size_t { kGeometry, kImages, kAnimations, kOwnerCount };

  void addView(uint32_t index) {
    if (index < document_.views.size()) ranges_.add(viewRange(document_, index), owner_);
  }

  /// Adds the bytes that an accessor uses; of a coded view they are not known one by one.
  void addAccessor(uint32_t index) {
    if (index >= document_.accessors.size()) return;
    const Accessor& accessor = document_.accessors[index];
    // Its range is not known, or was not checked.
    if (!accessor.is_known_type || !accessor.fault.ok()) return addView(accessor.view);
    for (const ByteRange& range : accessorRanges(document_, index, false)) {
      ranges_.add(range, owner_);
    }
  }

  void addViewOf(const Json* object) {
    addView(indexOf(findMember(object, "bufferView"), document_.views.size()));
  }

  void addGeometry() {
    for (const Primitive& primitive : document_.primitives) {
      for (const auto& attribute : primitive.attributes) addAccessor(attribute.accessor);
      addAccessor(primitive.indices);
      for (const char* name : {kExtensionName, kMeshExtension}) {
        const Json* extension = extensionOf(*primitive.json, name);
        addViewOf(extension);
        addViewOf(findMember(extension, "preview"));  // only ours has them
      }
    }
  }

  void addImages() {
    for (const Json& image : arrayOf(document_.json, "images")) {
      const Json* uri = findMember(image, "uri");
      if (uri == nullptr || !uri->is_string()) {
        addViewOf(&image);
        ++result_.image_count;
      } else if (isDataUri(uri->text())) {
        data_uri_bytes_ += uri->text().size();
        ++result_.image_count;
      } else {
        ++result_.image_file_count;
      }
    }
  }

  void addAnimations() {
    result_.animation_count = static_cast<uint32_t>(arrayOf(document_.json, "animations").size());
    for (const std::string_view path : kAnimationAccessors) {
      visitPath(&document_.json, path, [&](const Json& number) {
        addAccessor(indexOf(&number, document_.accessors.size()));
      });
    }
  }

  const Document& document_;
  Contents result_;
  OwnedRanges ranges_;
  Owner owner_ = kGeometry;  ///< of what is being added
  uint64_t data_uri_bytes_ = 0;
};

}  // namespace

Contents contentsOf(const Document& document) { return ContentsWalk(document).run(); }

}  // namespace mcc::gltf
