// SPDX-License-Identifier: MIT
#include "core/detection/arcs/arc_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detection/detection_trace.hpp"
#include "core/detection/target_selection.hpp"
#include "core/edges/edge_refinement.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/image/roi.hpp"
#include "core/image/scale.hpp"

namespace ellipse {
namespace {

constexpr std::size_t kMaxMeasured = 20;  // pairs measured per pass
constexpr double kMaxRegionShare = 0.25;  // of the picture, searched around coarser ellipses
constexpr double kMinReducedPx = 10.0;    // semi-minor axis below which reduction hides corners
constexpr double kSameInside = 0.8;  // IoU inside the picture of an ellipse before and after a fit

constexpr Thresholds kNoLimits{.contour_overlap = 0.0,
                               .ellipse_overlap = 0.0,
                               .min_axis_px = kAxisRangePx.min,
                               .max_axis_px = kAxisRangePx.max,
                               .max_axis_ratio = kAxisRatioRange.max,
                               .min_contour_size = 0,
                               .min_probability = 0.0};

// The part of a cut ellipse outside the picture differs between scales.
bool is_same_inside(const Ellipse& a, const Ellipse& b, const GradientMap& map) {
  return iou_inside(a, b, map.width(), map.height()) >= kSameInside;
}

// Whether the probability is at least one half. Less likely outlines are also measured with mixed
// polarity.
bool is_likely(const MeasuredEllipse& measured) {
  return log_odds(measured.probability) >= 0.0;
}

// Whether a picture reduced by a scale would show corners of the outline.
bool is_large_enough(const Ellipse& e, int scale) {
  return scale == 1 || e.semi_minor >= scale * kMinReducedPx;
}

// Minimum probability in a reduced picture: excludes only ellipses that are ruled out, since the
// finer scales judge the others.
double required_when_reduced(const Thresholds& thresholds) {
  const double required = thresholds.min_probability;
  return thresholds.accepts_any() ? std::min(required, probability_of(-kCertainLogOdds)) : required;
}

}  // namespace

std::span<const Detection> ArcDetector::detect(const Picture& picture,
                                               const Thresholds& thresholds) {
  if (trace_ != nullptr) trace_->clear();
  found_.begin(trace_);
  pyramid_.reduce(picture);
  search_scales(thresholds);
  found_.drop_rejected([&](const FoundEllipse& found) {
    return at_least(Reason::kUnlikely, found.measured.probability, thresholds.min_probability);
  });
  found_.merge_duplicates();
  refine_at_finer_scales(thresholds);
  report(thresholds.min_probability);
  ring_corrector_.correct(picture, min_gradient_, polarities_, detections_);
  if (trace_ != nullptr) trace_->report(detections_);
  return detections_;
}

// Evaluates the outline from the coarsest scale at which it is large enough to finer ones, until it
// is certain. -infinity if it is accepted at no scale.
std::optional<double> ArcDetector::log_odds_of(const Picture& picture,
                                               const Ellipse& e,
                                               const Thresholds& thresholds) {
  Thresholds limits = kNoLimits;
  limits.edge_low = thresholds.edge_low;
  limits.edge_high = thresholds.edge_high;
  limits.contour_overlap = thresholds.contour_overlap;
  limits.ellipse_overlap = thresholds.ellipse_overlap;
  pyramid_.reduce(picture);
  std::optional<FoundEllipse> best;
  for (int scale = pyramid_.coarsest_scale(); scale >= 1; scale /= 2) {
    if (!is_large_enough(e, scale)) continue;
    find_edges(scale, limits);
    const auto measured = judged_at(scale, e, limits);
    if (!measured) continue;
    if (is_certain(measured->probability)) return log_odds(measured->probability);
    if (!best || measured->probability > best->measured.probability) best = {*measured, scale};
  }
  return best ? confirmed_log_odds(*best, limits) : -std::numeric_limits<double>::infinity();
}

void ArcDetector::find_edges(int scale, const Thresholds& thresholds) {
  GradientMap& map = pyramid_.map_at(scale);
  map.compute(pyramid_.picture_at(scale), {thresholds.edge_low, thresholds.edge_high});
  chains_.trace(map);
}

// The outline, if the edges of this scale keep it in place [px of the picture]. Uses its better
// polarity, or both if they make an unlikely outline more probable.
std::optional<MeasuredEllipse> ArcDetector::judged_at(int scale,
                                                      const Ellipse& e,
                                                      const Thresholds& thresholds) {
  const GradientMap& map = pyramid_.map_at(scale);
  const Ellipse guess = to_region(e, {}, scale);
  std::optional<MeasuredEllipse> best;
  for (const Polarity polarity : {verifier_.better_polarity(map, guess), Polarity::kMixed}) {
    if (best && is_likely(*best)) break;
    MeasuredEllipse measured;
    const Verdict verdict = verifier_.verify(map, guess, polarity, thresholds, evidence_, measured);
    if (!verdict.is_accepted() || !is_same_inside(measured.ellipse, guess, map)) continue;
    measured.ellipse = to_frame(measured.ellipse, {}, scale);
    if (!best || measured.probability > best->probability) best = measured;
  }
  return best;
}

void ArcDetector::search_scales(const Thresholds& thresholds) {
  const auto finds_certain_target = [&](int scale, const Rect& region) {
    search(scale, region, thresholds);
    return !thresholds.wants_all && has_certain_target(scale, thresholds);
  };
  for (int scale = pyramid_.coarsest_scale(); scale >= 1; scale /= 2) {
    const Rect region = thresholds.wants_all ? Rect{} : region_of_found(scale);
    if (!region.empty() && finds_certain_target(scale, region)) return;
    if (finds_certain_target(scale, pyramid_.picture_at(1).luma.bounds())) return;
  }
  confirm_at_finer_scales(thresholds);
}

// The box around all ellipses of the coarser scales and their surroundings. Empty without any, or
// if it saves too little.
Rect ArcDetector::region_of_found(int scale) const {
  const Picture& picture = pyramid_.picture_at(1);
  const auto& [data, width, height, stride] = picture.luma;
  Rect box;
  for (const FoundEllipse& found : found_.all()) {
    const auto outline = distorted(picture.lens, found.measured.ellipse);
    if (!outline) return {};
    box = united(box, calculate_roi(*outline, kRoiExpansion, scale, width, height));
  }
  const double share = 1.0 * box.width * box.height / (1.0 * width * height);
  return share <= kMaxRegionShare ? box : Rect{};
}

// @param region  Begins at multiples of the scale [px of the picture].
void ArcDetector::search(int scale, const Rect& region, const Thresholds& full) {
  const auto reduced = [scale](int px) { return (px + scale - 1) / scale; };
  const Picture picture = pyramid_.picture_at(scale).part(
      {region.x / scale, region.y / scale, reduced(region.width), reduced(region.height)});
  scale_ = scale;
  region_ = region;
  rejected_.clear();
  if (picture.luma.empty()) return;
  Thresholds thresholds = full.at_scale(scale);
  if (scale > 1) thresholds.min_probability = required_when_reduced(full);
  map_ = &pyramid_.map_at(scale);
  map_->compute(picture, {thresholds.edge_low, thresholds.edge_high});
  min_gradient_ = kGradientGain * map_->thresholds().low / scale;
  if (trace_ != nullptr) trace_edges();
  chains_.trace(*map_);
  arcs_ = splitter_.split(*map_, chains_, thresholds.wants_all);
  if (trace_ != nullptr) trace_arcs();
  is_used_.assign(arcs_.size(), 0);
  try_single_arcs(thresholds);
  try_pairs(thresholds);
}

// Bounds the cost in a picture full of ellipses, each of which is measured and refined.
void ArcDetector::try_single_arcs(const Thresholds& thresholds) {
  const std::size_t found_before = found_.size();
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    if (!thresholds.wants_all && found_.size() >= found_before + kMaxPerPass) return;
    if (is_used_[i] == 0) try_arcs({&arcs_[i]}, thresholds);
  }
}

