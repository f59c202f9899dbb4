// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Entropy decoders.                                                                        [A.3]
//
// A payload has three streams: `codes` (binary range coder), `tokens` (three interleaved rANS
// states) and `raw` (plain bits). A small payload has only `codes`, and tokens and raw bits go
// through its range coder. Stage code is written once against the interface that DecoderIo and
// EncoderIo share:
//   bit(model, truth)            codes one adaptive binary decision
//   token<state>(row, schedule, truth)   codes one of 16 symbols
//   raw(bits, truth)             codes up to 32 equiprobable bits
//   magnitude(base, bits, sign, truth, negative)   codes base + raw bits, and a sign unless zero
// The decoder ignores `truth` and returns what it read; the encoder codes `truth` and returns it.
#ifndef MCC_ENTROPY_DECODER_H_
#define MCC_ENTROPY_DECODER_H_

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "base/host.h"
#include "entropy/models.h"
#include "mcc/status.h"

namespace mcc {

/// Loads in little-endian order, which compilers turn into one instruction. loadU16() copies bytes,
/// since gcc does not always combine two shifted bytes.
MCC_INLINE uint32_t loadU16(const uint8_t* p) {
  if constexpr (std::endian::native == std::endian::little) {
    uint16_t value;
    std::memcpy(&value, p, sizeof value);
    return value;
  } else {
    return uint32_t{p[0]} | uint32_t{p[1]} << 8;
  }
}
MCC_INLINE uint32_t loadU32(const uint8_t* p) {
  return uint32_t{p[0]} | uint32_t{p[1]} << 8 | uint32_t{p[2]} << 16 | uint32_t{p[3]} << 24;
}
MCC_INLINE uint64_t loadU64(const uint8_t* p) {
  return uint64_t{loadU32(p)} | uint64_t{loadU32(p + 4)} << 32;
}

/// Binary range decoder with a 64-bit range and 32-bit words. After its end the stream continues
/// with zeros, so that the writer may drop trailing zero bytes.
/// [A.3.2]
class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {
    code_ = uint64_t{nextWord()} << 32;
    code_ |= nextWord();
  }

  /// Branches on the bit, as callers do anyway, so that the next decision starts from a predicted
  /// range.
  MCC_INLINE bool bit(BitModel& model) {
    const uint64_t split = (range_ >> kProbabilityBits) * model.zeroProbability();
    const bool one = code_ >= split;
    if (one) {
      code_ -= split;
      range_ -= split;
    } else {
      range_ = split;
    }
    model.update(one);
    renormalise();
    return one;
  }

  /// Returns the value below 2^bits that falls into a symbol's interval; consume() must follow.
  uint32_t peek(uint32_t bits) {
    const uint64_t value = code_ / (range_ >> bits);
    const uint64_t last = (uint64_t{1} << bits) - 1;
    return static_cast<uint32_t>(value < last ? value : last);
  }
  void consume(uint32_t start, uint32_t frequency, uint32_t bits) {
    const uint64_t unit = range_ >> bits;
    code_ -= unit * start;
    range_ = unit * frequency;
    renormalise();
  }

  /// Reads the tokens and raw bits of payloads that have no streams for them.
  uint32_t token(TokenRow& row, const TokenSchedule& schedule) {
    const uint32_t slot = peek(kTokenBits);
    uint32_t start = 0;
    uint32_t frequency = 0;
    const uint32_t symbol = row.findAndAdapt(slot, schedule, start, frequency);
    consume(start, frequency, kTokenBits);
    return symbol;
  }
  uint32_t raw(uint32_t bits) {
    uint32_t value = 0;
    for (uint32_t done = 0; done < bits; done += 16) {
      const uint32_t count = bits - done < 16 ? bits - done : 16;
      const uint32_t part = peek(count);
      consume(part, 1, count);
      value |= part << done;
    }
    return value;
  }

  /// Whether all bytes were used, and beyond them at most the zeros that the writer may have
  /// dropped.
  bool finished() const { return next_ >= bytes_.size() && next_ <= bytes_.size() + 8; }
  bool overrun() const { return next_ > bytes_.size() + 8; }
  /// Returns the number of bits read so far, to within one bit.
  uint64_t spentBits() const { return 8 * uint64_t{next_} - std::bit_width(range_); }

 private:
  MCC_INLINE void renormalise() {
    if (range_ < (uint64_t{1} << 32)) [[unlikely]] {
      range_ <<= 32;
      code_ = code_ << 32 | nextWord();
    }
  }

