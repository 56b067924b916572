#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <vector>

namespace ellipse {

/// A sinusoidal wave in a flat sheet. Short waves are folds of cloth, long ones the curvature of a
/// plate. Lengths are in the units of the sheet.
struct Fold {
  Eigen::Vector2d wave{0.0, 0.0};   ///< Wave vector: direction times 2 pi / wavelength.
  double phase_rad = 0.0;           ///< At the sheet's origin.
  Eigen::Vector2d shift{0.0, 0.0};  ///< Largest displacement of the pattern.
  double shade = 0.0;               ///< Largest relative change of the light on its slopes.
};

/// Maps between the pattern of a deformed sheet and its visible positions.
class Deformation {
 public:
  Deformation() = default;
  explicit Deformation(const std::vector<Fold>& folds) : folds_(folds) {}

  [[nodiscard]] bool is_flat() const { return folds_.empty(); }

  /// The point of the pattern visible at a point of the sheet.
  [[nodiscard]] Eigen::Vector2d pattern_at(const Eigen::Vector2d& deformed) const;
  /// Its derivative.
  [[nodiscard]] Eigen::Matrix2d slope_at(const Eigen::Vector2d& deformed) const;
  /// The inverse of pattern_at(). The slopes of the displacements must sum to less than one half.
  [[nodiscard]] Eigen::Vector2d deformed_at(const Eigen::Vector2d& pattern) const;
  /// Relative light at a point of the sheet, 1 if it is flat.
  [[nodiscard]] double light_at(const Eigen::Vector2d& deformed) const;
  /// Upper bound of the displacement of the pattern.
  [[nodiscard]] double max_shift() const;

 private:
  std::vector<Fold> folds_;
};

}  // namespace ellipse
