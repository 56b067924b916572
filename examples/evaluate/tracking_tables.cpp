// SPDX-License-Identifier: MIT
#include "examples/evaluate/tracking_tables.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

constexpr double kSoon = 2.0;  // frames

double share_of(std::ptrdiff_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kNaN;
}

std::string share_text(int part, int whole) {
  return number(share_of(part, static_cast<std::size_t>(whole)), 4);
}

double share_soon(const std::vector<double>& returns) {
  const auto is_soon = [](double frames) { return frames <= kSoon; };
  return share_of(std::count_if(returns.begin(), returns.end(), is_soon), returns.size());
}

std::string frames_until(double frames) {
  return std::isinf(frames) ? "never" : number(frames, 0);
}

std::vector<TrackingMeasures> all_measures(const Evaluation& evaluation,
                                           const std::string& dataset) {
  std::vector<TrackingMeasures> all;
  for (std::size_t i = 0; i < evaluation.methods.size(); ++i) {
    all.push_back(tracking_measures_of(evaluation, i, dataset));
  }
  return all;
}

std::vector<std::string> visibility_row(const std::string& visible,
                                        const std::string& method,
                                        const RangeCounts& counts) {
  return {visible,
          method,
          std::to_string(counts.frames),
          share_text(counts.right, counts.frames),
          share_text(counts.centre_5, counts.frames),
          share_text(counts.centre_2, counts.frames),
          share_text(counts.wrong, counts.frames),
          share_text(counts.none, counts.frames)};
}

void write_json_range(std::ostream& out, const RangeCounts& counts) {
  out << "{\"frames\":" << counts.frames << ",\"right\":" << counts.right
      << ",\"centre_5\":" << counts.centre_5 << ",\"centre_2\":" << counts.centre_2
      << ",\"wrong\":" << counts.wrong << ",\"none\":" << counts.none << '}';
}

}  // namespace

Table visibility_table(const Evaluation& evaluation, const std::string& dataset) {
  Table table;
  table.title = "Tracking on " + dataset + ", by visible part of the perimeter";
  table.header = {
      "visible", "method", "frames", "right", "centre 5 %", "centre 2 %", "wrong", "none"};
  const std::vector<TrackingMeasures> all = all_measures(evaluation, dataset);
  for (std::size_t range = 0; range < kVisibleRanges; ++range) {
    std::string name = kVisibleRangeNames[range];
    for (std::size_t i = 0; i < all.size(); ++i) {
      const RangeCounts& counts = all[i].ranges[range];
      if (counts.frames == 0) continue;
      table.rows.push_back(visibility_row(name, evaluation.methods[i].name, counts));
      name.clear();
    }
  }
  table.note =
      "Fractions of frames, counted from the first frame with half of the perimeter in view, in "
      "each sequence and after each time out of view. Right: IoU inside the frame >= 0.8. Centre: "
      "within 5 and 2 % of the semi-major axis. Wrong: neither right nor within 5 %.";
  return table;
}

Table following_table(const Evaluation& evaluation, const std::string& dataset) {
  Table table;
  table.title = "Tracking summary on " + dataset;
  table.header = {"method",
                  "empty",
                  "locks",
                  "wrong",
                  "given",
                  "returns",
                  "median",
                  "max",
                  "in 2",
                  "ms p50",
                  "p95",
                  "p99",
                  "centre [px]"};
  const std::vector<TrackingMeasures> all = all_measures(evaluation, dataset);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TrackingMeasures& m = all[i];
    table.rows.push_back({evaluation.methods[i].name,
                          std::to_string(m.empty_frames),
                          share_text(m.locks_on_nothing, m.empty_frames),
                          std::to_string(m.wrong()),
                          std::to_string(m.given),
                          std::to_string(m.returns.size()),
                          frames_until(quantile(m.returns, 0.5)),
                          frames_until(quantile(m.returns, 1.0)),
                          number(share_soon(m.returns), 4),
                          number(quantile(m.times_ms, 0.5), 3),
                          number(quantile(m.times_ms, 0.95), 3),
                          number(quantile(m.times_ms, 0.99), 3),
                          number(quantile(m.centre_errors_px, 0.5), 3)});
  }
  table.note =
      "Locks: fraction of frames with an answer among the empty ones, which show no target. "
      "Wrong: number of frames. Given: initializations with the truth. Returns: times when half of "
      "the perimeter came back into view after the target was lost or out of view, and frames "
      "until the answer was right, 1 = immediately. Centre: median for frames with at least 60 % "
      "visible.";
  return table;
}

void write_json_tracking(std::ostream& out, const TrackingMeasures& m) {
  out << "\"visible\":{";
  for (std::size_t range = 0; range < kVisibleRanges; ++range) {
    out << (range == 0 ? "\"" : ",\"") << kVisibleRangeNames[range] << "\":";
    write_json_range(out, m.ranges[range]);
  }
  out << "},\"empty_frames\":" << m.empty_frames << ",\"locks_on_nothing\":" << m.locks_on_nothing
      << ",\"wrong\":" << m.wrong() << ",\"given\":" << m.given
      << ",\"returns\":" << m.returns.size()
      << ",\"frames_to_return_median\":" << json_number(quantile(m.returns, 0.5))
      << ",\"frames_to_return_max\":" << json_number(quantile(m.returns, 1.0))
      << ",\"returns_in_2_frames\":" << json_number(share_soon(m.returns))
      << ",\"median_ms\":" << json_number(quantile(m.times_ms, 0.5))
      << ",\"p95_ms\":" << json_number(quantile(m.times_ms, 0.95))
      << ",\"p99_ms\":" << json_number(quantile(m.times_ms, 0.99))
      << ",\"centre_error_median_px\":" << json_number(quantile(m.centre_errors_px, 0.5));
}

}  // namespace evaluate
