#pragma once  // SPDX-License-Identifier: MIT

#include <functional>
#include <string>
#include <vector>

#include "examples/evaluate/chooser.hpp"
#include "examples/evaluate/source_groups.hpp"
#include "examples/evaluate/source_results.hpp"
#include "examples/evaluate/tables.hpp"

namespace evaluate {

/// Performance of a choice on one source.
struct JudgedChoice {
  std::string name;
  SourceGrade grade;  ///< The difference is relative to the base settings.
};

/// Three evaluations of one source in the same run.
struct LeftOut {
  std::string source;
  std::string group;
  int frames = 0;
  double unchosen = 0.0;   ///< Grade of the base settings.
  JudgedChoice left_out;   ///< Chosen on the sources of all other groups.
  JudgedChoice in_sample;  ///< Chosen on all sources including this one.
};

/// For each source: chooses settings on the sources of other groups and evaluates them on this
/// source.
/// @param settings  Base settings.
/// @param advance   Called after each frame; returning false stops early.
/// @return One entry per source; fewer if stopped early.
///
/// Throws std::invalid_argument if all sources belong to one group.
[[nodiscard]] std::vector<LeftOut> leave_one_out(const std::vector<Sequence>& sequences,
                                                 const SourceGroups& groups,
                                                 Chooser& chooser,
                                                 const ellipse::TrackerSettings& settings,
                                                 Rule rule,
                                                 const std::function<bool(const Frame&)>& advance);

/// Results on sources that the choice has not seen.
[[nodiscard]] Table left_out_table(const std::string& method, const std::vector<LeftOut>& results);

/// Results on sources that the choice was made on.
[[nodiscard]] Table in_sample_table(const std::string& method, const std::vector<LeftOut>& results);

}  // namespace evaluate
