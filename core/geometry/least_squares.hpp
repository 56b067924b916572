#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace ellipse {

/// Tukey's biweight [BeatonTukey1974]: 1 for no distance, 0 from `reach` on.
[[nodiscard]] inline double tukey_weight(double distance, double reach) {
  const double r = distance / reach;
  return std::abs(r) < 1.0 ? (1.0 - r * r) * (1.0 - r * r) : 0.0;
}

/// Normal equations of weighted linear least squares, with a prior: minimizes the sum of
/// weight (row . x - value)^2 plus the prior's (x - mean)^T information (x - mean).
///
/// Iterated with tukey_weight() from the last solution, it is a robust estimate. An ellipse has
/// five parameters (GeometricFit), a homography eight (solve_homography()). Allocates nothing; not
/// thread-safe.
template <int kParameters>
class LeastSquares {
 public:
  using Vector = Eigen::Matrix<double, kParameters, 1>;
  using Matrix = Eigen::Matrix<double, kParameters, kParameters>;

  LeastSquares() = default;
  LeastSquares(const Vector& mean, const Matrix& information) : right_side_(information * mean) {
    std::size_t term = 0;
    for (int i = 0; i < kParameters; ++i) {
      for (int k = i; k < kParameters; ++k) normal_[term++] = information(k, i);
    }
  }

  void add(const Vector& row, double value, double weight) {
    std::size_t term = 0;
    for (int i = 0; i < kParameters; ++i) {
      const double weighted = weight * row[i];
      for (int k = i; k < kParameters; ++k) normal_[term++] += weighted * row[k];
      right_side_[i] += weighted * value;
    }
    ++samples_;
  }

  [[nodiscard]] int samples() const { return samples_; }

  /// Inverse covariance of the solution, if each weight is 1 over the variance of its value.
  [[nodiscard]] Matrix information() const {
    Matrix information;
    std::size_t term = 0;
    for (int i = 0; i < kParameters; ++i) {
      for (int k = i; k < kParameters; ++k) information(k, i) = information(i, k) = normal_[term++];
    }
    return information;
  }

  /// nullopt if the system is singular.
  [[nodiscard]] std::optional<Vector> solve() const {
    Matrix normal = information();
    normal.diagonal() *= 1.0 + kRidge;
    const Eigen::LDLT<Matrix> factors(normal);
    if (!(factors.vectorD().minCoeff() > 0.0)) return std::nullopt;
    const Vector solution = factors.solve(right_side_);
    return solution.allFinite() ? std::optional(solution) : std::nullopt;
  }

 private:
  static constexpr double kRidge = 1e-9;  // far below any standard deviation, above rounding

  std::array<double, kParameters*(kParameters + 1) / 2> normal_{};  // upper triangle, row by row
  Vector right_side_ = Vector::Zero();
  int samples_ = 0;
};

}  // namespace ellipse
