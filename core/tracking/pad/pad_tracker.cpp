// SPDX-License-Identifier: MIT
#include "core/tracking/pad/pad_tracker.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/camera/circle_pose.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/tracking/pad/coarse_search.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kTurnNoise = 0.002;    // sigma of the camera's rotation per frame [rad]
constexpr double kShiftNoise = 0.0015;  // sigma of its translation [radii]
constexpr double kFirstTurn = 0.03;     // initial sigmas of the velocity, as above
constexpr double kFirstShift = 0.05;
constexpr double kTypicalInnovation = 0.35;   // squared innovation over its predicted variance
constexpr double kInnovationRate = 0.25;      // smoothing exponent
constexpr double kMinRatio = 0.5;             // of one frame, to the typical innovation
constexpr double kMinInnovationRatio = 0.25;  // bounds of the smoothed one
constexpr double kMaxInnovationRatio = 64.0;
constexpr double kEdgeSigmaPx = 0.6;           // of one edge candidate
constexpr int kFineSamples = 72;               // near the prediction
constexpr int kWideSamples = 128;              // in the wide search
constexpr double kReachPx = 4.0;               // search range near the prediction
constexpr double kWideReach = 0.14;            // wide search range [radii]
constexpr double kSmallChangePx = 1.0;         // max RMS change at which normals are not recomputed
constexpr double kTolerancePx = 1.2;           // distance of a matched edge
constexpr double kToleranceRelative = 0.012;   // of the radius: deformed pads
constexpr double kMinCoverage = 0.65;          // matched share of all samples
constexpr double kWeakestCircle = 0.5;         // min matched share of each circle
constexpr int kMinMatched = 10;                // samples
constexpr double kLongestMiss = 12.0;          // [1/30 s]
constexpr int kHypotheses = 40;                // of the wide search
constexpr int kLockSteps = 3;                  // searches before a lock
constexpr double kSlowing = 0.8;               // velocity decay per 1/30 s without a match
constexpr double kGainShare = 0.3;             // smoothing factor of the contrast, per 1/30 s
constexpr double kMinGain = 0.3;               // of one frame; its inverse is the maximum
constexpr double kLearningShare = 0.2;         // the same of the radii
constexpr double kMinVisibleToLearn = 0.5;     // share of the outer circle
constexpr double kMinRadiusToLearnPx = 24.0;   // to learn lines
constexpr double kGrowthToLearn = 1.4;         // since the lines were learned
constexpr double kTurnOfLearnedLines = 0.003;  // sigma of their rotation [rad]
constexpr int kTrialsOfLine = 6;               // frames before a line is judged
constexpr double kMinMatchedOfLine = 0.5;      // share of these frames
constexpr double kEnoughVisible = 0.15;    // share of the outer circle that determines the centre
constexpr double kMaxCentreSigma = 0.025;  // [radii], if less is visible
constexpr double kSureCoverage = 0.75;     // min, if less is visible or to learn lines
constexpr double kSharedVariance = 1.3;    // of the refined edge: errors of samples are correlated
constexpr double kMinVisibleToRefine = 0.3;  // share of the outer circle

Eigen::Matrix3d shifted(const Eigen::Matrix3d& view, const Eigen::Vector2d& by_px) {
  Eigen::Matrix3d result = view;
  result.topRows<2>() += by_px * view.row(2);
  return result;
}

PadView view_in(const LumaWindow& window, const Eigen::Matrix3d& view) {
  return {shifted(view, -window.origin_px), window.lens.part(window.origin_px)};
}

// RMS displacement of the edges by a change.
double rms_px(std::span<const EdgeSample> samples, const HomographyChange& change) {
  double sum = 0.0;
  for (const EdgeSample& sample : samples) sum += std::pow(sample.predicted_px(change), 2);
  return samples.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(samples.size()));
}

// Smoothing factor over this time, from the factor per 1/30 s.
double share_in(double share_of_one, double frames) {
  return 1.0 - std::pow(1.0 - share_of_one, frames);
}

double tolerance_px(double radius_px) {
  return kTolerancePx + kToleranceRelative * radius_px;
}

}  // namespace

double PadTracker::radius_px() const {
  return PadView(view_, lens_).radius_px();
}

