// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The values of JSON's numbers and their spellings, in every locale.
#ifndef MCC_JSON_NUMBERS_H_
#define MCC_JSON_NUMBERS_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace mcc::gltf {

/// Returns the value of a number as JSON spells it; one that is too large is infinite.
double numberOf(std::string_view spelling);

/// Reads a non-negative integer, however it is spelt (3, 3.0, 3e0); those that are no plain digits
/// up to 2^53. Returns false for anything else.
bool readUnsigned(std::string_view spelling, uint64_t& value);

/// Returns the bits of the integer that a number is, or becomes without its fraction.
uint64_t wholeNumberOf(std::string_view spelling);

/// Whether two numbers have the same value: of plain integers every digit counts, else binary64.
bool areEqualNumbers(std::string_view a, std::string_view b);

/// Returns the shortest spelling that reads back as a finite value, and of those the nearest; the
/// larger one if two are as near. Its exponent and its point stand where people expect them.
std::string spellingOf(double value);

/// The same for readers that round what they read to binary32, as glTF's do with `min` and `max` of
/// floats: nine digits at most instead of seventeen.
std::string spellingOf(float value);

}  // namespace mcc::gltf

#endif  // MCC_JSON_NUMBERS_H_
