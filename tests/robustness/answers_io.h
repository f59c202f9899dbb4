// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Feeds answers of a test directly to the stages of the decoder, past the entropy coders. All tests
// share one instance of the stages, which takes half a minute to compile.
#ifndef MCC_TESTS_ROBUSTNESS_ANSWERS_IO_H_
#define MCC_TESTS_ROBUSTNESS_ANSWERS_IO_H_

#include <cstdint>

#include "reader/instances.h"
#include "robustness/observed_codes.h"

namespace mcc::test {

/// What a payload would say, had it been read.
class Answers {
 public:
  virtual ~Answers() = default;
  /// The next binary decision; adapts its model.
  virtual bool bit(BitModel& model) = 0;
  /// The next token of one of three states; adapts its row.
  virtual uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t state) = 0;
  /// The next bits, all equally likely.
  virtual uint32_t raw(uint32_t bits) = 0;
  /// Whether there were more questions than answers.
  virtual bool overrun() const { return false; }
};

/// The Io of a decoder that gets these answers.
class AnswersIo {
 public:
  using Burst = SameIo<AnswersIo>;
  using CodesBurst = SameIo<AnswersIo>;
  static constexpr bool kEncoding = false;
  static constexpr bool kFast = true;  // compiles the inner loops of the decoder

  explicit AnswersIo(Answers& answers) : answers_(answers) {}

  WatchedModels& watched() { return watched_; }

  bool bit(BitModel& model, bool = false) {
    const bool one = answers_.bit(model);
    watched_.see(&model, one);
    return one;
  }
  template <uint32_t kState>
  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t = 0) {
    return answers_.token(row, schedule, kState);
  }
  uint32_t raw(uint32_t bits, uint32_t = 0) { return answers_.raw(bits); }
  uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t, uint32_t& negative) {
    const uint32_t value = base + raw(bits);
    negative = raw(sign && value != 0 ? 1 : 0);
    return value;
  }
  bool overrun() const { return answers_.overrun(); }

 private:
  Answers& answers_;
  WatchedModels watched_;
};
static_assert(SymbolIo<AnswersIo>);

}  // namespace mcc::test

namespace mcc {
MCC_ALL_INSTANCES(extern, test::AnswersIo)
}  // namespace mcc

#endif  // MCC_TESTS_ROBUSTNESS_ANSWERS_IO_H_
