// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_GLTF_FILE_IO_H_
#define MCC_GLTF_FILE_IO_H_

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "gltf/document.h"

namespace mcc::gltf {

/// Reads a whole file. Errors say plainly what is there instead (nothing, a folder, no permission).
Result readFile(const std::filesystem::path& path, std::vector<uint8_t>& bytes);

/// Reads files below a folder, for loadDocument().
FileReader readerOf(const std::filesystem::path& folder);

/// A file that takes the place of another only when all is well.
class ReplacementFile {
 public:
  explicit ReplacementFile(std::filesystem::path destination);
  /// Removes the temporary file unless commit() was called.
  ~ReplacementFile();
  ReplacementFile(const ReplacementFile&) = delete;
  ReplacementFile& operator=(const ReplacementFile&) = delete;

  /// Whether the destination could be written, before any work is done for it.
  Result check() const;
  /// Writes a temporary file in the folder of the destination.
  Result write(std::span<const uint8_t> bytes);
  const std::filesystem::path& temporaryPath() const { return temporary_; }
  /// Renames it to the destination.
  Result commit();

 private:
  std::filesystem::path destination_;
  std::filesystem::path temporary_;
};

}  // namespace mcc::gltf

#endif  // MCC_GLTF_FILE_IO_H_