// The outer edge leaves the tilt ambiguous, and a wrong tilt blurs the inner circles in the radial
// profile. With a camera, compares the affine view and both poses of the circle, and keeps the view
// with the highest total contrast.
bool PadTracker::learn_pad(const LumaWindow& window, const Ellipse& outer_edge) {
  std::array<Eigen::Matrix3d, 3> views;
  std::size_t count = 0;
  views[count++] = image_from_pad(outer_edge);
  const auto poses = window.camera ? circle_poses(camera_, outer_edge) : std::nullopt;
  if (poses) {
    for (const CirclePose& pose : *poses) {
      const Eigen::Matrix3d view = image_from_pad(camera_, pose);
      views[count++] = view / view(2, 2);
    }
  }
  double max_contrast = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    auto model = learn_circles(window.luma, view_in(window, views[i]), ring_ratio_);
    if (!model) continue;
    double contrast = 0.0;
    for (const PadCircle& circle : model->circles) contrast += circle.contrast;
    if (contrast <= max_contrast) continue;
    max_contrast = contrast;
    model_ = std::move(*model);
    view_ = views[i];
  }
  return max_contrast > 0.0;
}

bool PadTracker::lock(const LumaWindow& window, const Ellipse& outer_edge) {
  is_locked_ = false;
  refined_.reset();
  inner_count_ = 0;
  camera_ = window.camera.value_or(default_camera(window.frame_px));
  lens_ = window.lens;
  if (!learn_pad(window, outer_edge)) return false;
  line_learner_.reserve(model_);
  line_learner_.start();
  gain_ = 1.0;
  innovation_ratio_ = 1.0;
  missed_ = 0.0;
  learned_radius_px_ = 0.0;
  motion_ = {};
  motion_.pose.diagonal() << 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-6, 1e-4, 1e-4;
  std::optional<Attempt> attempt;
  for (int step = 0; step < kLockSteps; ++step) {
    attempt = search_near(window, view_, motion_.pose);
    if (!attempt) return false;
    view_ = attempt->view;
    learn_radii(attempt->last, 1.0);
  }
  if (attempt->support.coverage < kMinCoverage) return false;
  motion_.pose = inverse_of(attempt->estimate.information);
  motion_.velocity_variance = camera_noise(view_, camera_, kFirstTurn, kFirstShift);
  is_locked_ = true;
  if (window.camera) {
    refine(window, attempt->visible);
    measure_inner_edges(window);
  }
  return true;
}

HomographyFilter PadTracker::predicted(double frames, double looseness) const {
  return motion_.after(
      frames,
      innovation_ratio_ * looseness * camera_noise(view_, camera_, kTurnNoise, kShiftNoise));
}

// Refines an approximate change: places and searches all samples again around it.
std::optional<PadTracker::Attempt> PadTracker::finish(const LumaWindow& window,
                                                      const Eigen::Matrix3d& start,
                                                      const HomographyPrior& prior,
                                                      const HomographyChange& change,
                                                      double reach_px) {
  const Eigen::Matrix3d view = moved(start, change);
  search_.sample(model_, view_in(window, view), window.luma, kFineSamples);
  if (search_.samples().size() < kMinMatched) return std::nullopt;
  search_.search(window.luma, gain_, reach_px);
  const HomographyPrior here{prior.mean - change, prior.information};
  const auto estimate = solve_homography(
      search_.samples(), here, HomographyChange::Zero(), reach_px, kEdgeSigmaPx, 3);
  if (!estimate) return std::nullopt;
  return attempt_of(view, {change + estimate->change, estimate->information}, estimate->change);
}

PadTracker::Attempt PadTracker::attempt_of(const Eigen::Matrix3d& view,
                                           const HomographyEstimate& estimate,
                                           const HomographyChange& last) const {
  const double radius = radius_px();
  return {
      moved(view, last),
      estimate,
      last,
      support_of(
          search_.samples(), last, tolerance_px(radius), static_cast<int>(model_.circles.size())),
      search_.visible_fraction()};
}

// Near a good prediction one search suffices.
std::optional<PadTracker::Attempt> PadTracker::search_near(const LumaWindow& window,
                                                           const Eigen::Matrix3d& start,
                                                           const HomographyCovariance& covariance) {
  const HomographyPrior prior{HomographyChange::Zero(), inverse_of(covariance)};
  search_.sample(model_, view_in(window, start), window.luma, kFineSamples);
  if (search_.samples().size() < kMinMatched) return std::nullopt;
  search_.search(window.luma, gain_, kReachPx, &covariance, 3.0 * kReachPx);
  auto estimate = solve_homography(
      search_.samples(), prior, HomographyChange::Zero(), 3.0 * kReachPx, kEdgeSigmaPx, 2);
  if (!estimate) return std::nullopt;
  estimate =
      solve_homography(search_.samples(), prior, estimate->change, kReachPx, kEdgeSigmaPx, 2);
  if (!estimate) return std::nullopt;
  std::optional<Attempt> attempt;
  if (rms_px(search_.samples(), estimate->change) <= kSmallChangePx) {
    attempt = attempt_of(start, *estimate, estimate->change);
  } else {
    attempt = finish(window, start, prior, estimate->change, kReachPx);
  }
  if (attempt) last_coverage_ = attempt->support.coverage;
  const bool is_good = attempt && attempt->support.coverage >= kMinCoverage &&
                       attempt->support.weakest >= kWeakestCircle &&
                       attempt->support.matched >= kMinMatched;
  return is_good ? attempt : std::nullopt;
}

