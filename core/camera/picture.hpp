#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "core/camera/lens_view.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// The luma of a picture, the lens that distorts it, its scale, and its position. A value;
/// borrows the pixels and the lens.
struct Picture {
  ImageView luma;
  LensView lens;                        ///< None by default.
  int scale = 1;                        ///< By which the frame was reduced.
  Eigen::Vector2d origin_px{0.0, 0.0};  ///< Of a part: its top-left pixel in the whole.

  Picture() = default;
  Picture(const ImageView& image,  // NOLINT(google-explicit-constructor): a picture without a lens
          const LensView& its_lens = {},
          int its_scale = 1)
      : luma(image), lens(its_lens), scale(its_scale) {}
  /// Without a lens; as the members of ImageView.
  Picture(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride)
      : luma{data, width, height, stride} {}

  /// The part inside a rectangle that begins in the picture; its end is clipped.
  [[nodiscard]] Picture part(const Rect& rect) const {
    const Eigen::Vector2d begin(rect.x, rect.y);
    Picture result(luma.region(rect), lens.part(begin), scale);
    result.origin_px = origin_px + begin;
    return result;
  }
};

}  // namespace ellipse
