// SPDX-License-Identifier: MIT
#include "examples/evaluate/sweep.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "examples/evaluate/plots.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

constexpr std::size_t kMaxValues = 200;

[[noreturn]] void reject_sweep(const std::string& text, const std::string& what) {
  throw std::invalid_argument("--sweep " + text + ": " + what);
}

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  return is_number && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string> range(const std::vector<std::string>& parts, const std::string& all) {
  if (parts.size() != 3) reject_sweep(all, "expected PROPERTY=FROM:TO:STEP");
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = number_in(parts[i]);
    if (!value) reject_sweep(all, "\"" + parts[i] + "\" is not a number");
    numbers[i] = *value;
  }
  const auto [from, to, step] = numbers;
  if (!(step > 0.0) || !(to >= from)) reject_sweep(all, "expected from <= to and a step above 0");
  const double steps = std::floor((to - from) / step + 1e-9);
  if (steps >= static_cast<double>(kMaxValues)) reject_sweep(all, "more than 200 values");
  std::vector<std::string> values;
  // Rounds to nine digits, so that 0.3 + 5 x 0.05 is printed as 0.55.
  for (int i = 0; i <= static_cast<int>(steps); ++i) {
    values.push_back(format("%.9g", from + i * step));
  }
  return values;
}

Measures measures_at(const Evaluation& evaluation, std::size_t value) {
  return measures_of(evaluation, value, [](const SeenFrame& /*seen*/) { return true; });
}

// The columns after the value.
struct Column {
  const char* name;
  int digits;
  double (*get)(const Measures&);
};

double average(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

template <Outcome kOutcome>
double count_of(const Measures& m) {
  return m.count(kOutcome);
}

constexpr Column kSweepColumns[] = {
    {"accuracy", 4, [](const Measures& m) { return m.accuracy(); }},
    {"precision", 4, [](const Measures& m) { return m.precision(); }},
    {"recall", 4, [](const Measures& m) { return m.recall(); }},
    {"F1", 4, [](const Measures& m) { return m.f1(); }},
    {"TP", 0, count_of<Outcome::kTruePositive>},
    {"TN", 0, count_of<Outcome::kTrueNegative>},
    {"FP", 0, count_of<Outcome::kFalsePositive>},
    {"FN", 0, count_of<Outcome::kFalseNegative>},
    {"WD", 0, count_of<Outcome::kWrong>},
    {"average_ms", 3, [](const Measures& m) { return average(m.all_times_ms()); }},
    {"median_ms", 3, [](const Measures& m) { return quantile(m.all_times_ms(), 0.5); }},
    {"p99_ms", 3, [](const Measures& m) { return quantile(m.all_times_ms(), 0.99); }},
    {"reference_median_ms",
     3,
     [](const Measures& m) { return quantile(m.reference_times_ms(), 0.5); }},
};

Panel panel_of(const Sweep& sweep,
               const Evaluation& evaluation,
               const std::string& title,
               const std::string& y_label,
               const std::vector<std::string>& names) {
  Panel panel{title, sweep.property, y_label, {}, {}, {}, y_label.empty()};
  for (const std::string& value : sweep.values) {
    if (const auto x = number_in(value)) panel.x.push_back(*x);
  }
  if (panel.x.size() < sweep.values.size())
    panel.ranges = sweep.values;  // non-numeric values: grouped bars
  for (const Column& column : kSweepColumns) {
    if (std::find(names.begin(), names.end(), column.name) == names.end()) continue;
    Curve curve{column.name, {}};
    for (std::size_t i = 0; i < sweep.values.size(); ++i) {
      curve.y.push_back(column.get(measures_at(evaluation, i)));
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

}  // namespace

Sweep parse_sweep(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    reject_sweep(text, "expected PROPERTY=FROM:TO:STEP");
  const std::string values = text.substr(equals + 1);
  Sweep sweep{text.substr(0, equals), {}};
  sweep.values =
      values.find(':') == std::string::npos ? split(values, ',') : range(split(values, ':'), text);
  return sweep;
}

std::vector<std::unique_ptr<Method>> methods_of(const Sweep& sweep,
                                                const ellipse::TrackerSettings& settings) {
  std::vector<std::unique_ptr<Method>> methods;
  for (const std::string& text : sweep.values) {
    ellipse::TrackerSettings changed = settings;
    ellipse::set_by_name(changed, sweep.property, text);
    changed.validate();
    methods.push_back(make_tracker_method(sweep.property + "=" + text, changed));
  }
  return methods;
}

Table sweep_table(const Sweep& sweep, const Evaluation& evaluation) {
  Table table{"Sweep of " + sweep.property, {sweep.property}, {}, ""};
  for (const Column& column : kSweepColumns) table.header.emplace_back(column.name);
  for (std::size_t i = 0; i < sweep.values.size(); ++i) {
    const Measures measures = measures_at(evaluation, i);
    std::vector<std::string> row{sweep.values[i]};
    for (const Column& column : kSweepColumns) {
      row.push_back(number(column.get(measures), column.digits));
    }
    table.rows.push_back(std::move(row));
  }
  table.note = std::to_string(evaluation.frames.size()) + " frames of all data sets";
  return table;
}

void write_sweep(const Sweep& sweep,
                 const Evaluation& evaluation,
                 const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / (sweep.property + ".csv");
  std::ofstream out(file);
  const Table table = sweep_table(sweep, evaluation);
  const auto write_row = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      out << (i > 0 ? "," : "") << (row[i] == "-" ? "" : row[i]);
    }
    out << '\n';
  };
  write_row(table.header);
  for (const auto& row : table.rows) write_row(row);
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");

  const std::vector<Panel> panels = {
      panel_of(sweep, evaluation, "Measures", "", {"accuracy", "precision", "recall", "F1"}),
      panel_of(sweep, evaluation, "Right", "frames", {"TP", "TN"}),
      panel_of(sweep, evaluation, "False", "frames", {"FP", "FN", "WD"}),
      panel_of(sweep, evaluation, "Time per frame", "ms", {"average_ms", "median_ms"}),
  };
  plot_to(folder / (sweep.property + ".svg"), panels, PlotFormat::kSvg);
  plot_to(folder / (sweep.property + ".png"), panels, PlotFormat::kPng);
}

}  // namespace evaluate
