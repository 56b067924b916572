// SPDX-License-Identifier: MIT
//
// The instrument that everything is measured with: examples/evaluate.
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/picture_reader.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

class Dataset : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() /
        ("ellipse-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
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

TEST_F(Dataset, ReadsCsvInNaturalOrderBySequence) {
  write("gt.csv",
        "image,cx,cy,semi_major,semi_minor,angle_rad,visible_fraction\n"
        "images/b/frame10.jpg,1,2,30,20,0.5,0.75\n"
        "images/b/frame9.jpg,,,,,,\n"
        "images/a/frame1.jpg,1,2,30,20,-0.5,\r\n");
  const auto sequences = read_dataset(folder_);
  ASSERT_EQ(sequences.size(), 2U);
  EXPECT_EQ(sequences[0].name, "a");
  ASSERT_EQ(sequences[1].frames.size(), 2U);
  EXPECT_EQ(sequences[1].frames[0].name, "b/frame9.jpg");
  EXPECT_FALSE(sequences[1].frames[0].truth.target);
  EXPECT_EQ(sequences[1].frames[1].truth.target->semi_major, 30.0);
  EXPECT_EQ(sequences[1].frames[1].truth.visible_fraction, 0.75);
  EXPECT_FALSE(sequences[0].frames[0].truth.visible_fraction);
}

TEST_F(Dataset, ReadsThePublishedForm) {
  write("one/ground_truth.txt",
        "Filename\tHasTarget\tTargetCenterX\tTargetCenterY\tTargetWidth\tTargetHeight\t"
        "TargetAngle\n"
        "f1.jpg\t1\t100.0\t50.0\t40.0\t60.0\t90.0\n"
        "f2.jpg\t0\t0.000\t0.000\t0.000\t0.000\t0.000\n"
        "f3.jpg\t1\t-1.000\t-1.000\t-1.000\t-1.000\t-1.000\n");
  const auto sequences = read_dataset(folder_);
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

TEST_F(Dataset, KeepsFoldersOfTheSameNameApart) {
  write("gt.csv",
        "image,cx,cy,semi_major,semi_minor,angle_rad\n"
        "one/img/1.png,,,,,\ntwo/img/1.png,,,,,\n3.png,,,,,\n");
  const auto sequences = read_dataset(folder_);
  ASSERT_EQ(sequences.size(), 3U);
  EXPECT_EQ(sequences[0].name, folder_.filename().string());
  EXPECT_EQ(sequences[1].name, "one/img");
  EXPECT_EQ(sequences[2].name, "two/img");
}

TEST_F(Dataset, NamesFileAndLineOfWhatIsBroken) {
  EXPECT_NE(error().find("neither gt.csv nor ground_truth.txt"), std::string::npos);
  const std::string header = "image,cx,cy,semi_major,semi_minor,angle_rad\n";
  write("gt.csv", header + "a.jpg,1,2,x,20,0\n");
  EXPECT_NE(error().find("gt.csv:2: semi_major"), std::string::npos) << error();
  write("gt.csv", header + "a.jpg,1,2,10,20,0\n");
  EXPECT_NE(error().find("gt.csv:2: the axes"), std::string::npos) << error();
  write("gt.csv", header + "a.jpg,1,2\n");
  EXPECT_NE(error().find("gt.csv:2: 3 fields"), std::string::npos) << error();
  write("gt.csv", "");
  EXPECT_NE(error().find("is empty"), std::string::npos);
}

TEST(PictureReader, NamesWhatItCannotRead) {
  gst_init(nullptr, nullptr);
  const fs::path bad = fs::temp_directory_path() / "ellipse-bad.jpg";
  const fs::path good = fs::temp_directory_path() / "ellipse-good.jpg";
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
  const cv::Mat picture = reader.read(good);  // also after an error
  EXPECT_EQ(picture.cols, 48);
  EXPECT_NEAR(picture.at<std::uint8_t>(5, 5), 77, 1);
  fs::remove(bad);
  fs::remove(good);
}

constexpr FrameSize kFrame{320, 240};
const ellipse::Ellipse kTarget{160.0, 120.0, 50.0, 40.0, 0.3};

Truth truth_of(const std::optional<ellipse::Ellipse>& target, double visible = 1.0) {
  return {target, visible, true};
}

TEST(Measures, JudgesEachOutcome) {
  const ellipse::Ellipse other{60.0, 60.0, 30.0, 30.0, 0.0};
  const auto of = [](const auto& answer, const Truth& truth) {
    return judge(answer, truth, kFrame, Rule::kIou);
  };
  EXPECT_EQ(of(std::optional(kTarget), truth_of(kTarget)), Outcome::kTruePositive);
  EXPECT_EQ(of(std::optional(other), truth_of(kTarget)), Outcome::kWrong);
  EXPECT_EQ(of(std::optional<ellipse::Ellipse>(), truth_of(kTarget)), Outcome::kFalseNegative);
  EXPECT_EQ(of(std::optional(other), Truth{}), Outcome::kFalsePositive);
  EXPECT_EQ(of(std::optional<ellipse::Ellipse>(), Truth{}), Outcome::kTrueNegative);
  // Hardly visible: it may be missed, and a miss or a hit counts, but not a wrong answer.
  EXPECT_EQ(of(std::optional<ellipse::Ellipse>(), truth_of(kTarget, 0.2)), Outcome::kTrueNegative);
  EXPECT_EQ(of(std::optional(other), truth_of(kTarget, 0.2)), Outcome::kNotJudged);
  EXPECT_EQ(of(std::optional(kTarget), Truth{{}, {}, false}), Outcome::kNotJudged);
}

TEST(Measures, RulesDifferAtTheirLimits) {
  ellipse::Ellipse shifted = kTarget;
  shifted.cx += 7.9;  // 10 % of the smaller full axis is 8 px
  EXPECT_TRUE(is_right(shifted, kTarget, kFrame, Rule::kPublished));
  shifted.cx += 0.2;
  EXPECT_FALSE(is_right(shifted, kTarget, kFrame, Rule::kPublished));
  ellipse::Ellipse grown = kTarget;
  grown.semi_major *= 1.12;  // overlap 1 / 1.12
  EXPECT_TRUE(is_right(grown, kTarget, kFrame, Rule::kIou));
  EXPECT_FALSE(is_right(grown, kTarget, kFrame, Rule::kPublished));
}

TEST(Measures, AreThePapers) {
  Measures m;
  const auto add = [&](Outcome outcome, int times) {
    for (int i = 0; i < times; ++i) m.add({outcome, 1.0, 1.0, 0.5, 2});
  };
  add(Outcome::kTruePositive, 6);
  add(Outcome::kTrueNegative, 2);
  add(Outcome::kFalsePositive, 1);
  add(Outcome::kFalseNegative, 2);
  add(Outcome::kWrong, 1);
  add(Outcome::kNotJudged, 5);
  EXPECT_EQ(m.judged(), 12);
  EXPECT_DOUBLE_EQ(m.accuracy(), 8.0 / 12.0);
  EXPECT_DOUBLE_EQ(m.precision(), 6.0 / 8.0);
  EXPECT_DOUBLE_EQ(m.recall(), 6.0 / 9.0);
  EXPECT_DOUBLE_EQ(m.f1(), 2.0 * 0.75 * (2.0 / 3.0) / (0.75 + 2.0 / 3.0));
  EXPECT_EQ(m.centre_errors_px(1).size(), 6U);
  EXPECT_TRUE(std::isnan(Measures().accuracy()));
}

TEST(Quantile, IsAnElementOfTheValues) {
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 1.0), 3.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.0), 1.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace evaluate
