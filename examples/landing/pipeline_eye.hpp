#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/landing/eye.hpp"

namespace landing {

/// A pipeline appsrc ! ellipsetrack ! appsink that is stepped picture by picture.
class PipelineEye : public Eye {
 public:
  /// @param properties  Of ellipsetrack, as gst-launch-1.0 writes them: camera and diameter too.
  /// Throws std::runtime_error where there is no such element or property.
  PipelineEye(const PictureFormat& format, const std::string& properties);

  [[nodiscard]] Look look(const Eigen::Vector3d& gravity, const Draw& draw) override;
  void forget() override;

 private:
  void tell_gravity(const Eigen::Vector3d& gravity);

  PictureFormat format_;
  std::uint64_t frame_ = 0;
  Pipeline pipeline_;
  Element source_;
  Element track_;
  Element sink_;
};

}  // namespace landing
