// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/contents.h"

#include <algorithm>
#include <set>

#include "gltf/document/layout.h"
#include "gltf/document/uri.h"

namespace mcc::gltf {
namespace {

/// Sorts ranges and joins those that touch.
void join(std::vector<ByteRange>& ranges) {
  std::sort(ranges.begin(), ranges.end());
  size_t count = 0;
  for (const ByteRange& range : ranges) {
    const bool touches = count != 0 && ranges[count - 1].buffer == range.buffer &&
                         range.begin <= ranges[count - 1].end;
    if (touches) {
      ranges[count - 1].end = std::max(ranges[count - 1].end, range.end);
    } else {
      ranges[count++] = range;
    }
  }
  ranges.resize(count);
}

uint64_t bytesOf(const std::vector<ByteRange>& ranges) {
  uint64_t sum = 0;
  for (const ByteRange& range : ranges) sum += range.end - range.begin;
  return sum;
}

class ContentsWalk {
 public:
  explicit ContentsWalk(const Document& document) : document_(document) {}

  Contents run() {
    addGeometry();
    const uint64_t in_geometry = take(result_.geometry_bytes, 0);
    addImages();
    const uint64_t in_images = take(result_.image_bytes, in_geometry);
    addAnimations();
    const uint64_t in_buffers = take(result_.animation_bytes, in_images);
    result_.image_bytes += data_uri_bytes_;
    // Buffers in data URIs take a third more than their bytes, which counts as JSON.
    const uint64_t used = std::min(in_buffers + data_uri_bytes_, document_.source_bytes);
    result_.other_bytes = document_.source_bytes - used;
    return result_;
  }

 private:
  void addView(uint64_t index) {
    if (index >= document_.views.size()) return;
    ranges_.push_back(viewRange(document_, index));
  }

  /// Adds the bytes that an accessor uses; of a coded view they are not known one by one.
  void addAccessor(uint64_t index) {
    if (index >= document_.accessors.size() || !known_.insert(index).second) return;
    const Accessor& accessor = document_.accessors[index];
    // Its range is not known, or was not checked.
    if (!accessor.is_known_type || !accessor.fault.ok()) return addView(accessor.view);
    const auto ranges = accessorRanges(document_, static_cast<uint32_t>(index), false);
    ranges_.insert(ranges_.end(), ranges.begin(), ranges.end());
  }

  void addNumber(const Json& object, const char* key, bool is_accessor) {
    uint64_t index = 0;
    if (!asUnsigned(findMember(object, key), index)) return;
    is_accessor ? addAccessor(index) : addView(index);
  }

  void addGeometry() {
    for (const Primitive& primitive : document_.primitives) {
      for (const auto& attribute : primitive.attributes) addAccessor(attribute.accessor);
      addAccessor(primitive.indices);
      for (const char* name : {kExtensionName, kMeshExtension}) {
        const Json* extension = extensionOf(*primitive.json, name);
        if (extension == nullptr) continue;
        addNumber(*extension, "bufferView", false);
        // Only ours has previews.
        if (const Json* preview = findMember(*extension, "preview")) {
          addNumber(*preview, "bufferView", false);
        }
      }
    }
  }

  void addImages() {
    for (const Json& image : arrayOf(document_.json, "images")) {
      const Json* uri = findMember(image, "uri");
      if (uri == nullptr || !uri->is_string()) {
        addNumber(image, "bufferView", false);
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
    for (const Json& animation : arrayOf(document_.json, "animations")) {
      ++result_.animation_count;
      for (const Json& sampler : arrayOf(animation, "samplers")) {
        addNumber(sampler, "input", true);
        addNumber(sampler, "output", true);
      }
    }
    for (const Json& skin : arrayOf(document_.json, "skins")) {
      addNumber(skin, "inverseBindMatrices", true);
    }
  }

  /// Sets `bytes` to what the ranges have grown by since they covered `before` bytes.
  uint64_t take(uint64_t& bytes, uint64_t before) {
    join(ranges_);
    const uint64_t now = bytesOf(ranges_);
    bytes = now - before;
    return now;
  }

  const Document& document_;
  Contents result_;
  std::vector<ByteRange> ranges_;  ///< of everything that was added
  std::set<uint64_t> known_;       ///< accessors that were added
  uint64_t data_uri_bytes_ = 0;
};

}  // namespace

Contents contentsOf(const Document& document) { return ContentsWalk(document).run(); }

}  // namespace mcc::gltf
