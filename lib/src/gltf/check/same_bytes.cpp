// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/same_bytes.h"

#include <algorithm>
#include <tuple>

namespace mcc::gltf {

/// How far the pairs that are moved alike have been compared. They come in ascending order.
struct SameBytes::Sweep {
  uint64_t end = 0;         ///< bytes before it that belong to an earlier pair were compared
  uint64_t difference = 0;  ///< the last of them that differs
  bool has_difference = false;
};

void SameBytes::add(const ByteRange& in_source, const ByteRange& in_result, size_t number) {
  if (in_source.end - in_source.begin != in_result.end - in_result.begin) {
    first_ = std::min(first_, number);
  } else if (in_source.begin != in_source.end) {
    pairs_.push_back({in_source, in_result.buffer, in_result.begin, number});
  }
}

bool SameBytes::isMovedAlike(const Pair& a, const Pair& b) const {
  return a.in_source.buffer == b.in_source.buffer && a.result_buffer == b.result_buffer &&
         a.result_begin - a.in_source.begin == b.result_begin - b.in_source.begin;
}

bool SameBytes::differs(const Pair& pair, Sweep& sweep) const {
  const auto [buffer, begin, end] = pair.in_source;
  if (sweep.has_difference && begin <= sweep.difference && sweep.difference < end) return true;
  const uint64_t from = std::max(begin, sweep.end);
  if (from >= end) return false;
  const auto a = source_.buffers[buffer].subspan(from, end - from);
  const auto b =
      result_.buffers[pair.result_buffer].subspan(pair.result_begin + (from - begin), end - from);
  const auto found = std::mismatch(a.begin(), a.end(), b.begin()).first;
  sweep.end = end;
  if (found == a.end()) return false;
  sweep.has_difference = true;
  sweep.difference = from + static_cast<uint64_t>(found - a.begin());
  sweep.end = sweep.difference + 1;
  return true;
}

size_t SameBytes::firstDifference() {
  const auto key = [](const Pair& pair) {
    return std::tuple(pair.in_source.buffer, pair.result_buffer,
                      pair.result_begin - pair.in_source.begin, pair.in_source.begin);
  };
  std::sort(pairs_.begin(), pairs_.end(),
            [&](const Pair& a, const Pair& b) { return key(a) < key(b); });
  Sweep sweep;
  for (size_t i = 0; i < pairs_.size(); ++i) {
    if (i != 0 && !isMovedAlike(pairs_[i - 1], pairs_[i])) sweep = {};
    if (differs(pairs_[i], sweep)) first_ = std::min(first_, pairs_[i].number);
  }
  return first_;
}

}  // namespace mcc::gltf
