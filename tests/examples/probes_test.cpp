// SPDX-License-Identifier: MIT
//
// The example programs that read the metadata in a pad probe, in C and in Python.
#include <glib.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "core/scene/catalog.hpp"
#include "tests/examples/programs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using programs::Outcome;

constexpr const char* kPlot = "04_live_plot.py";

class Reader : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::getenv("ELLIPSE_PYTHON") == nullptr && is_script(GetParam())) {
      GTEST_SKIP() << "no introspection, or no Python with gi and matplotlib";
    }
    folder_ = fs::temp_directory_path() / ("ellipse-probes-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static bool is_script(const std::string& program) { return program.ends_with(".py"); }

  fs::path picture() const { return folder_ / "centre.png"; }

  // The command line that runs it on a source.
  std::string command(const std::string& program, const std::string& source) const {
    const std::string file = is_script(program) ? std::string(std::getenv("ELLIPSE_PYTHON")) + " " +
                                                      std::getenv("ELLIPSE_SCRIPTS")
                                                : std::getenv("ELLIPSE_PROGRAMS");
    const std::string save = program == kPlot ? " --save " + picture().string() : "";
    return file + "/" + program + save + " '" + source + "'";
  }

  Outcome run(const std::string& source) const {
    return programs::run(command(GetParam(), source));
  }

  fs::path folder_;
};

std::string test_name(const testing::TestParamInfo<const char*>& info) {
  const std::string file = fs::path(info.param).stem().string();
  return "Example" + file.substr(0, 2);
}

INSTANTIATE_TEST_SUITE_P(Examples,
                         Reader,
                         testing::Values("03_probe.py", kPlot, "05_probe"),
                         test_name);

TEST_P(Reader, ReportsUnplayableFilesInOneLine) {
  const Outcome element = run("nosuchsource");
  EXPECT_EQ(element.status, 1);
  EXPECT_EQ(element.text, "no element \"nosuchsource\"\n");
  const Outcome file = run("filesrc location=no-such-file name=file ! pngdec");
  EXPECT_EQ(file.status, 1);
  EXPECT_NE(file.text.find("file: Resource not found.\n"), std::string::npos) << file.text;
  EXPECT_EQ(std::count(file.text.begin(), file.text.end(), '\n'), 1) << file.text;
}

TEST_P(Reader, ReportsThatThePluginIsMissing) {
  const Outcome outcome =
      programs::run("GST_PLUGIN_PATH= GST_PLUGIN_SYSTEM_PATH= GST_REGISTRY=" +
                    (folder_ / "registry.bin").string() + " " + command(GetParam(), "fakesrc"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.text,
            "no element ellipsetrack: is gst-ellipse installed, or GST_PLUGIN_PATH set?\n");
}

// Modules of these names that fail to import come before the real ones in the path.
TEST_P(Reader, ReportsMissingModulesInOneLine) {
  if (!is_script(GetParam())) GTEST_SKIP() << "no Python";
  for (const std::string module : {"gi", "matplotlib"}) {
    const fs::path modules = folder_ / ("without-" + module);
    fs::create_directories(modules);
    const std::string why = "No module named '" + module + "'";
    std::ofstream(modules / (module + ".py")) << "raise ModuleNotFoundError(\"" << why << "\")\n";
    const Outcome outcome = programs::run("PYTHONPATH='" + modules.string() + ":'$PYTHONPATH " +
                                          command(GetParam(), "videotestsrc num-buffers=1"));
    if (module == "matplotlib" && std::string(GetParam()) != kPlot) {
      EXPECT_EQ(outcome.status, 0) << outcome.text;
    } else {
      EXPECT_EQ(outcome.status, 1);
      EXPECT_EQ(outcome.text.find(why + ": install python3-" + module), 0U) << outcome.text;
      EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    }
  }
}

TEST_P(Reader, ExitsCleanlyOnInterrupt) {
  // It runs once its first frame has been written.
  const std::string trace = (folder_ / "trace").string();
  const std::string start =
      command(GetParam(),
              "ellipsetestsrc is-live=true ! tee name=t t. ! queue ! ellipsejson ! filesink "
              "buffer-mode=unbuffered location=" +
                  trace + " t. ! queue");
  const std::string log = (folder_ / "log").string();
  support::ChildProcess program(
      {.arguments = {"sh", "-c", "exec " + start + " > " + log + " 2>&1"}});
  const auto has_begun = [&] { return fs::exists(trace) && fs::file_size(trace) > 0; };
  while (!has_begun() && !program.is_over()) g_usleep(100'000);
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 0) << support::contents_of(log);
  EXPECT_EQ(support::contents_of(log).find("Traceback"), std::string::npos)
      << support::contents_of(log);
}

class Probe : public Reader {};

INSTANTIATE_TEST_SUITE_P(Examples, Probe, testing::Values("03_probe.py", "05_probe"), test_name);

struct Printed {
  int frame = 0;
  ellipse::Ellipse ellipse;
};

std::vector<Printed> printed(const std::string& text, const std::string& role) {
  std::vector<Printed> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t numbers = line.find("centre");
    if (numbers == std::string::npos || line.find("  " + role + " ") == std::string::npos) continue;
    Printed one;
    ellipse::Ellipse& e = one.ellipse;
    EXPECT_EQ(std::sscanf(line.c_str(), "frame %d", &one.frame), 1) << line;
    EXPECT_EQ(std::sscanf(line.c_str() + numbers,
                          "centre %lf %lf semi-axes %lf %lf angle %lf",
                          &e.cx,
                          &e.cy,
                          &e.semi_major,
                          &e.semi_minor,
                          &e.angle_rad),
              5)
        << line;
    all.push_back(one);
  }
  return all;
}

