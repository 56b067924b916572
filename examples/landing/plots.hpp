#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <vector>

namespace landing {

struct Landing;

// gnuplot draws each plot as FILE.svg and FILE.png. All functions throw std::runtime_error if it
// fails.

/// Touchdown positions on the pad.
void plot_touchdowns(const std::vector<Landing>& landings, const std::filesystem::path& file);

/// Cumulative fraction of landings by distance from the centre.
void plot_errors(const std::vector<Landing>& landings, const std::filesystem::path& file);

/// Height and distance of one landing over time, with its phases.
void plot_flight(const Landing& landing, const std::filesystem::path& file);

}  // namespace landing
