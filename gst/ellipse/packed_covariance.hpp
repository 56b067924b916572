#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

#include <Eigen/Core>
#include <cmath>

/// Writes the upper triangle of a covariance, row by row: the order of metadata and messages.
template <int kSize>
void pack_covariance(const Eigen::Matrix<double, kSize, kSize>& covariance, gdouble* to) {
  for (int i = 0; i < kSize; ++i) {
    for (int k = i; k < kSize; ++k) *to++ = covariance(i, k);
  }
}

/// The inverse of pack_covariance().
template <int kSize>
[[nodiscard]] Eigen::Matrix<double, kSize, kSize> unpacked_covariance(const gdouble* from) {
  Eigen::Matrix<double, kSize, kSize> covariance;
  for (int i = 0; i < kSize; ++i) {
    for (int k = i; k < kSize; ++k) covariance(i, k) = covariance(k, i) = *from++;
  }
  return covariance;
}

/// Largest standard deviation of a point in any direction, from the first two rows and columns.
template <class Matrix>
[[nodiscard]] double largest_sigma(const Matrix& covariance) {
  const double half_sum = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(half_sum + std::hypot(half_difference, covariance(0, 1)));
}
