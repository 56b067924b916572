// SPDX-License-Identifier: MIT
#include "examples/evaluate/report.hpp"

#include <glib.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <ostream>
#include <stdexcept>

#include "examples/evaluate/breakdown.hpp"
#include "examples/evaluate/gallery.hpp"
#include "examples/evaluate/plots.hpp"
#include "examples/evaluate/source_tables.hpp"
#include "examples/evaluate/tables.hpp"
#include "examples/evaluate/text.hpp"
#include "examples/evaluate/tracking_tables.hpp"

namespace evaluate {
namespace {

constexpr std::size_t kExhibits = 18;          // for a single data set
constexpr std::size_t kExhibitsOfSeveral = 6;  // for each of several data sets

constexpr const char* kStyle = R"(
:root { --ink: #1c2228; --soft: #5c6873; --line: #d9dee3; --paper: #ffffff; --accent: #0b6e4f; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1120px; padding: 32px 24px 64px; color: var(--ink);
  background: var(--paper); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 28px; margin: 0 0 4px; }
h2 { font-size: 21px; margin: 48px 0 0; padding-top: 12px; border-top: 3px solid var(--accent); }
h3 { font-size: 16px; margin: 28px 0 8px; }
p.note { color: var(--soft); margin: 6px 0 0; font-size: 13px; }
code { font: 13px "DejaVu Sans Mono", monospace; background: #f2f4f6; padding: 2px 5px;
  border-radius: 3px; overflow-wrap: anywhere; }
.tiles { display: flex; flex-wrap: wrap; gap: 12px; margin: 16px 0; }
.tile { border: 1px solid var(--line); border-radius: 6px; padding: 10px 16px; min-width: 132px; }
.tile b { display: block; font-size: 24px; }
.tile span { color: var(--soft); font-size: 13px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13.5px; }
th, td { padding: 4px 10px; text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 2px solid var(--ink); }
tbody td { border-bottom: 1px solid var(--line); }
tbody tr.first td { border-top: 1px solid var(--soft); }
svg { max-width: 100%; height: auto; }
.problems { border: 1px solid #c2410c; border-left-width: 6px; border-radius: 4px;
  padding: 8px 16px; margin: 16px 0; background: #fff7ed; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(330px, 1fr)); gap: 14px; }
figure { margin: 0; }
figure img { width: 100%; display: block; border-radius: 4px; }
figcaption { font-size: 12.5px; color: var(--soft); overflow-wrap: anywhere; }
.truth { color: #2f9e44; font-weight: 600; } .answer { color: #e8590c; font-weight: 600; }
)";

std::string escaped(const std::string& text) {
  char* safe = g_markup_escape_text(text.c_str(), static_cast<gssize>(text.size()));
  std::string result = safe;
  g_free(safe);
  return result;
}

// Green for good values, red for bad ones.
std::string tint(const std::string& cell) {
  char* end = nullptr;
  const double grade = std::strtod(cell.c_str(), &end);
  if (end == cell.c_str() || *end != '\0') return "";
  const double bad = std::min(1.0, std::max(0.0, (1.0 - grade) / 0.3));
  return format(
      " style=\"background:hsl(%.0f 65%% %.0f%%)\"", 140.0 - 125.0 * bad, 90.0 - 6.0 * bad);
}

void write_table(std::ostream& out, const Table& table, bool is_tinted) {
  out << "<h3>" << escaped(table.title) << "</h3>\n<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& name : table.header) out << "<th>" << escaped(name) << "</th>";
  out << "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out << (row[0].empty() ? "<tr>" : "<tr class=\"first\">");
    for (std::size_t i = 0; i < row.size(); ++i) {
      out << "<td" << (is_tinted && i > 1 ? tint(row[i]) : "") << '>' << escaped(row[i]) << "</td>";
    }
    out << "</tr>\n";
  }
  out << "</tbody></table></div>\n<p class=\"note\">" << escaped(table.note) << "</p>\n";
}

void write_tiles(std::ostream& out, const Evaluation& evaluation, const std::string& dataset) {
  const Measures m = measures_of(
      evaluation, 0, [&](const SeenFrame& seen) { return seen.sequence->dataset == dataset; });
  const double ratio = quantile(m.all_times_ms(), 0.5) / quantile(m.reference_times_ms(), 0.5);
  const auto tile = [&](const std::string& value, const char* name) {
    out << "<div class=\"tile\"><b>" << value << "</b><span>" << name << "</span></div>\n";
  };
  out << "<p class=\"note\">" << escaped(evaluation.methods[0].name)
      << "</p><div class=\"tiles\">\n";
  tile(number(m.f1(), 4), "F1");
  tile(number(m.precision(), 4), "precision");
  tile(number(m.recall(), 4), "recall");
  tile(number(quantile(m.all_centre_errors_px(), 0.5), 3) + " px", "median centre error");
  tile(number(quantile(m.all_times_ms(), 0.5), 2) + " ms", "median time per frame");
  tile(number(ratio, 2) + " &times;", "relative to Canny + findContours");
  out << "</div>\n";
}

// Removes the SVG file's header.
std::string inline_svg(const std::string& svg) {
  const std::size_t begin = svg.find("<svg");
  return begin == std::string::npos ? svg : svg.substr(begin);
}

void write_gallery(std::ostream& out,
                   const Evaluation& evaluation,
                   const std::string& dataset,
                   std::size_t max_exhibits) {
  out << "<h3>The worst frames of " << escaped(evaluation.methods[0].name)
      << "</h3>\n<p class=\"note\"><span class=\"truth\">Truth</span> and <span class=\"answer\">"
         "answer</span>. WD: wrong target, FP: no target present, FN: missed, TP: right, but "
         "inaccurate.</p>\n<div class=\"gallery\">\n";
  for (const Exhibit& exhibit : worst_frames(evaluation, 0, dataset, max_exhibits)) {
    cv::Mat small = exhibit.picture;
    if (small.cols > 640) {
      cv::resize(small, small, {640, 640 * small.rows / small.cols}, 0.0, 0.0, cv::INTER_AREA);
    }
    std::vector<std::uint8_t> file;
    cv::imencode(".jpg", small, file, {cv::IMWRITE_JPEG_QUALITY, 82});
    char* text = g_base64_encode(file.data(), file.size());
    out << "<figure><img alt=\"" << escaped(exhibit.caption) << "\" src=\"data:image/jpeg;base64,"
        << text << "\"><figcaption>" << escaped(exhibit.caption) << "</figcaption></figure>\n";
    g_free(text);
  }
  out << "</div>\n";
}

void write_problems(std::ostream& out,
                    const Evaluation& evaluation,
                    const std::vector<std::string>& problems) {
  if (!evaluation.is_interrupted && problems.empty()) return;
  out << "<div class=\"problems\"><b>These results are incomplete.</b>";
  if (evaluation.is_interrupted) {
    out << "<p>Interrupted after " << evaluation.frames.size() << " of "
        << evaluation.planned_frames << " frames.</p>";
  }
  if (!problems.empty()) out << "<ul>";
  for (const std::string& problem : problems) out << "<li>" << escaped(problem) << "</li>";
  if (!problems.empty()) out << "</ul>";
  out << "</div>\n";
}

}  // namespace

