// SPDX-License-Identifier: MIT
//
// Choices that are judged on sources they were not made on.
#include "examples/evaluate/leave_one_out.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "examples/evaluate/twin.hpp"
#include "tests/support/temporary_folder.hpp"

namespace evaluate {
namespace {

bool never_stop(const Frame& /*frame*/) {
  return true;
}

// Three frames of the twin under several data set names.
std::vector<Sequence> sources(const std::vector<std::string>& names) {
  Sequence sequence = make_twin()[0];
  sequence.frames.resize(3);
  std::vector<Sequence> all;
  for (const std::string& name : names) {
    all.push_back(sequence);
    all.back().dataset = name;
  }
  return all;
}

// Records the sources it is given. A choice made on fewer than three sources finds nothing.
class Watched : public Chooser {
 public:
  Choice choose(const std::vector<std::string>& sources) override {
    shown.push_back(sources);
    Choice choice{"of " + std::to_string(sources.size()), {}};
    if (sources.size() < 3) choice.settings.limits.min_axis_px = 600.0;
    return choice;
  }

  std::vector<std::vector<std::string>> shown;
};

TEST(LeaveOneOut, HidesTheJudgedGroupFromTheChooser) {
  const auto sequences = sources({"airlab-a", "airlab-b", "eye"});
  Watched chooser;
  const auto results =
      leave_one_out(sequences, SourceGroups(), chooser, {}, Rule::kIou, never_stop);
  using Names = std::vector<std::string>;
  const Names all = {"airlab-a", "airlab-b", "eye"};
  EXPECT_EQ(chooser.shown,
            (std::vector<Names>{{"eye"}, all, {"eye"}, all, {"airlab-a", "airlab-b"}, all}));
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[1].group, "airlab");
  EXPECT_EQ(results[1].left_out.name, "of 1");
  EXPECT_EQ(results[1].in_sample.name, "of 3");
}

TEST(LeaveOneOut, JudgesLeftOutAndInSampleChoicesAndTheDefaults) {
  Watched chooser;
  const auto results =
      leave_one_out(sources({"a", "b", "c"}), SourceGroups(), chooser, {}, Rule::kIou, never_stop);
  EXPECT_EQ(results.at(0).left_out.grade.grade, 0.0);
  EXPECT_EQ(results[0].in_sample.grade.grade, 1.0);
  EXPECT_EQ(results[0].unchosen, 1.0);
  EXPECT_NE(left_out_table("m", results).title.find("Left out"), std::string::npos);
  EXPECT_NE(in_sample_table("m", results).title.find("In sample"), std::string::npos);
}

TEST(LeaveOneOut, RejectsSourcesOfASingleGroup) {
  Watched chooser;
  EXPECT_THROW(
      (void)leave_one_out(
          sources({"airlab-a", "airlab-b"}), SourceGroups(), chooser, {}, Rule::kIou, never_stop),
      std::invalid_argument);
}

TEST(LeaveOneOut, GridChoosesTheBestPointOnTheGivenSources) {
  const auto sequences = sources({"a", "b"});
  GridChooser chooser({{"min-axis", {"600", "5", "6"}}, {"max-axis-ratio", {"1.001", "5"}}},
                      {},
                      sequences,
                      Rule::kIou,
                      never_stop);
  const Choice choice = chooser.choose({"a"});
  EXPECT_EQ(choice.name, "min-axis=5 max-axis-ratio=5");  // the first of equal ones
  EXPECT_EQ(choice.settings.limits.min_axis_px, 5.0);
  EXPECT_THROW(GridChooser({{"no-such", {"1"}}}, {}, sequences, Rule::kIou, never_stop),
               std::invalid_argument);
}

TEST(LeaveOneOut, GridNamesTheFramesThatCannotBeRead) {
  class Broken : public PictureSource {
   public:
    cv::Mat picture(const Frame& frame) override { throw std::runtime_error(frame.name); }
  };
  auto sequences = sources({"a"});
  sequences[0].pictures = std::make_shared<Broken>();
  const GridChooser chooser({{"min-axis", {"5"}}}, {}, sequences, Rule::kIou, never_stop);
  ASSERT_EQ(chooser.problems().size(), 3U);
  EXPECT_EQ(chooser.problems()[0], sequences[0].frames[0].name);
}

TEST(LeaveOneOut, PropertiesAreParsedAsValuesOrRanges) {
  using Values = std::vector<std::string>;
  EXPECT_EQ(parse_property("x=0.8:0.85:0.9").values, (Values{"0.8", "0.85", "0.9"}));
  EXPECT_EQ(parse_property("x=0.8:0.9:0.05").values, (Values{"0.8", "0.85", "0.9"}));
  EXPECT_EQ(parse_property("x=1:2").values, (Values{"1", "2"}));
  EXPECT_EQ(parse_property("x=a:b:c:d").values, (Values{"a", "b", "c", "d"}));
  EXPECT_EQ(parse_property("x=1,2").values, (Values{"1", "2"}));
  EXPECT_EQ(parse_property("x=7").values, Values{"7"});
  for (const char* bad : {"x", "=1", "x="}) {
    EXPECT_THROW((void)parse_property(bad), std::invalid_argument) << bad;
  }
}

TEST(SourceGroups, AreReadFromAFile) {
  const support::TemporaryFolder folder;
  const std::string file = folder.file("groups.txt");
  std::ofstream(file) << "# eyes\n\neyes: pupil-* eye-?\nroads:road\r\n";
  const SourceGroups groups(std::filesystem::path{file});
  EXPECT_EQ(groups.group_of("pupil-blinks"), "eyes");
  EXPECT_EQ(groups.group_of("eye-1"), "eyes");
  EXPECT_EQ(groups.group_of("eye-12"), "eye-12");
  EXPECT_EQ(groups.group_of("/data/road:road"), "roads");
  EXPECT_EQ(SourceGroups().group_of("airlab-gascola"), "airlab");
  EXPECT_EQ(SourceGroups().group_of("twin"), SourceGroups().group_of("scenes"));
  EXPECT_EQ(SourceGroups().group_of("scenes-negative"), SourceGroups().group_of("scenes"));
}

TEST(SourceGroups, ErrorNamesInvalidLines) {
  const support::TemporaryFolder folder;
  const std::string file = folder.file("groups.txt");
  std::ofstream(file) << "a: b\njust words\n";
  try {
    (void)SourceGroups(std::filesystem::path{file});
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("groups.txt:2: "), std::string::npos) << error.what();
  }
  EXPECT_THROW(SourceGroups(std::filesystem::path{"/no/such"}), std::runtime_error);
}

}  // namespace
}  // namespace evaluate
