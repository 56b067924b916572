// SPDX-License-Identifier: MIT
#include "core/tracking/pad/pad_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/camera/circle_pose.hpp"
#include "core/edges/noise.hpp"
#include "core/image/roi.hpp"
#include "core/tracking/frame_clock.hpp"
#include "core/tracking/pad/model_errors.hpp"
#include "core/tracking/pad/model_updates.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kUnknownMotion = 400.0;   // variance of an unknown motion over that of the noise
constexpr double kAdaptation_s = 0.116;    // time constant of motion noise, contrast and radii
constexpr double kReachPx = 4.0;           // min search range, and reach of Tukey's weights
constexpr double kMaxReach = 0.14;         // max search range beyond kReachPx [radii]
constexpr int kMaxSteps = 3;               // max searches of a frame, and before a lock
constexpr double kMaxCentreSigma = 0.033;  // [radii]: 90 % of the errors are below .05
constexpr double kGrowthToLearn = 1.4;     // since the lines were learned

// RMS displacement of the edges by a change.
double rms_px(std::span<const EdgeSample> samples, const HomographyChange& change) {
  double sum = 0.0;
  for (const EdgeSample& sample : samples) sum += std::pow(sample.predicted_px(change), 2);
  return samples.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(samples.size()));
}

// Adds an error of the centre [radii].
RingMatrix with_centre_error(const RingMatrix& information, double sigma) {
  if (sigma == 0.0) return information;
  RingMatrix covariance = information.inverse();
  covariance.diagonal().head<2>().array() += sigma * sigma;
  return covariance.inverse();
}

// Covariance of the measured ring in a view that maps the outer circle to it.
RingMatrix covariance_in(const Eigen::Matrix3d& view, const RingUncertainty& ring) {
  const RingMatrix to_view = ring_jacobian(ring.view, view);
  return to_view * ring.information.ldlt().solve(RingMatrix(to_view.transpose()));
}

}  // namespace

double PadTracker::radius_px() const {
  return PadView(view_, lens_).radius_px();
}

void PadTracker::begin_frame(const PadFrame& frame) {
  camera_ = frame.camera.value_or(default_camera(frame.frame_px));
  is_camera_known_ = frame.camera.has_value();
  lens_ = frame.picture.lens.part(-frame.picture.origin_px);
  edges_.begin_frame();
  refined_.reset();
}

bool PadTracker::lock(const PadFrame& frame, const Ellipse& outer_edge) {
  forget();
  begin_frame(frame);
  auto learned = learn_pad(frame.picture, outer_edge, frame.camera, ring_ratio_);
  if (!learned) return false;
  model_ = std::move(learned->model);
  view_ = learned->view;
  line_learner_.reserve(model_);
  line_learner_.start();
  gain_ = 1.0;
  relative_gain_ = 0.0;
  learned_radius_px_ = 0.0;
  const HomographyCovariance covariance = detected_covariance();
  std::optional<Attempt> attempt;
  for (int step = 0; step < kMaxSteps; ++step) {
    attempt = search_from(frame.picture, view_, covariance);
    if (!is_good(attempt)) return false;
    view_ = attempt->view;
    update_radii(model_, search_.samples(), attempt->last, 1.0, kReachPx);
  }
  if (!has_circle(attempt->view, 1.0, outer_edge)) return false;
  relative_gain_ = attempt->support.relative_gain;
  begin_motion(*attempt, HomographyChange::Zero());
  is_known_ = true;
  edges_.restart();
  if (is_camera_known_) measure_edges(frame.picture, attempt->visible, 1.0);
  return true;
}

std::optional<PadTrack> PadTracker::resume(const PadFrame& frame, const Ellipse& edge) {
  if (!is_known_ || (is_locked_ && unmatched_s_ == 0.0)) return std::nullopt;
  begin_frame(frame);
  for (const PadCircle& circle : model_.circles) {
    const auto start = with_circle(view_, edge, circle.radius);
    if (!start) continue;
    const auto attempt = search_from(frame.picture, *start, detected_covariance());
    if (!is_good(attempt) || !has_circle(attempt->view, circle.radius, edge)) continue;
    // Two detections determine the shift and the scale; other changes are slower than their errors.
    HomographyChange velocity = HomographyChange::Zero();
    if (is_locked_) {
      edges_.set_motion(elapsed_s_ / unmatched_s_ * motion_to(attempt->view));
      velocity.head<3>() = change_between(matched_view_, attempt->view).head<3>() / unmatched_s_;
    }
    begin_motion(*attempt, velocity);
    measure_edges(frame.picture, attempt->visible, 1.0);
    return make_track(&*attempt);
  }
  return std::nullopt;
}

