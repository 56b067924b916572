// SPDX-License-Identifier: MIT
#include "examples/evaluate/chooser.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/source_results.hpp"
#include "examples/evaluate/sweep.hpp"

namespace evaluate {
namespace {

constexpr std::size_t kMaxPoints = 500;

std::vector<std::string> split_at_colons(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':') parts.emplace_back();
    if (c != ':') parts.back() += c;
  }
  return parts;
}

// Distinguishes from:to:step, a range with at least one step, from three values.
bool is_range(const std::vector<std::string>& parts) {
  if (parts.size() != 3) return false;
  std::vector<double> numbers;
  for (const std::string& part : parts) {
    char* end = nullptr;
    numbers.push_back(std::strtod(part.c_str(), &end));
    if (part.empty() || *end != '\0') return false;
  }
  return numbers[2] > 0.0 && numbers[2] <= numbers[1] - numbers[0];
}

}  // namespace

Property parse_property(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw std::invalid_argument("--choose " + text + ": expected PROPERTY=VALUE:VALUE...");
  }
  std::vector<std::string> parts = split_at_colons(text.substr(equals + 1));
  if (parts.size() > 1 && !is_range(parts)) return {text.substr(0, equals), std::move(parts)};
  const Sweep sweep = parse_sweep(text);
  return {sweep.property, sweep.values};
}

GridChooser::GridChooser(const std::vector<Property>& grid,
                         const ellipse::TrackerSettings& settings,
                         const std::vector<Sequence>& sequences,
                         Rule rule,
                         const std::function<bool(const Frame&)>& advance) {
  add_points(grid, 0, {"", settings});
  std::vector<std::unique_ptr<Method>> methods;
  for (const Point& point : points_) {
    methods.push_back(make_tracker_method(point.choice.name, point.choice.settings));
  }
  const Evaluation evaluation = evaluate(sequences, methods, rule, advance);
  problems_ = evaluation.problems;
  for (const std::string& source : datasets_of(evaluation)) {
    sources_.push_back(source);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i].grades.push_back(grade_of(source_counts(evaluation, i, source)));
    }
  }
}

Choice GridChooser::choose(const std::vector<std::string>& sources) {
  const Point* best = nullptr;
  double best_sum = 0.0;
  for (const Point& point : points_) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (std::ranges::find(sources, sources_[i]) != sources.end()) sum += point.grades[i];
    }
    if (best == nullptr || sum > best_sum) {
      best = &point;
      best_sum = sum;
    }
  }
  return best->choice;
}

void GridChooser::add_points(const std::vector<Property>& grid,
                             std::size_t depth,
                             const Choice& choice) {
  if (depth == grid.size()) {
    if (points_.size() == kMaxPoints) {
      throw std::invalid_argument("--choose: more than " + std::to_string(kMaxPoints) + " points");
    }
    choice.settings.validate();
    points_.push_back({choice, {}});
    return;
  }
  for (const std::string& value : grid[depth].values) {
    Choice next = choice;
    next.name += (next.name.empty() ? "" : " ") + grid[depth].name + "=" + value;
    ellipse::set_by_name(next.settings, grid[depth].name, value);
    add_points(grid, depth + 1, next);
  }
}

}  // namespace evaluate
