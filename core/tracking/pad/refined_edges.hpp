#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "core/camera/picture.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/tracking/pad/outer_edge.hpp"
#include "core/tracking/pad/pad_model.hpp"

namespace ellipse {

/// Refines the circles of a followed pad in each frame. All views and ellipses are those of the
/// frame's ideal plane.
///
/// One object serves one thread. Allocates nothing.
class RefinedEdges {
 public:
  void configure(Refinement refinement) { outer_edge_.configure(refinement); }

  /// Forgets the sharpness and the exposure: another pad follows.
  void restart() { outer_edge_.restart(); }
  /// Forgets the acceleration: the pad is followed from here on.
  void restart_motion() { squared_acceleration_.reset(); }

  /// Call in each frame: no circle is refined yet, and the motion is unknown.
  void begin_frame();
  /// @param px  Displacement of the pad's centre in the picture per frame; zero = unknown.
  void set_motion(const Eigen::Vector2d& px) { motion_px_ = px; }

  /// @param gain        Ratio of image contrast to model contrast.
  /// @param adaptation  Share of this frame in means over time.
  /// @return As OuterEdge::refine().
  [[nodiscard]] std::optional<FittedEllipse> refine_outer(const Picture& picture,
                                                          const Eigen::Matrix3d& view,
                                                          const PadModel& model,
                                                          double gain,
                                                          double adaptation);

  /// RMS distance of the mean position during the exposure from the position in its middle [px].
  /// Call once per frame with a refined outer edge.
  [[nodiscard]] double exposure_error_px(double adaptation);

  /// Refines as many inner circles as inner() holds, from the outermost.
  void refine_inner(const Picture& picture,
                    const Eigen::Matrix3d& view,
                    const PadModel& model,
                    double gain);

  /// The inner circles of this frame. Valid until the next call.
  [[nodiscard]] std::span<const FittedEllipse> inner() const {
    return {inner_.data(), inner_count_};
  }

 private:
  OuterEdge outer_edge_;
  std::array<FittedEllipse, 2> inner_;
  std::size_t inner_count_ = 0;
  Eigen::Vector2d motion_px_{0.0, 0.0};
  Eigen::Vector2d last_motion_px_{0.0, 0.0};    // of the frame before
  std::optional<double> squared_acceleration_;  // adaptive [(px / frame^2)^2]
};

}  // namespace ellipse
