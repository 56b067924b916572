// SPDX-License-Identifier: MIT
#include "core/tracking/pad/refined_edges.hpp"

#include <cmath>

#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {
namespace {

// From the picture to the frame of which it is a part.
FittedEllipse in_frame(const Picture& picture, const FittedEllipse& edge) {
  const Eigen::Vector2d& origin = picture.origin_px;
  return {translated(edge.ellipse, origin.x(), origin.y()),
          {translated(edge.uncertainty.view, origin), edge.uncertainty.information}};
}

}  // namespace

void RefinedEdges::begin_frame() {
  last_motion_px_ = motion_px_;
  motion_px_.setZero();
  inner_count_ = 0;
}

std::optional<FittedEllipse> RefinedEdges::refine_outer(const Picture& picture,
                                                        const Eigen::Matrix3d& view,
                                                        const PadModel& model,
                                                        double gain,
                                                        double adaptation) {
  const auto edge = outer_edge_.refine(
      picture.luma, PadView::in(picture, view), model, gain, motion_px_, adaptation);
  if (!edge) return std::nullopt;
  return in_frame(picture, *edge);
}

// For a constant acceleration a, a t^2 / 24. Vibration changes it from frame to frame: its mean
// counts.
double RefinedEdges::exposure_error_px(double adaptation) {
  if (!motion_px_.isZero() && !last_motion_px_.isZero()) {
    const double now = (motion_px_ - last_motion_px_).squaredNorm();
    const double mean = squared_acceleration_.value_or(now);
    squared_acceleration_ = mean + adaptation * (now - mean);
  }
  return outer_edge_.squared_exposure() / 24.0 * std::sqrt(squared_acceleration_.value_or(0.0));
}

void RefinedEdges::refine_inner(const Picture& picture,
                                const Eigen::Matrix3d& view,
                                const PadModel& model,
                                double gain) {
  const PadView shown = PadView::in(picture, view);
  for (std::size_t i = 1; i < model.circles.size() && inner_count_ < inner_.size(); ++i) {
    const auto edge = refined_circle(picture.luma, shown, model.circles[i], gain, motion_px_);
    if (edge) inner_[inner_count_++] = in_frame(picture, *edge);
  }
}

}  // namespace ellipse
