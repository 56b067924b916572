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

/// The distance from the pad's centre within which a landing is right [m].
inline constexpr double kMaxOff = 0.3;

/// How the landings of each method at each speed ended.
[[nodiscard]] evaluate::Table outcome_table(const std::vector<Landing>& landings);

/// The pictures without a target, by what the vehicle was about.
[[nodiscard]] evaluate::Table unseen_table(const std::vector<Landing>& landings);

/// Writes report.md, landings.csv and the plots touchdown.svg, errors.svg and flight.svg, each also
/// as .png, into a folder. Throws std::runtime_error where that fails.
void write_report(const std::vector<Landing>& landings,
                  const std::string& command,
                  const std::filesystem::path& folder);

}  // namespace landing
