#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>

#include "core/scene/random.hpp"

namespace landing {

/// Approximately normal with standard deviation 1. Sums uniform numbers, because the result of a
/// logarithm depends on the machine.
[[nodiscard]] inline double normal(ellipse::Random& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += random.unit();
  return sum;
}

[[nodiscard]] inline Eigen::Vector3d normal_vector(ellipse::Random& random) {
  const double x = normal(random);
  const double y = normal(random);
  const double z = normal(random);
  return {x, y, z};
}

}  // namespace landing
