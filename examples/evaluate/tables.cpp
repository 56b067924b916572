// SPDX-License-Identifier: MIT
#include "examples/evaluate/tables.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <ostream>

#include "examples/evaluate/source_tables.hpp"
#include "examples/evaluate/text.hpp"
#include "examples/evaluate/tracking_tables.hpp"

namespace evaluate {
namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

auto in_dataset(const std::string& dataset) {
  return [dataset](const SeenFrame& seen) { return seen.sequence->dataset == dataset; };
}

std::string count(const Measures& measures, Outcome outcome) {
  return std::to_string(measures.count(outcome));
}

std::vector<std::string> times_row(const std::string& method,
                                   const std::string& outcome,
                                   const std::vector<double>& ms) {
  return {method,
          outcome,
          std::to_string(ms.size()),
          number(mean(ms), 3),
          number(quantile(ms, 1.0), 3),
          number(quantile(ms, 0.0), 3),
          number(quantile(ms, 0.5), 3),
          number(quantile(ms, 0.99), 3)};
}

// F1, or accuracy if there is nothing to find.
double grade(const Measures& measures) {
  const int with_target = measures.count(Outcome::kTruePositive) +
                          measures.count(Outcome::kFalseNegative) + measures.count(Outcome::kWrong);
  if (with_target == 0) return measures.accuracy();
  return measures.count(Outcome::kTruePositive) > 0 ? measures.f1() : 0.0;
}

void write_json_times(std::ostream& out, const Measures& measures) {
  for (std::size_t i = 0; i < kOutcomes; ++i) {
    const std::vector<double>& ms = measures.times_ms(static_cast<Outcome>(i));
    out << ",\"" << kOutcomeNames[i] << "\":{\"frames\":" << measures.count(static_cast<Outcome>(i))
        << ",\"avg_ms\":" << json_number(mean(ms))
        << ",\"max_ms\":" << json_number(quantile(ms, 1.0))
        << ",\"min_ms\":" << json_number(quantile(ms, 0.0))
        << ",\"p50_ms\":" << json_number(quantile(ms, 0.5))
        << ",\"p99_ms\":" << json_number(quantile(ms, 0.99)) << '}';
  }
}

void write_json_measures(std::ostream& out, const Measures& m) {
  out << "\"accuracy\":" << json_number(m.accuracy())
      << ",\"precision\":" << json_number(m.precision())
      << ",\"recall\":" << json_number(m.recall()) << ",\"f1\":" << json_number(m.f1());
  write_json_times(out, m);
  out << ",\"median_ms\":" << json_number(quantile(m.all_times_ms(), 0.5))
      << ",\"p99_ms\":" << json_number(quantile(m.all_times_ms(), 0.99))
      << ",\"reference_median_ms\":" << json_number(quantile(m.reference_times_ms(), 0.5))
      << ",\"centre_error_median_px\":" << json_number(quantile(m.all_centre_errors_px(), 0.5))
      << ",\"centre_error_p95_px\":" << json_number(quantile(m.all_centre_errors_px(), 0.95));
}

}  // namespace

Table measures_table(const Evaluation& evaluation, const std::string& dataset) {
  Table table;
  table.title = "Accuracy, precision, recall and F1 on " + dataset;
  table.header = {"method", "accuracy", "precision", "recall", "F1", "TP", "TN", "FP", "FN", "WD"};
  int not_judged = 0;
  int frames = 0;
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    const Measures m = measures_of(evaluation, i, in_dataset(dataset));
    table.rows.push_back({evaluation.methods[i].name,
                          number(m.accuracy(), 4),
                          number(m.precision(), 4),
                          number(m.recall(), 4),
                          number(m.f1(), 4),
                          count(m, Outcome::kTruePositive),
                          count(m, Outcome::kTrueNegative),
                          count(m, Outcome::kFalsePositive),
                          count(m, Outcome::kFalseNegative),
                          count(m, Outcome::kWrong)});
    not_judged = std::max(not_judged, m.count(Outcome::kNotJudged));
    frames = m.frames();
  }
  table.note = std::to_string(frames) + " frames";
  if (not_judged > 0) {
    table.note +=
        "; not judged (unlabelled, initialized with the truth, or hardly visible): up to " +
        std::to_string(not_judged);
  }
  return table;
}

Table times_table(const Evaluation& evaluation, const std::string& dataset) {
  Table table;
  table.title = "Time per frame on " + dataset + " [ms]";
  table.header = {"method", "outcome", "frames", "average", "maximum", "minimum", "median", "p99"};
  std::string ratios;
  std::vector<double> reference_ms;
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    const Measures m = measures_of(evaluation, i, in_dataset(dataset));
    std::string name = evaluation.methods[i].name;
    reference_ms = m.reference_times_ms();
    const double ratio = quantile(m.all_times_ms(), 0.5) / quantile(reference_ms, 0.5);
    ratios += (ratios.empty() ? "" : ", ") + name + " " + number(ratio, 2);
    for (std::size_t k = 0; k < kOutcomes; ++k) {
      const std::vector<double>& ms = m.times_ms(static_cast<Outcome>(k));
      if (ms.empty()) continue;
      table.rows.push_back(times_row(name, kOutcomeNames[k], ms));
      name.clear();
    }
    table.rows.push_back(times_row("", "all", m.all_times_ms()));
  }
  table.rows.push_back(times_row("cv::Canny + cv::findContours", "all", reference_ms));
  table.note = "Ratio of medians to cv::Canny + cv::findContours: " + ratios + ".";
  return table;
}

