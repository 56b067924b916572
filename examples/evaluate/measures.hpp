#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <optional>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/distorted_frame.hpp"

namespace evaluate {

/// What became of a frame, [Keipour2021] III.A.
enum class Outcome {
  kTruePositive,   ///< The right target.
  kTrueNegative,   ///< None, and there is none.
  kFalsePositive,  ///< One, though there is none.
  kFalseNegative,  ///< None, though the target is visible.
  kWrong,          ///< Another one, though the target is visible.
  kNotJudged,      ///< Not labelled, told, or too little visible to tell that it is right.
};
inline constexpr int kOutcomes = 6;
inline constexpr std::array<const char*, kOutcomes> kOutcomeNames = {
    "TP", "TN", "FP", "FN", "WD", "not judged"};

/// When an answer is right.
enum class Rule {
  kIou,        ///< Intersection over union inside the frame >= 0.8.
  kPublished,  ///< Centre within 10 % of the smaller full axis, each axis within 10 %.
};

/// Answers match from this intersection over union on [Rule::kIou].
inline constexpr double kMinIou = 0.8;

/// A target with less of its perimeter than this inside the frame may go unseen.
inline constexpr double kMinVisible = 0.3;

/// A target with this much of its perimeter inside the frame can be followed from there on.
inline constexpr double kMinToStart = 0.5;

struct FrameSize {
  int width = 0;
  int height = 0;
  const DistortedFrame* distortion = nullptr;  ///< Where a lens distorts it. Borrowed.
};

/// Share of the perimeter inside the frame, 0 to 1.
[[nodiscard]] double visible_part(const TrueEllipse& ellipse, const FrameSize& frame);

/// Of the target; 0 where there is no target.
[[nodiscard]] double visible_part(const Truth& truth, const FrameSize& frame);

/// Whether the frame shows anything of an ellipse: a part of its perimeter, or its inside alone.
[[nodiscard]] bool is_in_view(const TrueEllipse& ellipse, const FrameSize& frame);

/// Whether that holds for one of the true ellipses.
[[nodiscard]] bool is_in_view(const Truth& truth, const FrameSize& frame);

/// Intersection over union inside the frame.
[[nodiscard]] double iou_of(const ellipse::Ellipse& answer,
                            const ellipse::Ellipse& truth,
                            const FrameSize& frame);

[[nodiscard]] bool is_right(const ellipse::Ellipse& answer,
                            const ellipse::Ellipse& truth,
                            const FrameSize& frame,
                            Rule rule);

/// The true ellipse for which an answer is right, the one with the nearest centre where there are
/// several; nullopt where it is right for none. An ellipse without any perimeter in the frame
/// matches nothing: whatever is larger overlaps it.
[[nodiscard]] std::optional<ellipse::Ellipse> matched_ellipse(const ellipse::Ellipse& answer,
                                                              const Truth& truth,
                                                              const FrameSize& frame,
                                                              Rule rule);

/// Where the truth has several ellipses, an answer that matches any of them is right, and a miss
/// counts unless all of them are hardly visible.
[[nodiscard]] Outcome judge(const std::optional<ellipse::Ellipse>& answer,
                            const Truth& truth,
                            const FrameSize& frame,
                            Rule rule);

/// What was measured on one frame.
struct Result {
  Outcome outcome = Outcome::kNotJudged;
  double processing_ms = 0.0;
  double reference_ms = 0.0;     ///< Edges and contours alone, on the same frame.
  double centre_error_px = 0.0;  ///< Where the outcome is kTruePositive.
  int scale = 1;                 ///< Frame scale at which the answer was found.
  std::optional<ellipse::Ellipse> answer;
  bool is_given = false;  ///< The answer is the truth that the method was told.
};

/// The results of many frames.
class Measures {
 public:
  static constexpr int kScales = 8;  ///< 1, 2, 4, ... 128

  void add(const Result& result);

  [[nodiscard]] int count(Outcome outcome) const;
  [[nodiscard]] int judged() const;
  [[nodiscard]] int frames() const;  ///< Judged or not.

  /// [Keipour2021] III.A; NaN where nothing was counted.
  [[nodiscard]] double accuracy() const;
  [[nodiscard]] double precision() const;
  [[nodiscard]] double recall() const;
  [[nodiscard]] double f1() const;

  /// Processing times [ms] of the frames with one outcome, and of all.
  [[nodiscard]] const std::vector<double>& times_ms(Outcome outcome) const;
  [[nodiscard]] std::vector<double> all_times_ms() const;
  [[nodiscard]] const std::vector<double>& reference_times_ms() const { return reference_ms_; }

  /// Distances of the centre to the truth [px] of right answers found at a frame scale of 2^k.
  [[nodiscard]] const std::vector<double>& centre_errors_px(int log2_scale) const;
  [[nodiscard]] std::vector<double> all_centre_errors_px() const;

 private:
  std::array<int, kOutcomes> counts_{};
  std::array<std::vector<double>, kOutcomes> times_ms_;  // of the frames that were answered
  std::array<std::vector<double>, kScales> centre_errors_px_;
  std::vector<double> reference_ms_;
};

/// The q-quantile (0 to 1) of unsorted values; NaN where there are none.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace evaluate
