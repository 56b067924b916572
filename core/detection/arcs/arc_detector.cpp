// SPDX-License-Identifier: MIT
#include "core/detection/arcs/arc_detector.hpp"

#include <algorithm>
#include <cmath>

#include "core/detection/detection_trace.hpp"
#include "core/detection/target_selection.hpp"
#include "core/edges/edge_refinement.hpp"
#include "core/edges/thin_ring.hpp"
#include "core/geometry/ellipse_fit.hpp"

namespace ellipse {
namespace {

// Found by experiment, see docs/provenance.md.
constexpr double kEdgeFloor = 1.25;        // least threshold [grey levels / px]
constexpr double kFitRms = 0.8;            // [px], and
constexpr double kFitRmsRelative = 0.012;  // of the radius, or of a third of the arc
constexpr double kMinScore = 62.0;         // [nats]
constexpr int kMaxPairs = 400;
constexpr double kConvexSlackPx = 2.0;  // by which one arc may lie outside the other, and
constexpr double kConvexSlack = 0.1;    // of their distance
constexpr double kSameExact = 0.05;
constexpr double kSameDeformed = 0.08;
constexpr double kSameRefused = 0.1;
constexpr double kMuchLonger = 1.4;
constexpr double kOnEllipsePx = 2.5;
constexpr double kEnoughScore = 150.0;  // at half size [nats], and
constexpr double kEnoughScoreAlone = 75.0;
constexpr double kEnoughSupport = 0.85;
constexpr double kFullSizeGradient = 0.4;  // of the threshold at half size, where edges are steeper
constexpr double kMinTurnSupport = 0.5;
constexpr double kLoneInside = 0.3;        // of the perimeter
constexpr double kLonePartSupport = 0.35;  // above the wanted one, where less than half is inside
constexpr double kLoneSupport = 0.25;      // above the wanted one
constexpr double kLoneCut = 0.75;          // of the perimeter; with less of it the frame cuts it
constexpr double kLoneRatio = 2.2;         // of the axes
constexpr double kThickRing = 0.9;         // inner over outer radius

double radius_of(const Ellipse& e) {
  return std::sqrt(e.semi_major * e.semi_minor);
}

// A deformed edge leaves its ellipse by more, the larger it is; but a short arc knows no crumpling.
double fit_limit(const Ellipse& e, double length_px) {
  return kFitRms + kFitRmsRelative * std::min(radius_of(e), length_px / 3.0);
}

bool are_same(const Ellipse& a, const Ellipse& b, double tolerance) {
  return std::abs(a.cx - b.cx) + std::abs(a.cy - b.cy) < 2.0 * tolerance * b.semi_minor + 1.0 &&
         std::abs(a.semi_major - b.semi_major) < tolerance * b.semi_major + 1.0 &&
         std::abs(a.semi_minor - b.semi_minor) < tolerance * b.semi_minor + 1.0;
}

// Whether all of b is on the inner side of a's edge: what lies on one convex curve does.
bool is_inside_of(const Arc& b, const Arc& a) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d apart = b.points[k] - a.points[i];
      const double slack = kConvexSlackPx + kConvexSlack * apart.lpNorm<1>();
      if (apart.dot(a.inwards[i]) < -slack) return false;
    }
  }
  return true;
}

// Lengths for a picture of half the size.
Thresholds halved(const Thresholds& thresholds) {
  Thresholds half = thresholds;
  half.min_axis_px /= 2.0;
  half.max_axis_px /= 2.0;
  half.min_contour_size /= 2;
  return half;
}

// Whether the target, with all that are concentric with it, is beyond doubt: by much evidence, or
// by less where nothing else is there.
bool is_beyond_doubt(const Detection& target, std::span<const Detection> detections) {
  if (target.ellipse_overlap < kEnoughSupport) return false;
  double score = 0.0;
  bool is_alone = true;
  for (const Detection& other : detections) {
    if (other.ellipse == target.ellipse || are_partners(target.ellipse, other.ellipse)) {
      score += other.score;
    } else {
      is_alone = false;
    }
  }
  return score >= (is_alone ? kEnoughScoreAlone : kEnoughScore);
}

}  // namespace

