// SPDX-License-Identifier: MIT
#include "examples/evaluate/source_tables.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

constexpr const char* kNoDifference = "=";

// The grade with its mark; a blank keeps the digits aligned.
std::string marked(const SourceGrade& grade) {
  const bool is_claimed = !grade.difference || is_difference(*grade.difference);
  return number(grade.grade, 3) + (is_claimed ? " " : kNoDifference);
}

std::string range(const Interval& interval) {
  if (!std::isfinite(interval.low)) return "-";
  return number(interval.low, 3) + " to " + number(interval.high, 3);
}

std::string names_of(std::span<const SourceResults> results, bool draws_sequences) {
  std::string names;
  for (const SourceResults& source : results) {
    if (source.draws_sequences != draws_sequences) continue;
    names += (names.empty() ? "" : ", ") + source.source;
  }
  return names.empty() ? "none" : names;
}

double mean_grade(std::span<const SourceResults> results, std::size_t method) {
  double sum = 0.0;
  int count = 0;
  for (const SourceResults& source : results) {
    if (!source.has_target) continue;
    sum += source.methods[method].grade;
    ++count;
  }
  return count > 0 ? sum / count : kNaN;
}

std::vector<std::string> row_of(const Evaluation& evaluation, const SourceResults& source) {
  std::vector<std::string> row{source.source, std::to_string(source.frames)};
  for (const SourceGrade& method : source.methods) row.push_back(marked(method));
  if (!source.best_peer) {
    row.insert(row.end(), {"-", "-", "-"});
    return row;
  }
  const SourceGrade& peer = source.methods[*source.best_peer];
  row.push_back(evaluation.methods[*source.best_peer].name);
  row.push_back(number(peer.grade, 3));
  const bool is_first = *source.best_peer == 0;
  row.push_back(is_first ? "-"
                         : format("%+.3f", source.methods[0].grade - peer.grade) +
                               (is_difference(*peer.difference) ? " " : kNoDifference));
  return row;
}

std::vector<std::string> mean_row(const Evaluation& evaluation,
                                  std::span<const SourceResults> results) {
  const auto sources = std::ranges::count_if(results, &SourceResults::has_target);
  std::vector<std::string> row{format("mean of %d with ellipses", static_cast<int>(sources)), ""};
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    row.push_back(number(mean_grade(results, i), 3) + " ");
  }
  row.insert(row.end(), {"", "", ""});
  return row;
}

// Sum of one method's results for all ellipses of one source.
struct AllSum {
  FrameCounts counts;
  Interval interval{kNaN, kNaN};  // of F1
  std::vector<double> centre_errors_px;
  std::vector<double> axis_errors_px;
};

AllSum all_of(const Evaluation& evaluation, std::size_t method, const std::string& dataset) {
  AllSum sum;
  std::vector<FrameCounts> counts;
  for (std::size_t i = 0; i < evaluation.frames.size(); ++i) {
    if (evaluation.frames[i].sequence->dataset != dataset) continue;
    const AllResult& one = evaluation.methods[method].all[i];
    counts.push_back(one.counts);
    sum.counts += one.counts;
    std::ranges::copy(one.centre_errors_px, std::back_inserter(sum.centre_errors_px));
    std::ranges::copy(one.axis_errors_px, std::back_inserter(sum.axis_errors_px));
  }
  if (!sum.counts.has_target()) return sum;
  const SourceFrames source = source_frames(evaluation, dataset);
  sum.interval = grade_interval(source, scheme_for(source, counts), counts);
  return sum;
}

double share(int part, int rest) {
  return part + rest > 0 ? static_cast<double>(part) / (part + rest) : kNaN;
}

template <class Use>
void for_each_all(const Evaluation& evaluation, const Use& use) {
  for (const std::string& dataset : datasets_of(evaluation)) {
    for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
      if (evaluation.methods[i].all.empty()) continue;
      use(dataset, evaluation.methods[i].name, all_of(evaluation, i, dataset));
    }
  }
}

void write_json_interval(std::ostream& out, const Interval& interval) {
  out << '[' << json_number(interval.low) << ',' << json_number(interval.high) << ']';
}

void write_json_all(std::ostream& out, const Evaluation& evaluation) {
  const char* separator = "";
  for_each_all(
      evaluation, [&](const std::string& dataset, const std::string& name, const AllSum& a) {
        out << separator << "\n{\"method\":" << std::quoted(name)
            << ",\"dataset\":" << std::quoted(dataset) << ",\"right\":" << a.counts.right
            << ",\"mistaken\":" << a.counts.mistaken << ",\"missed\":" << a.counts.missed
            << ",\"f1\":" << json_number(f1_of(a.counts)) << ",\"interval\":";
        write_json_interval(out, a.interval);
        out << ",\"centre_error_median_px\":" << json_number(quantile(a.centre_errors_px, 0.5))
            << ",\"axis_error_median_px\":" << json_number(quantile(a.axis_errors_px, 0.5)) << '}';
        separator = ",";
      });
}

}  // namespace

