#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <vector>

namespace landing {

struct Landing;

// Each is drawn by gnuplot, as FILE.svg and FILE.png; throws std::runtime_error where that fails.

/// Where the vehicles touched down, on the pad.
void plot_touchdowns(const std::vector<Landing>& landings, const std::filesystem::path& file);

/// The share of landings within a distance from the centre.
void plot_errors(const std::vector<Landing>& landings, const std::filesystem::path& file);

/// Height and distance of one landing over time, by what it was about.
void plot_flight(const Landing& landing, const std::filesystem::path& file);

}  // namespace landing
