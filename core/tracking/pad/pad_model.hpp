#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/camera/picture.hpp"
#include "core/geometry/homography.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// Min contrast to learn a line or to refine a circle, as a share of the expected contrast; also
/// limits the contrast of a frame.
inline constexpr double kMinContrastShare = 0.25;

/// Min share of a pad's edges, or of the angles of a circle, that match.
inline constexpr double kMinCoverage = 0.65;

inline constexpr double kEdgeSigmaPx = 0.6;  ///< Min standard deviation of a match's position.

inline constexpr std::size_t kMaxCircles = 5;  ///< Of a pad.

/// A circular edge around the pad's centre.
struct PadCircle {
  double radius = 1.0;  ///< [radii of the outer circle]
  bool is_bright_outside = true;
  double contrast = 0.0;  ///< [grey levels]
  bool is_given = false;  ///< Its radius is configured and not learned.
  HomographyChange sensitivity = HomographyChange::Zero();  ///< As PadLine::sensitivity.
};

/// A straight edge on the pad.
struct PadLine {
  Eigen::Vector2d from;  ///< [radii of the outer circle]
  Eigen::Vector2d to;
  Eigen::Vector2d to_bright;  ///< Unit normal.
  double contrast = 0.0;      ///< [grey levels]
  int visible = 0;            ///< Visible samples in all frames.
  int matched = 0;            ///< Of these, matched ones.
  /// Change of the tracked view by an error of the line's position of a radius, see
  /// core/tracking/pad/model_errors.hpp.
  HomographyChange sensitivity = HomographyChange::Zero();
};

/// The edges by which a pad is tracked.
struct PadModel {
  std::vector<PadCircle> circles;  ///< The outer one first.
  std::vector<PadLine> lines;
};

/// The line of a sample's feature, see EdgeSample::feature. nullptr for a circle, or if the model's
/// lines have been removed since.
[[nodiscard]] PadLine* line_of(PadModel& model, int feature);

/// Max distance of a matched edge from the model: its error, and the pad's deformation.
/// @param radius_px  Of the pad.
[[nodiscard]] double match_tolerance_px(double radius_px);

/// Learns the circles of a pad: steps of the median brightness over all angles as a function of the
/// radius.
///
/// @param view        Projects the outer circle to the target's outer edge, within a few percent.
/// @param ring_ratio  Radius of the next circle inside the outer one, if known: it is added even if
///                    the image is too coarse to resolve it. 0 = learned.
/// @param min_apart   Min distance of neighbouring circles of the same polarity [radii]. The search
///                    would take the edge of one for the other if they were closer.
/// @return nullopt if there is no step of one polarity at the outer circle. Allocates only the
/// model.
[[nodiscard]] std::optional<PadModel> learn_circles(const ImageView& luma,
                                                    const PadView& view,
                                                    double ring_ratio = 0.0,
                                                    double min_apart = 0.0);

/// A pad that was learned, and its view.
struct LearnedPad {
  PadModel model;
  Eigen::Matrix3d view;  ///< Frame from pad.
};

/// Learns a pad in the view in which its circles have the highest total contrast: the outer edge
/// leaves the tilt ambiguous, and a wrong tilt blurs the inner circles in the radial profile. Tries
/// the affine view, and with a camera both poses of the circle.
///
/// @param outer_edge  In the ideal plane of the frame.
/// @param ring_ratio  As of learn_circles().
/// @return nullopt if no view shows a step of one polarity at the outer edge. Allocates the models.
[[nodiscard]] std::optional<LearnedPad> learn_pad(const Picture& picture,
                                                  const Ellipse& outer_edge,
                                                  const std::optional<Camera>& camera,
                                                  double ring_ratio);

}  // namespace ellipse
