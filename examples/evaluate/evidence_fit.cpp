// SPDX-License-Identifier: MIT
#include "examples/evaluate/evidence_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/detection/detection_trace.hpp"
#include "core/detection/detectors.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

using ellipse::EvidenceTable;
using ellipse::Features;
using ellipse::kFeatures;

constexpr double kRightIou = 0.85;
constexpr double kWrongIou = 0.6;
constexpr int kRounds = 2;                // fits after the first one
constexpr int kWrongPerFrame = 4;         // number of wrong candidates per frame
constexpr double kMinCandidates = 100.0;  // a source with fewer is weighted less
constexpr ellipse::Tolerance kSameEllipse{1.0, 0.05};
constexpr double kRidge = 1e-5;
constexpr int kMaxNewtonSteps = 40;

enum class Label { kRight, kWrong, kUnclear };

Label label_of(const ellipse::Ellipse& e, const Truth& truth, const FrameSize& size) {
  double best = 0.0;
  bool is_concentric = false;
  for (const TrueEllipse& each : ellipses_of(truth)) {
    best = std::max(best, iou_of(e, each.ellipse, size));
    is_concentric = is_concentric || ellipse::are_concentric(e, each.ellipse);
  }
  if (best >= kRightIou) return Label::kRight;
  const bool is_known_wrong = truth.is_complete && best < kWrongIou && !is_concentric;
  return is_known_wrong ? Label::kWrong : Label::kUnclear;
}

struct Sample {
  const LabelledCandidate* candidate;
  double weight;
};

// Weights all sources equally and, within a source, right and wrong candidates equally.
void weigh(std::vector<Sample>& samples) {
  std::map<std::pair<std::size_t, bool>, double> counts;
  for (const Sample& s : samples) ++counts[{s.candidate->source, s.candidate->is_right}];
  double sum = 0.0;
  for (Sample& s : samples) {
    const double count = counts[{s.candidate->source, s.candidate->is_right}];
    s.weight = 1.0 / std::max(count, kMinCandidates);
    sum += s.weight;
  }
  for (Sample& s : samples) s.weight /= sum;
}

using Vector = Eigen::Matrix<double, kFeatures + 1, 1>;
using Matrix = Eigen::Matrix<double, kFeatures + 1, kFeatures + 1>;

struct Scaling {
  Features means{};
  Features deviations{};

  [[nodiscard]] Vector apply(const Features& features) const {
    Vector x;
    for (std::size_t i = 0; i < kFeatures; ++i) {
      x[Eigen::Index(i)] = (features[i] - means[i]) / deviations[i];
    }
    x[kFeatures] = 1.0;
    return x;
  }
};

Scaling scaling_of(const std::vector<Sample>& samples) {
  Scaling scaling;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    double mean = 0.0;
    double square = 0.0;
    for (const Sample& s : samples) mean += s.weight * s.candidate->features[i];
    for (const Sample& s : samples) {
      const double d = s.candidate->features[i] - mean;
      square += s.weight * d * d;
    }
    scaling.means[i] = mean;
    scaling.deviations[i] = std::sqrt(square) + 1e-9;
  }
  return scaling;
}

// Newton's method on the weighted log likelihood with ridge penalty [HastieTibshiraniFriedman2009]
// 4.4.1.
EvidenceTable regress(const std::vector<Sample>& samples) {
  const Scaling scaling = scaling_of(samples);
  Vector b = Vector::Zero();
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    Vector gradient = kRidge * b;
    Matrix hessian = kRidge * Matrix::Identity();
    gradient[kFeatures] = 0.0;
    for (const Sample& s : samples) {
      const Vector x = scaling.apply(s.candidate->features);
      const double p = 1.0 / (1.0 + std::exp(-b.dot(x)));
      gradient += s.weight * (p - (s.candidate->is_right ? 1.0 : 0.0)) * x;
      hessian += s.weight * p * (1.0 - p) * x * x.transpose();
    }
    const Vector change = hessian.ldlt().solve(gradient);
    b -= change;
    if (change.lpNorm<Eigen::Infinity>() < 1e-6) break;
  }
  EvidenceTable table;
  table.means = scaling.means;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    table.weights[i] = b[Eigen::Index(i)] / scaling.deviations[i];
  }
  table.bias = b[kFeatures];
  return table;
}

// Returns all right candidates and the most probable wrong ones of each frame.
std::vector<Sample> hardest(const std::vector<Sample>& all, const EvidenceTable& table) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < all.size(); ++i) {
    order.emplace_back(-table.log_odds(all[i].candidate->features), i);
  }
  std::sort(order.begin(), order.end());
  std::map<std::size_t, int> wrong_of_frame;
  std::vector<Sample> kept;
  for (const auto& [odds, i] : order) {
    const LabelledCandidate& candidate = *all[i].candidate;
    if (candidate.is_right || wrong_of_frame[candidate.frame]++ < kWrongPerFrame)
      kept.push_back(all[i]);
  }
  weigh(kept);
  return kept;
}

}  // namespace

EvidenceFitter::EvidenceFitter(const ellipse::TrackerSettings& settings,
                               const std::vector<Sequence>& sequences,
                               const std::function<bool(const Frame&)>& advance)
    : settings_(settings) {
  for (const Sequence& sequence : sequences) {
    auto source = std::ranges::find(sources_, sequence.dataset);
    if (source == sources_.end()) source = sources_.insert(source, sequence.dataset);
    for (const Frame& frame : sequence.frames) {
      try {
        add(frame, sequence, static_cast<std::size_t>(source - sources_.begin()));
      } catch (const std::runtime_error& error) {
        problems_.emplace_back(error.what());
      }
      if (!advance(frame)) return;
    }
  }
}

