// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#ifndef MCC_TILES_MATRIX_H_
#define MCC_TILES_MATRIX_H_

#include <array>

#include "json/json.h"

namespace mcc::tiles {

/// A 4 x 4 matrix by columns, as glTF and 3D Tiles store it.
using Matrix = std::array<double, 16>;

inline constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// Returns the matrix that applies `b` and then `a`.
Matrix product(const Matrix& a, const Matrix& b);

/// Returns how much longer the matrix can make a vector, rounded up by at most 1e-9 of it. Returns
/// infinity when that is not a finite number.
double largestScale(const Matrix& matrix);

/// Inverts the part of a matrix that is not its translation, which becomes 0. Returns false when
/// there is no inverse of finite numbers.
bool invertLinear(const Matrix& matrix, Matrix& inverse);

/// Returns the point that a matrix makes of a point.
std::array<double, 3> transformed(const Matrix& matrix, const std::array<double, 3>& point);

/// Reads `count` finite numbers from a JSON array. Returns false when it is anything else.
bool readNumbers(const gltf::Json& json, double* numbers, size_t count);

}  // namespace mcc::tiles

#endif  // MCC_TILES_MATRIX_H_
