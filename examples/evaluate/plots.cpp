// SPDX-License-Identifier: MIT
#include "examples/evaluate/plots.hpp"

#include <gio/gio.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace evaluate {
namespace {

constexpr int kPanelWidth = 560;
constexpr int kPanelHeight = 300;
constexpr int kPanelColumns = 2;

template <class Type>
using Object = std::unique_ptr<Type, decltype(&g_object_unref)>;

// Quotes text for gnuplot, with its markup disabled.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

void write_data(std::ostream& script, const Panel& panel, std::size_t number) {
  script << "$data" << number << " << EOD\n";
  const std::size_t points = panel.ranges.empty() ? panel.x.size() : panel.ranges.size();
  for (std::size_t i = 0; i < points; ++i) {
    if (panel.ranges.empty()) {
      script << panel.x[i];
    } else {
      script << i;
    }
    for (const Curve& curve : panel.curves) {
      if (std::isfinite(curve.y[i])) {
        script << ' ' << curve.y[i];
      } else {
        script << " NaN";
      }
    }
    script << '\n';
  }
  script << "EOD\n";
}

// Bars begin at 0. Curves of shares begin below the lowest point, at a multiple of .05.
std::string y_range_of(const Panel& panel) {
  if (!panel.is_share) return "[0:*]";
  if (!panel.ranges.empty()) return "[0:1.03]";
  double lowest = 1.0;
  for (const Curve& curve : panel.curves) {
    for (const double y : curve.y) lowest = std::isfinite(y) ? std::min(lowest, y) : lowest;
  }
  const double first = std::max(0.0, std::floor(20.0 * (lowest - 0.01)) / 20.0);
  std::ostringstream range;
  range << '[' << first << ':' << 1.0 + 0.03 * (1.0 - first) << ']';
  return range.str();
}

void write_panel(std::ostream& script, const Panel& panel, std::size_t number) {
  script << "set title " << quoted(panel.title) << "\nset xlabel " << quoted(panel.x_label)
         << "\nset ylabel " << quoted(panel.y_label) << "\nset yrange " << y_range_of(panel)
         << '\n';
  if (panel.ranges.empty()) {
    script << "set xtics auto norotate\nset xrange [*:*]\n";
  } else {
    script << "set xrange [-0.5:" << static_cast<double>(panel.ranges.size()) - 0.5
           << "]\nset xtics rotate by -25 (";
    for (std::size_t i = 0; i < panel.ranges.size(); ++i) {
      script << (i > 0 ? ", " : "") << quoted(panel.ranges[i]) << ' ' << i;
    }
    script << ")\n";
  }
  script << "plot ";
  for (std::size_t k = 0; k < panel.curves.size(); ++k) {
    script << (k > 0 ? ", " : "") << "$data" << number << " using ";
    if (panel.ranges.empty()) {
      script << "1:" << k + 2 << " with linespoints lw 2 pt 7 ps 0.5";
    } else {
      script << k + 2 << " with histograms";
    }
    script << " title " << quoted(panel.curves[k].title);
  }
  script << '\n';
}

std::string script_of(const std::vector<Panel>& panels, PlotFormat format) {
  std::ostringstream script;
  script.precision(10);
  const std::size_t rows = (panels.size() + kPanelColumns - 1) / kPanelColumns;
  const int columns = panels.size() > 1 ? kPanelColumns : 1;
  script << "set terminal " << (format == PlotFormat::kSvg ? "svg" : "pngcairo") << " size "
         << columns * kPanelWidth << ',' << static_cast<int>(rows) * kPanelHeight
         << " font \"sans,11\" noenhanced background \"white\"\n"
         << "set datafile missing \"NaN\"\nset grid lc rgb \"#dddddd\"\nset border 3\n"
         << "set tics nomirror\nset key outside right center vertical reverse Left\nset style fill "
            "solid 0.85\nset boxwidth 0.9\nset offsets graph 0.02, 0.02, 0.05, 0\n";
  for (std::size_t i = 0; i < panels.size(); ++i) write_data(script, panels[i], i);
  script << "set multiplot layout " << rows << ',' << columns << '\n';
  for (std::size_t i = 0; i < panels.size(); ++i) write_panel(script, panels[i], i);
  script << "unset multiplot\n";
  return script.str();
}

std::string text_of(GBytes* bytes) {
  gsize size = 0;
  const auto* data = static_cast<const char*>(g_bytes_get_data(bytes, &size));
  std::string text(data != nullptr ? data : "", size);
  g_bytes_unref(bytes);
  return text;
}

[[noreturn]] void fail(GError* error) {
  const std::string what = std::string("gnuplot: ") + error->message;
  g_error_free(error);
  throw std::runtime_error(what);
}

}  // namespace

std::string run_gnuplot(const std::string& script) {
  GError* error = nullptr;
  const auto flags =
      static_cast<GSubprocessFlags>(G_SUBPROCESS_FLAGS_STDIN_PIPE | G_SUBPROCESS_FLAGS_STDOUT_PIPE |
                                    G_SUBPROCESS_FLAGS_STDERR_PIPE);
  const Object<GSubprocess> gnuplot(g_subprocess_new(flags, &error, "gnuplot", "-", nullptr),
                                    g_object_unref);
  if (!gnuplot) fail(error);
  GBytes* input = g_bytes_new_static(script.data(), script.size());
  GBytes* output = nullptr;
  GBytes* errors = nullptr;
  const bool has_run =
      g_subprocess_communicate(gnuplot.get(), input, nullptr, &output, &errors, &error) != FALSE;
  g_bytes_unref(input);
  if (!has_run) fail(error);
  const std::string error_text = text_of(errors);
  std::string image = text_of(output);
  if (!g_subprocess_get_successful(gnuplot.get()) || image.empty()) {
    throw std::runtime_error("gnuplot: " + error_text);
  }
  return image;
}

std::string plot(const std::vector<Panel>& panels, PlotFormat format) {
  return run_gnuplot(script_of(panels, format));
}

void plot_to(const std::filesystem::path& file,
             const std::vector<Panel>& panels,
             PlotFormat format) {
  const std::string image = plot(panels, format);
  std::ofstream out(file, std::ios::binary);
  out << image;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace evaluate
