// SPDX-License-Identifier: MIT
#include "core/tracking/pad/outer_edge.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "core/edges/edge_measurement.hpp"
#include "core/edges/edge_refinement.hpp"
#include "core/edges/photometric_refinement.hpp"
#include "core/edges/thin_ring.hpp"

namespace ellipse {
namespace {

Polarity polarity_of(bool is_bright_outside) {
  return is_bright_outside ? Polarity::kDarkInside : Polarity::kBrightInside;
}

// Adds errors common to all samples, which averaging does not reduce: those of a ring's blur
// correction, and of its width, which changes the size only [radii].
RingMatrix widened(const RingMatrix& information, double of_correction, double of_size) {
  RingMatrix covariance = information.inverse();
  covariance.diagonal().array() += of_correction * of_correction;
  covariance(2, 2) += of_size * of_size;
  return covariance.inverse();
}

// Whether the next circle is the other edge of a painted ring.
bool is_ring(const PadModel& model) {
  return model.circles.size() > 1 &&
         model.circles[1].is_bright_outside != model.circles[0].is_bright_outside;
}

// The mean of a value that is measured frame by frame.
Estimate averaged(const Estimate& mean, const Estimate& now, double adaptation) {
  return {std::lerp(mean.value, now.value, adaptation),
          std::hypot((1.0 - adaptation) * mean.sigma, adaptation * now.sigma)};
}

// Fits the gradient maxima near a circle's predicted image.
std::optional<FittedEllipse> fitted_maxima(EdgeMeasurer& measurer,
                                           const ImageView& luma,
                                           const PadView& view,
                                           const PadCircle& circle,
                                           double min_contrast,
                                           const Eigen::Vector2d& motion_px) {
  const auto predicted = project_circle(view.ideal_from_pad, circle.radius);
  if (!predicted) return std::nullopt;
  const OutlineSupport found =
      measurer.measure({luma, view.lens},
                       *predicted,
                       polarity_of(circle.is_bright_outside),
                       kRefinementSamples / 2,  // since this runs in each frame
                       kGradientOfStep * min_contrast,
                       motion_px.cast<float>());
  if (found.support < kMajority) return std::nullopt;
  return fitted_to_edges(measurer, view.lens, *predicted);
}

}  // namespace

void OuterEdge::restart() {
  (void)min_maxima_distance();  // computes its table now instead of in a frame
  sharpness_.reset();
  squared_motions_ = squared_blurs_ = 0.0;
}

std::optional<FittedEllipse> OuterEdge::refine(const ImageView& luma,
                                               const PadView& view,
                                               const PadModel& model,
                                               double gain,
                                               const Eigen::Vector2d& motion_px,
                                               double adaptation) {
  const auto outer = project_circle(view.ideal_from_pad, 1.0);
  if (!outer || refinement_ == Refinement::kNone) return std::nullopt;
  const PadCircle& circle = model.circles.front();
  const double min_contrast = kMinContrastShare * circle.contrast * gain;
  const double ring_px = model.circles.size() > 1
                             ? (1.0 - model.circles[1].radius) * outer->semi_minor
                             : std::numeric_limits<double>::infinity();
  const OuterEdge before = *this;
  std::optional<FittedEllipse> exact;
  if (refinement_ == Refinement::kPhotometric && !view.lens.is_distorted()) {
    exact = refined_photometrically(
        luma, *outer, polarity_of(circle.is_bright_outside), ring_px, min_contrast);
  }
  if (!exact) exact = on_maxima(luma, view, model, min_contrast, motion_px, adaptation);
  if (!exact) return std::nullopt;
  // Motion blurs the edges over at most its length, so that each may be predicted half of it off.
  Tolerance tolerance = kOuterEdgeTolerance;
  tolerance.px += 0.5 * motion_px.norm();
  if (is_same(exact->ellipse, *outer, tolerance)) return exact;
  *this = before;  // forgets the sharpness and the blur of an edge that may be another one
  return std::nullopt;
}

std::optional<FittedEllipse> OuterEdge::on_maxima(const ImageView& luma,
                                                  const PadView& view,
                                                  const PadModel& model,
                                                  double min_contrast,
                                                  const Eigen::Vector2d& motion_px,
                                                  double adaptation) {
  EdgeMeasurer measurer;
  const PadCircle& outer = model.circles.front();
  auto exact = fitted_maxima(measurer, luma, view, outer, min_contrast, motion_px);
  if (exact) {
    squared_motions_ += motion_px.squaredNorm();
    squared_blurs_ += measurer.motion_blur().squared_length;
  }
  if (!exact || !is_ring(model)) return exact;
  const PadCircle& next = model.circles[1];
  const Eigen::Vector2d blur_px = measurer.motion_blur().px.cast<double>();
  const Estimate now = measurer.sharpness();
  const auto inner = fitted_maxima(measurer, luma, view, next, min_contrast, motion_px);
  if (!inner) return exact;
  const RingEdges maxima{exact->ellipse, inner->ellipse};
  const auto known_ratio = next.is_given ? std::optional(next.radius) : std::nullopt;
  UnblurredRing ring;
  if (blur_px.isZero()) {
    sharpness_ = sharpness_ ? averaged(*sharpness_, now, adaptation) : now;
    ring = without_blur_bias(maxima, *sharpness_, known_ratio);
  } else {
    ring.edges = without_motion_blur(maxima, blur_px);
  }
  exact->ellipse = ring.edges.outer;
  const double radius_px = mean_radius_px(exact->ellipse);
  exact->uncertainty = {image_from_pad(exact->ellipse),
                        widened(exact->uncertainty.information,
                                ring.sigma_px / radius_px,
                                0.5 * ring.width.sigma / (1.0 + 0.5 * ring.width.value))};
  return exact;
}

std::optional<FittedEllipse> refined_circle(const ImageView& luma,
                                            const PadView& view,
                                            const PadCircle& circle,
                                            double gain,
                                            const Eigen::Vector2d& motion_px) {
  EdgeMeasurer measurer;
  return fitted_maxima(
      measurer, luma, view, circle, kMinContrastShare * circle.contrast * gain, motion_px);
}

}  // namespace ellipse
