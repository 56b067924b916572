// SPDX-License-Identifier: MIT
#include "core/tracking/pad/model_errors.hpp"

#include <cstddef>

#include "core/geometry/robust.hpp"
#include "core/tracking/pad/homography_solver.hpp"

namespace ellipse {
namespace {

constexpr double kFeatureSigma = 0.0014;  // of an inner circle or line in the model [radii]

// nullptr for the outer circle, whose radius is the unit, and for lines that have been removed.
HomographyChange* sensitivity_of(PadModel& model, int feature) {
  if (feature == 0) return nullptr;
  if (PadLine* line = line_of(model, feature)) return &line->sensitivity;
  const auto circle = static_cast<std::size_t>(feature);
  return circle < model.circles.size() ? &model.circles[circle].sensitivity : nullptr;
}

void multiply_sensitivities(PadModel& model, const HomographyCovariance& factor) {
  const auto multiply = [&](HomographyChange& s) { s = factor.lazyProduct(s).eval(); };
  for (PadCircle& circle : model.circles) multiply(circle.sensitivity);
  for (PadLine& line : model.lines) multiply(line.sensitivity);
}

}  // namespace

void propagate_model_errors(PadModel& model,
                            std::span<const EdgeSample> samples,
                            const ViewCorrection& correction) {
  multiply_sensitivities(model, correction.prior_information);
  for (const EdgeSample& sample : samples) {
    HomographyChange* sensitivity = sensitivity_of(model, sample.feature);
    const double predicted_px = sample.predicted_px(correction.change);
    const EdgeCandidate* edge = nearest_candidate(sample, predicted_px);
    if (sensitivity == nullptr || edge == nullptr) continue;
    const double weight =
        correction.precision * tukey_weight(edge->distance_px - predicted_px, correction.reach_px);
    *sensitivity += weight * sample.view.px_per_unit * sample.view.row;
  }
  multiply_sensitivities(model, correction.covariance);
}

void reduce_model_errors(PadModel& model, const RingGain& gain) {
  HomographyCovariance kept = HomographyCovariance::Identity();
  kept.leftCols<5>() -= gain;
  multiply_sensitivities(model, kept);
}

HomographyCovariance model_error_covariance(const PadModel& model) {
  HomographyCovariance sum = HomographyCovariance::Zero();
  for (const PadCircle& circle : model.circles) {
    sum += circle.sensitivity * circle.sensitivity.transpose();
  }
  for (const PadLine& line : model.lines) sum += line.sensitivity * line.sensitivity.transpose();
  return kFeatureSigma * kFeatureSigma * sum;
}

}  // namespace ellipse
