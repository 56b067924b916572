// SPDX-License-Identifier: MIT
//
// Data sets, the twin and reading pictures.
#include "examples/evaluate/dataset.hpp"

#include <gst/gst.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "core/scene/catalog.hpp"
#include "examples/evaluate/breakdown.hpp"
#include "examples/evaluate/dataset_writer.hpp"
#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/method.hpp"
#include "examples/evaluate/picture_reader.hpp"
#include "examples/evaluate/report.hpp"
#include "examples/evaluate/scenes.hpp"
#include "examples/evaluate/sweep.hpp"
#include "examples/evaluate/tables.hpp"
#include "examples/evaluate/twin.hpp"
#include "tests/support/temporary_folder.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

class DatasetFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("ellipse-" + std::to_string(getpid()) +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  // Creates picture files that are never read.
  void touch(const std::vector<std::string>& names) const {
    for (const std::string& name : names) write(name, "");
  }
  [[nodiscard]] std::string error() const {
    try {
      (void)read_dataset(folder_);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(DatasetFiles, ReadsCsvInNaturalOrderBySequence) {
  write("gt.csv",
        "image,cx,cy,semi_major,semi_minor,angle_rad,visible_fraction\n"
        "images/b/frame10.jpg,1,2,30,20,0.5,0.75\n"
        "images/b/frame9.jpg,,,,,,\n"
        "images/a/frame1.jpg,1,2,30,20,-0.5,\r\n");
  touch({"images/b/frame10.jpg", "images/b/frame9.jpg", "images/a/frame1.jpg"});
  const Dataset dataset = read_dataset(folder_);
  EXPECT_TRUE(dataset.problems.empty());
  const auto& sequences = dataset.sequences;
  ASSERT_EQ(sequences.size(), 2U);
  EXPECT_EQ(sequences[0].name, "a");
  ASSERT_EQ(sequences[1].frames.size(), 2U);
  EXPECT_EQ(sequences[1].frames[0].name, "b/frame9.jpg");
  EXPECT_FALSE(sequences[1].frames[0].truth.target);
  EXPECT_EQ(sequences[1].frames[1].truth.target->semi_major, 30.0);
  EXPECT_EQ(sequences[1].frames[1].truth.visible_fraction, 0.75);
  EXPECT_FALSE(sequences[0].frames[0].truth.visible_fraction);
}

TEST_F(DatasetFiles, ReadsThePublishedFormat) {
  write("one/ground_truth.txt",
        "Filename\tHasTarget\tTargetCenterX\tTargetCenterY\tTargetWidth\tTargetHeight\t"
        "TargetAngle\n"
        "f1.jpg\t1\t100.0\t50.0\t40.0\t60.0\t90.0\n"
        "f2.jpg\t0\t0.000\t0.000\t0.000\t0.000\t0.000\n"
        "f3.jpg\t1\t-1.000\t-1.000\t-1.000\t-1.000\t-1.000\n");
  touch({"one/f1.jpg", "one/f2.jpg", "one/f3.jpg"});
  const auto sequences = read_dataset(folder_).sequences;
  ASSERT_EQ(sequences.size(), 1U);
  const auto& frames = sequences[0].frames;
  ASSERT_EQ(frames.size(), 3U);
  // The width is the minor axis and lies along y, so that the major axis lies along x.
  EXPECT_EQ(frames[0].truth.target->semi_major, 30.0);
  EXPECT_EQ(frames[0].truth.target->semi_minor, 20.0);
  EXPECT_NEAR(std::sin(frames[0].truth.target->angle_rad), 0.0, 1e-12);
  EXPECT_FALSE(frames[1].truth.target);
  EXPECT_TRUE(frames[1].truth.is_labelled);
  EXPECT_FALSE(frames[2].truth.is_labelled);
}

TEST_F(DatasetFiles, KeepsFoldersOfTheSameNameApart) {
  write("gt.csv",
        "image,cx,cy,semi_major,semi_minor,angle_rad\n"
        "one/img/1.png,,,,,\ntwo/img/1.png,,,,,\n3.png,,,,,\n");
  touch({"one/img/1.png", "two/img/1.png", "3.png"});
  const auto sequences = read_dataset(folder_).sequences;
  ASSERT_EQ(sequences.size(), 3U);
  EXPECT_EQ(sequences[0].name, folder_.filename().string());
  EXPECT_EQ(sequences[1].name, "one/img");
  EXPECT_EQ(sequences[2].name, "two/img");
}

TEST_F(DatasetFiles, ProblemsNameFileAndLineOfMalformedRows) {
  touch({"a.jpg", "b.jpg", "c.jpg", "d.jpg"});
  write("gt.csv",
        "image,cx,cy,semi_major,semi_minor,angle_rad\n"
        "a.jpg,1,2,x,20,0\n"
        "b.jpg,1,2,10,20,0\n"
        "c.jpg,1,2\n"
        "d.jpg,1,2,20,10,0\n");
  const Dataset dataset = read_dataset(folder_);
  ASSERT_EQ(dataset.problems.size(), 4U);  // and c.jpg has no valid line
  EXPECT_NE(dataset.problems[0].find("gt.csv:2: semi_major"), std::string::npos);
  EXPECT_NE(dataset.problems[1].find("gt.csv:3: the axes"), std::string::npos);
  EXPECT_NE(dataset.problems[2].find("gt.csv:4: 3 fields"), std::string::npos);
  EXPECT_EQ(dataset.missing_frames, 3U);
  ASSERT_EQ(dataset.sequences.size(), 1U);
  EXPECT_EQ(dataset.sequences[0].frames.size(), 1U);
}

TEST_F(DatasetFiles, ReportsImagesWithoutRowsAndRowsWithoutImages) {
  touch({"a.jpg", "c.jpg"});
  write("gt.csv", "image,cx,cy,semi_major,semi_minor,angle_rad\na.jpg,,,,,\nb.jpg,,,,,\n");
  const Dataset dataset = read_dataset(folder_);
  ASSERT_EQ(dataset.problems.size(), 2U);
  EXPECT_NE(dataset.problems[0].find("gt.csv:3: image"), std::string::npos);
  EXPECT_NE(dataset.problems[1].find("c.jpg: not in the table"), std::string::npos);
  EXPECT_EQ(dataset.missing_frames, 1U);
}

TEST_F(DatasetFiles, RejectsIncompleteAndDuplicateRows) {
  touch({"a.jpg", "b.jpg", "c.jpg"});
  write("gt.csv",
        "image,cx,cy,semi_major,semi_minor,angle_rad,visible_fraction\n"
        "a.jpg,,2,20,10,0,1\n"
        "b.jpg,1,2,20,10,0,-3\n"
        "c.jpg,1,2,20,10,0,1\n"
        "c.jpg,1,2,20,10,0,1\n");
  const Dataset dataset = read_dataset(folder_);
  ASSERT_EQ(dataset.problems.size(), 3U);
  EXPECT_NE(dataset.problems[0].find("gt.csv:2: some fields"), std::string::npos);
  EXPECT_NE(dataset.problems[1].find("gt.csv:3: visible_fraction"), std::string::npos);
  EXPECT_NE(dataset.problems[2].find("gt.csv:5: image"), std::string::npos);
  EXPECT_EQ(dataset.sequences[0].frames.size(), 1U);
}

TEST_F(DatasetFiles, RejectsMissingEmptyAndIncompleteTables) {
  EXPECT_NE(error().find("neither gt.csv nor ground_truth.txt"), std::string::npos);
  write("gt.csv", "");
  EXPECT_NE(error().find("is empty"), std::string::npos);
  write("gt.csv", "image,cx\na.jpg,1\n");
  touch({"a.jpg"});
  EXPECT_NE(error().find("no column \"cy\""), std::string::npos) << error();
}

TEST_F(DatasetFiles, ReadInvertsWrite) {
  std::vector<Sequence> twin = make_twin();
  twin = {twin.front(), twin.back()};  // of two data sets
  for (Sequence& sequence : twin) sequence.frames.resize(3);
  write_dataset(twin, folder_, [](const Frame& /*frame*/) { return true; });
  const std::vector<Sequence> again = read_dataset(folder_).sequences;
  ASSERT_EQ(again.size(), 2U);
  std::swap(twin[0], twin[1]);  // sorted by name
  for (std::size_t i = 0; i < again.size(); ++i) {
    ASSERT_EQ(again[i].frames.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) {
      const Frame& written = twin[i].frames[k];
      const Frame& read = again[i].frames[k];
      EXPECT_EQ(read.name, written.name);
      EXPECT_EQ(read.truth.target, written.truth.target);
      EXPECT_EQ(read.conditions.noise, written.conditions.noise);
      EXPECT_EQ(read.pts_ns, written.pts_ns);
      EXPECT_EQ(again[i].dataset, twin[i].dataset);
      EXPECT_EQ(cv::norm(again[i].pictures->picture(read), twin[i].pictures->picture(written)), 0);
    }
  }
}

TEST(Twin, HasTheFrameCountsOfThePapersDataSet) {
  std::map<std::string, std::pair<int, int>> counts;  // frames, frames with the target
  for (const Sequence& sequence : make_twin()) {
    for (const Frame& frame : sequence.frames) {
      ++counts[sequence.dataset].first;
      counts[sequence.dataset].second += frame.truth.target ? 1 : 0;
    }
  }
  EXPECT_EQ(counts["twin"], std::pair(1511, 1378));
  EXPECT_EQ(counts["thin"], std::pair(456, 456));
}

TEST(Twin, TruthMatchesTheRenderedFrame) {
  // The picture has its contrast along the target's outline.
  const Sequence sequence = make_twin()[0];
  const Frame& frame = sequence.frames[70];
  const cv::Mat picture = sequence.pictures->picture(frame);
  double contrast = 0.0;
  for (int i = 0; i < 36; ++i) {
    const ellipse::Ellipse& e = *frame.truth.target;
    const Eigen::Vector2d out = e.center() + 1.08 * (e.point_at(0.174 * i) - e.center());
    const Eigen::Vector2d in = e.center() + 0.92 * (e.point_at(0.174 * i) - e.center());
    const auto level = [&](const Eigen::Vector2d& p) {
      return static_cast<double>(picture.at<std::uint8_t>(cvRound(p.y()), cvRound(p.x())));
    };
    contrast += (level(out) - level(in)) / 36.0;
  }
  EXPECT_GT(contrast, 100.0);
}

TEST(Scenes, SeedsAreParsedAsNumbersRangesAndLists) {
  using Seeds = std::vector<std::uint64_t>;
  EXPECT_EQ(scene_seeds("scenes:7"), Seeds{7});
  EXPECT_EQ(scene_seeds("scenes:901-903,7"), (Seeds{901, 902, 903, 7}));
  EXPECT_FALSE(scene_seeds("some/folder"));
  for (const char* bad :
       {"scenes:", "scenes:x", "scenes:1x", "scenes:1,", "scenes:2-1", "scenes:1-99999"}) {
    EXPECT_THROW((void)scene_seeds(bad), std::invalid_argument) << bad;
  }
}

TEST(Scenes, MakesOneSequencePerCatalogSceneAndSeed) {
  const std::vector<Sequence> scenes = make_scenes({5, 6}, {2.0, 15.0});
  ASSERT_EQ(scenes.size(), 2 * ellipse::scene_catalog().size());
  EXPECT_EQ(scenes[0].name, "approach-5");
  EXPECT_EQ(scenes[1].name, "approach-6");
  for (const Sequence& sequence : scenes) {
    ASSERT_EQ(sequence.frames.size(), 30U);
    EXPECT_EQ(sequence.dataset, "scenes");
    EXPECT_EQ(sequence.frames[0].pts_ns, 0);
    EXPECT_EQ(sequence.frames[29].pts_ns, 1'933'333'333);
  }
  const cv::Mat first = scenes[0].pictures->picture(scenes[0].frames[0]);
  const cv::Mat last = scenes[0].pictures->picture(scenes[0].frames[29]);
  EXPECT_GT(cv::norm(first, last, cv::NORM_INF), 0.0);
  // The first frame again, after the last one, when the renderer has been released.
  EXPECT_EQ(cv::norm(first, scenes[0].pictures->picture(scenes[0].frames[0]), cv::NORM_INF), 0.0);
  EXPECT_THROW((void)make_scenes({5}, {0.01, 15.0}), std::invalid_argument);
}

TEST(Scenes, GivesOneSceneOfTheCatalogByName) {
  const ScenePace pace{1.0, 10.0};
  const auto sequences = one_scene_by_name("scenes-negative:5-6", pace);
  ASSERT_TRUE(sequences);
  ASSERT_EQ(sequences->size(), 2U);
  const std::vector<Sequence> all = make_scenes({6}, pace);
  const auto same = std::ranges::find(all, "negative-6", &Sequence::name);
  ASSERT_NE(same, all.end());
  const Sequence& second = sequences->back();
  EXPECT_EQ(second.name, same->name);
  EXPECT_EQ(second.dataset, "scenes-negative");
  ASSERT_EQ(second.frames.size(), same->frames.size());
  const cv::Mat picture = second.pictures->picture(second.frames[9]);
  EXPECT_EQ(cv::norm(picture, same->pictures->picture(same->frames[9]), cv::NORM_INF), 0.0);
  EXPECT_FALSE(one_scene_by_name("scenes:5", pace));
  EXPECT_FALSE(one_scene_by_name("scenes-of-mine", pace));  // a folder
  try {
    (void)one_scene_by_name("scenes-moon:5", pace);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"moon\""), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)one_scene_by_name("scenes-negative:x", pace), std::invalid_argument);
}

TEST(Scenes, PadsLargerThanThePictureKeepTheirTruth) {
  int inside_only = 0;
  int empty = 0;
  for (const Sequence& sequence : make_scenes({5}, {16.0, 10.0})) {
    for (const Frame& frame : sequence.frames) {
      inside_only += frame.truth.target && frame.truth.visible_fraction == 0.0 ? 1 : 0;
      const bool may_be_empty = sequence.name == "negative-5" || sequence.name == "reenter-5";
      EXPECT_TRUE(frame.truth.target || may_be_empty) << frame.name;
      empty += frame.truth.target ? 0 : 1;
    }
  }
  EXPECT_GT(inside_only, 10);
  EXPECT_GT(empty, 160);  // all of "negative", some of "reenter"
}

TEST(PictureReader, ErrorNamesUnreadableFiles) {
  gst_init(nullptr, nullptr);
  const support::TemporaryFolder folder;
  const fs::path bad = folder.file("bad.jpg");
  const fs::path good = folder.file("good.jpg");
  std::ofstream(bad) << "no picture";
  cv::imwrite(good.string(), cv::Mat(32, 48, CV_8U, cv::Scalar(77)));
  PictureReader reader;
  for (const fs::path& file : {bad, fs::path("/no/such.jpg"), fs::path("/no/such.png")}) {
    try {
      (void)reader.read(file);
      ADD_FAILURE() << file;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
    }
  }
  const std::string cut = folder.file("cut.jpg");
  fs::copy_file(good, cut);
  fs::resize_file(cut, fs::file_size(good) * 2 / 3);
  EXPECT_THROW((void)reader.read(cut), std::runtime_error);
  const cv::Mat picture = reader.read(good);  // also after an error
  EXPECT_EQ(picture.cols, 48);
  EXPECT_NEAR(picture.at<std::uint8_t>(5, 5), 77, 1);
}

}  // namespace
}  // namespace evaluate
