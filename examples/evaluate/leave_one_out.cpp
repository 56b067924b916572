// SPDX-License-Identifier: MIT
#include "examples/evaluate/leave_one_out.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

std::vector<std::string> sources_of(const std::vector<Sequence>& sequences) {
  std::vector<std::string> sources;
  for (const Sequence& sequence : sequences) {
    const bool is_known = std::ranges::find(sources, sequence.dataset) != sources.end();
    if (!is_known) sources.push_back(sequence.dataset);
  }
  return sources;
}

std::vector<std::string> outside_of(const std::string& group,
                                    const std::vector<std::string>& sources,
                                    const SourceGroups& groups) {
  std::vector<std::string> others;
  for (const std::string& source : sources) {
    if (groups.group_of(source) != group) others.push_back(source);
  }
  if (others.empty()) {
    throw std::invalid_argument("--leave-one-out: all sources belong to the group \"" + group +
                                "\"; none is left to choose on");
  }
  return others;
}

// nullopt if it was stopped early or no frame could be read.
std::optional<LeftOut> judge_on(const std::vector<Sequence>& sequences,
                                const ellipse::TrackerSettings& unchosen,
                                const Choice& left_out,
                                const Choice& in_sample,
                                Rule rule,
                                const std::function<bool(const Frame&)>& advance) {
  std::vector<std::unique_ptr<Method>> methods;
  methods.push_back(make_tracker_method("unchosen", unchosen));
  methods.push_back(make_tracker_method(left_out.name, left_out.settings));
  methods.push_back(make_tracker_method(in_sample.name, in_sample.settings));
  const Evaluation evaluation = evaluate(sequences, methods, rule, advance);
  if (evaluation.is_interrupted || evaluation.frames.empty()) return std::nullopt;
  const SourceResults results = source_results(evaluation).front();
  LeftOut one;
  one.source = results.source;
  one.frames = results.frames;
  one.unchosen = results.methods[0].grade;
  one.left_out = {left_out.name, results.methods[1]};
  one.in_sample = {in_sample.name, results.methods[2]};
  return one;
}

std::vector<std::string> row_of(const LeftOut& one, const JudgedChoice& judged) {
  const Interval& interval = judged.grade.interval;
  const bool is_known = std::isfinite(interval.low);
  return {one.source,
          one.group,
          std::to_string(one.frames),
          number(judged.grade.grade, 4) + (is_difference(*judged.grade.difference) ? " " : "="),
          is_known ? number(interval.low, 3) + " to " + number(interval.high, 3) : "-",
          number(one.unchosen, 4),
          judged.name};
}

Table table_of(const std::vector<LeftOut>& results, JudgedChoice LeftOut::*judged) {
  Table table;
  table.header = {"source", "group", "frames", "F1 ", "95 %", "without", "chosen"};
  double sum = 0.0;
  double without = 0.0;
  for (const LeftOut& one : results) {
    table.rows.push_back(row_of(one, one.*judged));
    sum += (one.*judged).grade.grade;
    without += one.unchosen;
  }
  const auto count = static_cast<double>(results.size());
  table.rows.push_back(
      {"mean", "", "", number(sum / count, 4) + " ", "", number(without / count, 4), ""});
  table.note =
      "Without: the base settings. =: no difference from them, because the 95 % interval of the "
      "difference contains 0. For sources without an ellipse: fraction of frames without an "
      "answer.";
  return table;
}

}  // namespace

std::vector<LeftOut> leave_one_out(const std::vector<Sequence>& sequences,
                                   const SourceGroups& groups,
                                   Chooser& chooser,
                                   const ellipse::TrackerSettings& settings,
                                   Rule rule,
                                   const std::function<bool(const Frame&)>& advance) {
  const std::vector<std::string> sources = sources_of(sequences);
  std::vector<LeftOut> results;
  for (const std::string& source : sources) {
    const std::string group = groups.group_of(source);
    const Choice left_out = chooser.choose(outside_of(group, sources, groups));
    std::vector<Sequence> judged;
    std::ranges::copy_if(sequences, std::back_inserter(judged), [&](const Sequence& sequence) {
      return sequence.dataset == source;
    });
    auto one = judge_on(judged, settings, left_out, chooser.choose(sources), rule, advance);
    if (!one) break;
    one->group = group;
    results.push_back(std::move(*one));
  }
  return results;
}

Table left_out_table(const std::string& method, const std::vector<LeftOut>& results) {
  Table table = table_of(results, &LeftOut::left_out);
  table.title = "Left out: " + method + " on sources that the choice has not seen";
  return table;
}

Table in_sample_table(const std::string& method, const std::vector<LeftOut>& results) {
  Table table = table_of(results, &LeftOut::in_sample);
  table.title = "In sample: " + method + " on sources that the choice was made on";
  return table;
}

}  // namespace evaluate
