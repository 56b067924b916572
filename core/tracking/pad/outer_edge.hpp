#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "core/geometry/ellipse.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/geometry/robust.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"
#include "core/tracking/pad/refinement.hpp"

namespace ellipse {

/// Max difference of an outer edge and its prediction, or of a locked edge and its detection.
inline constexpr Tolerance kOuterEdgeTolerance{1.0, 0.03};

/// Refines the outer edge of a pad whose view is accurate to about a pixel, frame by frame. Learns
/// the sharpness of the edge and the length of the exposure.
///
/// One object serves one thread. Allocates nothing.
class OuterEdge {
 public:
  void configure(Refinement refinement) { refinement_ = refinement; }

  /// Forgets what it learned: another pad follows. The first call computes a table, see
  /// BlurredBars.
  void restart();

  /// Learns nothing if it returns nullopt.
  ///
  /// @param gain        Ratio of image contrast to model contrast.
  /// @param motion_px   As of motion_blur(); zero = unknown.
  /// @param adaptation  Share of this frame in the mean sharpness.
  /// @return The edge in the image's ideal plane; nullopt with Refinement::kNone, if less than half
  ///         of its visible part is matched, if too few edges are left for a fit, or if it is too
  ///         far from the predicted edge.
  [[nodiscard]] std::optional<FittedEllipse> refine(const ImageView& luma,
                                                    const PadView& view,
                                                    const PadModel& model,
                                                    double gain,
                                                    const Eigen::Vector2d& motion_px,
                                                    double adaptation);

  /// Squared share of the time from frame to frame that the exposure takes, by the motion blur so
  /// far; 0 if it is not known.
  [[nodiscard]] double squared_exposure() const {
    return squared_motions_ > 0.0 ? std::min(1.0, squared_blurs_ / squared_motions_) : 0.0;
  }

 private:
  [[nodiscard]] std::optional<FittedEllipse> on_maxima(const ImageView& luma,
                                                       const PadView& view,
                                                       const PadModel& model,
                                                       double min_contrast,
                                                       const Eigen::Vector2d& motion_px,
                                                       double adaptation);

  Refinement refinement_ = Refinement::kEdges;
  std::optional<Estimate> sharpness_;  // mean over frames whose motion blur hides no maxima
  double squared_motions_ = 0.0;       // sums over frames whose edge was accepted [px^2]
  double squared_blurs_ = 0.0;
};

/// Refines an inner circle of a pad by gradient maxima.
///
/// @return The circle in the image's ideal plane; nullopt if less than half of its visible part is
///         matched, or too few edges are left for a fit. Allocates nothing.
[[nodiscard]] std::optional<FittedEllipse> refined_circle(const ImageView& luma,
                                                          const PadView& view,
                                                          const PadCircle& circle,
                                                          double gain,
                                                          const Eigen::Vector2d& motion_px);

}  // namespace ellipse
