// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the stages code through. Each stage is written once, as a template over an Io, which is
//
//   StreamsIo    the reader's: reads the symbols of a payload             entropy/decoder_io.h
//   CompactIo    the same, where one coder has all symbols or code counts entropy/decoder_io.h
//   EncoderIo    the writer's: writes them, or counts what they would take entropy/enc_coder.h
//   CostIo       what counts in it, and in the trials of positions        entropy/enc_coder.h
//
// or one of the tests'. An Io is given the symbol (`truth`) and returns it; a decoder ignores what
// it is given and returns what it reads. Both sides therefore run the same code.           [A.3]
#ifndef MCC_ENTROPY_IO_H_
#define MCC_ENTROPY_IO_H_

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "base/host.h"
#include "entropy/models.h"

namespace mcc {

/// Inner loops use a Burst of the Io, which may keep a part of the Io's state in registers. Nothing
/// may use the Io between take() and giveBack(). A reference stands for the Io itself.
template <class Burst, class Io>
concept BurstOf = std::constructible_from<Burst, Io&> &&
    requires(std::remove_reference_t<Burst>& burst, Io& io) {
  burst.take(io);      // continues where the Io is now
  burst.giveBack(io);  // lets the Io continue where the burst is now
};

/// Codes the adaptive binary decisions and the plain bits of the `codes` stream.
template <class T>
concept BitIo = requires(T& io, const T& constant, BitModel& model, uint32_t bits, uint32_t truth,
                         bool one) {
  // Whether the symbols are given. Stages compute them only then.
  requires std::same_as<decltype(T::kEncoding), const bool>;
  // Whether inner loops are worth compiling apart for each choice of the encoder.
  requires std::same_as<decltype(T::kFast), const bool>;
  // The burst that codes binary decisions.
  requires BurstOf<typename T::CodesBurst, T>;
  // Codes an adaptive binary decision, and adapts its model.
  { io.bit(model, one) } -> std::same_as<bool>;
  // Codes up to 32 equally likely bits, of which `truth` has no more.
  { io.raw(bits, truth) } -> std::same_as<uint32_t>;
  // Whether more was read than there is. All symbols since then are meaningless.
  { constant.overrun() } -> std::same_as<bool>;
};

/// Codes everything. `row`, `schedule`: see entropy/models.h.
template <class T>
concept SymbolIo = BitIo<T> && requires(T& io, TokenRow& row, uint32_t base, uint32_t bits,
                                        bool sign, uint32_t truth, uint32_t& negative) {
  // The burst that codes tokens and magnitudes. Its hasRoom(n) says whether it may code n
  // tokens, with the raw bits of a vertex, before it is asked again.
  requires BurstOf<typename T::Burst, T>;
  requires requires(std::remove_reference_t<typename T::Burst> & burst) {
    { burst.hasRoom(1u) } -> std::same_as<bool>;
  };
  // Codes one of 16 symbols by one of three states, and adapts the row.
  { io.template token<0>(row, kPositionSchedule, truth) } -> std::same_as<uint32_t>;
  // Codes base + raw bits and, if `sign` is set and the sum is not zero, a sign bit.
  { io.magnitude(base, bits, sign, truth, negative) } -> std::same_as<uint32_t>;
};

/// Also has threeTokens() and threeMagnitudes(), which decode one token of each state, and what
/// follows them, at once. They may be called only if threeAtOnce().
template <class T>
concept ThreeAtOnceIo = T::kThreeAtOnce;

/// The burst of an Io that gains nothing from one: it uses the Io itself, and serves as both.
template <class Io>
class SameIo {
 public:
  static constexpr bool kEncoding = Io::kEncoding;
  explicit SameIo(Io& io) : io_(io) {}
  void take(Io&) {}
  void giveBack(Io&) const {}
  bool hasRoom(uint32_t) const { return true; }

  MCC_INLINE bool bit(BitModel& model, bool truth = false) { return io_.bit(model, truth); }
  template <uint32_t kState>
  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t truth) {
    return io_.template token<kState>(row, schedule, truth);
  }
  uint32_t raw(uint32_t bits, uint32_t truth) { return io_.raw(bits, truth); }
  uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t truth, uint32_t& negative) {
    return io_.magnitude(base, bits, sign, truth, negative);
  }

 private:
  Io& io_;
};

}  // namespace mcc

#endif  // MCC_ENTROPY_IO_H_
