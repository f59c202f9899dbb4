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
  /// "tokens bytes", "padding bytes", "padding", "codes", "tokens", "raw".
  explicit HeaderFields(std::span<const uint8_t> payload);

  bool has(const std::string& name) const;
  uint32_t get(const std::string& name) const;
  Bytes& bytes(const std::string& name);
  /// Sets a field, as a varint or in the field's fixed size.
  void set(const std::string& name, uint32_t value);
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

  std::vector<Field> fields_;
  std::span<const uint8_t> rest_;
  uint8_t version_ = 0;
};

Bytes varint(uint32_t value);

}  // namespace mcc::conformance

#endif  // MCC_TOOLS_CONFORMANCE_HEADER_FIELDS_H_
