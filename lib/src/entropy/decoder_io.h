// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The reader's Io: StreamsIo for payloads of three streams, CompactIo for those of one. Where the
// size of the code counts (MCC_COMPACT), CompactIo decodes both kinds, and its functions are called
// rather than inlined.                                                                     [A.3]
#ifndef MCC_ENTROPY_DECODER_IO_H_
#define MCC_ENTROPY_DECODER_IO_H_

#include <cstdint>
#include <span>
#include <type_traits>

#include "entropy/decoder.h"
#include "entropy/io.h"

namespace mcc {

/// A copy of the range decoder.
class RangeBurst {
 public:
  static constexpr bool kEncoding = false;
  template <class Io>
  explicit RangeBurst(const Io& io) : codes_(io.codes_) {}
  template <class Io>
  MCC_INLINE void giveBack(Io& io) const {
    io.codes_ = codes_;
  }
  template <class Io>
  MCC_INLINE void take(const Io& io) {
    codes_ = io.codes_;
  }

  MCC_INLINE bool bit(BitModel& model, bool = false) { return codes_.bit(model); }

 private:
  RangeDecoder codes_;
};

class StreamsIo;

/// Copies of the token and raw decoders, whose bounds are checked once per vertex.
class StreamsBurst {
 public:
  static constexpr bool kEncoding = false;
  static constexpr bool kThreeAtOnce = true;
  static constexpr bool threeAtOnce() { return true; }
  explicit StreamsBurst(const StreamsIo& io);
  void take(const StreamsIo& io);
  void giveBack(StreamsIo& io) const;

  /// Whether there is room for this many tokens with at most 51 raw bits each, and for loads that
  /// reach beyond them.
  MCC_INLINE bool hasRoom(uint32_t tokens) const {
    return tokens_.hasWords(tokens) && raw_.hasBytes(8 + 8 * tokens);
  }

  template <uint32_t kState>
  MCC_INLINE uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t = 0) {
    return tokens_.token<true>(kState, row, schedule);
  }
  uint32_t raw(uint32_t bits, uint32_t = 0) { return raw_.read(bits); }
  MCC_INLINE uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t,
                                uint32_t& negative) {
    return raw_.readMagnitude<true>(base, bits, sign, negative);
  }

  /// Decodes one token of each state.
  MCC_INLINE void threeTokens(TokenRow* const* rows, const TokenSchedule& schedule,
                              uint32_t* symbols) {
    tokens_.tokens(rows, schedule, symbols);
  }
  /// Decodes three magnitudes. Returns false, and reads nothing, when they have too many bits for
  /// one load.
  MCC_INLINE bool threeMagnitudes(const uint32_t* base, const uint32_t* bits, const uint32_t* signs,
                                  uint32_t* values, uint32_t* negative) {
    if (bits[0] + bits[1] + bits[2] > RawBitsDecoder::kThreeMagnitudesBits) [[unlikely]]
      return false;
    raw_.readThreeMagnitudes(base, bits, signs, values, negative);
    return true;
  }

 private:
  RansDecoder tokens_;
  RawBitsDecoder raw_;
};

class StreamsIo {
 public:
  using Burst = StreamsBurst;
  using CodesBurst = RangeBurst;
  static constexpr bool kEncoding = false;
  static constexpr bool kFast = true;

  StreamsIo(std::span<const uint8_t> codes, std::span<const uint8_t> tokens,
            std::span<const uint8_t> raw)
      : codes_(codes), tokens_(tokens), raw_(raw) {}

  MCC_INLINE bool bit(BitModel& model, bool = false) { return codes_.bit(model); }

  template <uint32_t kState>
  MCC_INLINE uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t = 0) {
    return tokens_.token(kState, row, schedule);
  }

  MCC_INLINE uint32_t raw(uint32_t bits, uint32_t = 0) { return raw_.read(bits); }

  MCC_INLINE uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t,
                                uint32_t& negative) {
    return raw_.readMagnitude(base, bits, sign, negative);
  }

  bool overrun() const { return codes_.overrun() || tokens_.overrun() || raw_.overrun(); }

  /// Returns the number of bits read so far, to within a few bits.
  uint64_t spentBits() const { return codes_.spentBits() + tokens_.spentBits() + raw_.spentBits(); }

  /// Checks that every stream was used up exactly. [A.3.8]
  Status finish() const { return checkFinished(overrun(), codes_, &tokens_, &raw_); }

 private:
  friend class StreamsBurst;
  friend class RangeBurst;

  RangeDecoder codes_;
  RansDecoder tokens_;
  RawBitsDecoder raw_;
};
static_assert(SymbolIo<StreamsIo> && ThreeAtOnceIo<StreamsBurst>);