void write_report(const Evaluation& evaluation,
                  const std::string& command,
                  const std::vector<std::string>& problems,
                  const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / "index.html";
  std::ofstream out(file);
  out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>gst-ellipse: "
         "evaluation</title>\n<meta name=\"viewport\" content=\"width=device-width\"><style>"
      << kStyle << "</style></head><body>\n<h1>Ellipse detection benchmark</h1>\n<p class=\"note\">"
      << evaluation.frames.size() << " frames, " << evaluation.methods.size()
      << " methods in the same run. <code>" << escaped(command) << "</code></p>\n";
  write_problems(out, evaluation, problems);
  out << "<h2>All sources</h2>\n";
  for (const Table& table : source_tables(evaluation)) write_table(out, table, false);
  const std::vector<std::string> datasets = datasets_of(evaluation);
  const std::size_t exhibits = datasets.size() > 1 ? kExhibitsOfSeveral : kExhibits;
  for (const std::string& dataset : datasets) {
    out << "<h2>" << escaped(dataset) << "</h2>\n";
    write_tiles(out, evaluation, dataset);
    write_table(out, measures_table(evaluation, dataset), false);
    write_table(out, sequences_table(evaluation, dataset), true);
    write_table(out, visibility_table(evaluation, dataset), false);
    write_table(out, following_table(evaluation, dataset), false);
    out << "<h3>Performance by condition</h3>\n"
        << inline_svg(plot(breakdown(evaluation, dataset), PlotFormat::kSvg)) << '\n';
    write_table(out, times_table(evaluation, dataset), false);
    write_table(out, centre_table(evaluation, dataset), false);
    write_gallery(out, evaluation, dataset, exhibits);
  }
  out << "</body></html>\n";
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace evaluate
