#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <string>

#include "core/scene/scene.hpp"
#include "examples/evaluate/dataset.hpp"

namespace evaluate {

/// When the frames of a rendered sequence are.
struct FrameTimes {
  double from_s = 0.0;  ///< Time of the first one.
  int frames = 0;
  int stride = 1;  ///< Each is so many frames of the camera after the last.
  double frames_per_second = 30.0;

  [[nodiscard]] double at_s(std::size_t frame) const {
    return from_s + static_cast<double>(frame) * stride / frames_per_second;
  }
};

/// The size of all rendered frames.
inline constexpr int kRenderedWidth = 640;
inline constexpr int kRenderedHeight = 360;

/// A sequence of a scene, 640 x 360, named "name/frame0000.png" and so on. Its truth is there at
/// once; a picture is rendered whenever it is asked for, the same one on every machine.
/// @param distortion  What the scene's lens makes of such a frame; nullptr for a pinhole.
[[nodiscard]] Sequence make_rendered(const std::string& dataset,
                                     const std::string& name,
                                     const ellipse::Scene& scene,
                                     const FrameTimes& times,
                                     const Conditions& conditions = {},
                                     std::shared_ptr<const DistortedFrame> distortion = nullptr);

}  // namespace evaluate