inline StreamsBurst::StreamsBurst(const StreamsIo& io) : tokens_(io.tokens_), raw_(io.raw_) {}
inline void StreamsBurst::take(const StreamsIo& io) { *this = StreamsBurst(io); }
inline void StreamsBurst::giveBack(StreamsIo& io) const {
  io.tokens_ = tokens_;
  io.raw_ = raw_;
}

#if defined(MCC_COMPACT)
#define MCC_CALLED MCC_OUT_OF_LINE
#else
#define MCC_CALLED MCC_INLINE
#endif

/// The decoder of payloads with a single coder and, in compact code, of all payloads. [A.3.7]
class CompactIo {
 public:
  static constexpr bool kEncoding = false;
  static constexpr bool kFast = false;
  static constexpr bool kThreeAtOnce = kCompact;
  /// Inner loops use the Io itself, or at most a copy of the range decoder.
  using Burst = CompactIo&;
  using CodesBurst = std::conditional_t<kSmall, CompactIo&, RangeBurst>;

  /// A single coder has only `codes`; others are decoded only in compact code, and are its default.
  CompactIo(std::span<const uint8_t> codes, std::span<const uint8_t> tokens,
            std::span<const uint8_t> raw, bool single = !kCompact)
      : codes_(codes), tokens_(tokens), raw_(raw), is_single_(single) {}

  MCC_CALLED bool bit(BitModel& model, bool = false) { return codes_.bit(model); }

  template <uint32_t kState>
  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t = 0) {
    return tokenOf(kState, row, schedule);
  }

  MCC_CALLED uint32_t raw(uint32_t bits, uint32_t = 0) {
    return isSingle() ? codes_.raw(bits) : raw_.read(bits);
  }

  MCC_CALLED uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t,
                                uint32_t& negative) {
    const uint32_t value = base + raw(bits);
    negative = raw(sign && value != 0 ? 1 : 0);
    return value;
  }

  /// False for a single coder, which codes the raw bits of each token right after it.
  bool threeAtOnce() const { return !isSingle(); }
  /// Decodes one token of each state. Only if threeAtOnce().
  MCC_INLINE void threeTokens(TokenRow* const* rows, const TokenSchedule& schedule,
                              uint32_t* symbols) {
    if (tokens_.hasWords(kRansStateCount)) [[likely]]
      return tokens_.tokens(rows, schedule, symbols);
    for (uint32_t s = 0; s < kRansStateCount; ++s) symbols[s] = tokenOf(s, *rows[s], schedule);
  }
  /// Decodes three magnitudes. Returns false, and reads nothing, when they take more than one load.
  MCC_INLINE bool threeMagnitudes(const uint32_t* base, const uint32_t* bits, const uint32_t* signs,
                                  uint32_t* values, uint32_t* negative) {
    if (!raw_.hasBytes(8) || bits[0] + bits[1] + bits[2] > RawBitsDecoder::kThreeMagnitudesBits)
        [[unlikely]]
      return false;
    raw_.readThreeMagnitudes(base, bits, signs, values, negative);
    return true;
  }

  bool overrun() const {
    return codes_.overrun() || (!isSingle() && (tokens_.overrun() || raw_.overrun()));
  }

  /// Returns the number of bits read so far, to within a few bits.
  uint64_t spentBits() const {
    return codes_.spentBits() + (isSingle() ? 0 : tokens_.spentBits() + raw_.spentBits());
  }

  /// Checks that every stream was used up exactly. [A.3.8]
  Status finish() const {
    return checkFinished(overrun(), codes_, isSingle() ? nullptr : &tokens_,
                         isSingle() ? nullptr : &raw_);
  }

  void take(const CompactIo&) {}
  void giveBack(const CompactIo&) {}
  bool hasRoom(uint32_t) const { return true; }

 private:
  friend class RangeBurst;

  MCC_INLINE bool isSingle() const { return !kCompact || is_single_; }
  MCC_CALLED uint32_t tokenOf(uint32_t state, TokenRow& row, const TokenSchedule& schedule) {
    return isSingle() ? codes_.token(row, schedule) : tokens_.token(state, row, schedule);
  }

  RangeDecoder codes_;
  RansDecoder tokens_;
  RawBitsDecoder raw_;
  const bool is_single_;
};
static_assert(SymbolIo<CompactIo>);

#undef MCC_CALLED

/// The decoder of payloads of one kind.
template <bool kSingle>
using DecoderIo = std::conditional_t<kSingle, CompactIo, StreamsIo>;

}  // namespace mcc

#endif  // MCC_ENTROPY_DECODER_IO_H_
