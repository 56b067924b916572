#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/ellipse_fit.hpp"
#include "core/image_view.hpp"
#include "core/pad_model.hpp"
#include "core/pad_view.hpp"

namespace ellipse {

/// What makes a followed ellipse exact.
enum class Refinement {
  kNone,         ///< Nothing: where the edges that it is followed by put it.
  kEdges,        ///< The crests of the gradient along the outer edge.
  kPhotometric,  ///< The brightness of all pixels along it; crests where the ring is too thin.
};

/// Their nicks, in their order.
[[nodiscard]] std::span<const char* const> refinement_nicks();

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
