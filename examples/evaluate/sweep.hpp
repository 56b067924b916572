#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "core/tracking/settings.hpp"
#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/tables.hpp"

namespace evaluate {

/// One property with several values: the sensitivity studies of [Keipour2021] Figures 3 and 4.
struct Sweep {
  std::string property;
  std::vector<std::string> values;
};

/// Parses "property=from:to:step" (both ends inclusive) or "property=value,value,...", where a
/// value may be a nick. Throws std::invalid_argument that describes the error.
[[nodiscard]] Sweep parse_sweep(const std::string& text);

/// One method per value. Throws std::invalid_argument if the property is unknown or rejects a
/// value.
[[nodiscard]] std::vector<std::unique_ptr<Method>> methods_of(
    const Sweep& sweep, const ellipse::TrackerSettings& settings);

/// One row per value: measures, counts and times over all data sets.
[[nodiscard]] Table sweep_table(const Sweep& sweep, const Evaluation& evaluation);

/// Writes PROPERTY.csv, PROPERTY.svg and PROPERTY.png with the paper's four panels.
void write_sweep(const Sweep& sweep,
                 const Evaluation& evaluation,
                 const std::filesystem::path& folder);

}  // namespace evaluate
