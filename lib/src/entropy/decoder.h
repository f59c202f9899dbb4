// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Entropy decoders.                                                                        [A.3]
//
// A payload has three streams: `codes` (binary range coder), `tokens` (three interleaved rANS
// states) and `raw` (plain bits). A small payload has only `codes`, and tokens and raw bits go
// through its range coder. decoder_io.h makes one decoder of them.
#ifndef MCC_ENTROPY_DECODER_H_
#define MCC_ENTROPY_DECODER_H_

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

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

/// Binary range decoder with a 64-bit range and 32-bit words. [A.3.2]
/// After its end the stream continues with zeros, so that the writer may drop
/// trailing zero bytes.
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

/// Three interleaved rANS states over one sequence of 16-bit words. [A.3.3]
/// The sequence begins with the initial values of the states,
/// which have 32 bits each.
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

/// Plain bits, which no model predicts. [A.3.4]
/// The least significant bit of a byte comes first.
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
    return static_cast<uint32_t>(window) & maskBelow(bits);
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
    const uint32_t value = base + (static_cast<uint32_t>(window) & maskBelow(bits));
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

}  // namespace mcc

#endif  // MCC_ENTROPY_DECODER_H_
