#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// An edge with less of the expected contrast is not the pad's.
inline constexpr double kMinContrastShare = 0.25;

/// A circle about the pad's centre where its brightness changes.
struct PadCircle {
  double radius = 1.0;  ///< [radii of the outer circle]
  bool is_bright_outside = true;
  double contrast = 0.0;  ///< [grey levels]
  bool is_given = false;  ///< Its radius was not learned, so it stays.
};

/// A straight edge on the pad.
struct PadLine {
  Eigen::Vector2d from;  ///< [radii of the outer circle]
  Eigen::Vector2d to;
  Eigen::Vector2d to_bright;  ///< Unit normal.
  double contrast = 0.0;      ///< [grey levels]
  int visible = 0;            ///< Frames in which enough of it was inside the picture,
  int matched = 0;            ///< and was matched.
};

/// What a pad shows: the edges by which it is followed.
struct PadModel {
  std::vector<PadCircle> circles;  ///< The outer one first.
  std::vector<PadLine> lines;
};

/// Learns the circles of a pad from a picture: the median brightness over the angles, as a function
/// of the radius, has a step at each.
///
/// @param view            With the outer circle on the target's outer edge, within a few percent.
/// @param ring_ratio      Radius of the circle next inside the outer one, where it is known: it is
///                        taken for what it is, also where the picture is too coarse to show it.
///                        0 = is learned.
/// nullopt where there is no step at the outer circle. Allocates the model, and nothing without
/// one.
[[nodiscard]] std::optional<PadModel> learn_circles(const ImageView& luma,
                                                    const PadView& view,
                                                    double ring_ratio = 0.0);

}  // namespace ellipse
