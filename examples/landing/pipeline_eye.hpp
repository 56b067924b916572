#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/landing/eye.hpp"

namespace landing {

/// Runs appsrc ! ellipsetrack ! appsink, one picture at a time.
class PipelineEye : public Eye {
 public:
  /// @param properties  For ellipsetrack in gst-launch-1.0 syntax, including camera and diameter.
  /// Throws std::runtime_error if the element or a property does not exist.
  PipelineEye(const PictureFormat& format, const std::string& properties);

  [[nodiscard]] Look look(const Eigen::Vector3d& gravity, const Draw& draw) override;
  void forget() override;

 private:
  void set_gravity(const Eigen::Vector3d& gravity);

  PictureFormat format_;
  std::uint64_t frame_ = 0;
  Pipeline pipeline_;
  Element source_;
  Element track_;
  Element sink_;
};

}  // namespace landing
