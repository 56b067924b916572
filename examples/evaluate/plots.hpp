#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>
#include <vector>

namespace evaluate {

struct Curve {
  std::string title;
  std::vector<double> y;  ///< One value per x; NaN = no point.
};

/// Curves with a common x axis.
struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<double> x;            ///< Either positions,
  std::vector<std::string> ranges;  ///< or names of ranges: grouped bars.
  std::vector<Curve> curves;
  bool is_share = false;  ///< Fractions from 0 to 1.
};

enum class PlotFormat { kSvg, kPng };

/// Runs gnuplot and returns its standard output. Throws std::runtime_error with gnuplot's message
/// if it is not installed or fails.
[[nodiscard]] std::string run_gnuplot(const std::string& script);

/// Draws panels in rows of two by run_gnuplot().
[[nodiscard]] std::string plot(const std::vector<Panel>& panels, PlotFormat format);

/// Writes the plot to a file. Throws std::runtime_error that names the file if it cannot be
/// written.
void plot_to(const std::filesystem::path& file,
             const std::vector<Panel>& panels,
             PlotFormat format);

}  // namespace evaluate
