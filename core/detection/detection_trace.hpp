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

/// Points in a row: [begin, end) of TracedPass::points.
struct TracedPiece {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// One look of a detector at a picture: its stages, in pixels of what was looked at.
struct TracedPass {
  Rect region;            ///< What was looked at [px of the frame]; `scale` times as large.
  int scale = 1;          ///< Pixels of the frame in one of the pass, each way.
  int width = 0;          ///< [px]
  int height = 0;         ///< [px]
  double edge_low = 0.0;  ///< The thresholds of edges as they were used [grey levels / px].
  double edge_high = 0.0;
  std::vector<std::uint8_t> luma;   ///< What was looked at, row by row.
  std::vector<std::uint8_t> edges;  ///< The same size: 255 on a thinned edge, else 0.
  std::vector<TracedPoint> points;
  /// `contours`: the contours. `arcs`: the chains of gradient maxima.
  std::vector<TracedPiece> chains;
  /// `contours`: the parts of contours between their corners, where these were tried. `arcs`: the
  /// best arcs, of which the guesses are made.
  std::vector<TracedPiece> arcs;
};

/// Something that was taken for an ellipse, and what became of it.
struct TracedCandidate {
  std::size_t pass = 0;
  std::vector<TracedPiece> pieces;  ///< What it was made of: one or two chains or arcs of its pass.
  std::optional<Ellipse> ellipse;   ///< As it was judged [px of the frame].
  Verdict verdict;                  ///< Lengths in px of the frame.
  double contour_overlap = 0.0;     ///< [Keipour2021] Eq. (1); of what was found only.
  double ellipse_overlap = 0.0;     ///< [Keipour2021] Eq. (2); of what was found only.
  double score = 0.0;               ///< As in Detection; of what was found only.
  double probability = 0.0;         ///< That it is an ellipse; 0 where nothing was measured.
  Features features{};              ///< What that was computed from.
  Features contributions{};         ///< What each of them adds to the log odds.
  bool is_target = false;           ///< By select_target().
};

/// What a detector saw in one picture, step by step, and why it refused what it refused: for
/// people who calibrate its thresholds, see Detector::set_trace(), Tracker::set_trace().
///
/// The tests themselves write down what they say; none is made a second time. Allocates as it
/// grows. One object serves one thread at a time.
class DetectionTrace {
 public:
  /// The last one is that which the detections come from. `arcs` looks at half the size first.
  [[nodiscard]] std::span<const TracedPass> passes() const { return passes_; }
  [[nodiscard]] std::span<const TracedCandidate> candidates() const { return candidates_; }

  // What follows is for those who detect.

  void clear();
  TracedPass& begin_pass(const ImageView& luma, int scale);
  [[nodiscard]] TracedPass& pass() { return passes_.back(); }

  /// @param ellipse, verdict  In pixels of the pass.
  /// @return The candidate's number.
  int add(std::span<const TracedPiece> pieces,
          const std::optional<Ellipse>& ellipse,
          const Verdict& verdict);
  /// What was measured of it, after it was brought to the edges [px of the picture].
  void measure(int candidate,
               const Ellipse& ellipse,
               const Features& features,
               const EvidenceTable& table);
  /// A later test has the last word, in pixels of the picture. Does nothing for candidate -1.
  void revise(int candidate, const Verdict& verdict);
  /// What is found in the end [px of the picture]; anything else was crowded out.
  void report(std::span<const Detection> detections);
  /// Does nothing for candidate -1.
  void choose(int candidate);
  /// All that is said in pixels of the picture becomes pixels of the frame that it is a region of,
  /// reduced by `scale`; ellipses, found in the ideal plane, are distorted as the frame shows them.
  void place_in_frame(const Rect& region, int scale, const LensView& lens = {});

 private:
  std::vector<TracedPass> passes_;
  std::vector<TracedCandidate> candidates_;
};

}  // namespace ellipse
