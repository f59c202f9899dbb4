// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/base/decoded_bytes.h"

#include "mcc/decoded_limit.h"

namespace mcc::gltf {

DecodedBytes::DecodedBytes(uint64_t max_decoded_bytes, uint64_t file_bytes)
    : limit_(decodedLimit(max_decoded_bytes, file_bytes)), file_bytes_(file_bytes) {}

void DecodedBytes::add(uint64_t bytes) {
  total_ = bytes > ~uint64_t{0} - total_ ? ~uint64_t{0} : total_ + bytes;
}

Result DecodedBytes::check() const {
  if (total_ <= limit_) return {};
  return error("", "its " + std::to_string(file_bytes_) + " bytes ask for " +
                       std::to_string(total_) + " bytes of decoded geometry; the limit is " +
                       std::to_string(limit_) +
                       ", which max_decoded_bytes (--max-decoded-bytes) raises");
}

}  // namespace mcc::gltf
