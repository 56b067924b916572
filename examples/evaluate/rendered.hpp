#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <string>

#include "core/scene/scene.hpp"
#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// Times of the frames of a rendered sequence.
struct FrameTimes {
  double from_s = 0.0;  ///< Time of the first frame.
  int frames = 0;
  int stride = 1;  ///< Uses every stride-th camera frame.
  double frames_per_second = 30.0;

  [[nodiscard]] double at_s(std::size_t frame) const {
    return from_s + static_cast<double>(frame) * stride / frames_per_second;
  }
};

/// Size of all rendered frames.
inline constexpr int kRenderedWidth = 640;
inline constexpr int kRenderedHeight = 360;

/// A sequence of a scene, 640 x 360, with frames "name/frame0000.png" and so on. The truth is
/// computed immediately; pictures are rendered on demand and are identical on every machine.
/// @param distortion  Lens distortion of the frames; nullptr for a pinhole camera.
[[nodiscard]] Sequence make_rendered(const std::string& dataset,
                                     const std::string& name,
                                     const ellipse::Scene& scene,
                                     const FrameTimes& times,
                                     const Conditions& conditions = {},
                                     std::shared_ptr<const DistortedFrame> distortion = nullptr);

}  // namespace evaluate