// Measures the pairs whose directions agree best with their ellipse. Arcs of one ellipse may differ
// in polarity.
void ArcDetector::try_pairs(const Thresholds& thresholds) {
  std::size_t measured = 0;
  for (const ArcPair& pair : pairs_.find(arcs_, is_used_)) {
    if (is_used_[pair.first] != 0 || is_used_[pair.second] != 0) continue;
    if (++measured > kMaxMeasured) return;
    try_arcs({&arcs_[pair.first], &arcs_[pair.second]}, thresholds);
  }
}

void ArcDetector::try_arcs(std::initializer_list<const Arc*> arcs, const Thresholds& thresholds) {
  Polarity polarity = (*arcs.begin())->polarity;
  for (const Arc* other : arcs) {
    if (other->polarity != polarity) polarity = Polarity::kMixed;
  }
  TracedPiece pieces[2];
  std::transform(arcs.begin(), arcs.end(), pieces, [](const Arc* arc) {
    return TracedPiece{arc->begin, arc->end};
  });
  const std::span<const TracedPiece> made_of(pieces, arcs.size());
  const auto fit = fit_with_residual(moments_of(arcs));
  if (fit) {
    try_guess({fit->ellipse, polarity, fit->rms_px}, made_of, thresholds);
  } else if (trace_ != nullptr) {
    (void)trace_->add(made_of, std::nullopt, {Reason::kNoEllipse});
  }
}

