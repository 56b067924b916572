// SPDX-License-Identifier: MIT
//
// ellipse-evaluate: runs the tracker over data sets with ground truth and prints the measures and
// the times of [Keipour2021] III.
#include <gst/gst.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/tracker.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/picture_reader.hpp"
#include "examples/evaluate/tables.hpp"

namespace evaluate {
namespace {

constexpr std::int64_t kFrameNs = 33'333'333;  // data sets of single pictures carry no time

struct Options {
  std::vector<std::string> datasets;
  std::vector<std::string> settings;
  std::string detector = "contours";
  std::string tracking = "redetect";
  std::string rule = "iou";
  std::string frames_file;
  std::string json_file;
};

double elapsed_ms(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since)
      .count();
}

// cv::GaussianBlur, cv::Canny and cv::findContours with fixed thresholds: what any method built on
// contours pays before it looks for an ellipse.
class Reference {
 public:
  double run_ms(const cv::Mat& picture) {
    const auto start = std::chrono::steady_clock::now();
    cv::GaussianBlur(picture, smooth_, {5, 5}, 1.0);
    cv::Canny(smooth_, edges_, 40, 80);
    cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    return elapsed_ms(start);
  }

 private:
  cv::Mat smooth_;
  cv::Mat edges_;
  std::vector<std::vector<cv::Point>> contours_;
};

class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total) : total_(total), is_shown_(isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() {
    if (is_shown_) std::fprintf(stderr, "\r\033[K");
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance(const std::string& what) {
    ++done_;
    if (!is_shown_) return;
    const auto filled = static_cast<int>(30 * done_ / total_);
    std::fprintf(stderr,
                 "\r\033[K[%s%s] %zu/%zu %s",
                 std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(30 - filled), ' ').c_str(),
                 done_,
                 total_,
                 what.c_str());
  }

 private:
  std::size_t total_;
  std::size_t done_ = 0;
  bool is_shown_;
};

// One line a frame: {"image":"...","target":[cx,cy,a,b,angle],"ms":[..],"outcome":"TP"}.
void write_frame(std::ostream& out,
                 const Frame& frame,
                 const std::optional<ellipse::Target>& target,
                 const Result& result,
                 const FrameSize& size) {
  out << "{\"image\":" << std::quoted(frame.name) << ",\"size\":[" << size.width << ','
      << size.height << "],\"target\":";
  if (target) {
    const ellipse::Ellipse& e = target->ellipse;
    out << '[' << e.cx << ',' << e.cy << ',' << e.semi_major << ',' << e.semi_minor << ','
        << e.angle_rad << "],\"scale\":" << target->scale;
  } else {
    out << "null";
  }
  out << ",\"ms\":[" << result.processing_ms << "],\"outcome\":\""
      << kOutcomeNames[static_cast<std::size_t>(result.outcome)] << "\"}\n";
}

class Evaluation {
 public:
  Evaluation(const ellipse::TrackerSettings& settings, Rule rule, std::ostream* frames_out)
      : settings_(settings), rule_(rule), frames_out_(frames_out) {}

  Measures run(const Sequence& sequence, ProgressBar& progress) {
    ellipse::Tracker tracker(settings_);
    Measures measures;
    std::int64_t pts_ns = 0;
    for (const Frame& frame : sequence.frames) {
      measures.add(run_frame(tracker, frame, pts_ns));
      pts_ns += kFrameNs;
      progress.advance(frame.name);
    }
    return measures;
  }

 private:
  Result run_frame(ellipse::Tracker& tracker, const Frame& frame, std::int64_t pts_ns) {
    const cv::Mat picture = reader_.read(frame.image);
    const FrameSize size{picture.cols, picture.rows};
    const ellipse::ImageView view{
        picture.data, picture.cols, picture.rows, static_cast<std::ptrdiff_t>(picture.step)};

    Result result;
    const auto start = std::chrono::steady_clock::now();
    const std::optional<ellipse::Target> target = tracker.process(view, pts_ns);
    result.processing_ms = elapsed_ms(start);
    result.reference_ms = reference_.run_ms(picture);

    const auto answer = target ? std::optional(target->ellipse) : std::nullopt;
    result.outcome = judge(answer, frame.truth, size, rule_);
    if (result.outcome == Outcome::kTruePositive) {
      result.centre_error_px = (answer->center() - frame.truth.target->center()).norm();
      result.scale = target->scale;
    }
    if (frames_out_ != nullptr) write_frame(*frames_out_, frame, target, result, size);
    return result;
  }

