// SPDX-License-Identifier: MIT
#include "examples/evaluate/command_peer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

class CommandPeer : public testing::Test {
 protected:
  std::map<std::string, PeerAnswer> run(const std::string& text, std::vector<fs::path> images) {
    std::ofstream(script_) << text;
    return run_command_peer(command(), images);
  }
  [[nodiscard]] std::string command() const { return "/bin/sh '" + script_ + "' x"; }

  // The error for an invalid answer of the script; it names the command.
  std::string error(const std::string& text) {
    try {
      (void)run(text, {"a.png", "b.png"});
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(command()), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return "";
  }
  void expect_error(const std::string& text, const std::string& part) {
    const std::string what = error(text);
    EXPECT_NE(what.find(part), std::string::npos) << what;
  }

 private:
  const support::TemporaryFolder folder_;
  const std::string script_ = folder_.file("peer.sh");
};

const std::string kAnswerEach =
    "while IFS= read -r image; do"
    " echo \"{\\\"image\\\":\\\"$image\\\",\\\"ms\\\":2.5,"
    "\\\"ellipses\\\":[[10,20.5,3,8,0.25]]}\"; done\n";

TEST_F(CommandPeer, AnswersLineByLine) {
  const auto answers = run(kAnswerEach, {"a b.png", "c.png"});
  ASSERT_EQ(answers.size(), 2U);
  const PeerAnswer& answer = answers.at("a b.png");
  EXPECT_EQ(answer.ms, 2.5);
  ASSERT_EQ(answer.detections.size(), 1U);
  const ellipse::Ellipse& e = answer.detections[0].ellipse;
  EXPECT_EQ(e.cy, 20.5);
  EXPECT_EQ(e.semi_major, 8.0);  // given second: the angle is that of the minor axis
  EXPECT_EQ(e.semi_minor, 3.0);
  EXPECT_NEAR(e.angle_rad, 0.25 - std::numbers::pi / 2.0, 1e-12);
  EXPECT_GT(answer.detections[0].score, 0.0);
}

// Exceeds the capacity of a pipe in both directions.
TEST_F(CommandPeer, HandlesThousandsOfAnswersStreamedOrAtTheEnd) {
  std::vector<fs::path> images;
  for (int i = 0; i < 5000; ++i) {
    images.emplace_back("/a/long/folder/for/many/pictures/frame" + std::to_string(i) + ".png");
  }
  EXPECT_EQ(run(kAnswerEach, images).size(), 5000U);
  EXPECT_EQ(run("all=$(cat)\nprintf '%s\\n' \"$all\" | " + kAnswerEach, images).size(), 5000U);
}

TEST_F(CommandPeer, MayOmitImagesAndReportNoEllipses) {
  const auto answers =
      run("cat > /dev/null; echo; echo '{\"image\":\"b.png\",\"ms\":1,\"ellipses\":[]}'",
          {"a.png", "b.png"});
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers.at("b.png").detections.empty());
  EXPECT_TRUE(run("cat > /dev/null", {"a.png"}).empty());
  EXPECT_TRUE(run("cat", {}).empty());
}

TEST_F(CommandPeer, ErrorNamesTheLineOfAMalformedAnswer) {
  expect_error("cat > /dev/null; echo; echo Segmentation", "line 2 of its answer is not a JSON");
  const auto answers = [](const std::string& line) {
    return "cat > /dev/null; echo '" + line + "'";
  };
  expect_error(answers(R"([1])"), "is not a JSON object: [1]");
  expect_error(answers(R"({"image":3,"ms":1,"ellipses":[]})"), "no string \"image\"");
  expect_error(answers(R"({"image":"a.png","ms":"1","ellipses":[]})"), "no time \"ms\"");
  expect_error(answers(R"({"image":"a.png","ms":1e999,"ellipses":[]})"), "no time \"ms\"");
  expect_error(answers(R"({"image":"a.png","ms":1,"ellipses":{}})"), "no list \"ellipses\"");
  for (const std::string bad :
       {"7", "[1,2,3,4]", "[1,2,3,0,0]", "[1,2,null,4,0]", "[1,2,-3,4,0]"}) {
    expect_error(answers(R"({"image":"a.png","ms":1,"ellipses":[)" + bad + "]}"),
                 "line 1 of its answer contains an invalid ellipse");
  }
  expect_error(answers(R"({"image":"z.png","ms":1,"ellipses":[]})"), "not requested");
  const std::string twice = R"({"image":"a.png","ms":1,"ellipses":[]})";
  expect_error(answers(twice + "\n" + twice), "an image twice");
}

TEST_F(CommandPeer, ErrorNamesTheExitStatus) {
  expect_error("cat > /dev/null; exit 3", "exited with status 3");
  expect_error(kAnswerEach + "exit 4", "exited with status 4");
  expect_error("kill -9 $$", "signal 9");
}

TEST_F(CommandPeer, ProgramsThatStopReadingAreAnError) {
  const std::vector<fs::path> images = {std::string(300'000, 'x'), "a.png"};
  EXPECT_THROW((void)run("exit 5", images), std::runtime_error);
  EXPECT_THROW((void)run("exit 0", images), std::runtime_error);
}

TEST_F(CommandPeer, ErrorNamesCommandsThatCannotStart) {
  const std::vector<fs::path> images = {"a.png"};
  for (const std::string bad : {"/no/such/program -x", "", "'unbalanced"}) {
    try {
      (void)run_command_peer(bad, images);
      ADD_FAILURE() << bad;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("\"" + bad + "\""), std::string::npos);
    }
  }
  const std::vector<fs::path> broken = {"a\nb.png"};
  EXPECT_THROW((void)run_command_peer("cat", broken), std::runtime_error);
}

}  // namespace
}  // namespace evaluate
