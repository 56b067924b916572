// SPDX-License-Identifier: MIT
#include "core/detection/detection_trace.hpp"

#include <string_view>

#include "core/image/scale.hpp"

namespace ellipse {
namespace {

// Converts lengths to pixels that are smaller by `scale`; other units stay.
Verdict magnified(Verdict verdict, int scale) {
  if (reason_info(verdict.reason).unit != std::string_view("px")) return verdict;
  verdict.measured *= scale;
  verdict.limit *= scale;
  return verdict;
}

}  // namespace

void DetectionTrace::clear() {
  passes_.clear();
  candidates_.clear();
}

TracedPass& DetectionTrace::begin_pass(const ImageView& luma, int scale) {
  TracedPass& pass = passes_.emplace_back();
  pass.region = {0, 0, scale * luma.width, scale * luma.height};
  pass.scale = scale;
  pass.width = luma.width;
  pass.height = luma.height;
  for (int y = 0; y < luma.height; ++y) {
    pass.luma.insert(pass.luma.end(), luma.row(y), luma.row(y) + luma.width);
  }
  return pass;
}

int DetectionTrace::add(std::span<const TracedPiece> pieces,
                        const std::optional<Ellipse>& ellipse,
                        const Verdict& verdict) {
  TracedCandidate& candidate = candidates_.emplace_back();
  candidate.pass = passes_.size() - 1;
  candidate.pieces.assign(pieces.begin(), pieces.end());
  if (ellipse) candidate.ellipse = to_frame(*ellipse, {}, passes_.back().scale);
  candidate.verdict = magnified(verdict, passes_.back().scale);
  return static_cast<int>(candidates_.size()) - 1;
}

void DetectionTrace::measure(int candidate,
                             const Ellipse& ellipse,
                             const Features& features,
                             const EvidenceTable& table) {
  TracedCandidate& known = candidates_[static_cast<std::size_t>(candidate)];
  known.ellipse = ellipse;
  known.features = features;
  known.contributions = table.contributions(features);
  known.probability = table.probability(features);
}

void DetectionTrace::revise(int candidate, const Verdict& verdict) {
  if (candidate >= 0) candidates_[static_cast<std::size_t>(candidate)].verdict = verdict;
}

void DetectionTrace::report(std::span<const Detection> detections) {
  for (TracedCandidate& candidate : candidates_) {
    if (candidate.verdict.is_accepted()) candidate.verdict = {Reason::kCrowdedOut};
  }
  for (const Detection& detection : detections) {
    TracedCandidate& candidate = candidates_[static_cast<std::size_t>(detection.candidate)];
    candidate.ellipse = detection.ellipse;
    candidate.verdict = {};
    candidate.is_detection = true;
    candidate.contour_overlap = detection.contour_overlap;
    candidate.ellipse_overlap = detection.ellipse_overlap;
    candidate.score = detection.score;
    candidate.probability = detection.probability;
  }
}

void DetectionTrace::choose(int candidate) {
  if (candidate < 0) return;
  candidates_[static_cast<std::size_t>(candidate)].verdict = {};
  candidates_[static_cast<std::size_t>(candidate)].is_target = true;
}

void DetectionTrace::to_frame_coordinates(const Rect& region, int scale, const LensView& lens) {
  for (TracedPass& pass : passes_) {
    pass.region.x += region.x;
    pass.region.y += region.y;
    pass.region.width *= scale;
    pass.region.height *= scale;
    pass.scale *= scale;
  }
  for (TracedCandidate& candidate : candidates_) {
    if (candidate.ellipse) {
      candidate.ellipse = distorted(lens, to_frame(*candidate.ellipse, region, scale));
    }
    candidate.verdict = magnified(candidate.verdict, scale);
  }
}

}  // namespace ellipse