// The truth of the source's first scene, at its own size and rate.
ellipse::Ellipse rendered(int frame) {
  constexpr int kWidth = 640;
  constexpr int kHeight = 360;
  const ellipse::Scene scene = ellipse::scene_by_name("approach");
  const auto view = ellipse::image_from_pad(scene, frame / 30.0, kWidth, kHeight);
  return ellipse::truth_of(scene.pad, view, kWidth, kHeight).outer_edge.value();
}

TEST_P(Probe, PrintsTheEllipsesOfEachFrame) {
  constexpr int kFrames = 30;
  const Outcome outcome = run("ellipsetestsrc num-buffers=" + std::to_string(kFrames));
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  const struct {
    const char* role;
    double tolerance_px;
  } kRoles[] = {{"truth", 0.05}, {"target", 0.25}};  // two digits are printed, the angle has three
  for (const auto& [role, tolerance_px] : kRoles) {
    const std::vector<Printed> ellipses = printed(outcome.text, role);
    ASSERT_EQ(ellipses.size(), kFrames) << outcome.text;
    for (int i = 0; i < kFrames; ++i) {
      EXPECT_EQ(ellipses[i].frame, i);
      EXPECT_LT(ellipse::max_difference_px(ellipses[i].ellipse, rendered(i)), tolerance_px)
          << role << " in frame " << i;
    }
  }
}

TEST_P(Probe, ReportsFramesWithoutEllipses) {
  const Outcome outcome = run("videotestsrc pattern=black num-buffers=2");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.text, "frame    0  nothing\nframe    1  nothing\n");
}

TEST_P(Probe, PrintsTheSameInCAndPython) {
  if (std::getenv("ELLIPSE_PYTHON") == nullptr) GTEST_SKIP() << "no Python with gi";
  const std::string source = "ellipsetestsrc scene=reenter num-buffers=60";
  const std::string twin = is_script(GetParam()) ? "05_probe" : "03_probe.py";
  EXPECT_EQ(run(source).text, programs::run(command(twin, source)).text);
}

class LivePlot : public Reader {
 protected:
  // Number of the picture's pixels in the colour of the target's line.
  int green_pixels() const {
    const cv::Mat image = cv::imread(picture().string());
    cv::Mat is_green;
    cv::inRange(image, cv::Scalar(44, 160, 44), cv::Scalar(44, 160, 44), is_green);
    return cv::countNonZero(is_green);
  }
};

INSTANTIATE_TEST_SUITE_P(Examples, LivePlot, testing::Values(kPlot), test_name);

TEST_P(LivePlot, DrawsTheTargetOverTheTruth) {
  const Outcome outcome = run("ellipsetestsrc num-buffers=60");
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  int found = 0;
  double off_px = 1.0;
  ASSERT_EQ(std::sscanf(outcome.text.c_str(),
                        "60 frames, target in %d, maximum centre error %lf px",
                        &found,
                        &off_px),
            2)
      << outcome.text;
  EXPECT_EQ(found, 60);
  EXPECT_LT(off_px, 0.1);
  EXPECT_GT(green_pixels(), 1000);
}

TEST_P(LivePlot, DrawsNoLineWithoutATarget) {
  const Outcome outcome = run("videotestsrc pattern=black num-buffers=2");
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_EQ(outcome.text, "2 frames, target in 0\n");
  EXPECT_LT(green_pixels(), 200);  // the legend has some
}

}  // namespace
