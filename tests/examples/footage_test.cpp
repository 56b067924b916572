// SPDX-License-Identifier: MIT
//
// Data sets from footage: videos, several ellipses in an image, ignored frames.
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>

#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/frame_files.hpp"
#include "examples/evaluate/video_reader.hpp"
#include "tests/examples/programs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader = "image,cx,cy,semi_major,semi_minor,angle_rad\n";

class Footage : public testing::Test {
 protected:
  void SetUp() override { gst_init(nullptr, nullptr); }

  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.file(name); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(file(name).parent_path());
    std::ofstream(file(name)) << text;
  }
  // A video of distinct frames, 25 per second.
  void write_video(const std::string& name, int frames) const {
    const std::string pipeline =
        "GST_PLUGIN_PATH= GST_REGISTRY=" + folder_.file("registry") +
        " gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=" + std::to_string(frames) +
        " ! video/x-raw,format=I420,width=64,height=48,framerate=25/1 ! jpegenc ! avimux ! "
        "filesink location=" +
        file(name).string();
    ASSERT_EQ(programs::run(pipeline).status, 0);
  }
  [[nodiscard]] Dataset read() const { return read_dataset(folder_.path()); }

  support::TemporaryFolder folder_;
};

TEST_F(Footage, SeveralRowsGiveSeveralEllipsesOfOneImage) {
  write("gt.csv", std::string(kHeader) + "a.png,10,20,5,4,0\nb.png,,,,,\na.png,30,20,6,3,0\n");
  write("a.png", "");
  write("b.png", "");
  const Dataset dataset = read();
  EXPECT_TRUE(dataset.problems.empty());
  const auto& frames = dataset.sequences.at(0).frames;
  ASSERT_EQ(frames.size(), 2U);
  const auto ellipses = ellipses_of(frames[0].truth);
  ASSERT_EQ(ellipses.size(), 2U);
  EXPECT_EQ(ellipses[0].ellipse.cx, 10.0);
  EXPECT_EQ(ellipses[1].ellipse.semi_major, 6.0);
  EXPECT_TRUE(ellipses_of(frames[1].truth).empty());
}

TEST_F(Footage, ImagesBothWithAndWithoutAnEllipseAreReported) {
  write("gt.csv", std::string(kHeader) + "a.png,,,,,\na.png,30,20,6,3,0\n");
  write("a.png", "");
  const Dataset dataset = read();
  ASSERT_EQ(dataset.problems.size(), 1U);
  EXPECT_NE(dataset.problems[0].find("gt.csv:3: "), std::string::npos) << dataset.problems[0];
}

TEST_F(Footage, InnerEdgesOfRingsAreSeparateEllipses) {
  write("gt.csv",
        "image,cx,cy,semi_major,semi_minor,angle_rad,visible,inner_semi_major\n"
        "a.png,10,20,8,4,0.5,0.7,6\nb.png,10,20,8,4,0.5,,9\n");
  write("a.png", "");
  write("b.png", "");
  const Dataset dataset = read();
  const auto ellipses = ellipses_of(dataset.sequences.at(0).frames.at(0).truth);
  ASSERT_EQ(ellipses.size(), 2U);
  EXPECT_EQ(ellipses[1].ellipse, (ellipse::Ellipse{10.0, 20.0, 6.0, 3.0, 0.5}));
  EXPECT_EQ(ellipses[1].visible_fraction, 0.7);
  ASSERT_EQ(dataset.problems.size(), 1U);
  EXPECT_NE(dataset.problems[0].find("gt.csv:3: inner_semi_major"), std::string::npos);
}

TEST_F(Footage, IgnoredImagesStayInTheSequenceUnlabelled) {
  write("gt.csv", std::string(kHeader) + "1.png,,,,,\n2.png,9,9,5,4,0\n");
  write("ignore.txt", "# hidden by the lid\n2.png\r\n3.png\n4.png\n");
  for (const char* name : {"1.png", "2.png", "3.png"}) write(name, "");
  const Dataset dataset = read();
  const auto& frames = dataset.sequences.at(0).frames;
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(frames[0].truth.is_labelled);
  EXPECT_FALSE(frames[1].truth.is_labelled);
  EXPECT_FALSE(frames[2].truth.is_labelled);  // without a row
  ASSERT_EQ(dataset.problems.size(), 1U);
  EXPECT_NE(dataset.problems[0].find("ignore.txt:4: image"), std::string::npos);
}

TEST_F(Footage, VideoFramesAreNamedByTheirNumber) {
  write_video("eye.avi", 5);
  write("gt.csv",
        std::string(kHeader) + "images/eye/frame_0003.png,,,,,\nimages/eye/frame_0001.png,,,,,\n");
  const Dataset dataset = read();
  ASSERT_EQ(dataset.problems.size(), 1U);
  EXPECT_NE(dataset.problems[0].find("eye.avi: 3 of its 5 frames"), std::string::npos)
      << dataset.problems[0];
  const Sequence& eye = dataset.sequences.at(0);
  ASSERT_EQ(eye.frames.size(), 2U);
  EXPECT_EQ(eye.name, "eye");
  EXPECT_EQ(eye.frames[0].name, "eye/frame_0001.png");
  EXPECT_EQ(eye.frames[0].pts_ns, 40'000'000);
  EXPECT_EQ(eye.frames[1].pts_ns, 120'000'000);
  const cv::Mat first = eye.pictures->picture(eye.frames[0]);
  const cv::Mat third = eye.pictures->picture(eye.frames[1]);
  EXPECT_EQ(first.size(), cv::Size(64, 48));
  EXPECT_GT(cv::norm(first, third, cv::NORM_INF), 50.0);
  // Seeks backwards too.
  EXPECT_EQ(cv::norm(first, eye.pictures->picture(eye.frames[0]), cv::NORM_INF), 0.0);
}

