// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tells where the bytes of a document are and what they are for.
//
// Lays out the buffer of a document whose accessors changed, before any byte of it is written:
// bytes that nothing refers to any more are left out, new buffer views are added, and everything
// gets its place in one buffer, the BIN chunk of a GLB.
#ifndef MCC_GLTF_DOCUMENT_LAYOUT_H_
#define MCC_GLTF_DOCUMENT_LAYOUT_H_

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "gltf/document/document.h"
#include "mcc/glb.h"

namespace mcc::gltf {

/// A range of bytes in one source buffer.
struct ByteRange {
  uint32_t buffer = 0;
  uint64_t begin = 0;
  uint64_t end = 0;

  auto operator<=>(const ByteRange&) const = default;
};

/// Returns the bytes of a view, coded or not.
ByteRange viewRange(const Document& document, uint64_t view);

/// Returns the source bytes an accessor needs: its elements, or its whole buffer views if
/// `whole_views`.
std::vector<ByteRange> accessorRanges(const Document& document, uint32_t accessor,
                                      bool whole_views);

/// Ranges of source bytes with their owners, and who owns which bytes.
class OwnedRanges {
 public:
  /// The owners of a byte, each with the number of its ranges there.
  using Owners = std::map<size_t, uint32_t>;

  void add(const ByteRange& range, size_t owner);
  /// Calls visit(bytes, owners) for the runs of bytes that have the same owners, at least one.
  void visit(const std::function<void(uint64_t bytes, const Owners& owners)>& visit);

 private:
  struct Edge {
    uint32_t buffer;
    uint64_t offset;
    bool is_begin;
    size_t owner;
  };
  std::vector<Edge> edges_;
};

/// Returns what the bytes of a loaded document are for. Bytes that several things use count once,
/// for the first of geometry, images and animations. Takes time proportional to the JSON, up to a
/// logarithm.
Contents contentsOf(const Document& document);

/// The number of the first new view while a document is edited. A file that names a view which does
/// not exist does so by a smaller number.
inline constexpr uint64_t kFirstNewView = uint64_t{1} << 52;

/// Values of NewView::target.
inline constexpr uint32_t kArrayBuffer = 34962;
inline constexpr uint32_t kElementArrayBuffer = 34963;

/// A buffer view that the result has in addition to those of the source.
struct NewView {
  uint64_t byte_count = 0;
  const uint8_t* bytes = nullptr;  ///< what it holds; null: whoever fills the buffer stores it
  std::vector<uint8_t> owned;      ///< where `bytes` are, if nobody else has them
  uint32_t stride_bytes = 0;       ///< 0: none is written
  uint32_t target = 0;             ///< of the GPU; 0: none is written
  bool is_in_front = false;        ///< before all bytes of the source, instead of after them

  void hold(std::vector<uint8_t> content) {
    owned = std::move(content);
    borrow(owned);
  }
  void borrow(std::span<const uint8_t> content) {
    bytes = content.data();
    byte_count = content.size();
  }
  /// Returns its JSON for a place in a buffer.
  Json json(uint64_t buffer, uint64_t offset) const;
};

/// Adds a view, and makes an accessor read it from its beginning.
inline void addView(NewView view, Json& accessor, std::vector<NewView>& views) {
  accessor.erase("byteOffset");
  accessor["bufferView"] = kFirstNewView + views.size();
  views.push_back(std::move(view));
}

/// Where everything in the buffer is.
struct Layout {
  /// Bytes that exist already, of the source or of a new view.
  struct Run {
    uint64_t offset = 0;
    std::span<const uint8_t> bytes;
  };
  std::vector<Run> runs;
  std::vector<uint64_t> offsets;  ///< of each new view
  uint64_t byte_count = 0;

  /// Stores the runs. `buffer` has `byte_count` bytes, which are zero.
  void copyTo(std::span<uint8_t> buffer) const;
};

/// Leaves out what was freed and adds what is new.
/// document   the source, as it was loaded. The layout borrows its bytes and those of the views.
/// json       the edited document. Buffer views have the numbers of the source; new view k has the
///            number kFirstNewView + k. Accessors keep their numbers; if an old one still has a
///            bufferView, nothing about its bytes was edited.
/// On return `json` has the final numbers and offsets, and the layout is that of its first buffer;
/// others are those whose bytes are missing, with their views as they were. A number of a view that
/// does not exist still names none. A view that nothing referred to in the source is kept, unless
/// it is free. View numbers do not change when document.foreign.keep_numbers: new views take the
/// free numbers first, then those after the end.
Layout layOut(const Document& document, std::span<const NewView> new_views, Json& json);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DOCUMENT_LAYOUT_H_
