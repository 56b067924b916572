#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <vector>

namespace ellipse {

/// A standing wave in a flat thing: a fold of cloth or, where it is long, a bend of a plate.
/// Lengths are in the units of the sheet.
struct Fold {
  Eigen::Vector2d wave{0.0, 0.0};   ///< Direction of the wave, times 2 pi over its length.
  double phase_rad = 0.0;           ///< At the sheet's origin.
  Eigen::Vector2d shift{0.0, 0.0};  ///< Largest displacement of the pattern.
  double shade = 0.0;               ///< Largest relative change of the light on its slopes.
};

/// Where the pattern of a deformed sheet appears.
class Deformation {
 public:
  Deformation() = default;
  explicit Deformation(const std::vector<Fold>& folds) : folds_(folds) {}

  [[nodiscard]] bool is_flat() const { return folds_.empty(); }

  /// The place of the pattern that is seen at a place of the sheet.
  [[nodiscard]] Eigen::Vector2d pattern_at(const Eigen::Vector2d& seen) const;
  /// Its derivative.
  [[nodiscard]] Eigen::Matrix2d slope_at(const Eigen::Vector2d& seen) const;
  /// The inverse of pattern_at(). The displacements must change by less than half of a distance.
  [[nodiscard]] Eigen::Vector2d seen_at(const Eigen::Vector2d& pattern) const;
  /// Light on a place of the sheet, 1 where it is flat.
  [[nodiscard]] double light_at(const Eigen::Vector2d& seen) const;
  /// No place of the pattern is displaced farther.
  [[nodiscard]] double max_shift() const;

 private:
  std::vector<Fold> folds_;
};

}  // namespace ellipse
