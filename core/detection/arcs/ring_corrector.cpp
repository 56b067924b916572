// SPDX-License-Identifier: MIT
#include "core/detection/arcs/ring_corrector.hpp"

#include <algorithm>
#include <cmath>

#include "core/edges/edge_refinement.hpp"
#include "core/edges/outline_samples.hpp"
#include "core/edges/thin_ring.hpp"

namespace ellipse {
namespace {

bool are_similar(double a, double b) {
  return std::min(a, b) >= kMajority * std::max(a, b);
}

RingEdges ordered(const Ellipse& a, const Ellipse& b) {
  return a.semi_major > b.semi_major ? RingEdges{a, b} : RingEdges{b, a};
}

}  // namespace

// Computes the table of blur now, so that the first frame does not.
RingCorrector::RingCorrector() : min_gap_px_(min_maxima_distance()) {}

void RingCorrector::correct(const Picture& picture,
                            double min_gradient,
                            std::span<const Polarity> polarities,
                            std::span<Detection> detections) {
  maxima_.clear();
  for (const Detection& detection : detections) maxima_.push_back(detection.ellipse);
  for (std::size_t i = 0; i < maxima_.size(); ++i) {
    const Ellipse& maximum = maxima_[i];
    if (polarities[i] == Polarity::kMixed) continue;
    const Polarity other = opposite(polarities[i]);
    measurer_.measure(picture, maximum, polarities[i], kRefinementSamples, min_gradient);
    if (measurer_.edges().size() < kMinEdgesOfEllipse) continue;
    const Estimate sharpness = measurer_.sharpness();
    const double contrast = measurer_.mean_contrast();
    const Ellipse* partner = closest_partner(polarities, i);
    if (partner != nullptr && !is_thin(ordered(maximum, *partner), sharpness.value)) continue;
    const auto next = partner != nullptr ? edge_near(picture, *partner, other, min_gradient)
                                         : edge_beside(picture, maximum, other, min_gradient);
    if (!next) continue;
    if (!are_similar(next->contrast, contrast)) continue;
    const RingEdges edges = without_blur_bias(ordered(maximum, next->ellipse), sharpness).edges;
    detections[i].ellipse =
        maximum.semi_major > next->ellipse.semi_major ? edges.outer : edges.inner;
  }
}

const Ellipse* RingCorrector::closest_partner(std::span<const Polarity> polarities,
                                              std::size_t i) const {
  const Ellipse& edge = maxima_[i];
  const Ellipse* closest = nullptr;
  for (std::size_t k = 0; k < maxima_.size(); ++k) {
    if (polarities[k] != opposite(polarities[i]) || !are_partners(edge, maxima_[k])) continue;
    const double gap = std::abs(maxima_[k].semi_major - edge.semi_major);
    if (closest == nullptr || gap < std::abs(closest->semi_major - edge.semi_major)) {
      closest = &maxima_[k];
    }
  }
  return closest;
}

std::optional<RingCorrector::Edge> RingCorrector::edge_near(const Picture& picture,
                                                            const Ellipse& guess,
                                                            Polarity polarity,
                                                            double min_gradient) {
  const OutlineSupport found =
      measurer_.measure(picture, guess, polarity, kRefinementSamples, min_gradient);
  if (found.turn_support < kMajority) return std::nullopt;
  const auto refined = fitted_to_edges(measurer_, picture.lens, guess);
  if (!refined) return std::nullopt;
  return Edge{refined->ellipse, measurer_.mean_contrast()};
}

// An edge that is too close or too small to be detected by itself.
std::optional<RingCorrector::Edge> RingCorrector::edge_beside(const Picture& picture,
                                                              const Ellipse& edge,
                                                              Polarity polarity,
                                                              double min_gradient) {
  for (const double gap : {-min_gap_px_, min_gap_px_}) {
    Ellipse guess = edge;
    guess.semi_major += gap;
    guess.semi_minor += gap;
    if (!(guess.semi_minor > 1.0)) continue;
    if (const auto found = edge_near(picture, guess, polarity, min_gradient)) return found;
  }
  return std::nullopt;
}

}  // namespace ellipse
