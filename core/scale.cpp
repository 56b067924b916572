// SPDX-License-Identifier: MIT
#include "core/scale.hpp"

#include <opencv2/imgproc.hpp>

namespace ellipse {

ImageView Scaler::reduce(const ImageView& luma, int scale) {
  if (scale == 1) return luma;
  const int width = luma.width / scale;
  const int height = luma.height / scale;
  if (width == 0 || height == 0) return {};
  const cv::Mat whole_blocks(height * scale,
                             width * scale,
                             CV_8UC1,
                             const_cast<std::uint8_t*>(luma.data),
                             static_cast<std::size_t>(luma.stride));
  cv::resize(whole_blocks, reduced_, {width, height}, 0, 0, cv::INTER_AREA);
  return {reduced_.data, width, height, static_cast<std::ptrdiff_t>(reduced_.step)};
}

Ellipse to_frame(const Ellipse& in_region, const Rect& region, int scale) {
  return translated(scaled(in_region, scale), region.x, region.y);
}

Ellipse to_region(const Ellipse& in_frame, const Rect& region, int scale) {
  return scaled(translated(in_frame, -region.x, -region.y), 1.0 / scale);
}

int next_scale(int scale, int max_scale, double size_px, double min_size_px, double max_size_px) {
  if (size_px > max_size_px && 2 * scale <= max_scale) return 2 * scale;
  if (size_px < min_size_px && scale > 1) return scale / 2;
  return scale;
}

}  // namespace ellipse
