// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "foreign/brotli_codec.h"

#include <brotli/encode.h>

#include <array>
#include <memory>
#include <new>

namespace mcc::foreign {

uint64_t brotliBytes(std::span<const uint8_t> file, int quality) {
  constexpr size_t kChunkBytes = size_t{1} << 16;
  const std::unique_ptr<BrotliEncoderState, decltype(&BrotliEncoderDestroyInstance)> state(
      BrotliEncoderCreateInstance(nullptr, nullptr, nullptr), &BrotliEncoderDestroyInstance);
  if (!state) throw std::bad_alloc();
  BrotliEncoderSetParameter(state.get(), BROTLI_PARAM_QUALITY, static_cast<uint32_t>(quality));
  std::array<uint8_t, kChunkBytes> chunk;
  uint64_t bytes = 0;
  size_t available_in = file.size();
  const uint8_t* next_in = file.data();
  while (BrotliEncoderIsFinished(state.get()) == BROTLI_FALSE) {
    size_t available_out = chunk.size();
    uint8_t* next_out = chunk.data();
    if (BrotliEncoderCompressStream(state.get(), BROTLI_OPERATION_FINISH, &available_in, &next_in,
                                    &available_out, &next_out, nullptr) == BROTLI_FALSE) {
      throw std::bad_alloc();  // its only failure here
    }
    bytes += chunk.size() - available_out;
  }
  return bytes;
}

}  // namespace mcc::foreign
