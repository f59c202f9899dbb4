// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/document/payload.h"

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

Result toResult(const Status& status, const std::string& where) {
  if (status.ok()) return {};
  std::string what = status.what;
  if (what.empty()) what = "error " + std::to_string(static_cast<int>(status.error));
  if (status.offset_bytes != Status::kNoOffset) {
    what += " (byte " + std::to_string(status.offset_bytes) + " of the payload)";
  }
  return error(where, what);
}

uint64_t outputBytes(const PayloadInfo& info) {
  uint64_t bytes = 0;
  for (const PieceInfo& piece : info.pieces) {
    for (const AttributeInfo& attribute : piece.attributes) {
      bytes += uint64_t{piece.wedge_count} * elementBytes(attribute.format);
    }
    for (const PartInfo& part : piece.parts) bytes += uint64_t{12} * part.triangle_count;
  }
  return bytes;
}

Status decodePieces(DecodedPayload& decoded, const mcc::DecodeOptions& options) {
  const std::span<const PieceInfo> infos = decoded.payload.info().pieces;
  std::vector<std::vector<AttributeTarget>> attribute_targets(infos.size());
  std::vector<std::vector<PartTarget>> part_targets(infos.size());
  std::vector<PieceTarget> targets(infos.size());
  decoded.pieces.resize(infos.size());
  for (size_t i = 0; i < infos.size(); ++i) {
    DecodedPiece& piece = decoded.pieces[i];
    for (const AttributeInfo& attribute : infos[i].attributes) {
      const size_t bytes = elementBytes(attribute.format);
      piece.attributes.emplace_back(infos[i].wedge_count * bytes);
      attribute_targets[i].push_back({piece.attributes.back().data(), bytes});
    }
    for (const PartInfo& part : infos[i].parts) {
      piece.parts.emplace_back(size_t{3} * part.triangle_count);
      part_targets[i].push_back({piece.parts.back().data(), IndexType::kUint32});
    }
    targets[i] = {attribute_targets[i], part_targets[i]};
  }
  return decoded.payload.decode(targets, options);
}

Result decodePieces(const std::string& where, DecodedPayload& decoded, const RunJobs& run_jobs) {
  mcc::DecodeOptions options;
  options.run_jobs = runnerOf(run_jobs);
  return toResult(decodePieces(decoded, options), where);
}

Result decodePayload(std::span<const uint8_t> bytes, const std::string& where,
                     DecodedPayload& decoded, const RunJobs& run_jobs) {
  decoded = {};
  MCC_GLTF_TRY(toResult(decoded.payload.open(bytes), where));
  return decodePieces(where, decoded, run_jobs);
}

}  // namespace mcc::gltf