std::span<const Detection> ArcDetector::detect(const ImageView& luma,
                                               const Thresholds& thresholds) {
  if (trace_ != nullptr) trace_->clear();
  if (!detect_at_half_size(luma, thresholds)) {
    // Who asks for short contours takes less evidence for enough.
    const double share = std::min(1.0, double(thresholds.min_contour_size) / kHalfSizeContourPx);
    detect_all(luma, thresholds, share * kMinScore, 1);
  }
  ring_corrector_.correct(luma, min_gradient_, polarities_, lens_, detections_);
  if (trace_ != nullptr) trace_->report(detections_);
  return detections_;
}

bool ArcDetector::detect_at_half_size(const ImageView& luma, const Thresholds& thresholds) {
  if (thresholds.wants_all || thresholds.min_contour_size < kHalfSizeContourPx) return false;
  const ImageView half = scaler_.reduce(luma, 2);
  detect_all(half, halved(thresholds), kMinScore, 2);
  const auto target = select_target(detections_);
  if (!target || !is_beyond_doubt(*target, detections_)) return false;
  refine_at_full_size(luma, thresholds);
  return true;
}

// What the exact axes show to be beyond the limits is left out.
void ArcDetector::refine_at_full_size(const ImageView& luma, const Thresholds& thresholds) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < detections_.size(); ++i) {
    Detection detection = detections_[i];
    detection.ellipse = scaled(detection.ellipse, 2.0);
    const auto refined = refined_on_picture(
        luma, detection.ellipse, polarities_[i], min_gradient_, kMaxRefinementSamples, lens_);
    if (refined) detection.ellipse = refined->ellipse;
    const Verdict verdict = thresholds.judge_axes_of(detection.ellipse);
    if (!verdict.is_accepted()) {
      reject(detection.candidate, verdict);
      continue;
    }
    polarities_[kept] = polarities_[i];
    detections_[kept++] = detection;
  }
  detections_.resize(kept);
}

void ArcDetector::detect_all(const ImageView& luma,
                             const Thresholds& thresholds,
                             double min_score,
                             int scale) {
  detections_.clear();
  polarities_.clear();
  found_.clear();
  refused_.clear();
  if (luma.empty()) return;
  const double floor = thresholds.edge_low > 0.0 ? thresholds.edge_low : kEdgeFloor;
  map_.compute(luma, thresholds.edge_high, floor);
  map_.set_lens(scale > 1 ? lens_.reduced(scale) : lens_);
  min_gradient_ = kFullSizeGradient * map_.threshold();
  if (trace_ != nullptr) trace_edges(luma, scale);
  chains_.trace(map_);
  arcs_ = splitter_.split(map_, chains_, thresholds.wants_all);
  if (trace_ != nullptr) trace_arcs();
  caution_.edge_density = static_cast<double>(chains_.pixels().size()) / (luma.width * luma.height);
  caution_.min_score = min_score;
  is_used_.assign(arcs_.size(), 0);
  try_single_arcs(thresholds);
  try_pairs(thresholds);
  report(thresholds);
}

void ArcDetector::try_single_arcs(const Thresholds& thresholds) {
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const Arc& arc = arcs_[i];
    if (is_used_[i] != 0 || arc.turn_rad < ArcSplitter::kMinSingleTurn) continue;
    try_arcs({&arc}, thresholds);
  }
}

// The best arcs with each other first: by the sum of their ranks.
void ArcDetector::try_pairs(const Thresholds& thresholds) {
  const std::size_t n = std::min(arcs_.size(), ArcSplitter::kMaxPairedArcs);
  int pairs = 0;
  for (std::size_t sum = 1; sum < 2 * n; ++sum) {
    for (std::size_t i = sum >= n ? sum - n + 1 : 0; 2 * i < sum; ++i) {
      const std::size_t k = sum - i;
      const Arc& a = arcs_[i];
      const Arc& b = arcs_[k];
      if (is_used_[i] != 0 || is_used_[k] != 0 || a.polarity != b.polarity) continue;
      if (!is_inside_of(a, b) || !is_inside_of(b, a)) continue;
      if (++pairs > kMaxPairs) return;
      try_arcs({&a, &b}, thresholds);
    }
  }
}