// The search range contains clutter: tests several hypotheses, each from four edges and the motion
// prior, and refines the best.
std::optional<PadTracker::Attempt> PadTracker::search_wide(const LumaWindow& window,
                                                           const Eigen::Matrix3d& start,
                                                           const HomographyCovariance& covariance) {
  const double reach_px = std::max(2.0 * kReachPx, kWideReach * radius_px());
  const HomographyPrior prior{HomographyChange::Zero(), inverse_of(covariance)};
  search_.sample(model_, view_in(window, start), window.luma, kWideSamples);
  const auto samples = search_.samples();
  if (samples.size() < kMinMatched) return std::nullopt;
  search_.search(window.luma, gain_, reach_px);
  const double fit_px = 0.5 * reach_px;
  const HomographyChange best = best_hypothesis(samples, prior, reach_px, fit_px);
  auto estimate = solve_homography(samples, prior, best, reach_px, kEdgeSigmaPx, 2);
  if (estimate)
    estimate = solve_homography(samples, prior, estimate->change, fit_px, kEdgeSigmaPx, 2);
  if (!estimate) return std::nullopt;
  auto attempt = finish(window, start, prior, estimate->change, 0.5 * fit_px);
  if (attempt) attempt = finish(window, start, prior, attempt->estimate.change, kReachPx);
  const bool is_good = attempt && attempt->support.coverage >= kMinCoverage &&
                       attempt->support.weakest >= kWeakestCircle &&
                       attempt->support.matched >= kMinMatched;
  return is_good ? attempt : std::nullopt;
}

// One hypothesis from all samples, the others from four samples with a random candidate each.
HomographyChange PadTracker::best_hypothesis(std::span<const EdgeSample> samples,
                                             const HomographyPrior& prior,
                                             double reach_px,
                                             double fit_px) {
  HomographyChange best = HomographyChange::Zero();
  double best_score = explained(samples, best, fit_px);
  const auto consider = [&](const std::optional<HomographyEstimate>& estimate) {
    if (!estimate) return;
    const double score = explained(samples, estimate->change, fit_px);
    if (score <= best_score) return;
    best_score = score;
    best = estimate->change;
  };
  consider(solve_homography(samples, prior, HomographyChange::Zero(), reach_px, kEdgeSigmaPx, 3));
  std::uint32_t state = 12345;  // the same hypotheses for the same frame
  const auto random = [&](std::size_t n) {
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return static_cast<std::size_t>(state >> 8) % n;
  };
  std::array<EdgeSample, 4> few;
  const std::size_t n = samples.size();
  for (int i = 0; i < kHypotheses; ++i) {
    const std::size_t first = random(n);
    for (std::size_t k = 0; k < few.size(); ++k) {
      few[k] = samples[(first + k * n / few.size() + random(n / few.size() + 1)) % n];
      if (few[k].count == 0) continue;
      few[k].candidates[0] = few[k].candidates[random(static_cast<std::size_t>(few[k].count))];
      few[k].count = 1;
    }
    consider(solve_homography(few, prior, best, 3.0 * reach_px, 2.0 * kEdgeSigmaPx, 1));
  }
  return best;
}

std::optional<EdgeTrack> PadTracker::track(const LumaWindow& window, double frames) {
  if (!is_locked_) return std::nullopt;
  camera_ = window.camera.value_or(default_camera(window.frame_px));
  lens_ = window.lens;
  refined_.reset();
  inner_count_ = 0;
  const Eigen::Matrix3d prediction = moved(view_, frames * motion_.velocity);
  last_coverage_ = 0.0;
  HomographyFilter before = predicted(frames, 1.0 + 0.5 * missed_);
  auto attempt = search_near(window, prediction, before.pose);
  if (!attempt) {
    before = predicted(frames, 400.0);
    attempt = search_wide(window, prediction, before.pose);
  }
  if (!attempt) attempt = search_coarse(window, prediction, before);
  if (!attempt) {
    coast(prediction, before, frames);
    return is_locked_ ? make_track(nullptr) : std::nullopt;
  }
  const Eigen::Matrix3d last_view = view_;
  accept(*attempt, before, frames);
  refine(window, attempt->visible);
  if (window.camera) measure_inner_edges(window);
  motion_.velocity = carried(motion_.velocity, last_view, view_, camera_, kTurnNoise, kShiftNoise);
  learn_lines(window, *attempt);
  return make_track(&*attempt);
}

