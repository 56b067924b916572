#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <optional>
#include <utility>

namespace ellipse {

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
  LeastSquares(const Vector& mean, const Matrix& information)
      : normal_(information), right_side_(information * mean) {}

  void add(const Vector& row, double value, double weight) {
    const Vector weighted = weight * row;
    add_columns(row, weighted, std::make_integer_sequence<int, kParameters>());
    right_side_ += value * weighted;
    ++samples_;
  }

  /// Adds all samples of other equations without a prior, with `factor` times their weights.
  void add(const LeastSquares& other, double factor) {
    normal_ += factor * other.normal_;
    right_side_ += factor * other.right_side_;
    samples_ += other.samples_;
  }

  [[nodiscard]] int samples() const { return samples_; }

  /// Inverse covariance of the solution, if each weight is 1 over the variance of its value.
  [[nodiscard]] Matrix information() const {
    return normal_.template selfadjointView<Eigen::Lower>();
  }

  /// nullopt if the system is singular.
  [[nodiscard]] std::optional<Vector> solve() const {
    Matrix normal = normal_;
    normal.diagonal() *= 1.0 + kRidge;
    const Eigen::LDLT<Matrix> factors(normal);
    if (!(factors.vectorD().minCoeff() > 0.0)) return std::nullopt;
    const Vector solution = factors.solve(right_side_);
    return solution.allFinite() ? std::optional(solution) : std::nullopt;
  }

 private:
  static constexpr double kRidge = 1e-9;  // far below any standard deviation, above rounding

  // Adds each column of the lower triangle from an even row on: pairs of numbers are added at once.
  template <int... kColumns>
  void add_columns(const Vector& row,
                   const Vector& weighted,
                   std::integer_sequence<int, kColumns...> /*columns*/) {
    ((normal_.col(kColumns).template tail<kParameters - (kColumns & ~1)>() +=
      weighted[kColumns] * row.template tail<kParameters - (kColumns & ~1)>()),
     ...);
  }

  Matrix normal_ = Matrix::Zero();  // lower triangle
  Vector right_side_ = Vector::Zero();
  int samples_ = 0;
};

}  // namespace ellipse
