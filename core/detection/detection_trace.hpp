#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/detection/detector.hpp"
#include "core/detection/evidence.hpp"
#include "core/detection/verdict.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// A pixel of a pass.
struct TracedPoint {
  int x = 0;
  int y = 0;
};

/// Consecutive points: [begin, end) of TracedPass::points.
struct TracedPiece {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The stages of a detector's pass at one scale, in pixels of the reduced picture.
struct TracedPass {
  /// The part of the frame that luma and edges show [px of the frame]. A pass of `arcs` that is
  /// restricted to a region has edges in that region only.
  Rect region;
  int scale = 1;          ///< Frame pixels per pixel of the pass, in each direction.
  int width = 0;          ///< [px]
  int height = 0;         ///< [px]
  double edge_low = 0.0;  ///< Edge thresholds in use [grey levels / px].
  double edge_high = 0.0;
  std::vector<std::uint8_t> luma;   ///< The input picture, row by row.
  std::vector<std::uint8_t> edges;  ///< The same size: 255 on a thinned edge, else 0.
  std::vector<TracedPoint> points;
  /// `contours`: the contours. `arcs`: the chains of gradient maxima.
  std::vector<TracedPiece> chains;
  /// `contours`: the parts of contours between corners, if these were tried. `arcs`: the best
  /// arcs, which form the candidates.
  std::vector<TracedPiece> arcs;
};

/// A candidate and its verdict.
struct TracedCandidate {
  std::size_t pass = 0;
  std::vector<TracedPiece> pieces;  ///< Its source: one or two chains or arcs of its pass.
  std::optional<Ellipse> ellipse;   ///< The judged ellipse [px of the frame].
  Verdict verdict;                  ///< Lengths in px of the frame.
  double contour_overlap = 0.0;     ///< [Keipour2021] Eq. (1); detections only.
  double ellipse_overlap = 0.0;     ///< [Keipour2021] Eq. (2); detections only.
  double score = 0.0;               ///< As in Detection; detections only.
  double probability = 0.0;         ///< Of being an ellipse; 0 if not measured.
  Features features{};              ///< Inputs of the probability.
  Features contributions{};         ///< Term of each feature in the log odds.
  bool is_detection = false;        ///< Reported by the detector.
  bool is_target = false;           ///< Chosen by select_target().
};

/// Records a detector's stages on one picture and the verdict on each candidate, for calibrating
/// thresholds; see Detector::set_trace(), Tracker::set_trace().
///
/// Holds the verdicts of the detector's own tests; no test runs twice. Allocates as it grows. One
/// object serves one thread at a time.
class DetectionTrace {
 public:
  /// In order of the search. `contours` makes one pass; `arcs` makes one per scale, a quarter of
  /// the size first. Before a finer scale it may make one restricted to the surroundings of the
  /// ellipses found so far.
  [[nodiscard]] std::span<const TracedPass> passes() const { return passes_; }
  [[nodiscard]] std::span<const TracedCandidate> candidates() const { return candidates_; }

  // For detectors and trackers only.

  void clear();
  TracedPass& begin_pass(const ImageView& luma, int scale);
  [[nodiscard]] TracedPass& pass() { return passes_.back(); }

  /// @param ellipse, verdict  In pixels of the pass.
  /// @return The candidate's index.
  int add(std::span<const TracedPiece> pieces,
          const std::optional<Ellipse>& ellipse,
          const Verdict& verdict);
  /// Records the ellipse fitted to the edges [px of the picture], its features and probability.
  void measure(int candidate,
               const Ellipse& ellipse,
               const Features& features,
               const EvidenceTable& table);
  /// Replaces the verdict after a later test [px of the picture]. Does nothing for candidate -1.
  void revise(int candidate, const Verdict& verdict);
  /// Records the final detections [px of the picture]; other accepted ones become kCrowdedOut.
  void report(std::span<const Detection> detections);
  /// Marks the target. Does nothing for candidate -1.
  void choose(int candidate);
  /// Converts all coordinates and lengths from pixels of the picture, a region of the frame reduced
  /// by `scale`, to pixels of the frame. Distorts the ellipses, which are in the ideal plane.
  void to_frame_coordinates(const Rect& region, int scale, const LensView& lens = {});

 private:
  std::vector<TracedPass> passes_;
  std::vector<TracedCandidate> candidates_;
};

}  // namespace ellipse