// Searches a coarse image of the surroundings. Inflates the covariances of `before` on success.
std::optional<PadTracker::Attempt> PadTracker::search_coarse(const LumaWindow& window,
                                                             const Eigen::Matrix3d& prediction,
                                                             HomographyFilter& before) {
  const auto coarse = coarse_search(window.luma, model_, view_in(window, prediction));
  if (!coarse) return std::nullopt;
  HomographyCovariance loose = HomographyCovariance::Zero();
  loose.diagonal() << 0.02, 0.02, 0.01, 2.5e-3, 2.5e-3, 1e-4, 1e-4, 1e-4;
  auto attempt = search_wide(window, shifted(*coarse, window.origin_px), loose);
  if (!attempt) return std::nullopt;
  // Total change from the prediction.
  const Eigen::Matrix3d between = prediction.inverse() * attempt->view;
  attempt->estimate.change = change_of(between / std::cbrt(between.determinant()));
  before.pose += loose;
  before.homography_velocity += loose;
  before.velocity_variance += loose;
  return attempt;
}

void PadTracker::accept(const Attempt& attempt, const HomographyFilter& before, double frames) {
  motion_ = before.corrected(attempt.estimate);
  if (model_.lines.empty()) motion_.leave_rotation_free();  // rings have no orientation
  // Squared displacement of the edges over its predicted variance.
  double moved_px = 0.0;
  double expected_px = 0.0;
  for (const EdgeSample& sample : search_.samples()) {
    moved_px += std::pow(sample.predicted_px(attempt.estimate.change), 2);
    expected_px += sample.view.row.dot(before.pose * sample.view.row);
  }
  if (expected_px > 0.0) {
    const double ratio =
        std::clamp(moved_px / (kTypicalInnovation * expected_px), kMinRatio, kMaxInnovationRatio);
    innovation_ratio_ = std::clamp(innovation_ratio_ * std::pow(ratio, kInnovationRate),
                                   kMinInnovationRatio,
                                   kMaxInnovationRatio);
  }
  const double gain = std::clamp(attempt.support.gain, kMinGain, 1.0 / kMinGain);
  gain_ += share_in(kGainShare, frames) * (gain - gain_);
  judge_lines(attempt.last);
  if (attempt.visible >= kMinVisibleToLearn)
    learn_radii(attempt.last, share_in(kLearningShare, frames));
  view_ = attempt.view;
  missed_ = 0.0;
}

// Snaps the view to the refined outer edge; constant-velocity prediction lags under acceleration.
void PadTracker::refine(const LumaWindow& window, double visible) {
  if (visible < kMinVisibleToRefine) return;
  const auto exact =
      refined_outer_edge(window.luma, view_in(window, view_), model_, gain_, refinement_);
  if (!exact) return;
  const auto view = with_outer_edge(
      view_, translated(exact->ellipse, window.origin_px.x(), window.origin_px.y()));
  if (!view) return;
  view_ = *view;
  refined_ = {shifted(exact->uncertainty.view, window.origin_px), exact->uncertainty.information};
}

void PadTracker::measure_inner_edges(const LumaWindow& window) {
  if (!refined_) return;
  const PadView view = view_in(window, view_);
  for (std::size_t i = 1; i < model_.circles.size() && inner_count_ < inner_edges_.size(); ++i) {
    const auto edge = refined_circle(window.luma, view, model_.circles[i], gain_);
    if (!edge) continue;
    inner_edges_[inner_count_++] = {
        translated(edge->ellipse, window.origin_px.x(), window.origin_px.y()),
        {shifted(edge->uncertainty.view, window.origin_px), edge->uncertainty.information}};
  }
}

// Updates the inner radii from their matches; the outer radius is the unit.
void PadTracker::learn_radii(const HomographyChange& change, double share) {
  for (std::size_t i = 1; i < model_.circles.size(); ++i) {
    PadCircle& circle = model_.circles[i];
    if (circle.is_given) continue;
    const double sign = circle.is_bright_outside ? 1.0 : -1.0;
    double sum = 0.0;
    double weights = 0.0;
    for (const EdgeSample& sample : search_.samples()) {
      if (sample.feature != static_cast<int>(i)) continue;
      const EdgeCandidate* edge = nearest_candidate(sample, sample.predicted_px(change));
      if (edge == nullptr) continue;
      const double beside_px = edge->distance_px - sample.predicted_px(change);
      const double px = sample.view.px_per_unit;
      const double weight = tukey_weight(beside_px, kReachPx) * px * px;
      sum += weight * sign * beside_px / px;
      weights += weight;
    }
    if (weights > 0.0) circle.radius += share * sum / weights;
  }
}

