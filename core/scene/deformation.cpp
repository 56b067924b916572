// SPDX-License-Identifier: MIT
#include "core/scene/deformation.hpp"

#include <algorithm>
#include <cmath>

namespace ellipse {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Vector2d Deformation::pattern_at(const Vector2d& deformed) const {
  Vector2d pattern = deformed;
  for (const Fold& fold : folds_) {
    pattern -= std::sin(fold.wave.dot(deformed) + fold.phase_rad) * fold.shift;
  }
  return pattern;
}

Matrix2d Deformation::slope_at(const Vector2d& deformed) const {
  Matrix2d slope = Matrix2d::Identity();
  for (const Fold& fold : folds_) {
    slope -=
        std::cos(fold.wave.dot(deformed) + fold.phase_rad) * fold.shift * fold.wave.transpose();
  }
  return slope;
}

Vector2d Deformation::deformed_at(const Vector2d& pattern) const {
  // Each step at least halves the error: 40 reach double precision.
  constexpr int kSteps = 40;
  Vector2d deformed = pattern;
  for (int i = 0; i < kSteps && !is_flat(); ++i) {
    const Vector2d error = pattern - pattern_at(deformed);
    deformed += error;
    if (error.squaredNorm() < 1e-24) break;
  }
  return deformed;
}

double Deformation::light_at(const Vector2d& deformed) const {
  double light = 1.0;
  for (const Fold& fold : folds_) {
    light += fold.shade * std::cos(fold.wave.dot(deformed) + fold.phase_rad);
  }
  return std::max(light, 0.0);
}

double Deformation::max_shift() const {
  double sum = 0.0;
  for (const Fold& fold : folds_) sum += fold.shift.norm();
  return sum;
}

}  // namespace ellipse
