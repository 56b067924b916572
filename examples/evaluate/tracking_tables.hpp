#pragma once  // SPDX-License-Identifier: MIT

#include <iosfwd>
#include <string>

#include "examples/evaluate/tables.hpp"
#include "examples/evaluate/tracking.hpp"

namespace evaluate {

/// Results of each method on one data set, by the visible fraction of the target.
[[nodiscard]] Table visibility_table(const Evaluation& evaluation, const std::string& dataset);

/// Tracking results of each method on one data set: false and wrong targets, time to recover after
/// a return, processing times, centre error.
[[nodiscard]] Table following_table(const Evaluation& evaluation, const std::string& dataset);

/// The same results as members of a JSON object.
void write_json_tracking(std::ostream& out, const TrackingMeasures& measures);

}  // namespace evaluate
