// SPDX-License-Identifier: MIT
#include "examples/landing/report.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>

#include "examples/evaluate/text.hpp"
#include "examples/landing/plots.hpp"

namespace landing {
namespace {

using evaluate::format;
using evaluate::Table;

struct Group {
  std::string name;
  std::vector<const Landing*> landings;
};

// Groups by method and speed, in order of their first landings.
std::vector<Group> groups_of(const std::vector<Landing>& landings) {
  std::vector<Group> groups;
  for (const Landing& landing : landings) {
    const std::string name =
        format("%s, %g m/s", landing.flight.method.c_str(), landing.flight.speed);
    auto group = std::find_if(
        groups.begin(), groups.end(), [&](const Group& known) { return known.name == name; });
    if (group == groups.end()) group = groups.insert(groups.end(), Group{name, {}});
    group->landings.push_back(&landing);
  }
  return groups;
}

using Figure = std::function<double(const Outcome&)>;

// Values of the landings that touched down, in ascending order.
std::vector<double> sorted(const Group& group, const Figure& figure) {
  std::vector<double> values;
  for (const Landing* landing : group.landings) {
    if (landing->outcome.has_touched_down) values.push_back(figure(landing->outcome));
  }
  std::sort(values.begin(), values.end());
  return values;
}

// The smallest value that this fraction of the values does not exceed.
double quantile(const std::vector<double>& values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  return values[static_cast<std::size_t>(std::max(rank, 0.0))];
}

double off_of(const Outcome& outcome) {
  return outcome.off.norm();
}

int climbs_of(const Group& group) {
  int climbs = 0;
  for (const Landing* landing : group.landings) climbs += landing->outcome.climbs;
  return climbs;
}

std::string share_of(long part, long all) {
  if (all == 0) return "-";
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(all);
  return format("%.1f", percent);
}

void write_csv(const std::filesystem::path& file, const std::vector<Landing>& landings) {
  std::ofstream out(file);
  out << "method,speed,course,condition,seed,touched_down,ahead_m,left_m,drift_m_s,sink_m_s,time_s,"
         "climbs,pictures\n";
  for (const Landing& landing : landings) {
    const Flight& flight = landing.flight;
    const Outcome& outcome = landing.outcome;
    out << format("%s,%g,%s,%s,%llu,%d,%.4f,%.4f,%.4f,%.4f,%.3f,%d,%zu\n",
                  flight.method.c_str(),
                  flight.speed,
                  name_of(flight.course),
                  flight.condition.c_str(),
                  static_cast<unsigned long long>(flight.seed),
                  outcome.has_touched_down ? 1 : 0,
                  outcome.off.x(),
                  outcome.off.y(),
                  outcome.drift,
                  outcome.sink,
                  outcome.time_s,
                  outcome.climbs,
                  outcome.moments.size());
  }
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

void write_table(std::ostream& out, const Table& table) {
  const auto write_row = [&](const std::vector<std::string>& row) {
    for (const std::string& cell : row) out << "| " << cell << ' ';
    out << "|\n";
  };
  out << "\n## " << table.title << "\n\n";
  write_row(table.header);
  write_row(std::vector<std::string>(table.header.size(), "---"));
  for (const auto& row : table.rows) write_row(row);
  if (!table.note.empty()) out << '\n' << table.note << '\n';
}

}  // namespace

Table outcome_table(const std::vector<Landing>& landings) {
  Table table;
  table.title = "Landings";
  table.header = {"method, platform",
                  "landings",
                  "within 0.3 m",
                  "%",
                  "off: median [m]",
                  "95 % [m]",
                  "largest [m]",
                  "drift: median [m/s]",
                  "time: median [s]",
                  "climbs",
                  "never down"};
  for (const Group& group : groups_of(landings)) {
    const auto all = static_cast<long>(group.landings.size());
    const long right = std::count_if(group.landings.begin(), group.landings.end(), [](auto* one) {
      return one->outcome.is_within(kMaxOff);
    });
    const std::vector<double> off = sorted(group, off_of);
    const auto drift = sorted(group, [](const Outcome& outcome) { return outcome.drift; });
    const auto time = sorted(group, [](const Outcome& outcome) { return outcome.time_s; });
    table.rows.push_back({group.name,
                          std::to_string(all),
                          std::to_string(right),
                          share_of(right, all),
                          evaluate::number(quantile(off, 0.5), 3),
                          evaluate::number(quantile(off, 0.95), 3),
                          evaluate::number(quantile(off, 1.0), 3),
                          evaluate::number(quantile(drift, 0.5), 2),
                          evaluate::number(quantile(time, 0.5), 1),
                          std::to_string(climbs_of(group)),
                          std::to_string(all - static_cast<long>(off.size()))});
  }
  table.note =
      "Off and drift: distance from the pad's centre and horizontal speed relative to it, at "
      "touchdown. Climbs: aborted descents.";
  return table;
}

Table unseen_table(const std::vector<Landing>& landings) {
  Table table;
  table.title =
      "Pictures [%] without a target, and without one although 30 % of the outline is in view";
  table.header = {"method, platform"};
  for (const char* phase : kPhaseNames) table.header.emplace_back(phase);
  for (const Group& group : groups_of(landings)) {
    std::vector<std::string> row = {group.name};
    for (std::size_t phase = 0; phase < kPhaseNames.size(); ++phase) {
      long frames = 0;
      long unseen = 0;
      long missed = 0;
      for (const Landing* landing : group.landings) {
        frames += landing->outcome.frames.at(phase);
        unseen += landing->outcome.unseen.at(phase);
        missed += landing->outcome.missed.at(phase);
      }
      row.push_back(frames == 0 ? "-" : share_of(unseen, frames) + ", " + share_of(missed, frames));
    }
    table.rows.push_back(row);
  }
  return table;
}

void write_report(const std::vector<Landing>& landings,
                  const std::string& command,
                  const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_csv(folder / "landings.csv", landings);
  plot_touchdowns(landings, folder / "touchdown");
  plot_errors(landings, folder / "errors");
  plot_flight(landings.front(), folder / "flight");
  std::ofstream out(folder / "report.md");
  out << "# Landings\n\n`" << command << "`\n";
  write_table(out, outcome_table(landings));
  write_table(out, unseen_table(landings));
  out << "\n## Touchdown positions\n\n![](touchdown.svg)\n\n![](errors.svg)\n"
      << "\n## First landing\n\n![](flight.svg)\n";
  if (!out.flush()) {
    throw std::runtime_error((folder / "report.md").string() + ": cannot be written");
  }
}

}  // namespace landing
