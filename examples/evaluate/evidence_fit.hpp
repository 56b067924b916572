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

/// A candidate of the detector `arcs`, and whether it is an ellipse of the truth.
struct LabelledCandidate {
  std::size_t source = 0;
  std::size_t frame = 0;
  ellipse::Ellipse ellipse;
  ellipse::Features features{};
  bool is_right = false;
};

/// Candidates that were told about the same probability.
struct CalibrationBin {
  int candidates = 0;
  double weight = 0.0;       ///< Each source weighs 1 in all.
  double probability = 0.0;  ///< Mean of what they were told, weighted.
  double right = 0.0;        ///< Share of them that are right, weighted.
};

/// Whether probabilities are what they say.
struct Calibration {
  std::array<CalibrationBin, 10> bins;  ///< By tenths.
  double log_loss = 0.0;                ///< Mean of -ln of what the truth was told, weighted.
};

/// Fits the table by which the detector `arcs` decides, by logistic regression on labelled frames.
///
/// A candidate is right where its intersection over union with a true ellipse is .85 and more, and
/// wrong below .6; what is between the two, or concentric with a true ellipse, does not count. Each
/// source weighs alike, its right and its wrong candidates too. Most wrong candidates are far from
/// any doubt: the table is fitted to all, then twice to the wrong ones of each frame that it
/// finds most probable.
class EvidenceFitter : public Chooser {
 public:
  /// Runs the detector on all frames that are labelled.
  /// @param settings  What the choice is made of, but for the table.
  /// @param advance   Called after each frame; false ends it early.
  EvidenceFitter(const ellipse::TrackerSettings& settings,
                 const std::vector<Sequence>& sequences,
                 const std::function<bool(const Frame&)>& advance);

  /// Throws std::invalid_argument where the sources have no right or no wrong candidate.
  [[nodiscard]] Choice choose(const std::vector<std::string>& sources) override;

  /// From all sources.
  [[nodiscard]] ellipse::EvidenceTable fit_all() const;

  /// Judges the candidates of each group by the table of the others. Of candidates of a frame that
  /// are the same ellipse the most probable one counts.
  [[nodiscard]] Calibration left_out_calibration(const SourceGroups& groups) const;

  /// Each names a frame that was left out, and why.
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