Table source_table(const Evaluation& evaluation, std::span<const SourceResults> results) {
  Table table;
  table.title = "F1 by source";
  table.header = {"source", "frames"};
  for (const MethodResults& method : evaluation.methods) table.header.push_back(method.name + " ");
  table.header.insert(table.header.end(), {"best peer", "its F1", "difference "});
  for (const SourceResults& source : results) table.rows.push_back(row_of(evaluation, source));
  table.rows.push_back(mean_row(evaluation, results));
  table.note =
      "For sources without an ellipse: fraction of frames without an answer. " +
      std::string(kNoDifference) + ": no difference from " + evaluation.methods[0].name +
      ", because the 95 % interval of the difference on the same resampled frames contains "
      "0. Difference: " +
      evaluation.methods[0].name +
      " minus the best peer. Peers are all methods without our detector or tracker, "
      "including the paper's.";
  return table;
}

Table interval_table(const Evaluation& evaluation, std::span<const SourceResults> results) {
  Table table;
  table.title = "95 % intervals of F1 by source";
  table.header = {"source"};
  for (const MethodResults& method : evaluation.methods) table.header.push_back(method.name);
  for (const SourceResults& source : results) {
    std::vector<std::string> row{source.source};
    for (const SourceGrade& method : source.methods) row.push_back(range(method.interval));
    table.rows.push_back(std::move(row));
  }
  table.note = "Bootstrap over whole sequences: " + names_of(results, true) +
               "; over blocks of one second, or of the autocorrelation time of errors if that is "
               "longer, for sources with fewer than " +
               std::to_string(kMinSequences) + " sequences: " + names_of(results, false) +
               ". -: no error to resample.";
  return table;
}

Table all_ellipses_table(const Evaluation& evaluation) {
  Table table;
  table.title = "All ellipses by source";
  table.header = {"source",
                  "method",
                  "true",
                  "found",
                  "right",
                  "precision",
                  "recall",
                  "F1",
                  "95 %",
                  "centre [px]",
                  "p95",
                  "axes [px]",
                  "p95"};
  std::string last;
  for_each_all(evaluation,
               [&](const std::string& dataset, const std::string& name, const AllSum& a) {
                 const FrameCounts& c = a.counts;
                 table.rows.push_back({dataset == last ? "" : dataset,
                                       name,
                                       std::to_string(c.right + c.missed),
                                       std::to_string(c.right + c.mistaken),
                                       std::to_string(c.right),
                                       number(share(c.right, c.mistaken), 4),
                                       number(share(c.right, c.missed), 4),
                                       number(f1_of(c), 4),
                                       range(a.interval),
                                       number(quantile(a.centre_errors_px, 0.5), 3),
                                       number(quantile(a.centre_errors_px, 0.95), 3),
                                       number(quantile(a.axis_errors_px, 0.5), 3),
                                       number(quantile(a.axis_errors_px, 0.95), 3)});
                 last = dataset;
               });
  table.note =
      "Matched one to one at IoU >= 0.8. True ellipses with less than 30 % of the perimeter "
      "in the frame, and their matches, do not count. Axes: the larger error of "
      "the two semi-axes. Methods that find only the target are omitted. If the truth lists only "
      "the target, other real ellipses count as mistaken.";
  return table;
}

std::vector<Table> source_tables(const Evaluation& evaluation) {
  const std::vector<SourceResults> results = source_results(evaluation);
  std::vector<Table> tables;
  if (results.empty()) return tables;
  tables = {source_table(evaluation, results), interval_table(evaluation, results)};
  Table all = all_ellipses_table(evaluation);
  if (!all.rows.empty()) tables.push_back(std::move(all));
  return tables;
}

void write_json_sources(std::ostream& out, const Evaluation& evaluation) {
  out << "\"sources\":[";
  const char* separator = "";
  for (const SourceResults& source : source_results(evaluation)) {
    for (std::size_t i = 0; i < source.methods.size(); ++i) {
      const SourceGrade& grade = source.methods[i];
      out << separator << "\n{\"method\":" << std::quoted(evaluation.methods[i].name)
          << ",\"dataset\":" << std::quoted(source.source)
          << ",\"grade\":" << json_number(grade.grade) << ",\"interval\":";
      write_json_interval(out, grade.interval);
      out << ",\"difference_from_first\":";
      if (grade.difference) {
        write_json_interval(out, *grade.difference);
      } else {
        out << "null";
      }
      out << ",\"is_best_peer\":" << (source.best_peer == i ? "true" : "false") << '}';
      separator = ",";
    }
  }
  out << "\n],\"all_ellipses\":[";
  write_json_all(out, evaluation);
  out << "\n]";
}

}  // namespace evaluate
