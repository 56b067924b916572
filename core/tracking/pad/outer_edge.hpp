#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/geometry/ellipse_fit.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"
#include "core/tracking/pad/refinement.hpp"

namespace ellipse {

/// The outer edge of a pad whose view is known within a pixel or so, made exact on the picture; in
/// its ideal plane.
///
/// @param gain  Of the picture's contrast over the model's.
/// @return nullopt where the picture does not show it well enough. Allocates nothing.
[[nodiscard]] std::optional<FittedEllipse> refined_outer_edge(const ImageView& luma,
                                                              const PadView& view,
                                                              const PadModel& model,
                                                              double gain,
                                                              Refinement refinement);

/// A circle of a pad inside its outer one, the same way by gradient maxima.
///
/// @return nullopt where the picture does not show it well enough. Allocates nothing.
[[nodiscard]] std::optional<FittedEllipse> refined_circle(const ImageView& luma,
                                                          const PadView& view,
                                                          const PadCircle& circle,
                                                          double gain);

}  // namespace ellipse
