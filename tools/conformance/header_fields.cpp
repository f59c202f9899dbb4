// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "header_fields.h"

#include <stdexcept>

#include "base/crc32.h"
#include "base/enc_bytes.h"
#include "container/payload_header.h"
#include "format/usual.h"

namespace mcc::conformance {

void repairChecksum(Bytes& payload) {
  if (payload.size() < kChecksummedFrom) return;
  const uint32_t checksum = checksumOf(payload);
  for (size_t i = 0; i < 4; ++i)
    payload[kChecksumOffset + i] = static_cast<uint8_t>(checksum >> (8 * i));
}

Bytes varint(uint32_t value) {
  ByteWriter out;
  out.writeVarint(value);
  return out.bytes();
}

HeaderFields::HeaderFields(std::span<const uint8_t> payload)
    : rest_(payload.subspan(kChecksummedFrom)), version_(payload[kVersionOffset]) {
  take("flags", 1);
  const uint32_t flags = get("flags");
  const bool has_blocks = (flags & payload_flag::kBlocks) != 0;
  if (has_blocks) takeVarint("header bytes");
  const bool many = (flags & payload_flag::kManyPieces) != 0;
  const uint32_t pieces = many ? takeVarint("piece count") : 1;
  for (uint32_t i = 0; i < pieces; ++i) takePiece(std::to_string(i) + ".");
  const auto block = [](uint32_t i) { return "block " + std::to_string(i) + "."; };
  for (uint32_t i = 0; has_blocks && i < pieces; ++i) takeBlock(block(i), i == 0);
  if (has_blocks) {
    if ((flags & payload_flag::kPadded) != 0) take("padding", takeVarint("padding bytes"));
    for (uint32_t i = 0; i < pieces; ++i) {
      for (const char* const stream : {"codes", "tokens", "raw"})
        take(block(i) + stream, get(block(i) + stream + " bytes"));
    }
    return;
  }
  const bool single = (flags & payload_flag::kSingleCoder) != 0;
  const uint32_t codes = single ? 0 : takeVarint("codes bytes");
  const uint32_t tokens = single ? 0 : takeVarint("tokens bytes");
  if ((flags & payload_flag::kPadded) != 0) take("padding", takeVarint("padding bytes"));
  take("codes", single ? rest_.size() : codes);
  if (single) return;
  take("tokens", tokens);
  take("raw", rest_.size());
}

void HeaderFields::takePiece(const std::string& prefix) {
  const uint32_t flags = takeVarint(prefix + "flags");
  const bool has_pivots = (flags & piece_flag::kSurfaceMask) == piece_flag::kSurfaceMask;
  for (const char* const name : {"vertices", "faces", "operations", "wedges"}) {
    if (!has_pivots || std::string_view(name) != "operations") takeVarint(prefix + name);
  }
  const auto takeIf = [&](uint32_t flag, const char* name) {
    return (flags & flag) != 0 ? takeVarint(prefix + name) : 0;
  };
  takeIf(piece_flag::kHoles, "dummies");
  takeIf(piece_flag::kIsolated, "isolated");
  takeIf(piece_flag::kListed, "listed");
  const uint32_t parts = takeIf(piece_flag::kManyParts, "parts");
  for (uint32_t i = 0; i < parts; ++i) takeVarint(prefix + "part " + std::to_string(i));
  if ((flags & piece_flag::kSameAttributes) != 0) return;
  const uint32_t attributes = takeVarint(prefix + "attributes");
  for (uint32_t i = 0; i < attributes; ++i) takeAttribute(prefix + std::to_string(i) + ".");
}

void HeaderFields::takeBlock(const std::string& prefix, bool is_first) {
  if (!is_first) {
    takeVarint(prefix + "repeated");
    const uint32_t exceptions = takeVarint(prefix + "exceptions");
    for (uint32_t i = 0; i < exceptions; ++i) {
      takeVarint(prefix + "skipped " + std::to_string(i));
      takeVarint(prefix + "back " + std::to_string(i));
    }
  }
  for (const char* const name : {"codes bytes", "tokens bytes", "raw bytes"})
    takeVarint(prefix + name);
  take(prefix + "checksum", 4);
  for (uint32_t s = 0; s < 3; ++s) {
    takeVarint(prefix + "low " + std::to_string(s));
    takeVarint(prefix + "size " + std::to_string(s));
  }
}

void HeaderFields::repairBlock(uint32_t index) {
  const std::string prefix = "block " + std::to_string(index) + ".";
  uint32_t checksum = crc32({});
  for (const char* const stream : {"codes", "tokens", "raw"}) {
    const Bytes& of_stream = bytes(prefix + stream);
    set(prefix + stream + " bytes", static_cast<uint32_t>(of_stream.size()));
    checksum = crc32(of_stream, checksum);
  }
  set(prefix + "checksum", checksum);
}

void HeaderFields::takeAttribute(const std::string& prefix) {
  take(prefix + "kind", 1);
  const uint32_t kind = get(prefix + "kind");
  if ((kind & kTypeStated) != 0) take(prefix + "type", 1);
  uint32_t target = 0;
  if ((kind & kMoreStated) != 0) {
    take(prefix + "set", 1);
    target = takeVarint(prefix + "target");
  }
  take(prefix + "predictor", 1);
  switch (static_cast<AttributeCoding>(kind >> 3 & 7)) {
    case AttributeCoding::kLattice:
      takeLattice(prefix, target == 0 ? componentsOf(prefix) : 0);
      break;
    case AttributeCoding::kOctahedral:
    case AttributeCoding::kTangentAngle: take(prefix + "bits", 1); break;
    case AttributeCoding::kAlias: takeVarint(prefix + "alias"); break;
    case AttributeCoding::kGrid:
      take(prefix + "grid bits", 1);
      take(prefix + "grid", 1);
      break;
    default: break;
  }
}

/// Name of a float of a lattice.
static std::string floatName(uint32_t index) {
  return index == 0 ? "step" : "origin " + std::to_string(index - 1);
}
static uint32_t floatShift(uint32_t index) { return kLatticeBitsBits + kFormBits * index; }

void HeaderFields::takeLattice(const std::string& prefix, uint32_t origins) {
  const uint32_t word = takeVarint(prefix + "lattice");
  for (uint32_t i = 0; i <= origins; ++i) {
    const uint32_t form = word >> floatShift(i) & 3;
    take(prefix + floatName(i), form == kUsualForm ? 0 : 4 - form);
  }
}

uint32_t HeaderFields::componentsOf(const std::string& attribute) const {
  if (has(attribute + "type")) return (get(attribute + "type") >> 3 & 15) + 1;
  return kUsualComponents[get(attribute + "kind") & 7];
}

void HeaderFields::setCoding(const std::string& attribute, AttributeCoding coding) {
  set(attribute + "kind", (get(attribute + "kind") & 0xc7) | static_cast<uint32_t>(coding) << 3);
}

void HeaderFields::setType(const std::string& attribute, ComponentType type, uint32_t components) {
  if (!has(attribute + "type")) {
    set(attribute + "kind", get(attribute + "kind") | kTypeStated);
    const std::string next = has(attribute + "set") ? "set" : "predictor";
    insertBefore(attribute + next, attribute + "type", {0});
  }
  set(attribute + "type", static_cast<uint32_t>(type) | (components - 1) << 3);
}

void HeaderFields::setLatticeBits(const std::string& attribute, uint32_t bits) {
  set(attribute + "lattice",
      (get(attribute + "lattice") >> kLatticeBitsBits << kLatticeBitsBits) | bits);
}

void HeaderFields::setFloat(const std::string& attribute, uint32_t index, uint32_t value,
                            uint32_t form) {
  const uint32_t shift = floatShift(index);
  set(attribute + "lattice", (get(attribute + "lattice") & ~(3u << shift)) | form << shift);
  Bytes& floats = bytes(attribute + floatName(index));
  floats.clear();
  for (uint32_t i = form; i < 4 && form != kUsualForm; ++i)
    floats.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

void HeaderFields::take(const std::string& name, size_t count) {
  const std::span<const uint8_t> bytes = rest_.first(count);
  fields_.push_back({name, {bytes.begin(), bytes.end()}, true});
  rest_ = rest_.subspan(count);
}

uint32_t HeaderFields::takeVarint(const std::string& name) {
  size_t count = 1;
  while (rest_[count - 1] >= 0x80) ++count;
  take(name, count);
  fields_.back().is_fixed = false;
  return get(name);
}

size_t HeaderFields::find(const std::string& name) const {
  for (size_t i = 0; i < fields_.size(); ++i) {
    if (fields_[i].name == name) return i;
  }
  return fields_.size();
}

bool HeaderFields::has(const std::string& name) const { return find(name) != fields_.size(); }

uint32_t HeaderFields::get(const std::string& name) const {
  const Field& field = fields_.at(find(name));
  uint64_t value = 0;
  for (size_t i = field.bytes.size(); i-- != 0;) {
    value = field.is_fixed ? value << 8 | field.bytes[i] : value << 7 | (field.bytes[i] & 0x7f);
  }
  return static_cast<uint32_t>(value);
}

Bytes& HeaderFields::bytes(const std::string& name) { return fields_.at(find(name)).bytes; }

void HeaderFields::set(const std::string& name, uint32_t value) {
  Field& field = fields_.at(find(name));
  if (!field.is_fixed) {
    field.bytes = varint(value);
    return;
  }
  for (size_t i = 0; i < field.bytes.size(); ++i)
    field.bytes[i] = static_cast<uint8_t>(value >> (8 * i));
}

void HeaderFields::insertBefore(const std::string& name, const std::string& added,
                                const Bytes& bytes) {
  fields_.insert(fields_.begin() + static_cast<std::ptrdiff_t>(find(name)), {added, bytes, true});
}

void HeaderFields::erase(const std::string& name) {
  fields_.erase(fields_.begin() + static_cast<std::ptrdiff_t>(find(name)));
}

/// The length counts its own bytes too.
Bytes HeaderFields::headerLength() const {
  size_t others = kChecksummedFrom;
  for (const Field& field : fields_) {
    if (field.name == "block 0.codes") break;
    if (field.name != "header bytes") others += field.bytes.size();
  }
  Bytes length;
  while (length.size() != varint(static_cast<uint32_t>(others + length.size())).size())
    length.push_back(0);
  return varint(static_cast<uint32_t>(others + length.size()) +
                static_cast<uint32_t>(header_length_change_));
}

Bytes HeaderFields::payload() const {
  Bytes all = {kMagic, version_, 0, 0, 0, 0};
  for (const Field& field : fields_) {
    const Bytes bytes = field.name == "header bytes" ? headerLength() : field.bytes;
    all.insert(all.end(), bytes.begin(), bytes.end());
  }
  repairChecksum(all);
  return all;
}

}  // namespace mcc::conformance
