#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

#include "core/detection/arcs/arc_pairs.hpp"
#include "core/detection/arcs/arcs.hpp"
#include "core/detection/arcs/ellipse_verifier.hpp"
#include "core/detection/arcs/found_ellipses.hpp"
#include "core/detection/arcs/pyramid.hpp"
#include "core/detection/arcs/ring_corrector.hpp"
#include "core/detection/detector.hpp"
#include "core/edges/chains.hpp"
#include "core/edges/gradient_map.hpp"

namespace ellipse {

struct TracedPiece;

/// Finds ellipses from the arcs of their edges: gradient, gradient maxima, chains, arcs. Candidates
/// are arcs with enough turn, pairs of arcs on one convex curve, and chains that turn by more than
/// half a turn. Each is fitted from its moments and measured on the edges around its whole
/// perimeter; the probability of an ellipse decides. An outline that is unlikely with edges of one
/// polarity is also measured with edges of both.
///
/// Searches at a quarter of the frame's size, then at half, then at full size, and stops early if
/// the best target is certain. Before each finer size it first searches only around the ellipses
/// found so far. If no size gives a certain target, the ellipses found in reduced pictures are
/// judged again at the finer sizes. Merges duplicates across sizes. Refines ellipses from reduced
/// pictures on each finer one.
///
/// Allocates nothing in the steady state. The work on one image is bounded by its pixels, by
/// ArcSplitter::kMaxArcs, and by fixed numbers of fitted and of measured pairs. A search
/// for a target accepts at most 50 ellipses of single arcs in each pass.
class ArcDetector final : public Detector {
 public:
  explicit ArcDetector(Simd simd = best_simd()) : pyramid_(simd) {}

  [[nodiscard]] std::span<const Detection> detect(const Picture& picture,
                                                  const Thresholds& thresholds) override;
  [[nodiscard]] bool has_probability() const override { return true; }
  [[nodiscard]] std::optional<double> log_odds_of(const Picture& picture,
                                                  const Ellipse& e,
                                                  const Thresholds& thresholds) override;
  [[nodiscard]] Overlaps detecting_overlaps() const override { return {}; }
  [[nodiscard]] Overlaps tracking_overlaps() const override { return {}; }

 private:
  struct Guess {
    Ellipse ellipse;  // [px of the pass]
    Polarity polarity;
    double rms_px;  // RMS distance of the points of its arcs
  };

  void search_scales(const Thresholds& thresholds);
  [[nodiscard]] Rect region_of_found(int scale) const;
  void search(int scale, const Rect& region, const Thresholds& full);
  void try_single_arcs(const Thresholds& thresholds);
  void try_pairs(const Thresholds& thresholds);
  void try_arcs(std::initializer_list<const Arc*> arcs, const Thresholds& thresholds);
  void try_guess(const Guess& guess,
                 std::span<const TracedPiece> pieces,
                 const Thresholds& thresholds);
  [[nodiscard]] bool is_cut(const Ellipse& in_pass) const;
  [[nodiscard]] Verdict examine(const Guess& guess,
                                const Thresholds& thresholds,
                                MeasuredEllipse& measured);
  [[nodiscard]] Verdict check_duplicate(const Guess& guess) const;
  void add(const MeasuredEllipse& measured);
  void use_arcs_on(const Ellipse& e, Polarity polarity);
  [[nodiscard]] bool has_certain_target(int scale, const Thresholds& thresholds);
  void find_edges(int scale, const Thresholds& thresholds);
  [[nodiscard]] std::optional<MeasuredEllipse> judged_at(int scale,
                                                         const Ellipse& e,
                                                         const Thresholds& thresholds);
  [[nodiscard]] double confirmed_log_odds(const FoundEllipse& found, const Thresholds& thresholds);
  void confirm_at_finer_scales(const Thresholds& full);
  void refine_at_finer_scales(const Thresholds& thresholds);
  void refine(int scale, MeasuredEllipse& measured) const;
  void report(double min_probability);
  // Of the searched region [px of the whole reduced picture].
  [[nodiscard]] Eigen::Vector2i origin_in_pass() const {
    return {region_.x / scale_, region_.y / scale_};
  }
  void trace_edges();
  void trace_arcs();

  Pyramid pyramid_;
  GradientMap* map_ = nullptr;  // of this pass
  ChainTracer chains_;
  ArcSplitter splitter_;
  ArcPairs pairs_;
  EllipseVerifier verifier_;
  RingCorrector ring_corrector_;
  std::span<Arc> arcs_;
  std::vector<std::uint8_t> is_used_;  // per arc: whether it lies on a found ellipse
  FoundEllipses found_;
  std::vector<Guess> rejected_;
  std::vector<Detection> detections_;
  std::vector<Polarity> polarities_;  // of the detections
  Rect region_;                       // of this pass
  int scale_ = 1;                     // of this pass
  double min_gradient_ = 0.0;         // smallest of an edge on the full picture
};

}  // namespace ellipse
