// SPDX-License-Identifier: MIT
#include "core/detection/arcs/ring_corrector.hpp"

#include <cmath>

#include "core/edges/outline_samples.hpp"
#include "core/edges/thin_ring.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kContrastTolerance = 0.4;  // largest log ratio of the edges' gradients

}  // namespace

// Keeps the table of blur out of the first frame.
RingCorrector::RingCorrector() : min_gap_px_(min_maxima_distance()) {}

void RingCorrector::correct(const Picture& picture,
                            double min_gradient,
                            std::span<const Polarity> polarities,
                            std::span<Detection> detections) {
  maxima_.clear();
  for (const Detection& detection : detections) maxima_.push_back(detection.ellipse);
  for (std::size_t i = 0; i < maxima_.size(); ++i) {
    const Ellipse& maximum = maxima_[i];
    const auto edge = refined_on_picture(picture, maximum, polarities[i], min_gradient);
    const auto next = edge ? next_edge(picture, min_gradient, polarities, i) : std::nullopt;
    if (!next || next->support < kMajority) continue;
    if (std::abs(std::log(next->gradient / edge->gradient)) > kContrastTolerance) continue;
    const bool is_outer = maximum.semi_major > next->ellipse.semi_major;
    detections[i].ellipse = is_outer ? without_blur_bias({maximum, next->ellipse}).outer
                                     : without_blur_bias({next->ellipse, maximum}).inner;
  }
}

// The closest partner among the detections; otherwise an edge on the picture that is too close or
// too small to be detected by itself.
std::optional<RefinedEllipse> RingCorrector::next_edge(const Picture& picture,
                                                       double min_gradient,
                                                       std::span<const Polarity> polarities,
                                                       std::size_t i) const {
  const Ellipse& edge = maxima_[i];
  const Polarity other = opposite(polarities[i]);
  const auto look_at = [&](const Ellipse& guess) {
    return refined_on_picture(picture, guess, other, min_gradient);
  };
  const Ellipse* closest = nullptr;
  for (std::size_t k = 0; k < maxima_.size(); ++k) {
    if (polarities[k] != other || !are_partners(edge, maxima_[k])) continue;
    const double gap = std::abs(maxima_[k].semi_major - edge.semi_major);
    if (closest == nullptr || gap < std::abs(closest->semi_major - edge.semi_major)) {
      closest = &maxima_[k];
    }
  }
  if (closest != nullptr) return look_at(*closest);
  for (const double gap : {-min_gap_px_, min_gap_px_}) {
    Ellipse guess = edge;
    guess.semi_major += gap;
    guess.semi_minor += gap;
    if (!(guess.semi_minor > 1.0)) continue;
    auto found = look_at(guess);
    if (found && found->support >= kMajority) return found;
  }
  return std::nullopt;
}

}  // namespace ellipse
