#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <optional>
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

struct TracedPiece;

/// Finds ellipses from the arcs of their edges: gradient, its maxima, chains, arcs; then every arc,
/// every pair of arcs that could be of one ellipse and every closed chain is a candidate, fitted
/// from its moments and measured on the edges around its whole perimeter. The probability that
/// these make an ellipse decides.
///
/// Looks at the picture in half its size first, then in a quarter and in full, as long as the
/// evidence leaves a doubt; then what a reduced picture shows is confirmed at the finer sizes. The
/// same ellipse from two sizes is one. What is found on a reduced picture is refined on the full
/// one.
///
/// Allocates nothing in the steady state. The work on one image is bounded: by its pixels, by
/// ArcSplitter::kMaxArcs, and by a fixed number of pairs among the best arcs.
class ArcDetector final : public Detector {
 public:
  explicit ArcDetector(Simd simd = best_simd())
      : maps_{GradientMap(simd), GradientMap(simd), GradientMap(simd)} {}

  [[nodiscard]] std::span<const Detection> detect(const ImageView& luma,
                                                  const Thresholds& thresholds) override;
  [[nodiscard]] bool tells_probability() const override { return true; }
  [[nodiscard]] std::optional<double> log_odds_of(const ImageView& luma,
                                                  const Ellipse& e,
                                                  const Thresholds& thresholds) override;
  [[nodiscard]] Overlaps detecting_overlaps() const override { return {}; }
  [[nodiscard]] Overlaps tracking_overlaps() const override { return {}; }

 private:
  struct Guess {
    Ellipse ellipse;  // [px of the pass]
    Polarity polarity;
    double rms_px;  // of the distances of the edges that it comes from
  };

  struct Found {
    MeasuredEllipse measured;  // [px of the picture]
    int scale;                 // of the pass that it was found in
  };

  void search_scales(const ImageView& luma, const Thresholds& thresholds);
  void search(const ImageView& luma, const Thresholds& thresholds, int scale);
  [[nodiscard]] GradientMap& map_at(int scale) {
    return maps_[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(scale)))];
  }
  void try_single_arcs(const Thresholds& thresholds);
  void try_pairs(const Thresholds& thresholds);
  void try_arcs(std::initializer_list<const Arc*> arcs, const Thresholds& thresholds);
  void try_guess(const Guess& guess,
                 std::span<const TracedPiece> pieces,
                 const Thresholds& thresholds);
  [[nodiscard]] Verdict examine(const Guess& guess,
                                const Thresholds& thresholds,
                                MeasuredEllipse& measured);
  [[nodiscard]] Verdict judge_news(const Guess& guess) const;
  void add(const MeasuredEllipse& measured);
  void use_arcs_on(const Ellipse& e, Polarity polarity);
  [[nodiscard]] bool is_beyond_doubt();
  void confirm_at_finer_scales(const Thresholds& full);
  void refine_at_full_size(const ImageView& luma, const Thresholds& thresholds);
  void report();
  void reject(int candidate, const Verdict& verdict);
  void trace_edges(const ImageView& luma);
  void trace_arcs();

  Scaler scaler_;
  std::array<GradientMap, 3> maps_;  // of the full picture, half and a quarter
  GradientMap* map_ = nullptr;       // of this pass
  ChainTracer chains_;
  ArcSplitter splitter_;
  EllipseVerifier verifier_;
  RingCorrector ring_corrector_;
  std::span<Arc> arcs_;
  std::vector<std::uint8_t> is_used_;  // by an ellipse that was found
  std::vector<Found> found_;
  std::vector<Guess> rejected_;
  std::vector<Detection> detections_;
  std::vector<Polarity> polarities_;  // of the detections
  int scale_ = 1;                     // of this pass
  double min_gradient_ = 0.0;         // of an edge on the full picture
};

}  // namespace ellipse
