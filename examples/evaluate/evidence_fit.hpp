#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/detection/evidence.hpp"
#include "examples/evaluate/chooser.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/source_groups.hpp"
#include "examples/evaluate/tables.hpp"

namespace evaluate {

/// A candidate of the detector `arcs`, labelled whether it is a true ellipse.
struct LabelledCandidate {
  std::size_t source = 0;
  std::size_t frame = 0;
  ellipse::Ellipse ellipse;
  ellipse::Features features{};
  bool is_right = false;
};

/// Candidates with similar predicted probability.
struct CalibrationBin {
  int candidates = 0;
  double probability = 0.0;  ///< Mean of the predicted probability.
  double right = 0.0;        ///< Fraction of right candidates.
};

/// Agreement of predicted probabilities with observed frequencies.
struct Calibration {
  std::array<CalibrationBin, 10> bins;  ///< Tenths of the probability.
  /// Mean of -ln of the probability predicted for the true label. All sources have equal weight.
  double log_loss = 0.0;
};

/// Fits the evidence table of the detector `arcs` by logistic regression on labelled frames.
///
/// A candidate is right if its intersection over union with a true ellipse is at least .85, and
/// wrong below .6. Candidates in between, or concentric with a true ellipse, are not used, nor are
/// wrong ones of a frame with an incomplete truth. Sources with at least 100 candidates have equal
/// weight; so have the right and the wrong candidates of a source. Most wrong candidates are easy
/// to reject. After the first fit, the table is therefore fitted twice more, to all right
/// candidates and the most probable wrong ones of each frame.
class EvidenceFitter : public Chooser {
 public:
  /// Runs the detector on all labelled frames.
  /// @param settings  Base settings of the choice; only the table is replaced.
  /// @param advance   Called after each frame; returning false stops early.
  EvidenceFitter(const ellipse::TrackerSettings& settings,
                 const std::vector<Sequence>& sequences,
                 const std::function<bool(const Frame&)>& advance);

  /// Throws std::invalid_argument if the sources have no right or no wrong candidate.
  [[nodiscard]] Choice choose(const std::vector<std::string>& sources) override;

  /// Fits to all sources.
  [[nodiscard]] ellipse::EvidenceTable fit_all() const;

  /// Evaluates each group's candidates with a table fitted to the other groups. Of a frame's
  /// candidates that are the same ellipse, only the most probable one counts.
  [[nodiscard]] Calibration left_out_calibration(const SourceGroups& groups) const;

  /// One message per skipped frame, with the reason.
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  void add(const Frame& frame, const Sequence& sequence, std::size_t source);
  [[nodiscard]] ellipse::EvidenceTable fit(const std::vector<std::string>& sources) const;
  [[nodiscard]] std::vector<const LabelledCandidate*> distinct(
      std::size_t source, const ellipse::EvidenceTable& table) const;

  ellipse::TrackerSettings settings_;
  std::vector<std::string> sources_;
  std::vector<LabelledCandidate> candidates_;
  std::size_t frames_ = 0;
  std::vector<std::string> problems_;
};

[[nodiscard]] Table calibration_table(const Calibration& calibration);

}  // namespace evaluate
