// SPDX-License-Identifier: MIT
#include "gst/overlay/label.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

using ellipse::Ellipse;
using ellipse::Rect;

namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalPx = 21.0;  // at scale 1
constexpr double kDescenderPx = 7.0;
constexpr double kMinScale = 0.3;

int stroke_px(double scale) {
  return std::max(1, static_cast<int>(std::lround(1.8 * scale)));
}

int capital_px(double scale) {
  return static_cast<int>(std::ceil(kCapitalPx * scale));
}

int margin_px(double scale) {
  return static_cast<int>(std::lround(2.0 + 4.0 * scale));
}

// Wider than the vertical margin, because the box ends in half circles.
int side_margin_px(double scale) {
  return 2 * margin_px(scale);
}

int height_px(double scale) {
  const int descender = static_cast<int>(std::ceil(kDescenderPx * scale));
  return capital_px(scale) + descender + 2 * margin_px(scale);
}

bool is_inside(const Rect& box, const Rect& frame) {
  return ellipse::intersect(box, frame) == box;
}

}  // namespace

// Both have sufficient contrast with a luma of 64 to 191. Text of this luma is easier to read on a
// black translucent box.
std::uint32_t contrast_to(std::uint32_t argb) {
  const double luma =
      0.299 * (argb >> 16U & 0xffU) + 0.587 * (argb >> 8U & 0xffU) + 0.114 * (argb & 0xffU);
  return luma < 64.0 ? 0xffffffU : 0U;
}

std::optional<Label> make_label(std::string text, int frame_width, int frame_height) {
  int baseline = 0;
  const auto width_at = [&](double scale) {
    return cv::getTextSize(text, kFont, scale, stroke_px(scale), &baseline).width +
           2 * side_margin_px(scale);
  };
  double scale = (5.0 + frame_height / 60.0) / kCapitalPx;
  const int full_width = width_at(scale);
  if (full_width > frame_width) scale *= static_cast<double>(frame_width) / full_width;
  const int width = width_at(scale);
  if (scale < kMinScale || width > frame_width) return std::nullopt;
  return Label{std::move(text), scale, {0, 0, width, height_px(scale)}};
}

std::optional<Rect> place_label(const Label& label,
                                const Ellipse& e,
                                double gap_px,
                                const Rect& frame,
                                std::span<const Rect> taken) {
  const double away = ellipse::half_extent(e).y() + gap_px;
  const int width = label.box.width;
  const int height = label.box.height;
  const double max_left = std::max(0, frame.width - width);
  const int left = static_cast<int>(std::lround(std::clamp(e.cx - 0.5 * width, 0.0, max_left)));
  const std::array tops{static_cast<int>(std::ceil(e.cy + away)),
                        static_cast<int>(std::floor(e.cy - away)) - height,
                        frame.height - height,
                        0};
  for (const int top : tops) {
    const Rect box{left, top, width, height};
    const bool is_free = std::none_of(taken.begin(), taken.end(), [&](const Rect& other) {
      return !ellipse::intersect(box, other).empty();
    });
    if (is_free && is_inside(box, frame)) return box;
  }
  return std::nullopt;
}

void draw_label(Canvas& canvas, const Label& label, std::uint32_t argb) {
  const Rect& box = label.box;
  const double round = 0.5 * (box.height - 1);
  // A line as thick as the height of the box draws its round ends.
  canvas.cover_line({box.x + round, box.y + round},
                    {box.x + box.width - 1 - round, box.y + round},
                    box.height - 1);
  const std::uint32_t opacity = (argb >> 24U) * 170U / 255U;
  canvas.paint(opacity << 24U | contrast_to(argb));

  cv::Mat mask = cv::Mat::zeros(box.height, box.width, CV_8U);
  cv::putText(mask,
              label.text,
              {side_margin_px(label.scale), margin_px(label.scale) + capital_px(label.scale)},
              kFont,
              label.scale,
              cv::Scalar(255),
              stroke_px(label.scale),
              cv::LINE_AA);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      canvas.cover(box.x + x, box.y + y, mask.at<std::uint8_t>(y, x));
    }
  }
  canvas.paint(argb);
}
