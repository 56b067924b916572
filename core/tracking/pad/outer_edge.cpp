// SPDX-License-Identifier: MIT
#include "core/tracking/pad/outer_edge.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "core/edges/edge_refinement.hpp"
#include "core/edges/photometric_refinement.hpp"
#include "core/edges/thin_ring.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kBlurBiasShare = 0.2;  // sigma of the blur correction, share of it

Polarity polarity_of(bool is_bright_outside) {
  return is_bright_outside ? Polarity::kDarkInside : Polarity::kBrightInside;
}

// Adds an error common to all samples [radii]; averaging does not reduce it.
RingMatrix widened(const RingMatrix& information, double sigma) {
  RingMatrix covariance = information.inverse();
  covariance.diagonal().array() += sigma * sigma;
  return covariance.inverse();
}

// Fits the gradient maxima near a circle's predicted image.
std::optional<FittedEllipse> on_maxima(const ImageView& luma,
                                       const PadView& view,
                                       const PadCircle& circle,
                                       double min_contrast,
                                       const Eigen::Vector2d& motion_px) {
  const auto predicted = project_circle(view.ideal_from_pad, circle.radius);
  if (!predicted) return std::nullopt;
  return refined_on_picture({luma, view.lens},
                            *predicted,
                            polarity_of(circle.is_bright_outside),
                            {kGradientOfStep * min_contrast, kMajority},
                            kRefinementSamples / 2,  // since this runs in each frame
                            motion_px);
}

// Removes the blur bias that separates the gradient maxima of a thin ring's two edges.
std::optional<FittedEllipse> on_outer_maxima(const ImageView& luma,
                                             const PadView& view,
                                             const PadModel& model,
                                             double min_contrast,
                                             const Eigen::Vector2d& motion_px) {
  const PadCircle& outer = model.circles.front();
  auto exact = on_maxima(luma, view, outer, min_contrast, motion_px);
  const bool is_ring =
      model.circles.size() > 1 && model.circles[1].is_bright_outside != outer.is_bright_outside;
  if (!exact || !is_ring) return exact;
  const auto inner = on_maxima(luma, view, model.circles[1], min_contrast, motion_px);
  if (!inner) return exact;
  const Ellipse blurred = exact->ellipse;
  exact->ellipse = without_blur_bias({blurred, inner->ellipse}).outer;
  const double sigma_px = kBlurBiasShare * max_difference_px(exact->ellipse, blurred);
  const double radius_px = std::sqrt(blurred.semi_major * blurred.semi_minor);
  exact->uncertainty = {image_from_pad(exact->ellipse),
                        widened(exact->uncertainty.information, sigma_px / radius_px)};
  return exact;
}

}  // namespace

std::optional<FittedEllipse> refined_outer_edge(const ImageView& luma,
                                                const PadView& view,
                                                const PadModel& model,
                                                double gain,
                                                Refinement refinement,
                                                const Eigen::Vector2d& motion_px) {
  const auto outer = project_circle(view.ideal_from_pad, 1.0);
  if (!outer || refinement == Refinement::kNone) return std::nullopt;
  const PadCircle& circle = model.circles.front();
  const double min_contrast = kMinContrastShare * circle.contrast * gain;
  const double ring_px = model.circles.size() > 1
                             ? (1.0 - model.circles[1].radius) * outer->semi_minor
                             : std::numeric_limits<double>::infinity();
  std::optional<FittedEllipse> exact;
  if (refinement == Refinement::kPhotometric && !view.lens.is_distorted()) {
    exact = refined_photometrically(
        luma, *outer, polarity_of(circle.is_bright_outside), ring_px, min_contrast);
  }
  if (!exact) exact = on_outer_maxima(luma, view, model, min_contrast, motion_px);
  if (!exact) return std::nullopt;
  // Motion blurs the edges over at most its length, so that each may be predicted half of it off.
  Tolerance tolerance = kOuterEdgeTolerance;
  tolerance.px += 0.5 * motion_px.norm();
  return is_same(exact->ellipse, *outer, tolerance) ? exact : std::nullopt;
}

std::optional<FittedEllipse> refined_circle(const ImageView& luma,
                                            const PadView& view,
                                            const PadCircle& circle,
                                            double gain,
                                            const Eigen::Vector2d& motion_px) {
  return on_maxima(luma, view, circle, kMinContrastShare * circle.contrast * gain, motion_px);
}

}  // namespace ellipse
