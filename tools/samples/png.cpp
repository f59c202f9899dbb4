// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "png.h"

#include <algorithm>
#include <cstddef>

namespace mcc::samples {
namespace {

void putBigEndian(std::vector<uint8_t>& bytes, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<uint8_t>(value >> shift));
}

uint32_t crc32Of(std::span<const uint8_t> bytes) {
  uint32_t crc = 0xffffffffu;
  for (const uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

uint32_t adler32Of(std::span<const uint8_t> bytes) {
  uint32_t a = 1;
  uint32_t b = 0;
  for (const uint8_t byte : bytes) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

void putChunk(std::vector<uint8_t>& png, const char (&type)[5], std::span<const uint8_t> content) {
  putBigEndian(png, static_cast<uint32_t>(content.size()));
  const size_t start = png.size();
  png.insert(png.end(), type, type + 4);
  png.insert(png.end(), content.begin(), content.end());
  putBigEndian(png, crc32Of(std::span<const uint8_t>(png).subspan(start)));
}

std::vector<uint8_t> storedZlib(std::span<const uint8_t> bytes) {
  std::vector<uint8_t> out = {0x78, 0x01};
  for (size_t start = 0; start < bytes.size();) {
    const size_t length = std::min<size_t>(bytes.size() - start, 65535);
    out.push_back(start + length == bytes.size() ? 1 : 0);
    for (const size_t field : {length, ~length}) {
      out.push_back(static_cast<uint8_t>(field));
      out.push_back(static_cast<uint8_t>(field >> 8));
    }
    const auto block = bytes.subspan(start, length);
    out.insert(out.end(), block.begin(), block.end());
    start += length;
  }
  putBigEndian(out, adler32Of(bytes));
  return out;
}

/// Puts a PNG together; `rows` begin with their filter.
std::vector<uint8_t> pngOf(uint32_t width, uint32_t height, uint8_t bits, uint8_t color_type,
                           std::span<const uint8_t> palette, std::span<const uint8_t> rows) {
  std::vector<uint8_t> header;
  putBigEndian(header, width);
  putBigEndian(header, height);
  for (const uint8_t field : {bits, color_type, uint8_t{0}, uint8_t{0}, uint8_t{0}})
    header.push_back(field);  // not interlaced
  std::vector<uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  putChunk(png, "IHDR", header);
  if (!palette.empty()) putChunk(png, "PLTE", palette);
  putChunk(png, "IDAT", storedZlib(rows));
  putChunk(png, "IEND", {});
  return png;
}

}  // namespace

std::vector<uint8_t> encodePalettePng(uint32_t width, uint32_t height,
                                      std::span<const uint8_t> indices,
                                      std::span<const Rgb> palette) {
  constexpr uint8_t kIndexed = 3;
  std::vector<uint8_t> colors;
  for (const Rgb& color : palette) {
    colors.insert(colors.end(), {color.red, color.green, color.blue});
  }
  std::vector<uint8_t> rows;
  for (uint32_t y = 0; y < height; ++y) {
    rows.push_back(0);  // filter: none
    for (uint32_t x = 0; x < width; x += 2) {
      const size_t at = size_t{y} * width + x;
      rows.push_back(static_cast<uint8_t>(indices[at] << 4 | indices[at + 1]));
    }
  }
  return pngOf(width, height, 4, kIndexed, colors, rows);
}

}  // namespace mcc::samples
