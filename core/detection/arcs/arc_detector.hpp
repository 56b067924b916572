#pragma once  // SPDX-License-Identifier: MIT

#include <initializer_list>
#include <span>
#include <vector>

#include "core/detection/arcs/arcs.hpp"
#include "core/detection/arcs/ellipse_verifier.hpp"
#include "core/detection/arcs/ring_corrector.hpp"
#include "core/detection/detector.hpp"
#include "core/edges/chains.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/image/scale.hpp"

namespace ellipse {

/// Finds ellipses from the arcs of their edges: gradient and its maxima, chains, arcs, then
/// every arc and every pair of arcs that could be of one ellipse, fitted from their moments and
/// verified on the edges around the whole perimeter.
///
/// Looks at the picture in half its size first, refines what it finds there on the full picture,
/// and looks at the full size only where the answer is weak, where contours below
/// kHalfSizeContourPx are asked for, or where all ellipses are.
///
/// Allocates nothing in the steady state. The work on one image is bounded: by its pixels, by
/// ArcSplitter::kMaxArcs, and by a fixed number of pairs among the best arcs.
class ArcDetector final : public Detector {
 public:
  explicit ArcDetector(Simd simd = best_simd()) : map_(simd) {}

  [[nodiscard]] std::span<const Detection> detect(const ImageView& luma,
                                                  const Thresholds& thresholds) override;
  [[nodiscard]] Overlaps detecting_overlaps() const override { return {0.7, 0.55}; }
  [[nodiscard]] Overlaps tracking_overlaps() const override { return {0.6, 0.45}; }

  static constexpr int kHalfSizeContourPx = 50;

 private:
  struct Guess {
    Ellipse ellipse;
    Polarity polarity;
    double length_px;  // of the arcs that it comes from
    double rms_px;     // and how well it fits them
  };

  void detect_all(const ImageView& luma, const Thresholds& thresholds, double min_score, int scale);
  [[nodiscard]] bool detect_at_half_size(const ImageView& luma, const Thresholds& thresholds);
  void refine_at_full_size(const ImageView& luma, const Thresholds& thresholds);
  void try_single_arcs(const Thresholds& thresholds);
  void try_pairs(const Thresholds& thresholds);
  void try_arcs(std::initializer_list<const Arc*> arcs, const Thresholds& thresholds);
  [[nodiscard]] Verdict examine(const Guess& guess,
                                const Thresholds& thresholds,
                                VerifiedEllipse& verified);
  [[nodiscard]] Verdict judge_news(const Guess& guess) const;
  void add(const VerifiedEllipse& found);
  void use_arcs_on(const VerifiedEllipse& found);
  [[nodiscard]] bool has_partner(std::size_t i, double largest_ratio) const;
  [[nodiscard]] Verdict judge_credit(std::size_t i, const Thresholds& thresholds) const;
  [[nodiscard]] static Verdict judge_alone(const VerifiedEllipse& found,
                                           const Thresholds& thresholds);
  void report(const Thresholds& thresholds);
  void reject(int candidate, const Verdict& verdict);
  void trace_edges(const ImageView& luma, int scale);
  void trace_arcs();

  Scaler scaler_;
  GradientMap map_;
  ChainTracer chains_;
  ArcSplitter splitter_;
  EllipseVerifier verifier_;
  RingCorrector ring_corrector_;
  std::span<Arc> arcs_;
  std::vector<std::uint8_t> is_used_;  // by an ellipse that was found
  std::vector<VerifiedEllipse> found_;
  std::vector<Guess> refused_;
  std::vector<Detection> detections_;
  std::vector<Polarity> polarities_;  // of the detections
  double min_gradient_ = 0.0;         // of an edge on the full picture
  Caution caution_;
};

}  // namespace ellipse