// Of the view of a detected pad.
HomographyCovariance PadTracker::detected_covariance() const {
  const double sigma = match_tolerance_px(radius_px()) / radius_px();
  return sigma * sigma * HomographyCovariance::Identity();
}

// The search may have moved to another edge than the detected one.
bool PadTracker::has_circle(const Eigen::Matrix3d& view, double radius, const Ellipse& detected) {
  const auto found = project_circle(view, radius);
  return found && is_same(*found, detected, kOuterEdgeTolerance);
}

// Starts the filter with the uncertainty of the velocity after a frame of unknown motion.
void PadTracker::begin_motion(const Attempt& attempt, const HomographyChange& velocity) {
  view_ = matched_view_ = attempt.view;
  is_locked_ = true;
  unmatched_s_ = 0.0;
  noise_factor_ = 1.0;
  edges_.restart_motion();
  motion_ = {};
  motion_.velocity = velocity;
  motion_.covariance = inverse_of(attempt.estimate.information);
  motion_.velocity_covariance = kFrame_s * kUnknownMotion * camera_noise(view_, camera_);
  propagate_errors(attempt, HomographyCovariance::Zero());
}

HomographyFilter PadTracker::predicted(double elapsed_s, double noise_factor) const {
  return motion_.after(elapsed_s, noise_factor * camera_noise(view_, camera_));
}

PadTracker::Attempt PadTracker::attempt_of(const Eigen::Matrix3d& view,
                                           const HomographyEstimate& estimate,
                                           const HomographyChange& last) const {
  return {moved(view, last),
          estimate,
          last,
          support_of(search_.samples(),
                     last,
                     match_tolerance_px(radius_px()),
                     static_cast<int>(model_.circles.size())),
          search_.visible_fraction()};
}

// Searches as far as the covariance says, and again around the result until samples stay in place.
std::optional<PadTracker::Attempt> PadTracker::search_from(const Picture& picture,
                                                           const Eigen::Matrix3d& start,
                                                           const HomographyCovariance& covariance) {
  const HomographyCovariance information = inverse_of(covariance);
  const double max_reach_px = kReachPx + kMaxReach * radius_px();
  // A single edge in shadow cannot be told from an edge of the object that casts it.
  const double relative_gain = has_inner_edges() ? relative_gain_ : 0.0;
  const ImageLevels levels{gain_, pixel_noise(picture.luma), relative_gain};
  // Lines match texture by chance, so the scatter of the matches lowers their weight against the
  // prior. Circles alone scatter because the pad is deformed: their matches keep the full weight.
  MatchLimits limits{
      .reach_px = kReachPx, .min_sigma_px = kEdgeSigmaPx, .uses_scatter = !model_.lines.empty()};
  std::optional<Attempt> attempt;
  HomographyChange change = HomographyChange::Zero();
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Matrix3d view = moved(start, change);
    search_.sample(model_, PadView::in(picture, view), picture.luma);
    if (step == 0) {
      search_.search(picture.luma, levels, kReachPx, &covariance, max_reach_px);
    } else {
      search_.search(picture.luma, levels, kReachPx);
    }
    const HomographyPrior prior{-change, information};
    limits.first_reach_px = step == 0 ? max_reach_px : kReachPx;
    const auto estimate = solve_homography(search_.samples(), prior, limits);
    if (!estimate) return std::nullopt;
    change += estimate->change;
    attempt =
        attempt_of(view, {change, estimate->information, estimate->precision}, estimate->change);
    if (rms_px(search_.samples(), estimate->change) <= match_tolerance_px(radius_px())) break;
  }
  return attempt;
}

bool PadTracker::is_good(const std::optional<Attempt>& attempt) {
  return attempt && attempt->support.coverage >= kMinCoverage && attempt->support.has_circles &&
         attempt->support.matched >= HomographyChange::SizeAtCompileTime;
}

