#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "core/tracking/tracker.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/distorted_frame.hpp"

namespace evaluate {

/// Outcome of a frame, [Keipour2021] III.A.
enum class Outcome {
  kTruePositive,   ///< The target was found.
  kTrueNegative,   ///< No answer, and there is no target.
  kFalsePositive,  ///< An answer, but there is no target.
  kFalseNegative,  ///< No answer, but the target is visible.
  kWrong,          ///< A wrong answer, and the target is visible.
  kNotJudged,      ///< Not labelled, initialized with the truth, or too little visible to judge.
};
inline constexpr int kOutcomes = 6;
inline constexpr std::array<const char*, kOutcomes> kOutcomeNames = {
    "TP", "TN", "FP", "FN", "WD", "not judged"};

/// Criterion of a right answer.
enum class Rule {
  kIou,        ///< Intersection over union inside the frame >= 0.8.
  kPublished,  ///< Centre error within 10 % of the smaller full axis, each axis within 10 %.
};

/// Minimum intersection over union of a match [Rule::kIou].
inline constexpr double kMinIou = 0.8;

/// The value of a measure that has none, e.g. a share of no frames.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A target with less of its perimeter inside the frame may be missed.
inline constexpr double kMinVisible = 0.3;

/// A target with at least this much of its perimeter inside the frame can be tracked from there on.
inline constexpr double kMinToStart = 0.5;

struct FrameSize {
  int width = 0;
  int height = 0;
  const DistortedFrame* distortion = nullptr;  ///< nullptr for a pinhole camera. Borrowed.
};

/// Fraction of the perimeter inside the frame, 0 to 1.
[[nodiscard]] double visible_part(const TrueEllipse& ellipse, const FrameSize& frame);

/// Of the target; 0 if there is none.
[[nodiscard]] double visible_part(const Truth& truth, const FrameSize& frame);

/// Whether any part of an ellipse is inside the frame, its perimeter or only its interior.
[[nodiscard]] bool is_in_view(const TrueEllipse& ellipse, const FrameSize& frame);

/// Whether any true ellipse is in view.
[[nodiscard]] bool is_in_view(const Truth& truth, const FrameSize& frame);

/// Intersection over union inside the frame.
[[nodiscard]] double iou_of(const ellipse::Ellipse& answer,
                            const ellipse::Ellipse& truth,
                            const FrameSize& frame);

[[nodiscard]] bool is_right(const ellipse::Ellipse& answer,
                            const ellipse::Ellipse& truth,
                            const FrameSize& frame,
                            Rule rule);

/// The true ellipse that the answer matches; of several, the one with the nearest centre. nullopt
/// if it matches none. An ellipse without perimeter in the frame never matches, because any larger
/// one overlaps it.
[[nodiscard]] std::optional<ellipse::Ellipse> matched_ellipse(const ellipse::Ellipse& answer,
                                                              const Truth& truth,
                                                              const FrameSize& frame,
                                                              Rule rule);

/// An answer that matches any of the true ellipses is right. No answer is a miss unless all of them
/// are hardly visible.
[[nodiscard]] Outcome judge(const std::optional<ellipse::Ellipse>& answer,
                            const Truth& truth,
                            const FrameSize& frame,
                            Rule rule);

/// Condition of an ellipse::Tracker after a frame. Peers' detectors run in one, too.
struct TrackerReport {
  ellipse::TrackerState state = ellipse::TrackerState::kSearching;
  std::optional<double> probability;  ///< Of the target.
};

/// Measurements of one frame.
struct Result {
  Outcome outcome = Outcome::kNotJudged;
  double processing_ms = 0.0;
  double reference_ms = 0.0;     ///< Duration of cv::Canny and cv::findContours on the same frame.
  double centre_error_px = 0.0;  ///< Defined for kTruePositive.
  int scale = 1;                 ///< Frame scale of the answer.
  std::optional<ellipse::Ellipse> answer;
  std::optional<TrackerReport> tracker = {};
  bool is_given = false;  ///< The answer is the truth that initialized the method.
};

/// Accumulated results.
class Measures {
 public:
  static constexpr int kScales = 8;  ///< Frame scales 1, 2, 4, ... 128.

  void add(const Result& result);

  [[nodiscard]] int count(Outcome outcome) const;
  [[nodiscard]] int judged() const;
  [[nodiscard]] int frames() const;  ///< All frames, judged or not.

  /// [Keipour2021] III.A; NaN if nothing was counted.
  [[nodiscard]] double accuracy() const;
  [[nodiscard]] double precision() const;
  [[nodiscard]] double recall() const;
  [[nodiscard]] double f1() const;

  /// Processing times [ms] of frames with one outcome, and of all.
  [[nodiscard]] const std::vector<double>& times_ms(Outcome outcome) const;
  [[nodiscard]] std::vector<double> all_times_ms() const;
  [[nodiscard]] const std::vector<double>& reference_times_ms() const { return reference_ms_; }

  /// Centre errors [px] of right answers found at a frame scale of 2^k.
  [[nodiscard]] const std::vector<double>& centre_errors_px(int log2_scale) const;
  [[nodiscard]] std::vector<double> all_centre_errors_px() const;

 private:
  std::array<int, kOutcomes> counts_{};
  std::array<std::vector<double>, kOutcomes> times_ms_;  // of the frames with a measured time
  std::array<std::vector<double>, kScales> centre_errors_px_;
  std::vector<double> reference_ms_;
};

/// The q-quantile (0 to 1) of unsorted values; NaN if there are none.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace evaluate