  ellipse::TrackerSettings settings_;
  Rule rule_;
  std::ostream* frames_out_;
  PictureReader reader_;
  Reference reference_;
};

ellipse::TrackerSettings settings_from(const Options& options) {
  ellipse::TrackerSettings settings;
  ellipse::set_by_name(settings, "detector", options.detector);
  ellipse::set_by_name(settings, "tracking", options.tracking);
  for (const std::string& assignment : options.settings) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw std::invalid_argument("--set " + assignment + ": expected property=value");
    }
    ellipse::set_by_name(settings, assignment.substr(0, equals), assignment.substr(equals + 1));
  }
  settings.validate();
  return settings;
}

std::ofstream open_for_writing(const std::string& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error(file + ": cannot be written");
  out.precision(10);
  return out;
}

void check_written(std::ofstream& out, const std::string& file) {
  if (out.is_open() && !out.flush()) throw std::runtime_error(file + ": could not be written");
}

void run(const Options& options) {
  const ellipse::TrackerSettings settings = settings_from(options);
  const Rule rule = options.rule == "iou" ? Rule::kIou : Rule::kPublished;
  std::vector<Sequence> sequences;
  std::size_t frames = 0;
  for (const std::string& dataset : options.datasets) {
    for (Sequence& sequence : read_dataset(dataset)) {
      frames += sequence.frames.size();
      sequences.push_back(std::move(sequence));
    }
  }
  std::ofstream frames_out;
  if (!options.frames_file.empty()) frames_out = open_for_writing(options.frames_file);
  std::ofstream json_out;
  if (!options.json_file.empty()) json_out = open_for_writing(options.json_file);

  cv::setNumThreads(1);
  std::vector<NamedMeasures> results;
  {
    ProgressBar progress(frames);
    Evaluation evaluation(settings, rule, frames_out.is_open() ? &frames_out : nullptr);
    for (const Sequence& sequence : sequences) {
      results.push_back({sequence.name, evaluation.run(sequence, progress)});
    }
  }
  results.push_back(total(results));
  print_measures(std::cout, results);
  print_times(std::cout, results.back().measures);
  print_centre_errors(std::cout, results.back().measures);
  if (json_out.is_open()) write_json(json_out, results);
  check_written(frames_out, options.frames_file);
  check_written(json_out, options.json_file);
}

}  // namespace
}  // namespace evaluate

int main(int argc, char** argv) {
  gst_init(nullptr, nullptr);
  evaluate::Options options;
  CLI::App app{"Measures the ellipse tracker on data sets with ground truth."};
  app.name("ellipse-evaluate");
  app.add_option("DATASET", options.datasets, "Folders with gt.csv or ground_truth.txt")
      ->required();
  app.add_option("--detector", options.detector, "Detector")->capture_default_str();
  app.add_option("--tracking", options.tracking, "Tracking: none or redetect")
      ->capture_default_str();
  app.add_option("--set", options.settings, "property=value, as of the element ellipsetrack")
      ->allow_extra_args(false);
  app.add_option("--rule", options.rule, "When an answer is right")
      ->capture_default_str()
      ->check(CLI::IsMember({"iou", "published"}));
  app.add_option("--frames", options.frames_file, "Write one JSON line a frame");
  app.add_option("--json", options.json_file, "Write all measures as JSON");
  CLI11_PARSE(app, argc, argv);
  try {
    evaluate::run(options);
  } catch (const std::exception& error) {
    std::cerr << "ellipse-evaluate: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
