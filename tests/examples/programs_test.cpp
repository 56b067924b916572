// SPDX-License-Identifier: MIT
//
// The example programs on the command line.
#include "tests/examples/programs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/dataset_writer.hpp"
#include "examples/evaluate/twin.hpp"
#include "tests/support/terminal.hpp"

namespace {

namespace fs = std::filesystem;
using programs::Outcome;

Outcome run(const std::string& program, const std::string& arguments) {
  return programs::run(std::string(std::getenv("ELLIPSE_PROGRAMS")) + "/" + program + " " +
                       arguments);
}

class Programs : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("ellipse-programs-" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(Programs, DemoWritesVideoTextAndContactSheet) {
  const Outcome demo = run("ellipse-demo", "--frames 40 --out " + folder_.string());
  EXPECT_EQ(demo.status, 0) << demo.text;
  EXPECT_NE(demo.text.find("frames                      40"), std::string::npos) << demo.text;
  for (const char* name : {"annotated.mkv", "targets.ndjson", "contact_sheet.png"}) {
    EXPECT_GT(fs::file_size(folder_ / name), 1000U) << name;
  }
  // It can read what it has written.
  const fs::path again = folder_ / "again";
  const Outcome second =
      run("ellipse-demo",
          (folder_ / "annotated.mkv").string() + " --frames 25 --out " + again.string());
  EXPECT_EQ(second.status, 0) << second.text;
  EXPECT_NE(second.text.find("frames                      25"), std::string::npos) << second.text;
  EXPECT_TRUE(fs::exists(again / "contact_sheet.png"));
}

// A file as cameras and phones record it. The program that writes it gets no plugin path: it could
// not load a plugin built with a sanitizer.
TEST_F(Programs, DemoReadsH264WithSoundFromMp4) {
  const std::string video = (folder_ / "video.mp4").string();
  ASSERT_EQ(programs::run("GST_PLUGIN_PATH= GST_REGISTRY=" + (folder_ / "registry").string() +
                          " gst-launch-1.0 -q videotestsrc num-buffers=20 ! videoconvert ! "
                          "x264enc ! mp4mux name=mux ! filesink location=" +
                          video + " audiotestsrc num-buffers=40 ! audioconvert ! avenc_aac ! mux.")
                .status,
            0);
  const Outcome demo = run("ellipse-demo", video + " --out " + (folder_ / "out").string());
  EXPECT_EQ(demo.status, 0) << demo.text;
  EXPECT_NE(demo.text.find("frames                      20"), std::string::npos) << demo.text;
}

// A range check alone accepts "nan".
TEST_F(Programs, NonFiniteNumbersAreRejectedByName) {
  const std::string evaluate = "ellipse-evaluate scenes:1 ";
  const std::pair<std::string, std::string> commands[] = {{"ellipse-landing ", "--speed"},
                                                          {"ellipse-landing ", "--gust"},
                                                          {"ellipse-landing ", "--runs"},
                                                          {"ellipse-landing ", "--width"},
                                                          {"ellipse-demo ", "--frames"},
                                                          {evaluate, "--seconds"},
                                                          {evaluate, "--fps"},
                                                          {evaluate, "--picture-fps"}};
  for (const auto& [command, option] : commands) {
    for (const char* number : {"nan", "inf", "-nan", "1e999"}) {
      const Outcome outcome = run(command, option + " " + number);
      EXPECT_NE(outcome.status, 0) << command << option << number;
      EXPECT_NE(outcome.text.find(option), std::string::npos) << outcome.text;
    }
  }
  const Outcome second = run("ellipse-landing", "--speed 0,nan");
  EXPECT_NE(second.text.find("--speed"), std::string::npos) << second.text;
}

TEST_F(Programs, DemoReportsBadInputsInOneLine) {
  const fs::path text_file = folder_ / "text.mp4";
  std::ofstream(text_file) << "this is no video\n";
  for (const std::string& input : {std::string("no-such-file.mp4"),
                                   std::string("/dev/video99"),
                                   std::string("no-such-%03d.png"),
                                   text_file.string()}) {
    const Outcome demo = run("ellipse-demo", input + " --out " + folder_.string());
    EXPECT_EQ(demo.status, 1) << input;
    EXPECT_NE(demo.text.find(input), std::string::npos) << demo.text;
    EXPECT_EQ(std::count(demo.text.begin(), demo.text.end(), '\n'), 1) << demo.text;
  }
}

TEST_F(Programs, EvaluateNamesUnusableFoldersAndSettings) {
  const Outcome folder = run("ellipse-evaluate", folder_.string());
  EXPECT_EQ(folder.status, 1);
  EXPECT_NE(folder.text.find(folder_.string()), std::string::npos) << folder.text;
  const Outcome setting = run("ellipse-evaluate", folder_.string() + " --set no-such=1");
  EXPECT_EQ(setting.status, 1);
  EXPECT_NE(setting.text.find("no-such"), std::string::npos) << setting.text;
}

// A data set of one sequence, cut out of the twin.
void write_dataset(const fs::path& folder, std::size_t frames) {
  std::vector<evaluate::Sequence> twin = evaluate::make_twin();
  twin.resize(1);
  twin[0].frames.resize(frames);
  evaluate::write_dataset(twin, folder, [](const evaluate::Frame& /*frame*/) { return true; });
}

TEST_F(Programs, EvaluateTakesTheFrameRateOfPicturesWithoutTimes) {
  write_dataset(folder_, 2);
  std::ofstream(folder_ / "gt.csv") << "image,cx,cy,semi_major,semi_minor,angle_rad\n"
                                       "images/approach/frame0000.png,,,,,\n"
                                       "images/approach/frame0001.png,,,,,\n";
  const fs::path frames = folder_ / "frames";
  const Outcome outcome =
      run("ellipse-evaluate",
          folder_.string() + " --fps 2 --picture-fps 10 --methods arcs+none --frames " +
              frames.string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  std::ifstream in(frames);
  for (const char* time : {"\"pts_ns\":0,", "\"pts_ns\":100000000,"}) {
    std::string line;
    std::getline(in, line);
    EXPECT_NE(line.find(time), std::string::npos) << line;
  }
}

TEST_F(Programs, EvaluateCountsAndShowsMissingFrames) {
  write_dataset(folder_, 4);
  fs::remove(folder_ / "images/approach/frame0001.png");
  std::ofstream(folder_ / "images/approach/frame0002.png") << "no picture";
  const Outcome outcome =
      run("ellipse-evaluate", folder_.string() + " --methods contours+redetect");
  EXPECT_EQ(outcome.status, 2) << outcome.text;
  EXPECT_NE(outcome.text.find("\n2 frames"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("Missing frames: 2."), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("gt.csv:3: image"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("frame0002.png: not a readable picture"), std::string::npos)
      << outcome.text;
}

// CSRT is slow, so the program still runs when the key is pressed.
TEST_F(Programs, EvaluateShowsPartialResultsWhenInterrupted) {
  const fs::path json = folder_ / "json";
  support::Terminal terminal({std::string(std::getenv("ELLIPSE_PROGRAMS")) + "/ellipse-evaluate",
                              "--methods",
                              "contours+none,csrt",
                              "--json",
                              json.string()});
  if (terminal.is_missing()) GTEST_SKIP() << terminal.reason();
  ASSERT_TRUE(terminal.read_until("] 3/")) << terminal.text();  // frame count
  terminal.type('\x03');
  EXPECT_EQ(terminal.wait_for_end(), 130);
  const std::string& shown = terminal.text();
  EXPECT_NE(shown.find("Interrupted: the results cover"), std::string::npos) << shown;
  EXPECT_NE(shown.find("Accuracy, precision, recall and F1 on twin"), std::string::npos) << shown;
  EXPECT_GT(fs::file_size(json), 200U);
}

// A program that answers each image with an ellipse far from the target.
fs::path write_wrong_peer(const fs::path& folder) {
  const fs::path peer = folder / "peer.sh";
  std::ofstream(peer) << "#!/bin/sh\nwhile read -r image; do\n"
                         "echo \"{\\\"image\\\":\\\"$image\\\",\\\"ms\\\":1.5,"
                         "\\\"ellipses\\\":[[20,20,9,8,0]]}\"\ndone\n";
  fs::permissions(peer, fs::perms::owner_all);
  return peer;
}

TEST_F(Programs, EvaluateFailsBelowItsLimitsAndNamesThem) {
  write_dataset(folder_ / "set", 2);
  const fs::path peer = write_wrong_peer(folder_);
  const std::string good = (folder_ / "set").string() + " --methods arcs+edges ";
  const std::string both = good + "--peer 'wrong=" + peer.string() + "' ";
  const Outcome kept = run("ellipse-evaluate", good + "--min-f1 1 --min-recall 1 --max-false 0");
  EXPECT_EQ(kept.status, 0) << kept.text;
  const Outcome unkept =
      run("ellipse-evaluate", both + "--min-f1 .9 --min-recall .5 --max-false 1");
  EXPECT_EQ(unkept.status, 1);
  for (const char* text : {"wrong on twin: F1 0 is below 0.9\n",
                           "wrong on twin: recall 0 is below 0.5\n",
                           "wrong on twin: 2 frames with a false answer, at most 1 allowed\n"}) {
    EXPECT_NE(unkept.text.find(text), std::string::npos) << text << unkept.text;
  }
  EXPECT_EQ(unkept.text.find("arcs+edges on"), std::string::npos) << unkept.text;
  EXPECT_EQ(run("ellipse-evaluate", both + "--max-false 2").status, 0);
  EXPECT_NE(run("ellipse-evaluate", good + "--min-f1 95").status, 0);  // a fraction, not a percent
}

TEST_F(Programs, EvaluateSweepWritesTableAndPlots) {
  write_dataset(folder_ / "set", 3);
  const Outcome outcome =
      run("ellipse-evaluate",
          (folder_ / "set").string() + " --sweep detect-contour-overlap=0.5:0.9:0.2 --sweep-dir " +
              (folder_ / "sweep").string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  std::ifstream csv(folder_ / "sweep/detect-contour-overlap.csv");
  std::string line;
  int lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 4);
  EXPECT_GT(fs::file_size(folder_ / "sweep/detect-contour-overlap.svg"), 5000U);
  EXPECT_GT(fs::file_size(folder_ / "sweep/detect-contour-overlap.png"), 5000U);
}

TEST_F(Programs, EvaluateRunsAnotherProgramAsAPeer) {
  write_dataset(folder_ / "set", 2);
  const fs::path peer = write_wrong_peer(folder_);
  const Outcome outcome =
      run("ellipse-evaluate",
          (folder_ / "set").string() + " --methods contours+redetect --peer \"always wrong=" +
              peer.string() + "\" --json " + (folder_ / "json").string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  std::ifstream in(folder_ / "json");
  const std::string json((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t position = json.find("\"method\":\"always wrong\"");
  ASSERT_NE(position, std::string::npos) << json;
  EXPECT_NE(json.find("\"WD\":{\"frames\":2,\"avg_ms\":1.5", position), std::string::npos) << json;
}

TEST_F(Programs, EvaluateTabulatesAFolderOfDataSets) {
  write_dataset(folder_ / "sets/one", 3);
  write_dataset(folder_ / "sets/two", 2);
  const fs::path page = folder_ / "page";
  const Outcome outcome =
      run("ellipse-evaluate",
          (folder_ / "sets").string() +
              " --all --methods arcs+edges,arcs+none,canny-fit --report " + page.string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  // The second set has the same name as the first, "twin".
  for (const char* part : {"\nF1 by source",
                           "\ntwin                ",
                           "sets/two:twin",
                           "\nmean of 2 with ellipses",
                           "\n95 % intervals of F1 by source",
                           "\nAll ellipses by source"}) {
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << outcome.text;
  }
  std::ifstream in(page / "index.html");
  const std::string html((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t second = html.find("<h2>" + (folder_ / "sets/two").string());
  ASSERT_NE(second, std::string::npos);
  EXPECT_LT(html.find("The worst frames of arcs+edges"), second);
  EXPECT_NE(html.find("The worst frames of arcs+edges", second), std::string::npos);
}

TEST_F(Programs, EvaluateChoosesSettingsOnOtherSources) {
  for (const char* name : {"one", "two"}) write_dataset(folder_ / name, 2);
  const std::string sets = (folder_ / "one").string() + " " + (folder_ / "two").string();
  std::ofstream(folder_ / "apart.txt") << "first: twi?\n";
  const std::string choose = "--leave-one-out " + sets + " --choose min-axis=600:5 ";
  // By default all rendered sources form one group.
  const Outcome together = run("ellipse-evaluate", choose);
  EXPECT_EQ(together.status, 1) << together.text;
  EXPECT_NE(together.text.find("\"rendered\""), std::string::npos) << together.text;
  fs::rename(folder_ / "two/gt.csv", folder_ / "two/old.csv");
  std::ifstream in(folder_ / "two/old.csv");
  std::ofstream out(folder_ / "two/gt.csv");
  for (std::string line; std::getline(in, line);) {
    if (line.ends_with(",twin")) line.replace(line.size() - 4, 4, "other");
    out << line << '\n';
  }
  out.close();
  const Outcome apart =
      run("ellipse-evaluate",
          choose + "--methods arcs+none --groups " + (folder_ / "apart.txt").string());
  EXPECT_EQ(apart.status, 0) << apart.text;
  for (const char* part : {"\nLeft out: arcs+none on sources that the choice has not seen",
                           "\nIn sample: arcs+none on sources that the choice was made on",
                           "first",
                           "min-axis=5"}) {
    EXPECT_NE(apart.text.find(part), std::string::npos) << part << apart.text;
  }
  const Outcome nothing = run("ellipse-evaluate", "--leave-one-out " + sets);
  EXPECT_NE(nothing.status, 0);
  EXPECT_NE(nothing.text.find("--choose"), std::string::npos) << nothing.text;
}

TEST_F(Programs, EvaluateComparesTrackingOnScenesWithPeers) {
  const Outcome outcome =
      run("ellipse-evaluate",
          "scenes:7 --seconds 0.1 --fps 30 --methods arcs+edges,kcf,csrt --json " +
              (folder_ / "json").string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  for (const char* part : {"\n54 frames",  // 17 scenes
                           "Tracking on scenes, by visible part of the perimeter",
                           "Tracking summary on scenes",
                           "touchdown-7"}) {
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << outcome.text;
  }
  std::ifstream in(folder_ / "json");
  const std::string json((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  EXPECT_NE(json.find("{\"method\":\"csrt\",\"dataset\":\"scenes\",\"visible\":{"),
            std::string::npos)
      << json;
  EXPECT_EQ(run("ellipse-evaluate", "scenes:seven").status, 1);
}

TEST_F(Programs, EvaluateRunsOnDistortedScenes) {
  const fs::path frames = folder_ / "frames";
  const Outcome outcome = run("ellipse-evaluate",
                              "distorted:7 --seconds 0.1 --fps 10 --methods arcs+edges --frames " +
                                  frames.string() + " --report " + (folder_ / "page").string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  for (const char* part : {"\n36 frames",  // 18 scenes, two lenses
                           "Tracking summary on distorted",
                           "touchdown-barrel-7",
                           "approach-fisheye-7"}) {
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << outcome.text;
  }
  EXPECT_GT(fs::file_size(folder_ / "page/index.html"), 5000U);
  std::ifstream in(frames);
  for (std::string line; std::getline(in, line);) {
    EXPECT_NE(line.find(",\"tracker\":\""), std::string::npos) << line;
    const bool has_target = line.find("\"target\":null") == std::string::npos;
    EXPECT_EQ(line.find(",\"probability\":") != std::string::npos, has_target) << line;
  }
  EXPECT_EQ(run("ellipse-evaluate", "distorted:seven").status, 1);
}

TEST_F(Programs, EvaluateSearchesCoarselyAsUnderLoad) {
  const fs::path frames = folder_ / "frames";
  const std::string command = "scenes:7 --seconds 0.1 --fps 10 --methods arcs+none --frames " +
                              frames.string() + " --finest-scale ";
  const Outcome outcome = run("ellipse-evaluate", command + "4");
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  std::ifstream in(frames);
  int found = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find("\"target\":null") != std::string::npos) continue;
    ++found;
    EXPECT_NE(line.find(",\"scale\":4,"), std::string::npos) << line;
  }
  EXPECT_GT(found, 10);
  EXPECT_NE(run("ellipse-evaluate", command + "3").status, 0);
}

TEST_F(Programs, EvaluateNamesUnknownMethodsSweepsAndPeers) {
  for (const char* bad : {"--methods magic", "--sweep magic=1:2:1", "--peer magic"}) {
    const Outcome outcome = run("ellipse-evaluate", bad);
    EXPECT_EQ(outcome.status, 1) << bad;
    EXPECT_NE(outcome.text.find("magic"), std::string::npos) << outcome.text;
  }
}

constexpr const char* kShortLanding = "ellipse-landing --runs 1 --speed 0 --width 160 ";

// timeout ends a program that would wait forever, with status 124.
Outcome run_bounded(const std::string& arguments) {
  return programs::run("timeout 300 " + std::string(std::getenv("ELLIPSE_PROGRAMS")) + "/" +
                       arguments);
}

TEST_F(Programs, LandingReportsUnwritableOutputsBeforeTheFlight) {
  for (const std::string& output : {"--video " + (folder_ / "no/x.mkv").string(),
                                    "--video " + folder_.string(),
                                    std::string("--report /proc/x")}) {
    const Outcome landing = run_bounded(kShortLanding + output);
    EXPECT_EQ(landing.status, 1) << landing.text;
    EXPECT_EQ(landing.text, "ellipse-landing: " + output + ": cannot be written\n");
  }
}

TEST_F(Programs, LandingStopsWhenTheDiskIsFull) {
  const Outcome landing = run_bounded(std::string(kShortLanding) + "--video /dev/full");
  EXPECT_EQ(landing.status, 1) << landing.text;
  EXPECT_NE(landing.text.find("ellipse-landing: --video /dev/full: "), std::string::npos)
      << landing.text;
}

TEST_F(Programs, ReadMetadataPrintsTargets) {
  const Outcome example = run("02_read_metadata", "");
  EXPECT_EQ(example.status, 0);
  EXPECT_NE(example.text.find("target 1 at"), std::string::npos) << example.text;
}

TEST_F(Programs, DetectImagePrintsTheTarget) {
  run("ellipse-demo", "--frames 13 --out " + folder_.string());
  const Outcome example = run("01_detect_image", (folder_ / "contact_sheet.png").string());
  EXPECT_EQ(example.status, 0) << example.text;
  EXPECT_EQ(run("01_detect_image", "").status, 1);
  const Outcome missing = run("01_detect_image", (folder_ / "missing.png").string());
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.text.find("missing.png: cannot be read"), std::string::npos) << missing.text;
}

}  // namespace
