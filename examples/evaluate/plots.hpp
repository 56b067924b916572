#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>
#include <vector>

namespace evaluate {

struct Curve {
  std::string title;
  std::vector<double> y;  ///< As many as the panel's x; NaN = no point.
};

/// Curves over one axis.
struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<double> x;            ///< Places, or
  std::vector<std::string> ranges;  ///< names of ranges: bars side by side.
  std::vector<Curve> curves;
  bool is_share = false;  ///< From 0 to 1.
};

enum class PlotFormat { kSvg, kPng };

/// What gnuplot draws to its standard output.
/// Throws std::runtime_error where it is not installed or fails, with what it says.
[[nodiscard]] std::string run_gnuplot(const std::string& script);

/// Panels side by side, two in a row, drawn by run_gnuplot().
[[nodiscard]] std::string plot(const std::vector<Panel>& panels, PlotFormat format);

/// Into a file. Throws std::runtime_error that names it, where it cannot be written.
void plot_to(const std::filesystem::path& file,
             const std::vector<Panel>& panels,
             PlotFormat format);

}  // namespace evaluate