Table sequences_table(const Evaluation& evaluation, const std::string& dataset) {
  Table table;
  table.title = "F1 by sequence of " + dataset;
  table.header = {"sequence", "frames"};
  for (const MethodResults& method : evaluation.methods) table.header.push_back(method.name);
  for (const std::string& sequence : sequences_of(evaluation, dataset)) {
    const auto claim = [&](const SeenFrame& seen) {
      return seen.sequence->name == sequence && seen.sequence->dataset == dataset;
    };
    std::vector<std::string> row{sequence, ""};
    for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
      const Measures measures = measures_of(evaluation, i, claim);
      row[1] = std::to_string(measures.frames());
      row.push_back(number(grade(measures), 3));
    }
    table.rows.push_back(std::move(row));
  }
  table.note = "For sequences without a target: fraction of frames without an answer.";
  return table;
}

Table centre_table(const Evaluation& evaluation, const std::string& dataset) {
  Table table;
  table.title = "Centre error on " + dataset + " [px]";
  table.header = {"method", "scale", "frames", "median", "p95"};
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    const Measures m = measures_of(evaluation, i, in_dataset(dataset));
    std::string name = evaluation.methods[i].name;
    const auto add_row = [&](const std::string& scale, const std::vector<double>& errors) {
      if (errors.empty()) return;
      table.rows.push_back({name,
                            scale,
                            std::to_string(errors.size()),
                            number(quantile(errors, 0.5), 3),
                            number(quantile(errors, 0.95), 3)});
      name.clear();
    };
    for (int k = 0; k < Measures::kScales; ++k) {
      add_row(std::to_string(1 << k), m.centre_errors_px(k));
    }
    if (m.all_centre_errors_px().size() > m.centre_errors_px(0).size()) {
      add_row("all", m.all_centre_errors_px());
    }
  }
  table.note = "Right answers only.";
  return table;
}

std::vector<Table> all_tables(const Evaluation& evaluation, const std::string& dataset) {
  return {measures_table(evaluation, dataset),
          times_table(evaluation, dataset),
          centre_table(evaluation, dataset),
          sequences_table(evaluation, dataset),
          visibility_table(evaluation, dataset),
          following_table(evaluation, dataset)};
}

void print(std::ostream& out, const Table& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  };
  widen(table.header);
  for (const auto& row : table.rows) widen(row);
  const auto print_row = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - row[i].size(), ' ');
      out << (i == 0 ? row[i] + space : "  " + space + row[i]);
    }
    out << '\n';
  };
  out << '\n' << table.title << '\n';
  print_row(table.header);
  for (const auto& row : table.rows) print_row(row);
  if (!table.note.empty()) out << table.note << '\n';
}

void write_json(std::ostream& out, const Evaluation& evaluation) {
  out << "{\"planned_frames\":" << evaluation.planned_frames
      << ",\"frames\":" << evaluation.frames.size()
      << ",\"missing_frames\":" << evaluation.missing_frames
      << ",\"interrupted\":" << (evaluation.is_interrupted ? "true" : "false") << ",\"results\":[";
  const char* separator = "";
  const auto write = [&](std::size_t method,
                         const std::string& dataset,
                         const std::string& sequence,
                         const Measures& measures) {
    out << separator << "\n{\"method\":" << std::quoted(evaluation.methods[method].name)
        << ",\"dataset\":" << std::quoted(dataset) << ",\"sequence\":" << std::quoted(sequence)
        << ',';
    write_json_measures(out, measures);
    out << '}';
    separator = ",";
  };
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    for (const std::string& dataset : datasets_of(evaluation)) {
      for (const std::string& sequence : sequences_of(evaluation, dataset)) {
        const auto claim = [&](const SeenFrame& seen) {
          return seen.sequence->name == sequence && seen.sequence->dataset == dataset;
        };
        write(i, dataset, sequence, measures_of(evaluation, i, claim));
      }
      write(i, dataset, "total", measures_of(evaluation, i, in_dataset(dataset)));
    }
  }
  out << "\n],\"tracking\":[";
  separator = "";
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    for (const std::string& dataset : datasets_of(evaluation)) {
      out << separator << "\n{\"method\":" << std::quoted(evaluation.methods[i].name)
          << ",\"dataset\":" << std::quoted(dataset) << ',';
      write_json_tracking(out, tracking_measures_of(evaluation, i, dataset));
      out << '}';
      separator = ",";
    }
  }
  out << "\n],";
  write_json_sources(out, evaluation);
  out << "}\n";
}

}  // namespace evaluate
