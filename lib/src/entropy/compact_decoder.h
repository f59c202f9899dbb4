// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The decoder of both kinds of payloads as stage code sees it, where code size matters: there is
// one type for both, and its functions are called rather than inlined. It decodes the same symbols
// as DecoderIo in dec_coder.h.        [A.3]
#ifndef MCC_ENTROPY_COMPACT_DECODER_H_
#define MCC_ENTROPY_COMPACT_DECODER_H_

#include <cstdint>
#include <span>

#include "entropy/decoder.h"

namespace mcc {

class CompactIo {
 public:
  static constexpr bool kEncoding = false;
  static constexpr bool kFast = false;
  static constexpr bool kThreeAtOnce = true;

  CompactIo(std::span<const uint8_t> codes, std::span<const uint8_t> tokens,
            std::span<const uint8_t> raw, bool single)
      : codes_(codes), tokens_(tokens), raw_(raw), is_single_(single) {}

  MCC_OUT_OF_LINE bool bit(BitModel& model, bool = false) { return codes_.bit(model); }

  template <uint32_t kState>
  uint32_t token(TokenRow& row, const TokenSchedule& schedule, uint32_t = 0) {
    return tokenOf(kState, row, schedule);
  }

  MCC_OUT_OF_LINE uint32_t raw(uint32_t bits, uint32_t = 0) {
    return is_single_ ? codes_.raw(bits) : raw_.read(bits);
  }

  /// Like DecoderIo::magnitude().
  MCC_OUT_OF_LINE uint32_t magnitude(uint32_t base, uint32_t bits, bool sign, uint32_t,
                                     uint32_t& negative) {
    const uint32_t value = base + raw(bits);
    negative = raw(sign && value != 0 ? 1 : 0);
    return value;
  }

  /// False for a single coder, which codes the raw bits of each token right after it.
  bool threeAtOnce() const { return !is_single_; }
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
    return codes_.overrun() || (!is_single_ && (tokens_.overrun() || raw_.overrun()));
  }

  Status finish() const {
    return checkFinished(overrun(), codes_, is_single_ ? nullptr : &tokens_,
                         is_single_ ? nullptr : &raw_);
  }

  /// Inner loops use the Io itself.
  using Burst = CompactIo&;
  using CodesBurst = CompactIo&;
  void take(const CompactIo&) {}
  void giveBack(const CompactIo&) {}
  bool hasRoom(uint32_t) const { return true; }

 private:
  MCC_OUT_OF_LINE uint32_t tokenOf(uint32_t state, TokenRow& row, const TokenSchedule& schedule) {
    return is_single_ ? codes_.token(row, schedule) : tokens_.token(state, row, schedule);
  }

  RangeDecoder codes_;
  RansDecoder tokens_;
  RawBitsDecoder raw_;
  const bool is_single_;
};

}  // namespace mcc

#endif  // MCC_ENTROPY_COMPACT_DECODER_H_
