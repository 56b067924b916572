#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "core/detection/detector.hpp"
#include "core/image/scale.hpp"

namespace support {

/// Returns scripted detections, in pixels of the frame, and records its calls.
class ScriptedDetector final : public ellipse::Detector {
 public:
  struct Call {
    int width;
    int height;
    ellipse::Thresholds thresholds;
  };
  struct Script {
    std::vector<std::vector<ellipse::Detection>> answers;  ///< The last one repeats.
    std::vector<Call> calls;
    std::function<ellipse::Rect()> region;  ///< Searched region of the frame [px].
  };

  explicit ScriptedDetector(Script& script) : script_(script) {}

  std::span<const ellipse::Detection> detect(const ellipse::Picture& picture,
                                             const ellipse::Thresholds& thresholds) override {
    const ellipse::ImageView& luma = picture.luma;
    const std::size_t turn = std::min(script_.calls.size(), script_.answers.size() - 1);
    script_.calls.push_back({luma.width, luma.height, thresholds});
    answer_ = script_.answers[turn];
    const ellipse::Rect region = script_.region();
    for (ellipse::Detection& detection : answer_) {
      detection.ellipse =
          to_region(detection.ellipse, region, luma.empty() ? 1 : region.width / luma.width);
    }
    return answer_;
  }
  ellipse::Overlaps detecting_overlaps() const override { return {0.95, 0.94}; }
  ellipse::Overlaps tracking_overlaps() const override { return {0.7, 0.3}; }

 private:
  Script& script_;
  std::vector<ellipse::Detection> answer_;
};

/// A detection with full overlaps.
inline ellipse::Detection detection_at(double cx, double cy, double semi_major) {
  return {{cx, cy, semi_major, 0.9 * semi_major, 0.0}, 1.0, 1.0, 100.0};
}

}  // namespace support
