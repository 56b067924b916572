#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/scene/sensor.hpp"
#include "examples/landing/pipeline.hpp"

namespace landing {

/// A method's result for one picture.
struct Look {
  bool has_target = false;
  std::optional<Eigen::Vector3d> position;               ///< Pad centre in the camera frame [m].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of the position [m^2].
  double visible_fraction = 0.0;                         ///< Visible fraction of the outline.
  Sample sample;                                         ///< The picture with its metadata.
};

/// Renders a picture into an image.
using Draw = std::function<void(const ellipse::MutableImage&)>;

/// Size and rate of the camera's pictures.
struct PictureFormat {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  int rate = 0;    ///< [1/s]

  /// Raw GStreamer caps, GRAY8.
  [[nodiscard]] std::string caps() const;

  /// Draws a picture into a new buffer with the timestamp of frame number `frame`. The caller owns
  /// it.
  [[nodiscard]] GstBuffer* draw(std::uint64_t frame, const Draw& draw) const;
};

/// Locates the pad, picture by picture. Not thread-safe.
class Eye {
 public:
  Eye() = default;
  virtual ~Eye() = default;
  Eye(const Eye&) = delete;
  Eye& operator=(const Eye&) = delete;

  /// Draws a picture and locates the pad in it.
  /// @param gravity  Direction of gravity in the camera frame.
  /// Throws std::runtime_error if a pipeline failed.
  [[nodiscard]] virtual Look look(const Eigen::Vector3d& gravity, const Draw& draw) = 0;

  /// Discards everything learned from earlier pictures.
  virtual void forget() = 0;
};

}  // namespace landing
