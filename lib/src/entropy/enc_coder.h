// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Entropy encoders: the inverses of decoder.h, and a coder that only counts costs.
#ifndef MCC_ENTROPY_ENC_CODER_H_
#define MCC_ENTROPY_ENC_CODER_H_

#include <algorithm>
#include <cstdint>
#include <vector>

#include "entropy/enc_cost.h"
#include "entropy/io.h"
#include "entropy/models.h"

namespace mcc {

/// Inverse of RangeDecoder.
class RangeEncoder {
 public:
  void bit(const BitModel& model, bool one) {
    const uint64_t split = (range_ >> kProbabilityBits) * model.zeroProbability();
    if (one) {
      add(split);
      range_ -= split;
    } else {
      range_ = split;
    }
    renormalise();
  }

  void symbol(uint32_t start, uint32_t frequency, uint32_t bits) {
    const uint64_t unit = range_ >> bits;
    add(unit * start);
    range_ = unit * frequency;
    renormalise();
  }

  /// Ends the stream with the fewest bytes that identify the final interval. The coder is then
  /// empty.
  std::vector<uint8_t> finish() {
    // Some multiple of 2^32 lies in [low, low + range), since range >= 2^32.
    const uint64_t rounded = (low_ + 0xffffffffu) & ~uint64_t{0xffffffffu};
    add(rounded - low_);
    emitWord();
    // The decoder continues with zeros, and accepts at most eight bytes more than there are.
    for (int i = 0; i < 4 && !bytes_.empty() && bytes_.back() == 0; ++i) bytes_.pop_back();
    return std::move(bytes_);
  }

 private:
  void add(uint64_t value) {
    low_ += value;
    if (low_ >= value) return;
    size_t i = bytes_.size();  // a carry: add one to the number formed by the words written so far
    for (;;) {
      i -= 4;
      uint32_t word = 0;
      for (size_t k = 0; k < 4; ++k) word |= uint32_t{bytes_[i + k]} << (8 * k);
      ++word;
      for (size_t k = 0; k < 4; ++k) bytes_[i + k] = static_cast<uint8_t>(word >> (8 * k));
      if (word != 0) return;
    }
  }

  void renormalise() {
    if (range_ < (uint64_t{1} << 32)) {
      emitWord();
      range_ <<= 32;
    }
  }

  void emitWord() {
    const uint32_t word = static_cast<uint32_t>(low_ >> 32);
    for (int shift = 0; shift < 32; shift += 8)
      bytes_.push_back(static_cast<uint8_t>(word >> shift));
    low_ <<= 32;
  }

  std::vector<uint8_t> bytes_;
  uint64_t low_ = 0;
  uint64_t range_ = ~uint64_t{0};
};

/// Inverse of RansDecoder. Tokens are recorded forwards and coded backwards.
class RansEncoder {
 public:
  void token(uint32_t state, uint32_t start, uint32_t frequency) {
    events_.push_back(state << 30 | start << 15 | (frequency - 1));
  }

  bool empty() const { return events_.empty(); }

  std::vector<uint8_t> finish() {
    std::vector<uint8_t> reversed;
    const auto pushWord = [&reversed](uint32_t word) {
      reversed.push_back(static_cast<uint8_t>(word >> 8));
      reversed.push_back(static_cast<uint8_t>(word));
    };
    uint32_t state[kRansStateCount] = {kRansLow, kRansLow, kRansLow};
    for (size_t i = events_.size(); i-- != 0;) {
      const uint32_t frequency = (events_[i] & 0x7fff) + 1;
      const uint32_t start = (events_[i] >> 15) & 0x7fff;
      uint32_t& x = state[events_[i] >> 30];
      if (x >= uint64_t{frequency} << 17) {
        pushWord(x & 0xffff);
        x >>= 16;
      }
      x = ((x / frequency) << kTokenBits) + x % frequency + start;
    }
    for (uint32_t i = kRansStateCount; i-- != 0;) {
      pushWord(state[i] >> 16);
      pushWord(state[i] & 0xffff);
    }
    std::reverse(reversed.begin(), reversed.end());
    events_.clear();
    return reversed;
  }

 private:
  std::vector<uint32_t> events_;  // state 2 | start 15 | frequency-1 15
};

/// Inverse of RawBitsDecoder.
class RawBitsEncoder {
 public:
  void write(uint32_t bits, uint32_t value) {
    window_ |= uint64_t{value} << count_;
    count_ += bits;
    for (; count_ >= 8; count_ -= 8, window_ >>= 8) bytes_.push_back(static_cast<uint8_t>(window_));
  }
  std::vector<uint8_t> finish() {
    if (count_ != 0) bytes_.push_back(static_cast<uint8_t>(window_));
    window_ = 0;
    count_ = 0;
    return std::move(bytes_);
  }