void ArcDetector::try_arcs(std::initializer_list<const Arc*> arcs, const Thresholds& thresholds) {
  const Arc& first = **arcs.begin();
  Moments moments = first.moments;
  double length_px = first.length_px();
  for (const Arc* other : std::span(arcs).subspan(1)) {
    moments.add(other->moments);
    length_px += other->length_px();
  }
  const auto fit = fit_with_residual(moments);
  VerifiedEllipse verified;
  Verdict verdict = {Reason::kNoEllipse};
  if (fit) {
    verdict = examine({fit->ellipse, first.polarity, length_px, fit->rms_px}, thresholds, verified);
  }
  if (trace_ != nullptr) {
    TracedPiece pieces[2];
    std::transform(arcs.begin(), arcs.end(), pieces, [](const Arc* arc) {
      return TracedPiece{arc->begin, arc->end};
    });
    const std::optional<Ellipse> guess = fit ? std::optional(fit->ellipse) : std::nullopt;
    verified.candidate = trace_->add({pieces, arcs.size()}, guess, verdict);
  }
  if (verdict.is_accepted()) add(verified);
}

Verdict ArcDetector::examine(const Guess& guess,
                             const Thresholds& thresholds,
                             VerifiedEllipse& verified) {
  const auto& [ellipse, polarity, length_px, rms_px] = guess;
  Verdict verdict = at_most(Reason::kPoorFit, rms_px, fit_limit(ellipse, length_px));
  if (verdict.is_accepted()) verdict = EllipseVerifier::judge_shape(ellipse, map_, thresholds);
  if (verdict.is_accepted()) verdict = judge_news(guess);
  if (verdict.is_accepted()) {
    verdict = EllipseVerifier::judge_promise(map_, ellipse, polarity, thresholds);
  }
  if (!verdict.is_accepted()) return verdict;
  verdict = verifier_.verify(map_, caution_, ellipse, polarity, thresholds, verified);
  if (!verdict.is_accepted()) refused_.push_back(guess);
  return verdict;
}

Verdict ArcDetector::judge_news(const Guess& guess) const {
  for (const VerifiedEllipse& known : found_) {
    const double tolerance = known.is_deformed ? kSameDeformed : kSameExact;
    if (known.polarity == guess.polarity && are_same(known.ellipse, guess.ellipse, tolerance)) {
      return {Reason::kKnown};
    }
  }
  // One from much more of its edge may do better than the one that was refused.
  for (const Guess& known : refused_) {
    if (known.polarity == guess.polarity && are_same(known.ellipse, guess.ellipse, kSameRefused) &&
        guess.length_px < kMuchLonger * known.length_px) {
      return {Reason::kRefused};
    }
  }
  return {};
}

// Of two that are the same, the better one stays.
void ArcDetector::add(const VerifiedEllipse& found) {
  for (VerifiedEllipse& known : found_) {
    const bool is_deformed = found.is_deformed || known.is_deformed;
    const double tolerance = is_deformed ? kSameDeformed : kSameExact;
    if (known.polarity != found.polarity || !are_same(known.ellipse, found.ellipse, tolerance)) {
      continue;
    }
    const bool is_better = known.needs_partner != found.needs_partner ? known.needs_partner
                                                                      : found.score > known.score;
    reject(is_better ? known.candidate : found.candidate, {Reason::kKnown});
    if (is_better) known = found;
    return;
  }
  found_.push_back(found);
  if (!found.needs_partner) use_arcs_on(found);
}

void ArcDetector::use_arcs_on(const VerifiedEllipse& found) {
  const double tolerance_px =
      found.is_deformed ? std::max(kOnEllipsePx, EllipseVerifier::deformation_px(found.ellipse))
                        : kOnEllipsePx;
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    if (is_used_[i] != 0 || arcs_[i].polarity != found.polarity) continue;
    const auto& points = arcs_[i].points;
    is_used_[i] = std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& point) {
      return std::abs(sampson_distance(found.ellipse, point)) <= tolerance_px;
    });
  }
}

