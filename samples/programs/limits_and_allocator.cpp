// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// limits_and_allocator IN.mcc: how a program that reads untrusted files bounds what they may cost.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "mcc/reader.h"

/// An allocator that gives no more than a budget, and records the most that was in use.
struct Budget {
  size_t left = 0;
  size_t in_use = 0;
  size_t peak = 0;

  static void* allocate(void* user, size_t bytes) {
    Budget& budget = *static_cast<Budget*>(user);
    if (bytes > budget.left) return nullptr;  // decode() ends with kOutOfMemory
    budget.left -= bytes;
    budget.in_use += bytes;
    if (budget.in_use > budget.peak) budget.peak = budget.in_use;
    return std::malloc(bytes);
  }
  static void release(void* user, void* memory, size_t bytes) {
    Budget& budget = *static_cast<Budget*>(user);
    budget.left += bytes;
    budget.in_use -= bytes;
    std::free(memory);
  }
};

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  std::ifstream stream(arguments[1], std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), {}};
  const std::span bytes(reinterpret_cast<const uint8_t*>(file.data()), file.size());

  // Limits are checked before anything is allocated: a file that claims more is refused by its
  // header.
  mcc::Limits limits;
  limits.max_vertices = 1000000;
  limits.max_triangles = 2000000;
  limits.max_output_bytes = 100000000;

  Budget budget;
  budget.left = 64000000;
  const mcc::Allocator allocator{Budget::allocate, Budget::release, &budget};

  mcc::Payload payload;
  mcc::Status status = payload.open(bytes, limits, allocator);
  if (!status.ok()) {
    std::printf("refused: %s\n", status.what);
    return 1;
  }
  const mcc::PieceInfo& piece = payload.info().pieces[0];
  std::vector<mcc::AttributeTarget> attributes(piece.attributes.size());
  std::vector<mcc::PartTarget> parts(piece.parts.size());
  const mcc::PieceTarget target{attributes, parts};

  mcc::DecodeOptions options;
  options.allocator = allocator;
  status = payload.decode({&target, 1}, options);
  std::printf("%s; %.1f bytes of working memory per vertex\n",
              status.ok() ? "decoded" : status.what,
              static_cast<double>(budget.peak) / piece.wedge_count);
  return status.ok() ? 0 : 1;
}
