// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_BIN_END_H_
#define MCC_TILES_BIN_END_H_

#include <cstdint>
#include <span>
#include <vector>

#include "gltf/base/result.h"
#include "gltf/document/glb.h"
#include "gltf/document/json.h"

namespace mcc::tiles {

/// The end of the BIN chunk of a GLB, where new buffer views are added. What was there does not
/// move.
class BinEnd {
 public:
  /// `glb` is borrowed, until bytes() is called for the last time.
  explicit BinEnd(const gltf::GlbFile& glb) : old_(glb.bin), has_bin_(glb.has_bin) {}

  /// Adds bytes at a multiple of 8, which properties of 64 bits need, and a buffer view of them to
  /// the JSON, whose number becomes `view`. There must be bytes. `members` are the members of the
  /// view apart from the place of its bytes.
  /// Errors: buffer 0 of the document is not the BIN chunk.
  gltf::Result addView(std::span<const uint8_t> bytes, gltf::Json members, gltf::Json& root,
                       uint32_t& view);

  /// Returns the bytes of the chunk.
  std::span<const uint8_t> bytes() const { return has_grown_ ? grown_ : old_; }

 private:
  gltf::Result startGrowing(gltf::Json& root);

  std::span<const uint8_t> old_;
  bool has_bin_ = false;
  bool has_grown_ = false;
  std::vector<uint8_t> grown_;
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_BIN_END_H_