// Learns the lines again as the pad grows in the image and shows finer ones.
void PadTracker::learn_lines(const LumaWindow& window, const Attempt& attempt) {
  const double radius = radius_px();
  const bool is_time =
      radius >= kMinRadiusToLearnPx && radius >= kGrowthToLearn * learned_radius_px_;
  if (!is_time || attempt.visible < kMinVisibleToLearn ||
      attempt.support.coverage < kSureCoverage) {
    return;
  }
  line_learner_.take(window.luma, view_in(window, view_));
  if (!line_learner_.is_ready()) return;
  line_learner_.learn(model_);
  line_learner_.start();
  learned_radius_px_ = radius;
  motion_.pose(5, 5) += kTurnOfLearnedLines * kTurnOfLearnedLines;
}

// Removes lines that are often unmatched, such as edges of shadows or occluders.
void PadTracker::judge_lines(const HomographyChange& change) {
  const auto circles = static_cast<int>(model_.circles.size());
  const auto samples = search_.samples();
  for (std::size_t begin = 0; begin < samples.size();) {
    const int feature = samples[begin].feature;
    std::size_t end = begin;
    int visible = 0;
    int matched = 0;
    for (; end < samples.size() && samples[end].feature == feature; ++end) {
      const double predicted = samples[end].predicted_px(change);
      const EdgeCandidate* edge = nearest_candidate(samples[end], predicted);
      visible += samples[end].is_visible ? 1 : 0;
      matched += edge != nullptr && std::abs(edge->distance_px - predicted) <= kTolerancePx ? 1 : 0;
    }
    begin = end;
    if (feature < circles || visible < 2) continue;
    PadLine& line = model_.lines[static_cast<std::size_t>(feature - circles)];
    ++line.visible;
    line.matched += 2 * matched >= visible ? 1 : 0;
  }
  std::erase_if(model_.lines, [](const PadLine& line) {
    return line.visible >= kTrialsOfLine && line.matched < kMinMatchedOfLine * line.visible;
  });
}

void PadTracker::coast(const Eigen::Matrix3d& prediction,
                       const HomographyFilter& before,
                       double frames) {
  view_ = prediction;
  motion_ = before;
  motion_.velocity *= std::pow(kSlowing, frames);
  missed_ += frames;
  if (missed_ > kLongestMiss) is_locked_ = false;
}

std::optional<EdgeTrack> PadTracker::make_track(const Attempt* attempt) const {
  const auto ellipse = project_circle(view_, 1.0);
  if (!ellipse) return std::nullopt;
  EdgeTrack track;
  track.ellipse = *ellipse;
  track.coverage = last_coverage_;
  if (attempt == nullptr) return track;
  track.coverage = attempt->support.coverage;
  track.outline = attempt->support.outline;
  track.visible = attempt->visible;
  track.is_visible = track.visible >= kEnoughVisible ||
                     (motion_.centre_sigma() <= kMaxCentreSigma && track.coverage >= kSureCoverage);
  return track;
}

RingUncertainty PadTracker::uncertainty() const {
  if (refined_) return {refined_->view, refined_->information / kSharedVariance};
  return {view_, motion_.pose.topLeftCorner<5, 5>().inverse()};
}

Rect PadTracker::region_after(double frames, int width, int height) const {
  const Rect frame{0, 0, width, height};
  const auto ideal = project_circle(moved(view_, frames * motion_.velocity), 1.0);
  const auto ellipse = ideal ? distorted(lens_, *ideal) : std::nullopt;
  if (!ellipse) return frame;
  const Eigen::Vector2d half = half_extent(*ellipse);
  const double margin = 1.3 * ellipse->semi_major + 16.0;
  const double left = std::floor(ellipse->cx - half.x() - margin);
  const double top = std::floor(ellipse->cy - half.y() - margin);
  const double right = std::ceil(ellipse->cx + half.x() + margin);
  const double bottom = std::ceil(ellipse->cy + half.y() + margin);
  const auto clamped = [](double v, int high) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(high)));
  };
  const int x = clamped(left, width);
  const int y = clamped(top, height);
  return intersect({x, y, clamped(right, width) - x, clamped(bottom, height) - y}, frame);
}

}  // namespace ellipse