  MCC_INLINE uint32_t nextWord() {
    const uint32_t word = wordAt(bytes_.data(), bytes_.size(), next_);
    next_ += 4;
    return word;
  }
  /// Handles the rare end of the stream out of line. Static, so that a decoder that is a local
  /// variable can stay in registers.
  MCC_OUT_OF_LINE static uint32_t wordAt(const uint8_t* bytes, size_t size, size_t at) {
    if (at + 4 <= size) return loadU32(bytes + at);
    uint32_t word = 0;
    for (size_t i = 0; i < 4 && at + i < size; ++i) word |= uint32_t{bytes[at + i]} << (8 * i);
    return word;
  }

  std::span<const uint8_t> bytes_;
  size_t next_ = 0;
  uint64_t range_ = ~uint64_t{0};
  uint64_t code_ = 0;
};

/// Three interleaved rANS states over one sequence of 16-bit words, which begins with the states'
/// initial values (32 bits each).
/// [A.3.3]
class RansDecoder {
 public:
  explicit RansDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {
    for (uint32_t& state : state_) {
      state = nextWord();
      state |= nextWord() << 16;
      if (state < kRansLow) {
        overrun_ = true;
        state = kRansLow;
      }
    }
  }

  /// Decodes a token. If kUnchecked, hasWords(1) must hold.
  template <bool kUnchecked = false>
  MCC_INLINE uint32_t token(uint32_t state, TokenRow& row, const TokenSchedule& schedule) {
    uint32_t x = state_[state];
    const uint32_t slot = x & (kTokenOne - 1);
    uint32_t start = 0;
    uint32_t frequency = 0;
    const uint32_t symbol = row.findAndAdapt(slot, schedule, start, frequency);
    x = frequency * (x >> kTokenBits) + slot - start;
    if (kUnchecked || hasWords(1)) [[likely]] {
      // Without a branch, because it is close to random whether a word is due.
      const int64_t due = (int64_t{x} - kRansLow) >> 63;  // -1 or 0
      const uint32_t longer = x << 16 | loadU16(bytes_.data() + next_);
      x ^= (x ^ longer) & static_cast<uint32_t>(due);
      next_ -= static_cast<size_t>(2 * due);
    } else if (x < kRansLow) {
      x = x << 16 | nextWord();
    }
    state_[state] = x;
    return symbol;
  }

  /// Decodes one token of each state, without checks: hasWords(3) must hold.
  MCC_INLINE void tokens(TokenRow* const* rows, const TokenSchedule& schedule, uint32_t* symbols) {
    const uint8_t* at = bytes_.data() + next_;
    MCC_UNROLL
    for (uint32_t s = 0; s < kRansStateCount; ++s) {
      uint32_t x = state_[s];
      const uint32_t slot = x & (kTokenOne - 1);
      uint32_t start = 0;
      uint32_t frequency = 0;
      symbols[s] = rows[s]->findAndAdapt(slot, schedule, start, frequency);
      x = frequency * (x >> kTokenBits) + slot - start;
      const uint64_t due = uint64_t{0} - uint64_t{x < kRansLow};
      const uint32_t longer = x << 16 | loadU16(at);
      state_[s] = x ^ ((x ^ longer) & static_cast<uint32_t>(due));
      at -= 2 * static_cast<int64_t>(due);
    }
    next_ = static_cast<size_t>(at - bytes_.data());
  }

  MCC_INLINE bool hasWords(size_t count) const { return next_ + 2 * count <= bytes_.size(); }

  bool finished() const {
    return !overrun_ && next_ == bytes_.size() && state_[0] == kRansLow && state_[1] == kRansLow &&
           state_[2] == kRansLow;
  }
  bool overrun() const { return overrun_; }
  /// Returns the number of bits read so far, to within three bits.
  uint64_t spentBits() const {
    uint64_t bits = 8 * uint64_t{next_};
    for (const uint32_t state : state_) bits -= std::bit_width(state);
    return bits;
  }

 private:
  uint32_t nextWord() {
    if (next_ + 2 > bytes_.size()) {
      overrun_ = true;
      return 0;
    }
    const uint32_t word = loadU16(bytes_.data() + next_);
    next_ += 2;
    return word;
  }

  std::span<const uint8_t> bytes_;
  size_t next_ = 0;
  uint32_t state_[kRansStateCount];
  bool overrun_ = false;
};

/// A table of masks with all ones below a bit; shifts by a variable take longer.
struct RawMasks {
  uint32_t below[64];
};
constexpr RawMasks makeRawMasks() {
  RawMasks masks{};
  for (uint32_t i = 0; i < 64; ++i) masks.below[i] = static_cast<uint32_t>((uint64_t{1} << i) - 1);
  return masks;
}
inline constexpr RawMasks kRawMasks = makeRawMasks();
MCC_INLINE uint32_t maskBelow(uint32_t bit) {
  if constexpr (kCompact) {
    return static_cast<uint32_t>((uint64_t{1} << bit) - 1);
  } else {
    return kRawMasks.below[bit];
  }
}

