#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace ellipse {

/// The two gradient maxima of a bar that the lens blurs, as GradientMap and subpixel_maximum()
/// measure them.
struct BarMaxima {
  double distance_px = 0.0;  ///< From each other.
  double sharpness = 0.0;    ///< As EdgeMeasurement::sharpness.
};

/// Number of the directions of a bar: they are spread over a turn.
inline constexpr std::size_t kBarDirections = 16;

/// Normals of the bars, by the index of the direction.
[[nodiscard]] const std::array<Eigen::Vector2d, kBarDirections>& bar_normals();

/// Bars that a lens blurs, of any width and direction.
class BlurredBars {
 public:
  /// The first object computes a table in about 20 ms. Allocates nothing.
  /// @param defocus  Doublings of the standard deviation of the lens's blur: 0 is in focus. At most
  ///                 max_defocus().
  explicit BlurredBars(double defocus);

  [[nodiscard]] static double max_defocus();

  /// Largest width at which blur moves the maxima [px].
  [[nodiscard]] double widest_px() const { return widest_px_; }

  /// O(1).
  /// @param direction  Index of the bar's direction.
  [[nodiscard]] BarMaxima maxima(double width_px, std::size_t direction) const;

 private:
  double blur_px_;  // standard deviation, by lens and kernels
  double widest_px_;
  std::size_t sharper_;
  double share_;  // of the next table
};

}  // namespace ellipse
