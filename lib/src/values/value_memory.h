// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Remembers values by the values next to them: where parts and charts repeat, even mirrored, one
// flag codes a value. [A.10.10]
#ifndef MCC_VALUES_VALUE_MEMORY_H_
#define MCC_VALUES_VALUE_MEMORY_H_

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/memory.h"
#include "entropy/models.h"
#include "mesh/dequantize.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"

namespace mcc {

struct MemoryModels {
  BitModel known[4][4];  ///< [candidates asked for before][last two outcomes]
};

/// Two different values for each key, as the wedges that have them.
struct MemoryEntry {
  uint32_t check;
  uint32_t wedge[2];  ///< the latest first; kNone: none
};

/// Values for each key, which is made of the values at an edge or of a prediction. With
/// kIgnoresSigns, floats that differ in sign are equal. [A.10.10]
template <uint32_t kComponents, bool kIgnoresSigns>
class ValueMemory {
 public:
  /// `entries` is work space.
  explicit ValueMemory(Array<MemoryEntry>& entries) : entries_(entries) {}

  /// Starts with no values. `values`: kComponents per wedge.
  [[nodiscard]] bool start(uint32_t face_count, const int32_t* values) {
    values_ = values;
    history_ = 0;
    bits_ = std::min(static_cast<uint32_t>(std::bit_width(face_count)) + 1, kMostBits);
    return entries_.assign(size_t{1} << bits_, MemoryEntry{0, {kNone, kNone}});
  }

  /// The key of the values at the ends of an edge, the same in both directions.
  uint64_t edgeKey(uint32_t a, uint32_t b) const { return keyOf(hashOf(a) + hashOf(b)); }
  /// The key of a prediction that integers stand for.
  static uint64_t predictionKey(const uint32_t* integers) { return keyOf(hashOf(integers)); }

  /// To be called before the first ask() about a wedge.
  void begin() { asked_count_ = 0; }
  /// Asks whether the value is one of those at a key. Values that were asked for before are left
  /// out, and so is that of wedge `except`, unless it is kNone. `isValue(k)` is the encoder's
  /// answer for the value of wedge k. Returns k, or kNone.
  template <class Io, class IsValue>
  uint32_t ask(Io& io, MemoryModels& models, uint64_t key, uint32_t except, IsValue isValue) {
    const MemoryEntry e = entries_[placeOf(key)];
    if (e.check != static_cast<uint32_t>(key)) return kNone;
    for (const uint32_t k : e.wedge) {
      if (k == kNone || (except != kNone && isEqual(k, except)) || wasAsked(k)) continue;
      BitModel& model = models.known[asked_count_][history_];
      const bool hit = io.bit(model, Io::kEncoding && isValue(k));
      history_ = (history_ << 1 | (hit ? 1u : 0u)) & 3;
      if (hit) return k;
      asked_[asked_count_++] = k;
    }
    return kNone;
  }

  void learn(uint64_t key, uint32_t wedge) {
    MemoryEntry& e = entries_[placeOf(key)];
    const uint32_t check = static_cast<uint32_t>(key);
    const bool is_known = e.check == check;
    if (!is_known || e.wedge[0] == kNone || !isEqual(wedge, e.wedge[0])) {
      e.wedge[1] = is_known ? e.wedge[0] : kNone;
    }
    e.check = check;
    e.wedge[0] = wedge;
  }

  /// Learns the third corners of the faces that the wedges in the group of w complete.
  template <class Io>
  void learnGroup(const AttributeJob<Io>& job, uint32_t w) {
    const uint64_t of_group = hashOf(w);
    for (uint32_t m = w; m != kNone; m = job.groups.nextOf(m)) learnFaces(job, m, of_group);
  }

 private:
  static constexpr uint32_t kMostBits = 22;
  static constexpr uint32_t kFaceLimit = 16;

  template <class Io>
  void learnFaces(const AttributeJob<Io>& job, uint32_t w, uint64_t of_w) {
    uint32_t faces = 0;
    for (uint32_t h = job.wedges.firstCompleted(w); h != kNone && faces < kFaceLimit;
         h = job.wedges.nextCompleted(h), ++faces) {
      const auto [n, p] = job.othersOf(h);
      if (!job.isCoded(n) || !job.isCoded(p)) continue;
      const uint64_t of_n = hashOf(n);
      const uint64_t of_p = hashOf(p);
      learn(keyOf(of_n + of_p), w);
      learn(keyOf(of_w + of_n), p);
      learn(keyOf(of_w + of_p), n);
    }
  }

  uint32_t seen(uint32_t w, uint32_t c) const {
    const int32_t value = values_[size_t{w} * kComponents + c];
    return kIgnoresSigns ? bitsFromOrdered(value) & 0x7fffffffu : static_cast<uint32_t>(value);
  }
  bool isEqual(uint32_t a, uint32_t b) const {
    uint32_t difference = 0;
    for (uint32_t c = 0; c < kComponents; ++c) difference |= seen(a, c) ^ seen(b, c);
    return difference == 0;
  }
  bool wasAsked(uint32_t k) const {
    return std::any_of(asked_, asked_ + asked_count_,
                       [=, this](uint32_t other) { return isEqual(k, other); });
  }
  static uint64_t addToHash(uint64_t h, uint32_t x) {
    h = (h ^ x) * 0x9e3779b97f4a7c15u;
    return h ^ (h >> 29);
  }
  static constexpr uint64_t kEmptyHash = 0x243f6a8885a308d3u;
  uint64_t hashOf(uint32_t w) const {
    uint32_t integers[kComponents];
    for (uint32_t c = 0; c < kComponents; ++c) integers[c] = seen(w, c);
    return hashOf(integers);
  }
  static uint64_t hashOf(const uint32_t* integers) {
    uint64_t h = kEmptyHash;
    for (uint32_t c = 0; c < kComponents; ++c) h = addToHash(h, integers[c]);
    return h;
  }
  size_t placeOf(uint64_t key) const { return static_cast<size_t>(key >> (64 - bits_)); }
  static uint64_t keyOf(uint64_t hash) {
    const uint64_t h = hash * 0xbf58476d1ce4e5b9u;
    return h ^ (h >> 32);
  }

  Array<MemoryEntry>& entries_;
  const int32_t* values_ = nullptr;
  uint32_t bits_ = 0;
  uint32_t history_ = 0;
  uint32_t asked_[4];
  uint32_t asked_count_ = 0;
};

}  // namespace mcc

#endif  // MCC_VALUES_VALUE_MEMORY_H_
