#pragma once  // SPDX-License-Identifier: MIT

#include <iosfwd>
#include <string>

#include "examples/evaluate/tables.hpp"
#include "examples/evaluate/tracking.hpp"

namespace evaluate {

/// What each method makes of the frames of one data set, by how much of the target they show.
[[nodiscard]] Table visibility_table(const Evaluation& evaluation, const std::string& dataset);

/// How each method follows through one data set: targets where there are none, wrong ones, how soon
/// it is right when the target comes back, times, the error of the centre.
[[nodiscard]] Table following_table(const Evaluation& evaluation, const std::string& dataset);

/// The same figures for programs, as members of a JSON object.
void write_json_tracking(std::ostream& out, const TrackingMeasures& measures);

}  // namespace evaluate
