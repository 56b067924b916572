#pragma once  // SPDX-License-Identifier: MIT

#include <functional>
#include <string>
#include <vector>

#include "examples/evaluate/chooser.hpp"
#include "examples/evaluate/source_groups.hpp"
#include "examples/evaluate/source_results.hpp"
#include "examples/evaluate/tables.hpp"

namespace evaluate {

/// What a choice is worth on one source.
struct JudgedChoice {
  std::string name;
  SourceGrade grade;  ///< Its difference is from the settings without a choice.
};

/// One source, judged three ways in one run.
struct LeftOut {
  std::string source;
  std::string group;
  int frames = 0;
  double unchosen = 0.0;   ///< Grade of the settings without a choice.
  JudgedChoice left_out;   ///< Chosen on the sources of all other groups.
  JudgedChoice in_sample;  ///< Chosen on all sources, this one among them.
};

/// For each source: chooses on the sources of other groups, and judges on that source.
/// @param settings  Without a choice.
/// @param advance   Called after each frame; false ends it early.
/// @return One entry a source; fewer where it was ended early.
/// Throws std::invalid_argument where all sources are of one group.
[[nodiscard]] std::vector<LeftOut> leave_one_out(const std::vector<Sequence>& sequences,
                                                 const SourceGroups& groups,
                                                 Chooser& chooser,
                                                 const ellipse::TrackerSettings& settings,
                                                 Rule rule,
                                                 const std::function<bool(const Frame&)>& advance);

/// The figures of sources that the choice has not seen.
[[nodiscard]] Table left_out_table(const std::string& method, const std::vector<LeftOut>& results);

/// The figures of sources that the choice was made on.
[[nodiscard]] Table in_sample_table(const std::string& method, const std::vector<LeftOut>& results);

}  // namespace evaluate