std::optional<PadTrack> PadTracker::track(const PadFrame& frame, double elapsed_s) {
  if (!is_locked_) return std::nullopt;
  begin_frame(frame);
  elapsed_s_ = elapsed_s;
  const Eigen::Matrix3d prediction = moved(view_, elapsed_s * motion_.velocity);
  double noise_factor = noise_factor_;
  HomographyFilter before = predicted(elapsed_s, noise_factor);
  auto attempt = search_from(frame.picture, prediction, before.covariance);
  last_coverage_ = attempt ? attempt->support.coverage : 0.0;
  if (!is_good(attempt)) {
    noise_factor = kUnknownMotion;
    before = predicted(elapsed_s, noise_factor);
    attempt = search_from(frame.picture, prediction, before.covariance);
  }
  if (!is_good(attempt)) {
    coast(prediction, before, elapsed_s);
    return is_locked_ ? make_track(nullptr) : std::nullopt;
  }
  // Lines that lead to an impossible view are not on the pad.
  if (!model_.lines.empty() && !is_possible(attempt->view)) {
    model_.lines.clear();
    attempt->view = without_perspective(attempt->view);
  }
  const Eigen::Matrix3d last_view = view_;
  const double adaptation = 1.0 - std::exp(-elapsed_s / kAdaptation_s);
  accept(*attempt, before, noise_factor, adaptation);
  measure_edges(frame.picture, attempt->visible, adaptation);
  motion_.velocity = carried(motion_.velocity, last_view, view_, camera_);
  learn_lines(frame.picture, *attempt);
  return make_track(&*attempt);
}

// From the centre of a circle to its edge, the depth changes by at most the circle's radius:
// relative to the depth of the centre, by at most its angular radius.
bool PadTracker::is_possible(const Eigen::Matrix3d& view) const {
  const auto outer = project_circle(view, 1.0);
  if (!outer) return false;
  const double angular_radius = outer->semi_major / std::max(camera_.fx, camera_.fy);
  return view.row(2).head<2>().norm() <= angular_radius * std::abs(view(2, 2));
}

void PadTracker::accept(const Attempt& attempt,
                        const HomographyFilter& before,
                        double noise_factor,
                        double adaptation) {
  motion_ = before.corrected(attempt.estimate);
  if (model_.lines.empty()) motion_.fix_rotation();  // rings have no orientation
  // Squared displacement of the edges over its predicted variance.
  double moved_px = 0.0;
  double expected_px = 0.0;
  for (const EdgeSample& sample : search_.samples()) {
    moved_px += std::pow(sample.predicted_px(attempt.estimate.change), 2);
    expected_px += variance_along(sample.view.row, before.covariance);
  }
  const double needed = noise_factor * moved_px / expected_px;
  noise_factor_ =
      std::clamp(noise_factor_ + adaptation * (needed - noise_factor_), 1.0, kUnknownMotion);
  const double gain = std::clamp(attempt.support.gain, kMinContrastShare, 1.0 / kMinContrastShare);
  gain_ += adaptation * (gain - gain_);
  relative_gain_ += adaptation * (attempt.support.relative_gain - relative_gain_);
  propagate_errors(attempt, inverse_of(before.covariance));
  drop_refuted_lines(model_, search_.samples(), attempt.last, match_tolerance_px(radius_px()));
  if (attempt.visible >= kMajority) {
    update_radii(model_, search_.samples(), attempt.last, adaptation, kReachPx);
  }
  if (unmatched_s_ == 0.0) edges_.set_motion(motion_to(attempt.view));
  view_ = attempt.view;
  unmatched_s_ = 0.0;
}

// Displacement of the pad's centre in the picture since the last match; zero if unknown.
Eigen::Vector2d PadTracker::motion_to(const Eigen::Matrix3d& view) const {
  const auto before = PadView(matched_view_, lens_).at({0.0, 0.0});
  const auto after = PadView(view, lens_).at({0.0, 0.0});
  return before && after ? Eigen::Vector2d(after->point - before->point)
                         : Eigen::Vector2d(0.0, 0.0);
}

void PadTracker::propagate_errors(const Attempt& attempt,
                                  const HomographyCovariance& prior_information) {
  propagate_model_errors(
      model_,
      search_.samples(),
      {attempt.last, motion_.covariance, prior_information, kReachPx, attempt.estimate.precision});
}

// Of the filter's view, and of the model's errors.
HomographyCovariance PadTracker::covariance() const {
  return motion_.covariance + model_error_covariance(model_);
}

