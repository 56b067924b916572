#pragma once  // SPDX-License-Identifier: MIT

#include <span>
#include <string>

namespace ellipse {

/// Why an ellipse is not found, or found and not the target.
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
  kKnown,            ///< The same ellipse was found before, or is better seen elsewhere.
  kCrowdedOut,       ///< There are too many, and better ones.
  // Those of the arcs besides.
  kPoorFit,      ///< Its arcs are not of one ellipse.
  kFarOutside,   ///< Its centre is farther from the picture than the picture is large.
  kRefused,      ///< The same was refused before, by as many edges.
  kTooFewEdges,  ///< Along its normals.
  kUnlikely,     ///< Its edges are not those of an ellipse.
  // Those of SelectTarget, [Keipour2021] Algorithm 3.
  kOtherPlace,  ///< Away from where the target was.
  kOtherSize,   ///< Of another size than the target was.
  kSingle,      ///< Alone, while there are concentric ones; II.4.
  kWeakerSet,   ///< Its set has less evidence than another.
  kWeakInSet,   ///< It has little evidence beside others of its set.
  kInnerEdge,   ///< Inside of the target.
  kSameEdge,    ///< The target's edge, from its other side, with less evidence.
};

/// What a test says of an ellipse.
struct Verdict {
  Reason reason = Reason::kAccepted;
  double measured = 0.0;  ///< In the unit of ReasonInfo; 0 where nothing is measured.
  double limit = 0.0;     ///< The setting's value, where a setting changes it.

  [[nodiscard]] bool is_accepted() const { return reason == Reason::kAccepted; }
  bool operator==(const Verdict&) const = default;
};

[[nodiscard]] inline Verdict at_least(Reason reason, double measured, double limit) {
  return measured >= limit ? Verdict{} : Verdict{reason, measured, limit};
}

[[nodiscard]] inline Verdict at_most(Reason reason, double measured, double limit) {
  return measured <= limit ? Verdict{} : Verdict{reason, measured, limit};
}

/// A reason as programs show it to people.
struct ReasonInfo {
  const char* nick;         ///< In kebab-case.
  const char* description;  ///< A clause, without a full stop.
  const char* quantity;     ///< What is measured; empty where nothing is.
  const char* unit;         ///< "px", "rad", "nats", or empty.
  /// The name among setting_infos() that changes the limit, without "detect-" and "track-";
  /// empty where none does.
  const char* setting;
};

/// Valid for ever; thread-safe.
[[nodiscard]] const ReasonInfo& reason_info(Reason reason);

/// All of them, in the order of Reason.
[[nodiscard]] std::span<const ReasonInfo> reason_infos();

/// A verdict in words: "too flat: axis ratio 6.1, at most 5".
[[nodiscard]] std::string to_text(const Verdict& verdict);

}  // namespace ellipse
