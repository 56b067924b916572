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

/// What a method reports about one picture.
struct Look {
  bool has_target = false;
  std::optional<Eigen::Vector3d> position;  ///< Of the pad's centre in the camera's frame [m].
  double error = 0.0;                       ///< Standard deviation of the position [m].
  double visible_fraction = 0.0;            ///< Share of the outline that the picture shows.
  Sample sample;                            ///< The picture with its metadata.
};

/// Fills a picture.
using Draw = std::function<void(const ellipse::MutableImage&)>;

/// The size and the rate of the camera's pictures.
struct PictureFormat {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  int rate = 0;    ///< [1/s]

  /// Raw GStreamer caps, GRAY8.
  [[nodiscard]] std::string caps() const;

  /// Draws a picture into a new buffer with the time of frame number `frame`. The caller owns it.
  [[nodiscard]] GstBuffer* draw(std::uint64_t frame, const Draw& draw) const;
};

/// Looks for the pad, picture by picture. Serves one thread.
class Eye {
 public:
  Eye() = default;
  virtual ~Eye() = default;
  Eye(const Eye&) = delete;
  Eye& operator=(const Eye&) = delete;

  /// Has a picture drawn, and searches it.
  /// @param gravity  Down in the camera's frame.
  /// Throws std::runtime_error where a pipeline has failed.
  [[nodiscard]] virtual Look look(const Eigen::Vector3d& gravity, const Draw& draw) = 0;

  /// Drops everything learned from earlier pictures.
  virtual void forget() = 0;
};

}  // namespace landing
