#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Reduces images by a power of two: ScaleImage of [Keipour2021] Algorithm 3.
class Scaler {
 public:
  /// Each pixel of the result is the mean of scale x scale pixels, so x in the result is
  /// (x + 0.5) scale - 0.5 in the picture. A remainder at the right and bottom is cut off.
  ///
  /// @param scale  A power of two from 1 to 128. At 1 the picture itself is returned.
  /// @return Valid until the next call or until the picture is released; empty if the picture is
  ///         smaller than `scale`. Allocates if the picture is larger than any before.
  [[nodiscard]] ImageView reduce(const ImageView& luma, int scale);

 private:
  std::vector<std::uint8_t> reduced_;
  std::vector<std::uint16_t> sums_;
};

/// Maps an ellipse from a region reduced by `scale` to its frame: ScaleSize and CompensateOffset of
/// [Keipour2021] Algorithms 3 and 2.
[[nodiscard]] Ellipse to_frame(const Ellipse& in_region, const Rect& region, int scale);

/// The inverse of to_frame().
[[nodiscard]] Ellipse to_region(const Ellipse& in_frame, const Rect& region, int scale);

}  // namespace ellipse
