#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>

#include "core/camera/picture.hpp"
#include "core/detection/evidence.hpp"
#include "core/detection/thresholds.hpp"
#include "core/detection/verdict.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

class DetectionTrace;

/// Coarsest scale of `arcs`, and of the periodic search while a target is certain.
inline constexpr int kCoarsestScale = 4;

/// An ellipse that passed every test of a detector.
struct Detection {
  Ellipse ellipse;               ///< In the ideal plane of the searched picture [px].
  double contour_overlap = 0.0;  ///< [Keipour2021] Eq. (1).
  double ellipse_overlap = 0.0;  ///< [Keipour2021] Eq. (2).
  double score = 0.0;            ///< Strength of evidence; comparable within one detector only.
  double probability = 1.0;      ///< Of being an ellipse; 1 if the detector has none.
  int candidate = -1;            ///< Index in a DetectionTrace; -1 without one.
  Verdict as_target = {};        ///< Why it cannot be the target, independent of others.
};

/// The two thresholds of an ellipse's fit; [Keipour2021] Table I.
struct Overlaps {
  double contour = 0.0;  ///< ContourOverlap, 0 to 1.
  double ellipse = 0.0;  ///< EllipseOverlap, 0 to 1.

  /// Replaces zeros by the detector's own overlaps.
  [[nodiscard]] Overlaps or_own(const Overlaps& own) const {
    return {contour > 0.0 ? contour : own.contour, ellipse > 0.0 ? ellipse : own.ellipse};
  }
  bool operator==(const Overlaps&) const = default;
};

/// Finds all ellipses of a picture: DetectEllipses of [Keipour2021] Algorithm 1.
class Detector {
 public:
  virtual ~Detector() = default;

  /// @param picture     Any size, also empty. Borrowed for the call only.
  /// @param thresholds  In their ranges, as TrackerSettings::validate() checks; lengths may be
  ///                    smaller by the scale, see Thresholds::at_scale().
  /// @return Every ellipse found, in no particular order. Valid until the next call.
  ///
  /// No content of the picture throws. Deterministic. One object serves one thread at a time.
  [[nodiscard]] virtual std::span<const Detection> detect(const Picture& picture,
                                                          const Thresholds& thresholds) = 0;

  /// Whether the detector computes Detection::probability and applies min_probability.
  [[nodiscard]] virtual bool has_probability() const { return false; }

  /// Log odds that the outline `e` of this picture is an ellipse, by the same evidence as detect();
  /// nullopt if the detector cannot compute them, -infinity if the edges do not support the outline
  /// at all. Cheaper than detect(): no search.
  ///
  /// @param e           The outline, as Detection::ellipse.
  /// @param thresholds  Only the edge and overlap thresholds apply.
  [[nodiscard]] virtual std::optional<double> log_odds_of(const Picture& /*picture*/,
                                                          const Ellipse& /*e*/,
                                                          const Thresholds& /*thresholds*/) {
    return std::nullopt;
  }

  /// The detector's default thresholds without a tracked target.
  [[nodiscard]] virtual Overlaps detecting_overlaps() const = 0;
  /// The lower defaults for the region around a tracked target.
  [[nodiscard]] virtual Overlaps tracking_overlaps() const = 0;

  /// Records the stages and verdicts of later detect() calls; nullptr = off. The detections stay
  /// bit-identical. Borrowed.
  void set_trace(DetectionTrace* trace) { trace_ = trace; }

  /// Sets the evidence table of later calls, if the detector computes probabilities.
  void set_evidence(const EvidenceTable& table) { evidence_ = table; }

 protected:
  DetectionTrace* trace_ = nullptr;
  EvidenceTable evidence_ = built_in_evidence();
};

}  // namespace ellipse
