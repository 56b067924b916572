// SPDX-License-Identifier: MIT
#include "core/tracking/outline_judge.hpp"

#include <optional>

#include "core/camera/lens_view.hpp"
#include "core/detection/evidence.hpp"
#include "core/edges/outline_samples.hpp"
#include "core/image/roi.hpp"

namespace ellipse {
namespace {

constexpr double kLessMatched = 0.1;  // drop of the matched share that triggers an evaluation

// Crops a picture to an ellipse of its frame and the surroundings.
Picture part_around(const Picture& picture, const Ellipse& outline) {
  const Rect whole{static_cast<int>(picture.origin_px.x()),
                   static_cast<int>(picture.origin_px.y()),
                   picture.luma.width,
                   picture.luma.height};
  const Rect around = intersect(
      calculate_roi(
          outline, kRoiExpansion, kCoarsestScale, whole.x + whole.width, whole.y + whole.height),
      whole);
  return picture.part({around.x - whole.x, around.y - whole.y, around.width, around.height});
}

}  // namespace

void OutlineJudge::start(double log_odds, double prior) {
  odds_.start(log_odds, prior);
  since_judged_s_ = 0.0;
  judged_overlap_ = 1.0;
}

void OutlineJudge::add_detection(double log_odds, double prior) {
  add(log_odds);
  odds_.raise(log_odds, prior);
  judged_overlap_ = 1.0;
}

void OutlineJudge::judge(Detector& detector,
                         const Picture& picture,
                         const Target& target,
                         const Thresholds& limits) {
  if (is_due(target)) (void)evaluate(detector, picture, target, limits);
}

std::optional<double> OutlineJudge::evaluate(Detector& detector,
                                             const Picture& picture,
                                             const Target& target,
                                             const Thresholds& limits) {
  if (since_judged_s_ == 0.0) return odds_.last();  // already in this frame
  const auto outline = distorted(picture.lens.part(-picture.origin_px), target.ellipse);
  if (!outline || target.visible_fraction < kMajority) return std::nullopt;
  judged_overlap_ = target.ellipse_overlap;
  const Picture part = part_around(picture, *outline);
  Thresholds thresholds = limits;
  thresholds.contour_overlap = detector.tracking_overlaps().contour;
  thresholds.ellipse_overlap = detector.tracking_overlaps().ellipse;
  const auto judged = detector.log_odds_of(
      part, translated(target.ellipse, -part.origin_px.x(), -part.origin_px.y()), thresholds);
  if (!judged) return std::nullopt;
  add(*judged);
  return odds_.last();
}

bool OutlineJudge::is_due(const Target& target) const {
  const bool is_less_matched = target.ellipse_overlap < judged_overlap_ - kLessMatched;
  return !is_certain() || is_less_matched || since_judged_s_ >= kCheckPeriod_s;
}

bool OutlineJudge::is_certain() const {
  return log_odds() >= kCertainLogOdds;
}

void OutlineJudge::add(double log_odds) {
  odds_.add(log_odds, since_judged_s_);
  since_judged_s_ = 0.0;
}

}  // namespace ellipse
