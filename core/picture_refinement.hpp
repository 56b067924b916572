#pragma once  // SPDX-License-Identifier: MIT

#include <optional>

#include "core/arcs.hpp"
#include "core/ellipse.hpp"
#include "core/image_view.hpp"
#include "core/lens_view.hpp"

namespace ellipse {

/// An ellipse on the picture.
struct RefinedEllipse {
  Ellipse ellipse;
  RingUncertainty uncertainty;
  double support = 0.0;   ///< Share of the places inside the picture with a crest near.
  double gradient = 0.0;  ///< Mean of these crests [units of Gradient].
};

inline constexpr int kMostPlaces = 96;

/// Refines an ellipse that is known within a pixel or two, on the picture itself: looks for the
/// crest of the gradient across its perimeter at some places, and computes no gradient elsewhere.
///
/// @param places  At most kMostPlaces. With fewer it is faster, and the noise tells more.
/// @param least_gradient  Weaker crests do not count [units of Gradient].
/// @param lens    The ellipse is of the ideal plane, before and after; the perimeter is searched as
///                the lens bends it.
/// @return nullopt where too few crests are near. Allocates nothing; the time depends on no size.
[[nodiscard]] std::optional<RefinedEllipse> refined_on_picture(const ImageView& luma,
                                                               const Ellipse& e,
                                                               Polarity polarity,
                                                               double least_gradient,
                                                               int places = kMostPlaces,
                                                               const LensView& lens = {});

}  // namespace ellipse