/// Plain bits, least significant bit first.
/// [A.3.4]
class RawBitsDecoder {
 public:
  explicit RawBitsDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  MCC_INLINE uint32_t read(uint32_t bits) {  // bits <= 32
    const size_t byte = static_cast<size_t>(next_bit_ >> 3);
    uint64_t window = 0;
    if (byte + 8 <= bytes_.size()) [[likely]] {
      window = loadU64(bytes_.data() + byte);
    } else {
      for (size_t i = 0; i < 8 && byte + i < bytes_.size(); ++i) {
        window |= uint64_t{bytes_[byte + i]} << (8 * i);
      }
    }
    window >>= next_bit_ & 7;
    next_bit_ += bits;
    return static_cast<uint32_t>(window & ((uint64_t{1} << bits) - 1));
  }

  /// Reads base + `bits` raw bits (at most 56 with the sign); a sign bit follows if `sign` is set
  /// and the sum is not zero. If kUnchecked, hasBytes(8) must hold.
  template <bool kUnchecked = false>
  MCC_INLINE uint32_t readMagnitude(uint32_t base, uint32_t bits, bool sign, uint32_t& negative) {
    const size_t byte = static_cast<size_t>(next_bit_ >> 3);
    if (!kUnchecked && byte + 8 > bytes_.size()) [[unlikely]] {
      const uint32_t value = base + read(bits);
      negative = read(sign && value != 0 ? 1 : 0);
      return value;
    }
    const uint64_t window = loadU64(bytes_.data() + byte) >> (next_bit_ & 7);
    const uint32_t value = base + static_cast<uint32_t>(window & ((uint64_t{1} << bits) - 1));
    const uint32_t signs = sign && value != 0 ? 1 : 0;
    negative = static_cast<uint32_t>(window >> bits) & signs;
    next_bit_ += bits + signs;
    return value;
  }

  /// Reads three magnitudes and signs (`signs` are 0 or 1) from one load, of at most
  /// kThreeMagnitudesBits bits. Unchecked: hasBytes(8) must hold.
  MCC_INLINE void readThreeMagnitudes(const uint32_t* base, const uint32_t* bits,
                                      const uint32_t* signs, uint32_t* values, uint32_t* negative) {
    uint64_t window =
        loadU64(bytes_.data() + static_cast<size_t>(next_bit_ >> 3)) >> (next_bit_ & 7);
    MCC_UNROLL
    for (uint32_t s = 0; s < 3; ++s) {
      const uint32_t value = base[s] + (static_cast<uint32_t>(window) & maskBelow(bits[s]));
      const uint32_t has_sign = uint32_t{value != 0} & signs[s];
      window >>= bits[s];
      values[s] = value;
      negative[s] = static_cast<uint32_t>(window) & has_sign;
      window >>= has_sign;
      next_bit_ += bits[s] + has_sign;
    }
  }
  static constexpr uint32_t kThreeMagnitudesBits = 64 - 7 - 3;

  MCC_INLINE bool hasBytes(size_t count) const { return (next_bit_ >> 3) + count <= bytes_.size(); }
  /// Whether every byte was used and the rest of the last one is zero.
  bool finished() const {
    if ((next_bit_ + 7) / 8 != bytes_.size()) return false;
    return next_bit_ % 8 == 0 || bytes_.back() >> (next_bit_ % 8) == 0;
  }
  bool overrun() const { return (next_bit_ + 7) / 8 > bytes_.size(); }
  uint64_t spentBits() const { return next_bit_; }

 private:
  std::span<const uint8_t> bytes_;
  uint64_t next_bit_ = 0;
};

/// Checks that every stream was used up exactly. Null pointers stand for streams that the payload
/// does not have. [A.3.8]
inline Status checkFinished(bool overrun, const RangeDecoder& codes, const RansDecoder* tokens,
                            const RawBitsDecoder* raw) {
  if (overrun) return fail(Error::kTruncated, "a stream ends before its last symbol");
  if (!codes.finished()) return fail(Error::kTrailingBytes, "the code stream has bytes left over");
  if (tokens != nullptr && !tokens->finished()) {
    return fail(Error::kTrailingBytes, "the token stream does not end where its last symbol does");
  }
  if (raw != nullptr && !raw->finished()) {
    return fail(Error::kTrailingBytes, "the raw bits do not end where the last of them does");
  }
  return {};
}

/// Inner loops that code one vertex after another use an Io::Burst. They take it from the Io, and
/// give it back before anything else uses the Io. An Io::CodesBurst is the same for binary
/// decisions. This one is the Io itself, and serves as both.
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

