// SPDX-License-Identifier: MIT
#include "examples/evaluate/breakdown.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "core/geometry/ellipse.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

using Quantity = std::function<std::optional<double>(const SeenFrame&)>;

// Names of the ranges between consecutive limits; the last range is open.
std::vector<std::string> names_of(const std::vector<double>& limits, double unit) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i + 1 < limits.size(); ++i) {
    names.push_back(format("%g to %g", limits[i] * unit, limits[i + 1] * unit));
  }
  names.push_back(format("from %g", limits.back() * unit));
  return names;
}

// Index of the range that contains a value; nullopt below the first limit.
std::optional<std::size_t> range_of(double value, const std::vector<double>& limits) {
  const auto above = std::upper_bound(limits.begin(), limits.end(), value);
  if (above == limits.begin()) return std::nullopt;
  return static_cast<std::size_t>(above - limits.begin()) - 1;
}

struct Axis {
  const char* title;
  const char* label;
  double unit;  // divisor for the printed limits
  std::vector<double> limits;
  Quantity quantity;
};

std::vector<Axis> axes() {
  const auto of_target = [](auto get) {
    return [get](const SeenFrame& seen) -> std::optional<double> {
      if (!seen.frame->truth.target) return std::nullopt;
      return get(seen);
    };
  };
  return {
      {"Recall by size",
       "semi-major axis [px]",
       1.0,
       {0, 15, 25, 40, 60, 90, 130, 180, 250},
       of_target([](const SeenFrame& seen) { return seen.frame->truth.target->semi_major; })},
      {"Recall by visible part",
       "perimeter inside the frame [%]",
       100.0,
       {0.3, 0.5, 0.7, 0.9, 1.0},
       of_target([](const SeenFrame& seen) { return visible_part(seen.frame->truth, seen.size); })},
      {"Recall by noise",
       "standard deviation [grey levels]",
       1.0,
       {0, 1, 2, 4, 8, 12},
       [](const SeenFrame& seen) { return seen.frame->conditions.noise; }},
      {"Recall by edge deformation",
       "edge deviation [% of the radius]",
       100.0,
       {0, 0.005, 0.015, 0.025},
       [](const SeenFrame& seen) { return seen.frame->conditions.crumple; }},
  };
}

// nullopt if fewer than two ranges have frames.
std::optional<Panel> recall_panel(const Evaluation& evaluation,
                                  const std::string& dataset,
                                  const Axis& axis) {
  Panel panel{axis.title, axis.label, "recall", {}, names_of(axis.limits, axis.unit), {}, true};
  std::vector<bool> is_used(axis.limits.size(), false);
  for (std::size_t method = 0; method < evaluation.methods.size(); ++method) {
    Curve curve{evaluation.methods[method].name, {}};
    for (std::size_t range = 0; range < axis.limits.size(); ++range) {
      const auto claim = [&](const SeenFrame& seen) {
        if (seen.sequence->dataset != dataset) return false;
        const std::optional<double> value = axis.quantity(seen);
        return value && range_of(*value, axis.limits) == range;
      };
      curve.y.push_back(measures_of(evaluation, method, claim).recall());
      is_used[range] = is_used[range] || std::isfinite(curve.y.back());
    }
    panel.curves.push_back(std::move(curve));
  }
  if (std::count(is_used.begin(), is_used.end(), true) < 2) return std::nullopt;
  return panel;
}

Panel centre_panel(const Evaluation& evaluation, const std::string& dataset) {
  const std::vector<double> limits = {0, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5};
  Panel panel{"Centre error",
              "distance [px]",
              "fraction of right answers",
              {},
              names_of(limits, 1.0),
              {},
              true};
  for (std::size_t method = 0; method < evaluation.methods.size(); ++method) {
    const auto errors = measures_of(evaluation, method, [&](const SeenFrame& seen) {
                          return seen.sequence->dataset == dataset;
                        }).all_centre_errors_px();
    Curve curve{evaluation.methods[method].name, std::vector<double>(limits.size(), 0.0)};
    for (const double error : errors) {
      curve.y[*range_of(error, limits)] += 1.0 / static_cast<double>(errors.size());
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

}  // namespace

std::vector<Panel> breakdown(const Evaluation& evaluation, const std::string& dataset) {
  std::vector<Panel> panels{centre_panel(evaluation, dataset)};
  for (const Axis& axis : axes()) {
    if (auto panel = recall_panel(evaluation, dataset, axis)) panels.push_back(std::move(*panel));
  }
  return panels;
}

}  // namespace evaluate
