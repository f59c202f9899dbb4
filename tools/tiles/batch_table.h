// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads the batch table of a tile as columns that the binary tables of the 3D Metadata
// Specification can hold with the same values.
#ifndef MCC_TILES_BATCH_TABLE_H_
#define MCC_TILES_BATCH_TABLE_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/base/result.h"
#include "gltf/document/json.h"

namespace mcc::tiles {

/// A property of all batches, with the words of the 3D Metadata Specification.
struct Column {
  std::string name;            ///< as the batch table spells it
  std::string type;            ///< "SCALAR", "VEC2" to "VEC4", "STRING" or "BOOLEAN"
  std::string component_type;  ///< "INT8" to "FLOAT64"; empty for strings and booleans
  bool is_array = false;
  uint64_t array_length = 0;  ///< 0: lengths differ, and `array_offsets` holds them
  bool is_required = true;    ///< every batch has a value
  gltf::Json no_data;         ///< what stands for a missing value, which no batch has; null: none
  gltf::Json default_value;   ///< the value where there are no bytes; null: values are missing
  /// Little-endian and without padding; empty: every batch has `default_value`.
  std::vector<uint8_t> values;
  std::vector<uint64_t> array_offsets;   ///< empty, or one per batch and one more
  std::vector<uint64_t> string_offsets;  ///< empty, or one per string and one more
};

struct BatchTable {
  std::vector<Column> columns;
  gltf::Json extras;  ///< null: there are none
};

/// Reads a batch table of `batch_count` batches. With no batches there are no columns. `json` and
/// `binary` are the two parts of the table, which may be empty.
/// Errors say what has no exact counterpart or is not valid, with its place. Safe for untrusted
/// input: time and memory are linear in the bytes of the table.
gltf::Result readBatchTable(std::span<const uint8_t> json, std::span<const uint8_t> binary,
                            uint64_t batch_count, BatchTable& table);

/// Makes a column of a JSON array with one value for each batch: all numbers, strings, booleans or
/// arrays of one of these. Missing values (null) are allowed next to numbers and strings.
/// Errors: the values have no common type that holds all of them exactly. Declared here for tests.
gltf::Result readJsonColumn(const gltf::Json& values, Column& column);

}  // namespace mcc::tiles

#endif  // MCC_TILES_BATCH_TABLE_H_
