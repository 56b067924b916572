#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>

#include "core/camera/lens_view.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// The luma of a picture and the lens that distorts it. A value; borrows the pixels and the lens.
struct Picture {
  ImageView luma;
  LensView lens;  ///< None by default.

  Picture() = default;
  Picture(const ImageView& image,  // NOLINT(google-explicit-constructor): a picture without a lens
          const LensView& its_lens = {})
      : luma(image), lens(its_lens) {}
  /// Without a lens; as the members of ImageView.
  Picture(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride)
      : luma{data, width, height, stride} {}
};

}  // namespace ellipse