 private:
  std::vector<uint8_t> bytes_;
  uint64_t window_ = 0;
  uint32_t count_ = 0;
};

/// Counts costs and codes nothing: for the encoder's trials.
class CostIo {
 public:
  using Burst = SameIo<CostIo>;
  using CodesBurst = SameIo<CostIo>;
  static constexpr bool kEncoding = true;
  static constexpr bool kFast = false;

  bool bit(BitModel& model, bool truth) {
    const uint32_t zero = model.zeroProbability();
    cost_ += costOf(truth ? kProbabilityOne - zero : zero, kProbabilityBits);
    model.update(truth);
    return truth;
  }

  template <uint32_t kState>
  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t truth) {
    cost_ += costOf(row.frequency(truth), kTokenBits);
    row.adapt(truth, schedule);
    return truth;
  }

  uint32_t raw(uint32_t bits, uint32_t truth) {
    cost_ += uint64_t{bits} * kCostOne;
    return truth;
  }

  uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t truth, uint32_t& negative) {
    raw(bits, truth - base);
    if (sign && truth != 0) raw(1, negative);
    return truth;
  }

  bool overrun() const { return false; }
  uint64_t cost() const { return cost_; }  ///< in units of 1/65536 bit

 protected:
  uint64_t cost_ = 0;
};

static_assert(SymbolIo<CostIo>);

/// The encoder as stage code sees it, see entropy/io.h. Codes into three streams, into a single
/// one, or both ways at once, so that the smaller can be chosen. Also counts the cost.
class EncoderIo : public CostIo {
 public:
  using Burst = EncoderIo&;
  using CodesBurst = SameIo<EncoderIo>;
  EncoderIo() : EncoderIo(false, false) {}  ///< only counts the cost
  explicit EncoderIo(bool single) : EncoderIo(!single, single) {}
  EncoderIo(bool three, bool single) : three_(three), single_(single), writes_(three || single) {}

  bool bit(BitModel& model, bool truth) {
    if (writes_) writeBit(model, truth);
    return CostIo::bit(model, truth);
  }

  template <uint32_t kState>
  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t truth) {
    if (writes_) writeToken(kState, row.start(truth), row.frequency(truth));
    return CostIo::token<kState>(row, schedule, truth);
  }

  uint32_t raw(uint32_t bits, uint32_t truth) {
    if (writes_) writeRaw(bits, truth);
    return CostIo::raw(bits, truth);
  }

  uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t truth, uint32_t& negative) {
    raw(bits, truth - base);
    if (sign && truth != 0) raw(1, negative);
    return truth;
  }

  void take(EncoderIo&) {}
  void giveBack(EncoderIo&) {}
  bool hasRoom(uint32_t) const { return true; }

  struct Streams {
    std::vector<uint8_t> codes;
    std::vector<uint8_t> tokens;
    std::vector<uint8_t> raw;
  };
  /// Ends the three streams, or the single one if there is no other.
  Streams finish() {
    if (!three_) return finishSingle();
    return {codes_.finish(), tokens_.finish(), raw_.finish()};
  }
  /// Ends the single one of both.
  Streams finishSingle() { return {single_codes_.finish(), {}, {}}; }

 private:
  // Trials are most of the work of the writer, and they write nothing: this keeps their part short.
  MCC_OUT_OF_LINE void writeBit(const BitModel& model, bool one) {
    if (three_) codes_.bit(model, one);
    if (single_) single_codes_.bit(model, one);
  }
  MCC_OUT_OF_LINE void writeToken(uint32_t state, uint32_t start, uint32_t frequency) {
    if (three_) tokens_.token(state, start, frequency);
    if (single_) single_codes_.symbol(start, frequency, kTokenBits);
  }
  MCC_OUT_OF_LINE void writeRaw(uint32_t bits, uint32_t value) {
    if (three_) raw_.write(bits, value);
    for (uint32_t done = 0; single_ && done < bits; done += 16) {
      const uint32_t count = std::min(bits - done, 16u);
      single_codes_.symbol((value >> done) & ((1u << count) - 1), 1, count);
    }
  }

  const bool three_;
  const bool single_;
  const bool writes_;
  RangeEncoder codes_;
  RangeEncoder single_codes_;
  RansEncoder tokens_;
  RawBitsEncoder raw_;
};

static_assert(SymbolIo<EncoderIo>);

}  // namespace mcc

#endif  // MCC_ENTROPY_ENC_CODER_H_
