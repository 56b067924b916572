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

/// What ellipsetrack says of a picture.
struct Look {
  bool has_target = false;
  std::optional<Eigen::Vector3d> position;  ///< Of its centre in the camera's frame [m].
  double error = 0.0;                       ///< Standard deviation of that [m].
  double visible_fraction = 0.0;            ///< Share of the outline that the picture shows.
  Sample sample;                            ///< The picture with its metadata.
};

/// A pipeline appsrc ! ellipsetrack ! appsink that is stepped picture by picture. Serves one
/// thread.
class Eye {
 public:
  /// @param properties  Of ellipsetrack, as gst-launch-1.0 writes them: camera and diameter too.
  /// Throws std::runtime_error where there is no such element or property.
  Eye(int width, int height, int rate, const std::string& properties);

  /// Has a picture drawn, and waits for what is found in it.
  /// @param gravity  Down in the camera's frame.
  /// Throws std::runtime_error where the pipeline has failed.
  Look look(const Eigen::Vector3d& gravity,
            const std::function<void(const ellipse::MutableImage&)>& draw);

  /// Lets it search as if nothing were known.
  void forget();

 private:
  void tell_gravity(const Eigen::Vector3d& gravity);

  int width_;
  int height_;
  int rate_;
  std::uint64_t frame_ = 0;
  Pipeline pipeline_;
  Element source_;
  Element track_;
  Element sink_;
};

}  // namespace landing