template <bool kSingle>
class DecoderIo;

/// A copy of the range decoder.
class CodesDecoderBurst {
 public:
  static constexpr bool kEncoding = false;
  template <bool kSingle>
  explicit CodesDecoderBurst(const DecoderIo<kSingle>& io) : codes_(io.codes_) {}
  template <bool kSingle>
  MCC_INLINE void giveBack(DecoderIo<kSingle>& io) const {
    io.codes_ = codes_;
  }
  template <bool kSingle>
  MCC_INLINE void take(const DecoderIo<kSingle>& io) {
    codes_ = io.codes_;
  }

  MCC_INLINE bool bit(BitModel& model, bool = false) { return codes_.bit(model); }

 private:
  RangeDecoder codes_;
};

/// Copies of the token and raw decoders, whose bounds are checked once per vertex.
class DecoderBurst {
 public:
  static constexpr bool kEncoding = false;
  /// This Io has threeTokens() and threeMagnitudes(); others lack this constant.
  static constexpr bool kThreeAtOnce = true;
  static constexpr bool threeAtOnce() { return true; }  ///< whether they may be called
  explicit DecoderBurst(const DecoderIo<false>& io);
  void take(const DecoderIo<false>& io);
  void giveBack(DecoderIo<false>& io) const;

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

/// The decoder as stage code sees it. If kSingle, everything goes through the range coder. [A.3.7]
template <bool kSingle>
class DecoderIo {
 public:
  using Burst = std::conditional_t<kSingle, SameIo<DecoderIo>, DecoderBurst>;
  using CodesBurst = CodesDecoderBurst;
  static constexpr bool kEncoding = false;
  static constexpr bool kFast = !kSingle;  ///< worth compiling inner loops separately per choice

  DecoderIo(std::span<const uint8_t> codes, std::span<const uint8_t> tokens,
            std::span<const uint8_t> raw)
      : codes_(codes), tokens_(tokens), raw_(raw) {}

  MCC_INLINE bool bit(BitModel& model, bool = false) { return codes_.bit(model); }

  template <uint32_t kState>
  MCC_INLINE uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t = 0) {
    if constexpr (kSingle) {
      return codes_.token(row, schedule);
    } else {
      return tokens_.token(kState, row, schedule);
    }
  }

  MCC_INLINE uint32_t raw(uint32_t bits, uint32_t = 0) {
    if constexpr (kSingle) {
      return codes_.raw(bits);
    } else {
      return raw_.read(bits);
    }
  }

  /// Reads base + `bits` raw bits, then a sign bit if `sign` is set and the sum is not zero.
  MCC_INLINE uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t,
                                uint32_t& negative) {
    if constexpr (kSingle) {
      const uint32_t value = base + raw(bits);
      negative = raw(sign && value != 0 ? 1 : 0);
      return value;
    } else {
      return raw_.readMagnitude(base, bits, sign, negative);
    }
  }

  /// Whether more was read than the streams hold. All values since then are meaningless.
  bool overrun() const {
    if constexpr (kSingle) {
      return codes_.overrun();
    } else {
      return codes_.overrun() || tokens_.overrun() || raw_.overrun();
    }
  }

  /// Returns the number of bits read so far, to within a few bits.
  uint64_t spentBits() const {
    if constexpr (kSingle) {
      return codes_.spentBits();
    } else {
      return codes_.spentBits() + tokens_.spentBits() + raw_.spentBits();
    }
  }

  /// Checks that every stream was used up exactly. [A.3.8]
  Status finish() const {
    if constexpr (kSingle) {
      return checkFinished(overrun(), codes_, nullptr, nullptr);
    } else {
      return checkFinished(overrun(), codes_, &tokens_, &raw_);
    }
  }

 private:
  struct Absent {
    explicit Absent(std::span<const uint8_t>) {}
  };
  friend class DecoderBurst;
  friend class CodesDecoderBurst;

  RangeDecoder codes_;
  [[no_unique_address]] std::conditional_t<kSingle, Absent, RansDecoder> tokens_;
  [[no_unique_address]] std::conditional_t<kSingle, Absent, RawBitsDecoder> raw_;
};

inline DecoderBurst::DecoderBurst(const DecoderIo<false>& io)
    : tokens_(io.tokens_), raw_(io.raw_) {}
inline void DecoderBurst::take(const DecoderIo<false>& io) { *this = DecoderBurst(io); }
inline void DecoderBurst::giveBack(DecoderIo<false>& io) const {
  io.tokens_ = tokens_;
  io.raw_ = raw_;
}

}  // namespace mcc

#endif  // MCC_ENTROPY_DECODER_H_
