// SPDX-License-Identifier: MIT
//
// The example programs as people start them.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string text;  // standard output and standard error
};

Outcome run(const std::string& program, const std::string& arguments) {
  const std::string command = std::string(std::getenv("ELLIPSE_PROGRAMS")) + "/" + program + " " +
                              arguments + " 2>&1 < /dev/null";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> block{};
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe)) {
    outcome.text.append(block.data(), n);
  }
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class Programs : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / "ellipse-programs-test";
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
  // What it has written it can also read.
  const fs::path again = folder_ / "again";
  const Outcome second =
      run("ellipse-demo",
          (folder_ / "annotated.mkv").string() + " --frames 25 --out " + again.string());
  EXPECT_EQ(second.status, 0) << second.text;
  EXPECT_NE(second.text.find("frames                      25"), std::string::npos) << second.text;
  EXPECT_TRUE(fs::exists(again / "contact_sheet.png"));
}

TEST_F(Programs, DemoSaysInOneLineWhatIsWrong) {
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

TEST_F(Programs, EvaluateNamesWhatItCannotUse) {
  const Outcome folder = run("ellipse-evaluate", folder_.string());
  EXPECT_EQ(folder.status, 1);
  EXPECT_NE(folder.text.find(folder_.string()), std::string::npos) << folder.text;
  const Outcome setting = run("ellipse-evaluate", folder_.string() + " --set no-such=1");
  EXPECT_EQ(setting.status, 1);
  EXPECT_NE(setting.text.find("no-such"), std::string::npos) << setting.text;
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
}

}  // namespace