void ArcDetector::try_guess(const Guess& guess,
                            std::span<const TracedPiece> pieces,
                            const Thresholds& thresholds) {
  MeasuredEllipse measured;
  const Verdict verdict = examine(guess, thresholds, measured);
  if (trace_ != nullptr) {
    const Eigen::Vector2i origin = origin_in_pass();
    measured.candidate =
        trace_->add(pieces, translated(guess.ellipse, origin.x(), origin.y()), verdict);
    if (measured.probability > 0.0) {
      trace_->measure(measured.candidate,
                      to_frame(measured.ellipse, region_, scale_),
                      measured.features,
                      evidence_);
    }
  }
  if (verdict.is_accepted() && !is_cut(measured.ellipse)) {
    add(measured);
  } else if (verdict.is_accepted() && trace_ != nullptr) {
    trace_->revise(measured.candidate, {Reason::kCut});
  }
  // Edges of both polarities count only if they make the outline likely.
  const bool is_measured = measured.probability > 0.0 && measured.polarity != Polarity::kMixed;
  if (thresholds.accepts_any() && is_measured && !is_likely(measured)) {
    Thresholds likely = thresholds;
    likely.min_probability = std::max(probability_of(0.0), thresholds.min_probability);
    try_guess({measured.ellipse, Polarity::kMixed, guess.rms_px}, pieces, likely);
  }
}

// Whether the searched region cuts an ellipse that reaches farther into the picture: the whole
// picture decides about it.
bool ArcDetector::is_cut(const Ellipse& in_pass) const {
  const Picture& picture = pyramid_.picture_at(1);
  const auto outline = distorted(picture.lens, to_frame(in_pass, region_, scale_));
  if (!outline) return false;
  const auto& [data, width, height, stride] = picture.luma;
  const Rect box = calculate_roi(*outline, 1.0, 1, width, height);
  return intersect(box, region_) != box;
}

Verdict ArcDetector::examine(const Guess& guess,
                             const Thresholds& thresholds,
                             MeasuredEllipse& measured) {
  const auto& [ellipse, polarity, rms_px] = guess;
  const double limit_px = EllipseVerifier::deformation_px(ellipse);
  Verdict verdict = at_most(Reason::kPoorFit, rms_px, limit_px);
  if (verdict.is_accepted()) verdict = EllipseVerifier::judge_shape(ellipse, *map_, thresholds);
  if (verdict.is_accepted()) verdict = check_duplicate(guess);
  if (!verdict.is_accepted()) return verdict;
  verdict = verifier_.verify(*map_, ellipse, polarity, thresholds, evidence_, measured);
  if (!verdict.is_accepted()) rejected_.push_back(guess);
  return verdict;
}

Verdict ArcDetector::check_duplicate(const Guess& guess) const {
  if (found_.has_certain(to_frame(guess.ellipse, region_, scale_), guess.polarity, scale_)) {
    return {Reason::kKnown};
  }
  for (const Guess& known : rejected_) {
    if (known.polarity == guess.polarity && are_one_ellipse(known.ellipse, guess.ellipse, 1.0)) {
      return {Reason::kDuplicateOfRejected};
    }
  }
  return {};
}

// Only a certain ellipse uses its arcs up: those of an uncertain one may belong to another ellipse.
void ArcDetector::add(const MeasuredEllipse& measured) {
  if (is_certain(measured.probability)) use_arcs_on(measured.ellipse, measured.polarity);
  FoundEllipse found{measured, scale_};
  found.measured.ellipse = to_frame(measured.ellipse, region_, scale_);
  found_.add(found);
}

void ArcDetector::use_arcs_on(const Ellipse& e, Polarity polarity) {
  const double tolerance_px = EllipseVerifier::deformation_px(e);
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    if (is_used_[i] != 0 || !may_agree(arcs_[i].polarity, polarity)) continue;
    const auto& points = arcs_[i].points;
    is_used_[i] = std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& point) {
      return std::abs(sampson_distance(e, point)) <= tolerance_px;
    });
  }
}

// Whether the best target is certain enough to skip the remaining scales. Reduction to fewer pixels
// hides corners and, near the border, a larger edge around it.
bool ArcDetector::has_certain_target(int scale, const Thresholds& thresholds) {
  report(thresholds.min_probability);
  const auto target = select_target(detections_);
  return target && is_certain(target->probability) && is_large_enough(target->ellipse, scale);
}

