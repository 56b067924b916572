#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>
#include <vector>

#include "examples/evaluate/tables.hpp"
#include "examples/landing/landing.hpp"

namespace landing {

struct Landing {
  Flight flight;
  Outcome outcome;
};

/// Maximum distance from the pad's centre of a successful landing [m].
inline constexpr double kMaxOff = 0.3;

/// Outcomes of the landings by method and speed.
[[nodiscard]] evaluate::Table outcome_table(const std::vector<Landing>& landings);

/// Pictures without a target, by phase.
[[nodiscard]] evaluate::Table unseen_table(const std::vector<Landing>& landings);

/// Writes report.md, landings.csv and the plots touchdown.svg, errors.svg and flight.svg (each also
/// as .png) to a folder. Throws std::runtime_error if that fails.
void write_report(const std::vector<Landing>& landings,
                  const std::string& command,
                  const std::filesystem::path& folder);

}  // namespace landing
