// SPDX-License-Identifier: MIT
#include "core/outer_edge.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "core/photometric_refinement.hpp"
#include "core/picture_refinement.hpp"
#include "core/ring_edges.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kLeastContrast = 0.3;  // of the expected one
constexpr double kCrestOfStep = 48.0;   // of GradientMap's gradient, per grey level
constexpr double kLeastSupport = 0.5;   // share of the perimeter with a crest
constexpr int kPlaces = 48;             // half of what the detector takes: each frame pays
constexpr double kThinRingPx = 6.0;
constexpr double kRepulsionShare = 0.2;     // of its correction, that may be left of it
constexpr double kReachOfNextEdgePx = 2.0;  // its blur
constexpr double kNearPx = 1.0;
constexpr double kNearRelative = 0.03;

constexpr const char* kNicks[] = {"none", "edges", "photometric"};

Polarity polarity_of(bool is_bright_outside) {
  return is_bright_outside ? Polarity::kDarkInside : Polarity::kBrightInside;
}

// What all places of an edge err by alike [radii], their number does not make less.
RingMatrix widened(const RingMatrix& information, double sigma) {
  RingMatrix covariance = information.inverse();
  covariance.diagonal().array() += sigma * sigma;
  return covariance.inverse();
}

// The crests of both edges of a thin ring are drawn apart.
std::optional<FittedEllipse> on_crests(const ImageView& luma,
                                       const PadView& view,
                                       const PadModel& model,
                                       const Ellipse& outer,
                                       double ring_px,
                                       double least_contrast) {
  const double least = kCrestOfStep * least_contrast;
  const bool is_bright_outside = model.circles.front().is_bright_outside;
  const auto edge =
      refined_on_picture(luma, outer, polarity_of(is_bright_outside), least, kPlaces, view.lens);
  if (!edge || edge->support < kLeastSupport) return std::nullopt;
  const bool is_ring =
      model.circles.size() > 1 && model.circles[1].is_bright_outside != is_bright_outside;
  FittedEllipse exact{edge->ellipse, edge->uncertainty};
  if (!is_ring || ring_px >= kThinRingPx) return exact;
  const auto inner = project_circle(view.ideal_from_pad, model.circles[1].radius);
  if (!inner) return exact;
  const auto next =
      refined_on_picture(luma, *inner, polarity_of(!is_bright_outside), least, kPlaces, view.lens);
  if (!next || next->support < kLeastSupport) return exact;
  exact.ellipse = without_repulsion({edge->ellipse, next->ellipse}).outer;
  const double sigma_px = kRepulsionShare * max_difference_px(exact.ellipse, edge->ellipse);
  const double radius_px = std::sqrt(outer.semi_major * outer.semi_minor);
  exact.uncertainty.information = widened(exact.uncertainty.information, sigma_px / radius_px);
  return exact;
}

}  // namespace

std::span<const char* const> refinement_nicks() {
  return kNicks;
}

std::optional<FittedEllipse> refined_outer_edge(const ImageView& luma,
                                                const PadView& view,
                                                const PadModel& model,
                                                double gain,
                                                Refinement refinement) {
  const auto outer = project_circle(view.ideal_from_pad, 1.0);
  if (!outer || refinement == Refinement::kNone) return std::nullopt;
  const PadCircle& circle = model.circles.front();
  const double least_contrast = kLeastContrast * circle.contrast * gain;
  const double ring_px = model.circles.size() > 1
                             ? (1.0 - model.circles[1].radius) * outer->semi_minor
                             : std::numeric_limits<double>::infinity();
  std::optional<FittedEllipse> exact;
  if (refinement == Refinement::kPhotometric && !view.lens.is_bent()) {
    exact = refined_photometrically(luma,
                                    *outer,
                                    polarity_of(circle.is_bright_outside),
                                    ring_px - kReachOfNextEdgePx,
                                    least_contrast);
  }
  if (!exact) exact = on_crests(luma, view, model, *outer, ring_px, least_contrast);
  if (!exact) return std::nullopt;
  const bool is_near =
      max_difference_px(exact->ellipse, *outer) <= kNearPx + kNearRelative * outer->semi_major;
  return is_near ? exact : std::nullopt;
}

}  // namespace ellipse
