#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Makes pictures smaller by a power of two: ScaleImage of [Keipour2021] Algorithm 3.
class Scaler {
 public:
  /// Each pixel of the result is the mean of scale x scale pixels, so that x in the result is
  /// (x + 0.5) scale - 0.5 in the picture. What is left over at the right and below is cut off.
  ///
  /// @param scale  A power of two from 1 to 128. At 1 the picture itself is returned.
  /// @return Valid until the next call or until the picture goes away; empty where the picture is
  ///         smaller than `scale`. Allocates when the picture is larger than any before.
  [[nodiscard]] ImageView reduce(const ImageView& luma, int scale);

 private:
  std::vector<std::uint8_t> reduced_;
  std::vector<std::uint16_t> sums_;
};

/// From the pixels of a region reduced by `scale` to those of the frame that the region is in:
/// ScaleSize and CompensateOffset of [Keipour2021] Algorithms 3 and 2.
[[nodiscard]] Ellipse to_frame(const Ellipse& in_region, const Rect& region, int scale);

/// The inverse of to_frame().
[[nodiscard]] Ellipse to_region(const Ellipse& in_frame, const Rect& region, int scale);

}  // namespace ellipse
