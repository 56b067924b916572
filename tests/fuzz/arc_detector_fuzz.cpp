// SPDX-License-Identifier: MIT
//
// A libFuzzer target: any picture of up to 257 x 257 pixels, any stride, any valid thresholds.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/detection/arcs/arc_detector.hpp"

namespace {

// The detector's guarantees for every result.
bool is_sound(const ellipse::Detection& d) {
  const ellipse::Ellipse& e = d.ellipse;
  return std::isfinite(e.cx + e.cy + e.angle_rad + d.score) && e.semi_major >= e.semi_minor &&
         e.semi_minor > 0.0 && d.ellipse_overlap >= 0.0 && d.ellipse_overlap <= 1.0 + 1e-9 &&
         d.contour_overlap >= 0.0 && d.contour_overlap <= 1.0 + 1e-9;
}

// Reads the input byte by byte; 0 after its end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  int next() { return at_ < size_ ? data_[at_++] : 0; }
  [[nodiscard]] const std::uint8_t* rest() const { return data_ + at_; }
  [[nodiscard]] std::size_t rest_size() const { return size_ - at_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

ellipse::Thresholds thresholds_from(Bytes& bytes) {
  ellipse::Thresholds thresholds;
  thresholds.contour_overlap = bytes.next() / 255.0;
  thresholds.ellipse_overlap = bytes.next() / 255.0;
  thresholds.min_axis_px = 1.0 + bytes.next() / 8.0;
  thresholds.max_axis_px = thresholds.min_axis_px + 4.0 * bytes.next();
  thresholds.max_axis_ratio = 1.0 + bytes.next() / 8.0;
  thresholds.min_contour_size = 5 + bytes.next();
  thresholds.edge_high = bytes.next() / 16.0;
  return thresholds;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static ellipse::ArcDetector detector;
  Bytes bytes(data, size);
  const int width = 1 + bytes.next() + (bytes.next() & 1);
  const int height = 1 + bytes.next() + (bytes.next() & 1);
  const int stride = width + bytes.next() % 17;
  const ellipse::Thresholds thresholds = thresholds_from(bytes);

  // Repeats the rest of the input, in a buffer of exactly this size so that out-of-bounds reads are
  // caught.
  const std::size_t needed = static_cast<std::size_t>(stride) * (height - 1) + width;
  std::vector<std::uint8_t> pixels(needed, 128);
  for (std::size_t i = 0; bytes.rest_size() > 0 && i < needed; i += bytes.rest_size()) {
    std::memcpy(&pixels[i], bytes.rest(), std::min(bytes.rest_size(), needed - i));
  }
  for (const ellipse::Detection& detection :
       detector.detect({pixels.data(), width, height, stride}, thresholds)) {
    if (!is_sound(detection)) std::abort();
  }
  return 0;
}
