// SPDX-License-Identifier: MIT
#include "examples/landing/plots.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "examples/evaluate/plots.hpp"
#include "examples/evaluate/text.hpp"
#include "examples/landing/report.hpp"

namespace landing {
namespace {

using evaluate::format;

void write(const std::filesystem::path& file, const std::string& drawn) {
  std::ofstream out(file, std::ios::binary);
  out << drawn;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

void draw(std::filesystem::path file, int width, int height, const std::string& script) {
  const auto drawn_by = [&](const char* terminal) {
    return evaluate::run_gnuplot(
        format("set terminal %s size %d,%d font \"sans,11\" noenhanced background \"white\"\n",
               terminal,
               width,
               height) +
        "set border 3 lc rgb \"#888888\"\nset tics nomirror textcolor rgb \"#333333\"\n"
        "set grid lc rgb \"#e4e4e4\"\nset key reverse Left\n" +
        script);
  };
  write(file.replace_extension(".svg"), drawn_by("svg"));
  write(file.replace_extension(".png"), drawn_by("pngcairo"));
}

std::vector<std::string> methods_of(const std::vector<Landing>& landings) {
  std::vector<std::string> methods;
  for (const Landing& landing : landings) {
    const std::string& method = landing.flight.method;
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) {
      methods.push_back(method);
    }
  }
  return methods;
}

constexpr const char* kColours[] = {"#2a7f3f", "#d9742b", "#4063a3", "#9a3b7c"};

const char* colour_of(std::size_t method) {
  return kColours[method % std::size(kColours)];
}

template <class Write>
void write_data(std::ostream& script, const std::string& name, const Write& write_lines) {
  script << '$' << name << " << EOD\n";
  write_lines();
  script << "EOD\n";
}

// One labelled rectangle per phase.
void write_phases(std::ostream& script, const std::vector<Moment>& moments) {
  constexpr const char* kShades[] = {
      "#f4e3e3", "#e9eef8", "#e3f0ee", "#e6f2df", "#fdf3da", "#f6e0c6", "#f0d6e4"};
  int number = 1;
  for (std::size_t first = 0; first < moments.size();) {
    std::size_t last = first;
    while (last < moments.size() && moments[last].phase == moments[first].phase) ++last;
    const double from_s = moments[first].time_s;
    const double to_s = last < moments.size() ? moments[last].time_s : moments.back().time_s;
    const auto phase = static_cast<std::size_t>(moments[first].phase);
    script << format(
        "set object %d rectangle from %g, graph 0 to %g, graph 1 fc rgb \"%s\" fs solid noborder "
        "behind\n",
        number,
        from_s,
        to_s,
        kShades[phase]);
    script << format(
        "set label %d \"%s\" at %g, graph 0.97 rotate by -90 left tc rgb \"#555555\" "
        "font \"sans,9\" front\n",
        number,
        kPhaseNames.at(phase),
        0.5 * (from_s + to_s));
    ++number;
    first = last;
  }
}

std::string data_name(std::size_t method) {
  std::string name("m");
  name += std::to_string(method);
  return name;
}

}  // namespace

void plot_touchdowns(const std::vector<Landing>& landings, const std::filesystem::path& file) {
  std::ostringstream script;
  const std::vector<std::string> methods = methods_of(landings);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    write_data(script, data_name(i), [&] {
      script << "NaN NaN\n";
      for (const Landing& landing : landings) {
        if (landing.flight.method != methods[i] || !landing.outcome.has_touched_down) continue;
        script << -landing.outcome.off.y() << ' ' << landing.outcome.off.x() << '\n';
      }
    });
  }
  const double radius = landings.front().flight.rig.pad_radius;
  script << "set size ratio -1\nset xrange [-0.85:0.85]\nset yrange [-0.85:0.85]\nset parametric\n"
            "set trange [0:2*pi]\nset xlabel \"right of the centre [m]\"\n"
            "set ylabel \"ahead of the centre [m]\"\nset key outside top center horizontal\nplot "
         << format("%g*cos(t), %g*sin(t) lc rgb \"#999999\" lw 2 notitle, ", radius, radius)
         << format("%g*cos(t), %g*sin(t) lc rgb \"#999999\" dt 2 title \"%g m\"",
                   kMaxOff,
                   kMaxOff,
                   kMaxOff);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    script << format(", $m%zu using 1:2 with points pt 7 ps 0.6 lc rgb \"%s\" title \"%s\"",
                     i,
                     colour_of(i),
                     methods[i].c_str());
  }
  script << '\n';
  draw(file, 560, 600, script.str());
}

void plot_errors(const std::vector<Landing>& landings, const std::filesystem::path& file) {
  std::ostringstream script;
  const std::vector<std::string> methods = methods_of(landings);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    std::vector<double> off;
    double all = 0.0;
    for (const Landing& landing : landings) {
      if (landing.flight.method != methods[i]) continue;
      all += 1.0;
      if (landing.outcome.has_touched_down) off.push_back(landing.outcome.off.norm());
    }
    std::sort(off.begin(), off.end());
    write_data(script, data_name(i), [&] {
      script << "0 0\n";
      for (std::size_t k = 0; k < off.size(); ++k) {
        script << off[k] << ' ' << static_cast<double>(k + 1) / all << '\n';
      }
      script << "1 " << static_cast<double>(off.size()) / all << '\n';
    });
  }
  script << "set xrange [0:0.6]\nset yrange [0:1.02]\nset key bottom right\n"
            "set xlabel \"distance from the centre at touchdown [m]\"\n"
            "set ylabel \"fraction of landings within\"\n"
         << format(
                "set arrow from %g,0 to %g,1.02 nohead dt 2 lc rgb \"#999999\"\n", kMaxOff, kMaxOff)
         << "plot ";
  for (std::size_t i = 0; i < methods.size(); ++i) {
    script << format("%s$m%zu using 1:2 with steps lw 2 lc rgb \"%s\" title \"%s\"",
                     i > 0 ? ", " : "",
                     i,
                     colour_of(i),
                     methods[i].c_str());
  }
  script << '\n';
  draw(file, 640, 360, script.str());
}

void plot_flight(const Landing& landing, const std::filesystem::path& file) {
  const std::vector<Moment>& moments = landing.outcome.moments;
  std::ostringstream script;
  write_data(script, "flight", [&] {
    for (const Moment& moment : moments) {
      const double off = (moment.vehicle.position.head<2>() - moment.platform).norm();
      const double drift = (moment.vehicle.velocity.head<2>() - moment.platform_velocity).norm();
      script << moment.time_s << ' ' << moment.vehicle.position.z() << ' ' << off << ' ' << drift
             << ' ' << (moment.is_visible ? "NaN" : "0") << '\n';
    }
  });
  write_phases(script, moments);
  script << format("set xrange [0:%g]\n", moments.back().time_s)
         << "set yrange [0:*]\nset xlabel \"time [s]\"\nset ylabel \"m, m/s\"\n"
            "set key outside top center horizontal\n"
            "plot $flight using 1:2 with lines lw 2 lc rgb \"#4063a3\" title \"height [m]\", "
            "$flight using 1:3 with lines lw 2 lc rgb \"#2a7f3f\" title \"distance [m]\", "
            "$flight using 1:4 with lines lw 1 lc rgb \"#d9742b\" title \"drift [m/s]\", "
            "$flight using 1:5 with points pt 5 ps 0.5 lc rgb \"#b02020\" title \"no target\"\n";
  draw(file, 900, 380, script.str());
}

}  // namespace landing
