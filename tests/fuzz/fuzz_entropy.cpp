// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Any sequence of reads on any three streams, or on one: values stay in their ranges, models stay
// valid, and the ends of streams are detected.
#include <array>
#include <vector>

#include "entropy/decoder_io.h"
#include "entropy/numbers.h"
#include "fuzz/byte_feed.h"
#include "mcc/types.h"

namespace mcc::test {
namespace {

void checkRow(const TokenRow& row) {
  require(row.c[0] == 0 && row.c[kTokenCount] == kTokenOne, "a row has other ends");
  for (uint32_t symbol = 0; symbol < kTokenCount; ++symbol) {
    require(row.c[symbol] < row.c[symbol + 1], "a symbol has no frequency");
  }
}

template <bool kSingle>
void readStreams(std::span<const uint8_t> script, std::span<const uint8_t> codes,
                 std::span<const uint8_t> tokens, std::span<const uint8_t> raw) {
  DecoderIo<kSingle> io(codes, tokens, raw);
  std::array<BitModel, 4> bits;
  std::array<TokenRow, 4> rows;
  for (TokenRow& row : rows) row.setUniform();
  GolombModel golomb;
  TreeModel<5> tree;
  for (const uint8_t step : script) {
    const uint32_t which = step >> 6;
    const uint32_t n = step >> 3 & 7;
    switch (step & 7) {
      case 0:
      case 1: io.bit(bits[which]); break;
      case 2:
        require(io.template token<0>(rows[which], kPositionSchedule) < kTokenCount, "a token");
        break;
      case 3:
        require(io.template token<2>(rows[which], kAttributeSchedule) < kTokenCount, "a token");
        break;
      case 4: require(uint64_t{io.raw(4 * n)} < uint64_t{1} << 4 * n, "raw bits"); break;
      case 5: require(codeGolomb(io, golomb, 0) != mcc::kNone, "a golomb number"); break;
      case 6: require(codeTree(io, tree, 0) < 32, "a tree number"); break;
      default: {
        uint32_t negative = 0;
        const uint32_t value = io.magnitude(n, 3 * n, (which & 1) != 0, 0, negative);
        require(negative == 0 || (value != 0 && (which & 1) != 0), "a sign of nothing");
        require(value - n < uint64_t{1} << 3 * n, "a magnitude");
      }
    }
    checkRow(rows[which]);
  }
  const Status status = io.finish();
  require(!io.overrun() || status.error == Error::kTruncated, "an end that nobody notices");
}

}  // namespace
}  // namespace mcc::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace mcc::test;
  if (size > 1 << 14) return 0;
  ByteFeed feed(data, size);
  const bool single = (feed.byte() & 1) != 0;
  const auto script = feed.take(feed.u16());
  const auto codes = feed.take(feed.u16());
  const auto tokens = feed.take(feed.u16());
  // Copies of exactly their sizes, so that the sanitizer sees every read beyond them.
  const std::vector<uint8_t> a(codes.begin(), codes.end());
  const std::vector<uint8_t> b(tokens.begin(), tokens.end());
  const auto rest = feed.rest();
  const std::vector<uint8_t> c(rest.begin(), rest.end());
  if (single) {
    readStreams<true>(script, a, {}, {});
  } else {
    readStreams<false>(script, a, b, c);
  }
  return 0;
}
