// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A payload as a list of named fields, each of which can be changed.                          [A.2]
#ifndef MCC_TOOLS_CONFORMANCE_HEADER_FIELDS_H_
#define MCC_TOOLS_CONFORMANCE_HEADER_FIELDS_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mcc/reader.h"

namespace mcc::conformance {

using Bytes = std::vector<uint8_t>;

/// Makes the checksum fit the bytes, if there are as many.
void repairChecksum(Bytes& payload);

class HeaderFields {
 public:
  /// Parses a valid payload. Names are "flags", "piece count"; for piece i "i.flags", "i.vertices",
  /// "i.faces", "i.operations", "i.wedges", "i.dummies", "i.isolated", "i.duplicates",
  /// "i.degenerates", "i.listed", "i.parts", "i.part k", "i.attributes"; for its attribute k
  /// "i.k.kind", "i.k.type", "i.k.set", "i.k.target", "i.k.predictor", "i.k.bits", "i.k.lattice",
  /// "i.k.step", "i.k.origin c", "i.k.alias", "i.k.grid bits", "i.k.grid"; "codes bytes",
  /// "tokens bytes", "padding bytes", "padding", "codes", "tokens", "raw". With blocks "header
  /// bytes" follows the flags, and instead of lengths and streams there are, for block i, "block
  /// i.repeated", "block i.exceptions", "block i.skipped k", "block i.back k", "block i.codes
  /// bytes", "block i.tokens bytes", "block i.raw bytes", "block i.checksum", "block i.low s",
  /// "block i.size s", and "block i.codes", "block i.tokens", "block i.raw".
  explicit HeaderFields(std::span<const uint8_t> payload);

  bool has(const std::string& name) const;
  uint32_t get(const std::string& name) const;
  Bytes& bytes(const std::string& name);
  /// Sets a field, as a varint or in the field's fixed size.
  void set(const std::string& name, uint32_t value);
  void setMinorVersion(uint8_t minor) {
    version_ = static_cast<uint8_t>((version_ & 0xf0) | minor);
  }
  void insertBefore(const std::string& name, const std::string& added, const Bytes& bytes);
  void erase(const std::string& name);

  uint32_t componentsOf(const std::string& attribute) const;
  /// Changes an attribute, whose prefix is "i.k.".
  void setCoding(const std::string& attribute, AttributeCoding coding);
  void setType(const std::string& attribute, ComponentType type, uint32_t components);
  void setLatticeBits(const std::string& attribute, uint32_t bits);
  /// Sets float `index` of a lattice, its step or origin `index` - 1, without its `form` lowest
  /// bytes.
  void setFloat(const std::string& attribute, uint32_t index, uint32_t value, uint32_t form = 0);

  /// Makes the length of the header, which otherwise fits, wrong by `change`.
  void changeHeaderLength(int32_t change) { header_length_change_ = change; }
  /// Makes what the table says of the streams of a block fit them.
  void repairBlock(uint32_t index);

  /// Returns the payload with a checksum that fits.
  Bytes payload() const;

 private:
  struct Field {
    std::string name;
    Bytes bytes;
    bool is_fixed = false;
  };

  size_t find(const std::string& name) const;
  void take(const std::string& name, size_t count);
  uint32_t takeVarint(const std::string& name);
  void takePiece(const std::string& prefix);
  void takeAttribute(const std::string& prefix);
  void takeLattice(const std::string& prefix, uint32_t origins);
  void takeBlock(const std::string& prefix, bool is_first);
  Bytes headerLength() const;

  std::vector<Field> fields_;
  std::span<const uint8_t> rest_;
  uint8_t version_ = 0;
  int32_t header_length_change_ = 0;
};

Bytes varint(uint32_t value);

}  // namespace mcc::conformance

#endif  // MCC_TOOLS_CONFORMANCE_HEADER_FIELDS_H_
