// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "json/json.h"

namespace mcc::tiles {

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 4; ++row) {
      for (size_t k = 0; k < 4; ++k) result[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return result;
}

/// The largest eigenvalue of A = M^T M is the limit of trace(A^n)^(1/n), which is never below it.
/// Squaring A 34 times leaves a factor of at most 3^(1/2^34). Each power is divided by its trace,
/// so that no number overflows. The matrix itself is only divided when its squares would.
double largestScale(const Matrix& matrix) {
  constexpr double kMost = 1e100;
  double largest = 0;
  for (size_t i = 0; i < 9; ++i) {
    largest = std::max(largest, std::abs(matrix[i / 3 * 4 + i % 3]));
  }
  if (std::isfinite(largest) && (largest > kMost || (largest > 0 && largest < 1 / kMost))) {
    Matrix divided = matrix;
    for (double& element : divided) element /= largest;
    return largestScale(divided) * largest;  // once: its largest element is 1
  }
  double power[3][3] = {};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      for (size_t k = 0; k < 3; ++k) power[i][j] += matrix[4 * i + k] * matrix[4 * j + k];
    }
  }
  double logarithm = 0;
  double exponent = 1;
  for (int round = 0; round < 35; ++round, exponent /= 2) {
    const double trace = power[0][0] + power[1][1] + power[2][2];
    if (trace == 0) return 0;
    if (!std::isfinite(trace)) return std::numeric_limits<double>::infinity();
    logarithm += exponent * std::log(trace);
    double squared[3][3] = {};
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) {
        for (size_t k = 0; k < 3; ++k) {
          squared[i][j] += (power[i][k] / trace) * (power[k][j] / trace);
        }
      }
    }
    std::copy(&squared[0][0], &squared[0][0] + 9, &power[0][0]);
  }
  return std::exp(logarithm / 2);
}

bool invertLinear(const Matrix& matrix, Matrix& inverse) {
  const auto at = [&](size_t row, size_t column) { return matrix[4 * column + row]; };
  inverse = kIdentity;
  double determinant = 0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      const size_t r0 = (i + 1) % 3, r1 = (i + 2) % 3, c0 = (j + 1) % 3, c1 = (j + 2) % 3;
      const double cofactor = at(r0, c0) * at(r1, c1) - at(r0, c1) * at(r1, c0);
      if (j == 0) determinant += at(i, 0) * cofactor;
      inverse[4 * i + j] = cofactor;  // the transpose of the cofactors
    }
  }
  bool is_finite = determinant != 0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      inverse[4 * i + j] /= determinant;
      is_finite = is_finite && std::isfinite(inverse[4 * i + j]);
    }
  }
  return is_finite;
}

std::array<double, 3> transformed(const Matrix& matrix, const std::array<double, 3>& point) {
  std::array<double, 3> result = {matrix[12], matrix[13], matrix[14]};
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 3; ++k) result[row] += matrix[4 * k + row] * point[k];
  }
  return result;
}

bool readNumbers(const gltf::Json& json, double* numbers, size_t count) {
  if (!json.is_array() || json.size() != count) return false;
  for (size_t i = 0; i < count; ++i) {
    if (!gltf::asNumber(json[i], numbers[i]) || !std::isfinite(numbers[i])) return false;
  }
  return true;
}

}  // namespace mcc::tiles