TEST_F(Footage, RowsWithoutAVideoFrameAreReported) {
  write_video("eye.avi", 2);
  write("gt.csv",
        std::string(kHeader) +
            "images/eye/frame_0000.png,,,,,\nimages/eye/frame_0001.png,,,,,\n"
            "images/eye/frame_0002.png,,,,,\n");
  const Dataset dataset = read();
  ASSERT_EQ(dataset.problems.size(), 1U);
  EXPECT_NE(dataset.problems[0].find("gt.csv:4: "), std::string::npos);
  EXPECT_NE(dataset.problems[0].find("not one of the 2 frames"), std::string::npos);
  EXPECT_EQ(dataset.missing_frames, 1U);
}

TEST_F(Footage, InvalidVideosAreReportedByName) {
  write("eye.mp4", "this is no video\n");
  write("gt.csv", std::string(kHeader) + "images/eye/frame_0000.png,,,,,\n");
  const Dataset dataset = read();
  ASSERT_EQ(dataset.missing_frames, 1U);
  EXPECT_NE(dataset.problems.at(0).find("eye.mp4: "), std::string::npos) << dataset.problems[0];
}

TEST_F(Footage, VideosOfTheSameNameGiveSeparateFiles) {
  for (const char* name : {"a", "b"}) {
    fs::create_directories(file(name));
    write_video(std::string(name) + "/eye.avi", 1);
    write(std::string(name) + "/gt.csv", std::string(kHeader) + "images/eye/frame_0000.png,,,,,\n");
  }
  std::vector<Sequence> sequences;
  for (const fs::path& folder : dataset_folders(folder_.path())) {
    for (Sequence& sequence : read_dataset(folder).sequences) sequences.push_back(sequence);
  }
  ASSERT_EQ(sequences.size(), 2U);
  write_files(sequences, file("out"), [](const Frame& /*frame*/) { return true; });
  EXPECT_NE(sequences[0].frames[0].image, sequences[1].frames[0].image);
  for (const Sequence& sequence : sequences) {
    EXPECT_FALSE(cv::imread(sequence.frames[0].image.string()).empty());
  }
}

TEST_F(Footage, FoldersOfDataSetsAreExpanded) {
  for (const char* name : {"b/gt.csv", "a/gt.csv", "other/readme.txt"}) write(name, "");
  EXPECT_EQ(dataset_folders(folder_.path()), (std::vector<fs::path>{file("a"), file("b")}));
  EXPECT_EQ(dataset_folders(file("a")), std::vector<fs::path>{file("a")});
  EXPECT_EQ(dataset_folders("scenes:7"), std::vector<fs::path>{"scenes:7"});
  const std::string many_seeds = "scenes:" + std::string(300, '7');
  EXPECT_EQ(dataset_folders(many_seeds), std::vector<fs::path>{many_seeds});
}

TEST_F(Footage, PicturesWithoutTimesGetTheGivenRate) {
  write("gt.csv", std::string(kHeader) + "1.png,,,,,\n2.png,,,,,\n");
  write("1.png", "");
  write("2.png", "");
  EXPECT_EQ(read_dataset(folder_.path(), 10.0).sequences[0].frames[1].pts_ns, 100'000'000);
}

TEST_F(Footage, PicturesOfOneSetMayDifferInSize) {
  write("gt.csv", std::string(kHeader) + "1.png,80,60,30,30,0\n2.png,200,150,80,80,0\n");
  for (const auto& [name, width, radius] : {std::tuple{"1.png", 160, 30}, {"2.png", 400, 80}}) {
    cv::Mat picture(width * 3 / 4, width, CV_8U, cv::Scalar(40));
    cv::circle(picture, {width / 2, width * 3 / 8}, radius, cv::Scalar(200), -1, cv::LINE_AA);
    cv::imwrite(file(name).string(), picture);
  }
  const Dataset dataset = read();
  std::vector<std::unique_ptr<Method>> methods;
  for (const char* name : {"arcs+edges", "canny-fit"}) methods.push_back(make_method(name, {}));
  const Evaluation evaluation =
      evaluate(dataset.sequences, methods, Rule::kIou, [](const Frame& /*frame*/) { return true; });
  ASSERT_EQ(evaluation.frames.size(), 2U);
  EXPECT_EQ(evaluation.frames[1].size.width, 400);
  for (const MethodResults& method : evaluation.methods) {
    for (const Result& result : method.results) {
      EXPECT_EQ(result.outcome, Outcome::kTruePositive) << method.name;
    }
  }
}

}  // namespace
}  // namespace evaluate