// Averages the log odds at the ellipse's scale with those at the finer scales, each weighted with
// the square root of its resolution: reduction hides the corners of a polygon, which show again at
// the finer scales. Skips a scale whose noise may hide the outline, since blur reduces the gradient
// by up to the ratio of the scales. The threshold of a finer scale is at least that of the coarser
// one: compression removes fine noise, but not the errors that it causes.
double ArcDetector::confirmed_log_odds(const FoundEllipse& found, const Thresholds& thresholds) {
  const MeasuredEllipse& measured = found.measured;
  double high = pyramid_.map_at(found.scale).thresholds().high;
  double sum = log_odds(measured.probability);
  double weights = 1.0;
  for (int scale = found.scale / 2; scale >= 1; scale /= 2) {
    const GradientMap& map = pyramid_.map_at(scale);
    high = std::max(high, map.thresholds().high);
    if (measured.gradient * scale / found.scale < kGradientGain * high) continue;
    const Ellipse guess = to_region(measured.ellipse, {}, scale);
    MeasuredEllipse finer;
    const Verdict verdict = verifier_.verify(
        map, guess, measured.polarity, thresholds.at_scale(scale), evidence_, finer);
    const bool holds = verdict.is_accepted() && is_same_inside(finer.ellipse, guess, map);
    const double weight = std::sqrt(static_cast<double>(found.scale) / scale);
    sum += weight * (holds ? log_odds(finer.probability) : -kCertainLogOdds);
    weights += weight;
  }
  return sum / weights;
}

void ArcDetector::confirm_at_finer_scales(const Thresholds& full) {
  Thresholds thresholds = full;
  thresholds.contour_overlap = thresholds.ellipse_overlap = 0.0;
  thresholds.min_contour_size = 0;
  thresholds.min_probability = probability_of(-kCertainLogOdds);
  for (FoundEllipse& found : found_.all()) {
    found.measured.probability = probability_of(confirmed_log_odds(found, thresholds));
  }
}

// Drops ellipses whose refined axes are beyond the limits.
void ArcDetector::refine_at_finer_scales(const Thresholds& thresholds) {
  found_.drop_rejected([&](FoundEllipse& found) {
    if (found.scale == 1) return Verdict{};
    for (int scale = found.scale / 2; scale >= 1; scale /= 2) refine(scale, found.measured);
    return thresholds.judge_axes_of(found.measured.ellipse);
  });
}

void ArcDetector::refine(int scale, MeasuredEllipse& measured) const {
  const auto refined = refined_on_picture(pyramid_.picture_at(scale),
                                          to_region(measured.ellipse, {}, scale),
                                          measured.polarity,
                                          scale * min_gradient_);
  if (refined) measured.ellipse = to_frame(refined->ellipse, {}, scale);
}

void ArcDetector::report(double min_probability) {
  detections_.clear();
  polarities_.clear();
  for (const FoundEllipse& found : found_.all()) {
    const MeasuredEllipse& one = found.measured;
    if (one.probability < min_probability) continue;
    detections_.push_back({one.ellipse,
                           one.on_ellipse,
                           one.support,
                           log_odds(one.probability),
                           one.probability,
                           one.candidate,
                           one.as_target});
    polarities_.push_back(one.polarity);
  }
}

// Has the size of the whole picture, but edges in the searched region only.
void ArcDetector::trace_edges() {
  const ImageView& luma = pyramid_.picture_at(scale_).luma;
  TracedPass& pass = trace_->begin_pass(luma, scale_);
  pass.edge_low = map_->thresholds().low;
  pass.edge_high = map_->thresholds().high;
  pass.edges.resize(pass.luma.size());
  const Eigen::Vector2i origin = origin_in_pass();
  for (int y = 0; y < map_->height(); ++y) {
    const std::uint8_t* row = map_->maxima() + std::ptrdiff_t(y) * map_->stride();
    std::uint8_t* edges =
        pass.edges.data() + std::ptrdiff_t(origin.y() + y) * pass.width + origin.x();
    for (int x = 0; x < map_->width(); ++x) edges[x] = row[x] != 0 ? 255 : 0;
  }
}

void ArcDetector::trace_arcs() {
  TracedPass& pass = trace_->pass();
  const Eigen::Vector2i origin = origin_in_pass();
  for (const std::int32_t pixel : chains_.pixels()) {
    const Eigen::Vector2i point = origin + map_->pixel_at(pixel);
    pass.points.push_back({point.x(), point.y()});
  }
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    const std::size_t begin = pass.chains.empty() ? 0 : pass.chains.back().end;
    pass.chains.push_back({begin, begin + chains_.chain(i).size()});
  }
  for (const Arc& arc : arcs_) pass.arcs.push_back({arc.begin, arc.end});
}

}  // namespace ellipse