bool ArcDetector::has_partner(std::size_t i, double largest_ratio) const {
  const VerifiedEllipse& one = found_[i];
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const VerifiedEllipse& other = found_[k];
    if (k == i || !are_partners(one.ellipse, other.ellipse, largest_ratio)) continue;
    if (!other.needs_partner) return true;
    if (one.polarity != other.polarity && std::min(one.covered, other.covered) >= 0.2 &&
        std::min(one.inside_fraction, other.inside_fraction) >= 0.3) {
      return true;
    }
  }
  return false;
}

// What is alone must be more than a painted arc, or a petal: whole; or, where the frame cuts it,
// round, seen to a good part, and there without a gap.
Verdict ArcDetector::judge_alone(const VerifiedEllipse& found, const Thresholds& thresholds) {
  const double support = std::min(found.support, found.turn_support);
  const double wanted = thresholds.ellipse_overlap;
  const Verdict inside = at_least(Reason::kLoneCut, found.inside_fraction, kLoneInside);
  if (!inside.is_accepted()) return inside;
  if (found.inside_fraction < kLoneCut) {
    const double ratio = found.ellipse.aspect_ratio();
    const Verdict flat = at_most(Reason::kLoneCutFlat, ratio, kLoneRatio);
    if (!flat.is_accepted()) return flat;
  }
  const double margin = found.inside_fraction < 0.5 ? kLonePartSupport : kLoneSupport;
  if (support >= wanted + margin) return {};
  return below_setting(Reason::kLoneOpen, support - margin, wanted);
}

// Both edges of a painted line are partners too. So a thin ring has to stand alone.
Verdict ArcDetector::judge_credit(std::size_t i, const Thresholds& thresholds) const {
  const VerifiedEllipse& found = found_[i];
  const Verdict turn = at_least(Reason::kOpenEnds, found.turn_support, kMinTurnSupport);
  if (!turn.is_accepted()) return turn;
  if (found.needs_partner && !has_partner(i, kMaxRingRatio)) return {Reason::kNoPartner};
  return has_partner(i, kThickRing) ? Verdict{} : judge_alone(found, thresholds);
}

void ArcDetector::report(const Thresholds& thresholds) {
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const VerifiedEllipse& found = found_[i];
    Verdict verdict = judge_credit(i, thresholds);
    if (verdict.is_accepted()) {
      verdict = at_least(Reason::kContourOverlap, found.on_ellipse, thresholds.contour_overlap);
    }
    if (!verdict.is_accepted()) {
      reject(found.candidate, verdict);
      continue;
    }
    detections_.push_back(
        {found.ellipse, found.on_ellipse, found.support, found.score, found.candidate});
    polarities_.push_back(found.polarity);
  }
}

void ArcDetector::reject(int candidate, const Verdict& verdict) {
  if (trace_ != nullptr) trace_->revise(candidate, verdict);
}

void ArcDetector::trace_edges(const ImageView& luma, int scale) {
  TracedPass& pass = trace_->begin_pass(luma, scale);
  pass.edge_low = pass.edge_high = map_.threshold() / kGradientGain;
  for (int y = 0; y < map_.height(); ++y) {
    const std::uint8_t* row = map_.maxima() + std::ptrdiff_t(y) * map_.stride();
    for (int x = 0; x < map_.width(); ++x) pass.edges.push_back(row[x] != 0 ? 255 : 0);
  }
}

void ArcDetector::trace_arcs() {
  TracedPass& pass = trace_->pass();
  for (const std::int32_t pixel : chains_.pixels()) {
    pass.points.push_back({pixel % map_.stride(), pixel / map_.stride()});
  }
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    const std::size_t begin = pass.chains.empty() ? 0 : pass.chains.back().end;
    pass.chains.push_back({begin, begin + chains_.chain(i).pixels.size()});
  }
  for (const Arc& arc : arcs_) pass.arcs.push_back({arc.begin, arc.end});
}

}  // namespace ellipse