void PadTracker::measure_edges(const Picture& picture, double visible, double adaptation) {
  refine(picture, visible, adaptation);
  // Rings alone hardly determine the tilt: it would drift, and lines would be learned in a wrong
  // view.
  if (is_camera_known_ && model_.lines.empty()) view_ = with_nearer_pose(camera_, view_);
  if (is_camera_known_ && refined_) edges_.refine_inner(picture, view_, model_, gain_);
  matched_view_ = view_;
}

// While most of the outer edge is visible, moves the view to the refined edge: constant-velocity
// prediction lags under acceleration, and in defocus the matches contain the same errors, so that
// a combination of both would be overconfident. A short arc hardly determines the ring: its
// refinement is combined with the view.
void PadTracker::refine(const Picture& picture, double visible, double adaptation) {
  const auto exact = edges_.refine_outer(picture, view_, model_, gain_, adaptation);
  if (!exact) return;
  const auto view = with_circle(view_, exact->ellipse);
  if (!view) return;
  RingUncertainty ring = exact->uncertainty;
  if (visible >= kMajority) {
    view_ = *view;
    reduce_model_errors(model_, RingGain::Identity());
  } else {
    correct_view(*view, covariance_in(*view, ring));
    ring = {view_, covariance().topLeftCorner<5, 5>().inverse()};
  }
  refined_ = {
      ring.view,
      with_centre_error(ring.information, edges_.exposure_error_px(adaptation) / radius_px())};
}

// Corrects the view by the refined outer edge, in proportion to the errors of both.
void PadTracker::correct_view(const Eigen::Matrix3d& refined, const RingMatrix& errors) {
  const HomographyChange change = change_between(view_, refined);
  const RingGain gain =
      motion_.correct_by_ring(change.head<5>(), errors, model_error_covariance(model_));
  reduce_model_errors(model_, gain);
  view_ = moved(refined, gain * change.head<5>() - change);
}

// Learns the lines again as the pad grows in the image and shows finer ones.
void PadTracker::learn_lines(const Picture& picture, const Attempt& attempt) {
  const double radius = radius_px();
  if (radius < kGrowthToLearn * learned_radius_px_ || attempt.visible < kMajority) return;
  line_learner_.take(picture.luma, PadView::in(picture, view_));
  if (!line_learner_.is_ready()) return;
  line_learner_.learn(model_, gain_);
  line_learner_.start();
  learned_radius_px_ = radius;
}

void PadTracker::coast(const Eigen::Matrix3d& prediction,
                       const HomographyFilter& before,
                       double elapsed_s) {
  view_ = prediction;
  motion_ = before;
  unmatched_s_ += elapsed_s;
  if (unmatched_s_ > kMemory_s) is_locked_ = false;
}

std::optional<PadTrack> PadTracker::make_track(const Attempt* attempt) const {
  const auto ellipse = outline();
  if (!ellipse) return std::nullopt;
  PadTrack track;
  track.ellipse = *ellipse;
  track.coverage = last_coverage_;
  if (attempt == nullptr) return track;
  track.coverage = attempt->support.coverage;
  track.outer_coverage = attempt->support.outer_coverage;
  track.is_visible = centre_sigma(covariance()) <= kMaxCentreSigma;
  return track;
}

RingUncertainty PadTracker::uncertainty() const {
  if (refined_) return *refined_;
  return {view_, covariance().topLeftCorner<5, 5>().inverse()};
}

// Rings alone hardly determine the perspective.
std::optional<PatternView> PadTracker::pattern() const {
  if (model_.lines.empty()) return std::nullopt;
  return PatternView{view_, covariance().bottomRightCorner<2, 2>()};
}

Rect PadTracker::region_after(double elapsed_s, int width, int height) const {
  const Rect frame{0, 0, width, height};
  const auto ideal = project_circle(moved(view_, elapsed_s * motion_.velocity), 1.0);
  const auto ellipse = ideal ? distorted(lens_, *ideal) : std::nullopt;
  if (!ellipse) return frame;
  const double r = ellipse->semi_major;
  const double reach_px = kReachPx + kMaxReach * r + GradientMap::kBorder;
  return calculate_roi(*ellipse, std::max(kRoiExpansion, 1.0 + reach_px / r), 1, width, height);
}

}  // namespace ellipse
