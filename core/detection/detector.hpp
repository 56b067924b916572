#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>

#include "core/camera/lens_view.hpp"
#include "core/detection/evidence.hpp"
#include "core/detection/thresholds.hpp"
#include "core/detection/verdict.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

class DetectionTrace;

/// An ellipse that passed every test of a detector.
struct Detection {
  Ellipse ellipse;               ///< [px] of the picture that was searched, in its ideal plane.
  double contour_overlap = 0.0;  ///< [Keipour2021] Eq. (1).
  double ellipse_overlap = 0.0;  ///< [Keipour2021] Eq. (2).
  double score = 0.0;            ///< Evidence for it; comparable within one detector only.
  double probability = 1.0;      ///< That it is an ellipse; 1 where a detector does not say.
  int candidate = -1;            ///< Its number in a DetectionTrace; -1 without one.
  Verdict as_target = {};        ///< Why it is not the target, whatever else is there.
};

/// The two thresholds that say how well an ellipse must fit; [Keipour2021] Table I.
struct Overlaps {
  double contour = 0.0;  ///< ContourOverlap, 0 to 1.
  double ellipse = 0.0;  ///< EllipseOverlap, 0 to 1.

  bool operator==(const Overlaps&) const = default;
};

/// Finds all ellipses of a picture: DetectEllipses of [Keipour2021] Algorithm 1.
class Detector {
 public:
  virtual ~Detector() = default;

  /// @param luma        Any size, also empty. Borrowed for the call only.
  /// @param thresholds  Valid ones; see Thresholds::validate().
  /// @return Every ellipse found, in no particular order. Valid until the next call.
  ///
  /// No content of the picture throws. Deterministic. One object serves one thread at a time.
  [[nodiscard]] virtual std::span<const Detection> detect(const ImageView& luma,
                                                          const Thresholds& thresholds) = 0;

  /// Whether Detection::probability means something, so that min_probability acts.
  [[nodiscard]] virtual bool tells_probability() const { return false; }

  /// Log odds that an outline of this picture is an ellipse, by the evidence that detect() decides
  /// by; nullopt where a detector does not say. Cheaper than detect(): nothing else is looked for.
  ///
  /// @param e           The outline, as Detection::ellipse.
  /// @param thresholds  Of edges and overlaps; the limits of size and probability do not count.
  [[nodiscard]] virtual std::optional<double> log_odds_of(const ImageView& /*luma*/,
                                                          const Ellipse& /*e*/,
                                                          const Thresholds& /*thresholds*/) {
    return std::nullopt;
  }

  /// The detector's own thresholds where nothing is known of the target.
  [[nodiscard]] virtual Overlaps detecting_overlaps() const = 0;
  /// The lowered ones, for the surroundings of a target that is being tracked.
  [[nodiscard]] virtual Overlaps tracking_overlaps() const = 0;

  /// Every call of detect() from now on tells there what it sees, and why it refuses what it
  /// refuses; nullptr = no more. The detections stay the same to the bit. Borrowed.
  void set_trace(DetectionTrace* trace) { trace_ = trace; }

  /// Through what lens every picture from now on is seen; none by default.
  void set_lens(const LensView& lens) { lens_ = lens; }

  /// By what evidence is judged from now on, where the detector gives a probability.
  void set_evidence(const EvidenceTable& table) { evidence_ = table; }

 protected:
  DetectionTrace* trace_ = nullptr;
  EvidenceTable evidence_ = built_in_evidence();
  LensView lens_;
};

}  // namespace ellipse
