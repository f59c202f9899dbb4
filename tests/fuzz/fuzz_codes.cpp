// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The bits of the input are the answers to the decisions of mesh collapse codes. Whatever they are,
// what is expanded must be a surface. The first bytes are the claims of the header.
#include "connectivity/mc_codes.h"
#include "connectivity/stitch.h"
#include "entropy/decoder_io.h"
#include "fuzz/byte_feed.h"
#include "robustness/face_check.h"

namespace mcc::test {
namespace {

/// A decoder that reads its answers as they are.
class AnswerIo {
 public:
  using Burst = SameIo<AnswerIo>;
  using CodesBurst = SameIo<AnswerIo>;
  static constexpr bool kEncoding = false;
  [[maybe_unused]] static constexpr bool kFast = true;

  explicit AnswerIo(ByteFeed& feed) : feed_(feed) {}

  bool bit(BitModel& model, bool = false) {
    const bool one = raw(1) != 0;
    model.update(one);
    return one;
  }
  uint32_t raw(uint32_t bits, uint32_t = 0) {
    uint32_t value = 0;
    for (uint32_t i = 0; i < bits; ++i) {
      if (left_ == 0) {
        is_overrun_ = feed_.empty();
        window_ = feed_.byte();
        left_ = 8;
      }
      value |= (window_ & 1) << i;
      window_ >>= 1;
      --left_;
    }
    return value;
  }
  bool overrun() const { return is_overrun_; }

 private:
  ByteFeed& feed_;
  uint32_t window_ = 0;
  uint32_t left_ = 0;
  bool is_overrun_ = false;
};
static_assert(BitIo<AnswerIo>);

void runCodes(ByteFeed& feed) {
  McCounts claims;
  claims.operation_count = feed.u16() % 5000;
  claims.vertex_count = feed.u16() % 5000;
  claims.face_count = feed.u16() % 10000;
  claims.dummy_count = feed.byte();
  const uint32_t flags = feed.byte();
  claims.has_handles = (flags & 1) != 0;
  FaceMesh mesh{Allocator{}};
  McModels models;
  require(mesh.words.assign(size_t{claims.face_count} * kFaceWords, kNone), "memory");
  AnswerIo io(feed);
  if (!McMachine<AnswerIo>(io, models, claims, mesh, McTruth{}).run().ok()) return;
  require(mesh.face_count == claims.face_count && mesh.vertex_count == claims.vertex_count,
          "counts");
  std::string failure = checkFaces(mesh.words.data(), mesh.face_count, mesh.vertex_count);
  require(failure.empty(), failure);
  StitchModels stitch_models;
  Groups groups{Allocator{}};
  Stitcher<AnswerIo> stitcher(io, stitch_models, mesh, nullptr);
  if (!stitcher.run((flags & 128) != 0, 0, groups).ok()) return;
  require(groups.count <= mesh.vertex_count, "stitching makes vertices");
  failure = checkFaces(mesh.words.data(), mesh.face_count, groups.count);
  require(failure.empty(), "stitched: " + failure);
}

}  // namespace
}  // namespace mcc::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  mcc::test::ByteFeed feed(data, size);
  mcc::test::runCodes(feed);
  return 0;
}