void EvidenceFitter::add(const Frame& frame, const Sequence& sequence, std::size_t source) {
  const cv::Mat picture = sequence.pictures->picture(frame);
  if (!frame.truth.is_labelled) return;
  const FrameSize size{picture.cols, picture.rows, sequence.distortion.get()};
  // No candidate reaches a probability of 1, so all are measured and none suppresses others.
  ellipse::Thresholds thresholds = settings_.limits;
  thresholds.contour_overlap = thresholds.ellipse_overlap = 0.0;
  thresholds.min_probability = 1.0;
  thresholds.wants_all = true;
  const auto detector = ellipse::make_detector(ellipse::DetectorKind::kArcs);
  ellipse::DetectionTrace trace;
  detector->set_trace(&trace);
  (void)detector->detect(
      {picture.data, picture.cols, picture.rows, static_cast<std::ptrdiff_t>(picture.step)},
      thresholds);
  for (const ellipse::TracedCandidate& candidate : trace.candidates()) {
    if (candidate.probability == 0.0) continue;
    const Label label = label_of(*candidate.ellipse, frame.truth, size);
    if (label == Label::kUnclear) continue;
    candidates_.push_back(
        {source, frames_, *candidate.ellipse, candidate.features, label == Label::kRight});
  }
  ++frames_;
}

EvidenceTable EvidenceFitter::fit(const std::vector<std::string>& sources) const {
  std::vector<Sample> all;
  for (const LabelledCandidate& candidate : candidates_) {
    const bool is_one = std::ranges::find(sources, sources_[candidate.source]) != sources.end();
    if (is_one) all.push_back({&candidate, 0.0});
  }
  const auto right =
      std::count_if(all.begin(), all.end(), [](const Sample& s) { return s.candidate->is_right; });
  if (right == 0 || static_cast<std::size_t>(right) == all.size()) {
    throw std::invalid_argument(
        right == 0 ? "--fit-evidence: no candidate in the frames is an ellipse"
                   : "--fit-evidence: every candidate in the frames is an ellipse");
  }
  weigh(all);
  EvidenceTable table = regress(all);
  for (int round = 0; round < kRounds; ++round) table = regress(hardest(all, table));
  return table;
}

EvidenceTable EvidenceFitter::fit_all() const {
  return fit(sources_);
}

std::vector<const LabelledCandidate*> EvidenceFitter::distinct(std::size_t source,
                                                               const EvidenceTable& table) const {
  std::vector<const LabelledCandidate*> sorted;
  for (const LabelledCandidate& candidate : candidates_) {
    if (candidate.source == source) sorted.push_back(&candidate);
  }
  std::ranges::stable_sort(sorted, [&](const auto* a, const auto* b) {
    if (a->frame != b->frame) return a->frame < b->frame;
    return table.log_odds(a->features) > table.log_odds(b->features);
  });
  std::vector<const LabelledCandidate*> kept;
  for (const LabelledCandidate* candidate : sorted) {
    const bool is_known = std::any_of(kept.rbegin(), kept.rend(), [&](const auto* other) {
      return other->frame == candidate->frame &&
             is_same(candidate->ellipse, other->ellipse, kSameEllipse);
    });
    if (!is_known) kept.push_back(candidate);
  }
  return kept;
}

Calibration EvidenceFitter::left_out_calibration(const SourceGroups& groups) const {
  Calibration calibration;
  double sources = 0.0;
  for (std::size_t source = 0; source < sources_.size(); ++source) {
    std::vector<std::string> others;
    std::ranges::copy_if(sources_, std::back_inserter(others), [&](const std::string& other) {
      return groups.group_of(other) != groups.group_of(sources_[source]);
    });
    if (others.empty()) continue;
    const EvidenceTable table = fit(others);
    const auto candidates = distinct(source, table);
    if (candidates.empty()) continue;
    sources += 1.0;
    const double weight = 1.0 / static_cast<double>(candidates.size());
    for (const LabelledCandidate* candidate : candidates) {
      const double p = table.probability(candidate->features);
      auto& bin = calibration.bins[std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * p))];
      ++bin.candidates;
      bin.probability += p;
      if (candidate->is_right) ++bin.right;
      calibration.log_loss -= weight * std::log(std::max(1e-9, candidate->is_right ? p : 1.0 - p));
    }
  }
  for (CalibrationBin& bin : calibration.bins) {
    if (bin.candidates == 0) continue;
    bin.probability /= bin.candidates;
    bin.right /= bin.candidates;
  }
  calibration.log_loss /= std::max(1.0, sources);
  return calibration;
}

Table calibration_table(const Calibration& calibration) {
  Table table;
  table.title = "Left out: candidates by predicted probability";
  table.header = {"predicted", "candidates", "mean", "right"};
  for (std::size_t i = 0; i < calibration.bins.size(); ++i) {
    const CalibrationBin& bin = calibration.bins[i];
    const auto tenth = static_cast<double>(i) / 10.0;
    table.rows.push_back({number(tenth, 1) + " to " + number(tenth + 0.1, 1),
                          std::to_string(bin.candidates),
                          bin.candidates > 0 ? number(bin.probability, 3) : "-",
                          bin.candidates > 0 ? number(bin.right, 3) : "-"});
  }
  table.note = "Log loss: " + number(calibration.log_loss, 4) +
               ", with equal weights of all sources. Candidates that are neither right nor wrong "
               "are excluded.";
  return table;
}

Choice EvidenceFitter::choose(const std::vector<std::string>& sources) {
  Choice choice{"fitted", settings_};
  choice.settings.evidence = fit(sources);
  return choice;
}

}  // namespace evaluate
