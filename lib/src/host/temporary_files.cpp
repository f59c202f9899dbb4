// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "host/temporary_files.h"

#include <algorithm>
#include <system_error>

namespace mcc::gltf {

void TemporaryFiles::add(const std::filesystem::path& path) {
  const Lock held = lock();
  paths_.push_back(path);
}

void TemporaryFiles::forget(const std::filesystem::path& path) {
  const Lock held = lock();
  const auto found = std::find(paths_.rbegin(), paths_.rend(), path);
  if (found != paths_.rend()) paths_.erase(std::next(found).base());
}

TemporaryFiles::Lock TemporaryFiles::removeAll() {
  Lock held = lock();
  removeThem();
  return held;
}

TemporaryFiles::Lock TemporaryFiles::removeAllWithin(std::chrono::milliseconds patience) {
  Lock held(mutex_, patience);
  if (held.owns_lock()) removeThem();
  return held;
}

void TemporaryFiles::removeThem() {
  std::error_code ignored;
  // Folders were added before the files in them, so remove them last.
  for (auto path = paths_.rbegin(); path != paths_.rend(); ++path) {
    std::filesystem::remove(*path, ignored);
  }
  paths_.clear();
}

}  // namespace mcc::gltf
