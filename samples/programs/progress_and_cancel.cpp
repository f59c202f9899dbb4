// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// progress_and_cancel IN.mcc [PERCENT]: decodes a payload, reports progress, and stops at PERCENT.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "mcc/reader.h"

struct Task {
  double stop_at = 2;
  int call_count = 0;
};

/// Called on the decoding thread after every stage. Returning false ends decode() with kCancelled.
bool tell(void* user, double done) {
  Task& task = *static_cast<Task*>(user);
  ++task.call_count;
  std::printf("%3.0f %%\n", 100 * done);
  return done < task.stop_at;
}

int main(int argument_count, char** arguments) {
  if (argument_count < 2) return 2;
  std::ifstream stream(arguments[1], std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), {}};
  Task task;
  if (argument_count > 2) task.stop_at = std::atof(arguments[2]) / 100;

  mcc::Payload payload;
  mcc::Status status = payload.open({reinterpret_cast<const uint8_t*>(file.data()), file.size()});
  if (!status.ok()) {
    std::fprintf(stderr, "%s\n", status.what);
    return 1;
  }
  // The targets are null, so everything is decoded and dropped.
  std::vector<std::vector<mcc::AttributeTarget>> attributes;
  std::vector<std::vector<mcc::PartTarget>> parts;
  std::vector<mcc::PieceTarget> targets;
  for (const mcc::PieceInfo& piece : payload.info().pieces) {
    attributes.emplace_back(piece.attributes.size());
    parts.emplace_back(piece.parts.size());
    targets.push_back({attributes.back(), parts.back()});
  }

  mcc::DecodeOptions options;
  options.progress = tell;
  options.progress_user = &task;
  status = payload.decode(targets, options);
  if (status.error == mcc::Error::kCancelled) {
    std::printf("stopped after %d calls\n", task.call_count);
    return 0;  // decode() has released its memory; the targets hold unspecified bytes
  }
  std::printf("%s\n", status.ok() ? "decoded" : status.what);
  return status.ok() ? 0 : 1;
}
