#pragma once  // SPDX-License-Identifier: MIT

#include <string>

namespace ellipse {

/// Why a candidate is rejected, or why a detection is not the target.
enum class Reason {
  kAccepted,
  // The tests of [Keipour2021] Algorithm 1.
  kContourTooShort,  ///< Below minContourSize.
  kNoEllipse,        ///< No ellipse goes through its points.
  kTooSmall,         ///< Minor axis below mnAxSize.
  kTooLarge,         ///< Major axis above mxAxSize.
  kTooFlat,          ///< Above maxAxisRatio.
  kContourOverlap,   ///< Eq. (1) too low.
  kEllipseOverlap,   ///< Eq. (2) too low.
  kKnown,            ///< Duplicates an ellipse found before, or found better at another scale.
  kCrowdedOut,       ///< Dropped for better ones: too many detections.
  // Further tests of the arc detector.
  kPoorFit,              ///< RMS distance of its arcs from the ellipse too large.
  kFarOutside,           ///< Its centre is more than one picture size outside.
  kCut,                  ///< Reaches beyond the searched region; judged again in the whole picture.
  kDuplicateOfRejected,  ///< Duplicates a candidate rejected before.
  kTooFewEdges,          ///< Too few edges match its outline.
  kUnlikely,             ///< Probability of an ellipse too low.
  // The tests of SelectTarget, [Keipour2021] Algorithm 3.
  kTooFarFromLast,  ///< Too far from the last target.
  kOtherSize,       ///< Size differs too much from the last target's.
  kSingle,          ///< Single, while another set has two edges; II.4.
  kWeakerSet,       ///< Its concentric set has less evidence than another.
  kWeakInSet,       ///< Score too low compared to the best of its set.
  kInnerEdge,       ///< An edge inside the target's.
  kSameEdge,        ///< A second fit to the target's edge, with a lower score.
};

/// Result of a test.
struct Verdict {
  Reason reason = Reason::kAccepted;
  double measured = 0.0;  ///< In the unit of ReasonInfo; 0 if nothing is measured.
  double limit = 0.0;     ///< The bound that `measured` violates, in the same unit.

  [[nodiscard]] bool is_accepted() const { return reason == Reason::kAccepted; }
  bool operator==(const Verdict&) const = default;
};

/// Accepts if measured >= limit, else rejects for `reason`, also NaN.
[[nodiscard]] inline Verdict at_least(Reason reason, double measured, double limit) {
  return measured >= limit ? Verdict{} : Verdict{reason, measured, limit};
}

/// Accepts if measured <= limit, else rejects for `reason`, also NaN.
[[nodiscard]] inline Verdict at_most(Reason reason, double measured, double limit) {
  return measured <= limit ? Verdict{} : Verdict{reason, measured, limit};
}

/// Texts of a reason for display.
struct ReasonInfo {
  const char* nick;         ///< In kebab-case.
  const char* description;  ///< A clause, without a full stop.
  const char* quantity;     ///< Name of the measured value, or empty.
  const char* unit;         ///< "px" or empty.
  /// Name in setting_infos() of the setting for the limit, without "detect-" or "track-"; or
  /// empty.
  const char* setting;
};

/// Static lifetime; thread-safe.
[[nodiscard]] const ReasonInfo& reason_info(Reason reason);

/// A verdict in words: "too flat: axis ratio 6.1, at most 5".
[[nodiscard]] std::string to_text(const Verdict& verdict);

}  // namespace ellipse
