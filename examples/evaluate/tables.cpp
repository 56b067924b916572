// SPDX-License-Identifier: MIT
#include "examples/evaluate/tables.hpp"

#include <cmath>
#include <cstdio>
#include <iomanip>
#include <numeric>
#include <ostream>

namespace evaluate {
namespace {

template <class... Values>
std::string format(const char* pattern, const Values&... values) {
  const int length = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  std::snprintf(text.data(), text.size(), pattern, values...);
  text.pop_back();
  return text;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void print_time_row(std::ostream& out, const char* name, const std::vector<double>& ms) {
  if (ms.empty()) return;
  out << format("%-12s %6zu %9.3f %9.3f %9.3f %9.3f %9.3f\n",
                name,
                ms.size(),
                mean(ms),
                quantile(ms, 1.0),
                quantile(ms, 0.0),
                quantile(ms, 0.5),
                quantile(ms, 0.99));
}

// JSON has no NaN: what was not measured is null.
std::string json_number(double value) {
  return std::isfinite(value) ? format("%.6g", value) : "null";
}

}  // namespace

NamedMeasures total(const std::vector<NamedMeasures>& sequences) {
  NamedMeasures all{"total", {}};
  for (const NamedMeasures& sequence : sequences) all.measures.add(sequence.measures);
  return all;
}

void print_measures(std::ostream& out, const std::vector<NamedMeasures>& rows) {
  out << format("%-32s %6s %8s %9s %7s %7s %5s %5s %4s %4s %4s\n",
                "sequence",
                "frames",
                "accuracy",
                "precision",
                "recall",
                "F1",
                "TP",
                "TN",
                "FP",
                "FN",
                "WD");
  for (const auto& [name, m] : rows) {
    out << format("%-32s %6zu %8.4f %9.4f %7.4f %7.4f %5d %5d %4d %4d %4d\n",
                  name.c_str(),
                  m.all_times_ms().size(),
                  m.accuracy(),
                  m.precision(),
                  m.recall(),
                  m.f1(),
                  m.count(Outcome::kTruePositive),
                  m.count(Outcome::kTrueNegative),
                  m.count(Outcome::kFalsePositive),
                  m.count(Outcome::kFalseNegative),
                  m.count(Outcome::kWrong));
  }
  const int not_judged = rows.back().measures.count(Outcome::kNotJudged);
  if (not_judged > 0) out << format("%d frames are not judged.\n", not_judged);
}

void print_times(std::ostream& out, const Measures& measures) {
  out << format("\n%-12s %6s %9s %9s %9s %9s %9s\n",
                "time [ms]",
                "frames",
                "average",
                "maximum",
                "minimum",
                "median",
                "p99");
  for (std::size_t i = 0; i < kOutcomes; ++i) {
    print_time_row(out, kOutcomeNames[i], measures.times_ms(static_cast<Outcome>(i)));
  }
  print_time_row(out, "all", measures.all_times_ms());
  print_time_row(out, "reference", measures.reference_times_ms());
  out << format(
      "median / reference: %.2f (cv::GaussianBlur + cv::Canny + cv::findContours)\n",
      quantile(measures.all_times_ms(), 0.5) / quantile(measures.reference_times_ms(), 0.5));
}

void print_centre_errors(std::ostream& out, const Measures& measures) {
  out << format("\n%-18s %6s %9s %9s\n", "centre error [px]", "frames", "median", "p95");
  const auto row = [&](const std::string& name, const std::vector<double>& errors) {
    if (errors.empty()) return;
    out << format("%-18s %6zu %9.3f %9.3f\n",
                  name.c_str(),
                  errors.size(),
                  quantile(errors, 0.5),
                  quantile(errors, 0.95));
  };
  for (int k = 0; k < Measures::kScales; ++k) {
    row(format("scale %d", 1 << k), measures.centre_errors_px(k));
  }
  row("all", measures.all_centre_errors_px());
}

void write_json(std::ostream& out, const std::vector<NamedMeasures>& rows) {
  out << "{\"sequences\":[";
  const char* separator = "";
  for (const auto& [name, m] : rows) {
    out << separator << "\n{\"name\":" << std::quoted(name)
        << ",\"accuracy\":" << json_number(m.accuracy())
        << ",\"precision\":" << json_number(m.precision())
        << ",\"recall\":" << json_number(m.recall()) << ",\"f1\":" << json_number(m.f1());
    for (std::size_t i = 0; i < kOutcomes; ++i) {
      const std::vector<double>& ms = m.times_ms(static_cast<Outcome>(i));
      out << ",\"" << kOutcomeNames[i] << "\":{\"frames\":" << ms.size()
          << ",\"avg_ms\":" << json_number(mean(ms))
          << ",\"max_ms\":" << json_number(quantile(ms, 1.0))
          << ",\"min_ms\":" << json_number(quantile(ms, 0.0)) << '}';
    }
    out << ",\"median_ms\":" << json_number(quantile(m.all_times_ms(), 0.5))
        << ",\"p99_ms\":" << json_number(quantile(m.all_times_ms(), 0.99))
        << ",\"reference_median_ms\":" << json_number(quantile(m.reference_times_ms(), 0.5))
        << ",\"centre_error_median_px\":" << json_number(quantile(m.all_centre_errors_px(), 0.5))
        << '}';
    separator = ",";
  }
  out << "\n]}\n";
}

}  // namespace evaluate
