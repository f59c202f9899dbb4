// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
// Finds out what random answers to the mesh collapse machine yield, to make claims that fit them.
// What random answers to the mesh collapse machine yield, for claims that fit them.
#ifndef MCC_TESTS_ROBUSTNESS_OBSERVED_CODES_H_
#define MCC_TESTS_ROBUSTNESS_OBSERVED_CODES_H_

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "connectivity/mc_codes.h"
#include "robustness/face_check.h"

namespace mcc::test {

/// Counts the ones among the answers for some models.
class WatchedModels {
 public:
  void watch(const BitModel* first, size_t count) { watched_.push_back({first, first + count}); }
  void see(const BitModel* model, bool one) {
    for (const Range& w : watched_) ones_ += one && model >= w.begin && model < w.end ? 1 : 0;
  }
  uint32_t ones() const { return ones_; }

 private:
  struct Range {
    const BitModel* begin;
    const BitModel* end;
  };
  std::vector<Range> watched_;
  uint32_t ones_ = 0;
};

struct ObservedCodes {
  uint32_t vertices = 0;
  uint32_t faces = 0;
  uint32_t dummies = 0;
  bool complete = false;  ///< all operations were taken
  std::string failure;
};

/// Runs the machine on claims it cannot fulfil, to learn what the answers of `io` yield. `io` has
/// watched(), which returns its WatchedModels.
template <class Io>
ObservedCodes observeCodes(Io& io, const McCounts& claims) {
  constexpr uint32_t kUntouched = 0xabababab;
  ObservedCodes observed;
  FaceMesh mesh{Allocator{}};
  McModels models;
  if (!mesh.words.assign(size_t{claims.face_count} * kFaceWords, kUntouched)) {
    observed.failure = "no memory";
    return observed;
  }
  io.watched().watch(models.dummy_end, 2);
  io.watched().watch(&models.dummy_twig, 1);
  io.watched().watch(&models.dummy_finish, 1);
  CodeHistogram histogram;
  const McWatch watch{&histogram, nullptr};
  const Status status = McMachine<Io>(io, models, claims, mesh, McTruth{}).run(&watch);
  if (status.ok()) observed.failure = "fulfils impossible claims";
  while (observed.faces < claims.face_count &&
         mesh.words[size_t{observed.faces} * kFaceWords] != kUntouched) {
    for (uint32_t k = 0; k < 3; ++k) {
      observed.vertices =
          std::max(observed.vertices, mesh.words[size_t{observed.faces} * kFaceWords + k] + 1);
    }
    ++observed.faces;
  }
  observed.dummies = io.watched().ones() + static_cast<uint32_t>(histogram.dummy);
  observed.complete =
      std::string(status.what) == "the codes do not yield the counts that the header claims";
  if (observed.failure.empty())
    observed.failure = checkFaces(mesh.words.data(), observed.faces, observed.vertices);
  return observed;
}

}  // namespace mcc::test

#endif  // MCC_TESTS_ROBUSTNESS_OBSERVED_CODES_H_
