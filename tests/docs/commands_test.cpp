// SPDX-License-Identifier: MIT
//
// Runs the command lines of the documents as they are written and checks the results.
// docs/cookbook.md says what replaces devices.
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/docs/json_lines.hpp"
#include "tests/docs/recipes.hpp"
#include "tests/docs/sockets.hpp"
#include "tests/gst/loopback.hpp"
#include "tests/gst/support.hpp"
#include "tests/support/shell_job.hpp"

namespace {

namespace fs = std::filesystem;
using recipes::all_of;
using recipes::Document;
using recipes::json_lines_of;
using recipes::Recipe;
using support::ShellJob;

constexpr std::size_t kFrames = 60;  // of the source that replaces a device
constexpr char kCamera[] = "ellipsetestsrc is-live=true num-buffers=60";

const Document& cookbook() {
  static const Document document = recipes::read(ELLIPSE_ROOT "/docs/cookbook.md");
  return document;
}
const Document& readme() {
  static const Document document = recipes::read(ELLIPSE_ROOT "/README.md");
  return document;
}

using Jobs = std::vector<std::pair<const Recipe*, std::unique_ptr<ShellJob>>>;

class Commands : public testing::TestWithParam<std::pair<const Document*, const Recipe*>> {
 protected:
  static void SetUpTestSuite() {
    work_ = std::make_unique<support::TemporaryFolder>();
    for (const char* port : {"1883", "5000", "5005", "8554"}) {
      held_.push_back(std::make_unique<support::OwnPort>());
      ports_[port] = held_.back()->number();
    }
    for (const auto& [name, program] : cookbook().files) {
      std::ofstream(work_->file(name)) << in_the_tests(program);
    }
    g_setenv("XDG_DATA_HOME", work_->file("data").c_str(), TRUE);
    if (const char* python = std::getenv("ELLIPSE_PYTHON")) {
      fs::create_directory(work_->file("bin"));
      fs::create_symlink(python, work_->file("bin/python3"));
      g_setenv("PATH", (work_->file("bin") + ":" + std::getenv("PATH")).c_str(), TRUE);
    }
    ShellJob job(cookbook().recipes.front().text, work_->file(""), "work");
    ASSERT_EQ(job.wait_for_end(), 0) << job.errors();
  }
  static void TearDownTestSuite() {
    work_.reset();
    held_.clear();
  }

  // A recipe starts with the shared input files only, without results of earlier recipes.
  Commands() {
    fs::copy(
        work_->file(""), file(""), fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  }

  static const Document& document() { return *GetParam().first; }
  static const Recipe& recipe() { return *GetParam().second; }

  // Replaces devices as the table in the cookbook says.
  static std::string in_the_tests(std::string text) {
    const std::regex jpeg("v4l2src device=/dev/video\\d ! image/jpeg");
    text = std::regex_replace(text, jpeg, std::string(kCamera) + " ! jpegenc ! image/jpeg");
    text = std::regex_replace(text, std::regex("v4l2src( device=/dev/video\\d)?"), kCamera);
    for (int n = 0; text.find("autovideosink") != std::string::npos; ++n) {
      const std::string sink =
          "jpegenc ! multifilesink location=screen" + std::to_string(n) + "-%04d.jpg";
      text = std::regex_replace(
          text, std::regex("autovideosink"), sink, std::regex_constants::format_first_only);
    }
    for (const auto& [port, free] : ports_) {
      text = std::regex_replace(text, std::regex("\\b" + port + "\\b"), std::to_string(free));
    }
    return text;
  }

  static std::size_t frames_of(const std::string& text) {
    const auto numbers = all_of(text, "num-buffers=(\\d+)");
    return numbers.empty() ? kFrames : std::stoul(numbers.front());
  }

  std::string file(const std::string& name) const { return folder_.file(name); }

  // A network or a leaky queue may lose frames.
  static void expect_targets(const std::string& text, std::size_t frames, bool may_drop) {
    const std::vector<recipes::JsonLine> lines = json_lines_of(text);
    if (may_drop) {
      EXPECT_GE(lines.size(), frames / 2) << text;
      EXPECT_LE(lines.size(), frames);
    } else {
      EXPECT_EQ(lines.size(), frames) << text;
    }
    const auto found = std::count_if(
        lines.begin(), lines.end(), [](const recipes::JsonLine& line) { return line.has_target; });
    EXPECT_GE(found, std::floor(0.5 * static_cast<double>(lines.size()))) << text;
  }

  // JSON lines of a tracker that reads back what was written.
  std::string view_in(const std::string& source) const {
    const std::string failure =
        support::run_pipeline(source + " ! videoconvert ! ellipsetrack ! ellipsejson ! " +
                              "filesink location=" + file("seen-again.ndjson"));
    EXPECT_EQ(failure, "") << source;
    return support::contents_of(file("seen-again.ndjson"));
  }

  // Checks the files named in a command line. @return their number.
  std::size_t check_files(const std::string& text) const {
    const std::size_t frames = frames_of(text);
    const bool may_drop = text.find("leaky") != std::string::npos ||
                          text.find("rtspsrc") != std::string::npos ||
                          text.find("udpsrc") != std::string::npos;
    std::size_t count = 0;
    for (const std::string& name : all_of(text, "(?:filesink|playlist)[ -]location=([\\w.%/-]+)")) {
      SCOPED_TRACE(name);
      ++count;
      if (name.ends_with(".ndjson")) {
        expect_targets(support::contents_of(file(name)), frames, may_drop);
      } else if (name.ends_with(".mkv") || name.ends_with(".mp4")) {
        expect_targets(
            view_in("filesrc location=" + file(name) + " ! decodebin"), frames, may_drop);
      } else if (name.ends_with(".m3u8")) {
        check_playlist(name, frames);
      } else if (name.ends_with(".jpg") || name.ends_with(".png")) {
        const bool is_jpeg = name.ends_with(".jpg");
        const std::string source = "multifilesrc location=" + file(name) +
                                   (is_jpeg ? " caps=image/jpeg" : " caps=image/png") +
                                   ",framerate=30/1 ! " + (is_jpeg ? "jpegdec" : "pngdec");
        expect_targets(view_in(source), frames, may_drop);
      } else if (!name.ends_with(".ts")) {  // segments of a playlist
        --count;
      }
    }
    return count;
  }

  void check_playlist(const std::string& name, std::size_t frames) const {
    std::ofstream whole(file("whole.ts"), std::ios::binary);
    std::istringstream playlist(support::contents_of(file(name)));
    std::size_t segments = 0;
    std::string line;
    for (std::getline(playlist, line); std::getline(playlist, line);) {
      if (line.empty() || line.starts_with("#")) continue;
      ++segments;
      const std::string segment = support::contents_of(file(line));
      EXPECT_GT(segment.size(), 1000U) << line;
      whole << segment;
    }
    whole.close();
    EXPECT_GE(segments, 2U);
    expect_targets(view_in("filesrc location=" + file("whole.ts") + " ! decodebin"), frames, false);
  }

  // Checks a recording: each line has the time and the target of a frame of the video.
  void check_clock(const std::string& video, const std::string& written) const {
    const auto viewed = json_lines_of(view_in("filesrc location=" + file(video) + " ! decodebin"));
    const auto lines = json_lines_of(support::contents_of(file(written)));
    ASSERT_EQ(viewed.size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_NEAR(viewed[i].pts_ns, lines[i].pts_ns, 1e6) << "frame " << i;
      EXPECT_NEAR(std::hypot(viewed[i].cx - lines[i].cx, viewed[i].cy - lines[i].cy), 0.0, 1.0)
          << "frame " << i;
    }
  }

  // @return The number of results that were checked.
  std::size_t check(const Recipe& recipe, const ShellJob& job) const {
    const std::string text = in_the_tests(recipe.text);
    SCOPED_TRACE(text);
    std::size_t count = check_files(text);
    if (!recipe.shown.empty()) {
      ++count;
      EXPECT_EQ(job.output(), recipe.shown);
    }
    const bool is_printed = std::regex_search(text, std::regex("fdsink\\s*\\n|mosquitto_sub"));
    if (is_printed) {
      ++count;
      expect_targets(job.output(), frames_of(text), recipe.waits_for_ctrl_c);
    }
    return count;
  }

  static void wait_until_ready(const Recipe& recipe, const ShellJob& job) {
    const bool is_client = recipe.text.find("mosquitto_sub") != std::string::npos;
    for (const std::string& port : recipes::ports_of(recipe, document())) {
      const auto is_ready = [&] { return support::is_port_open(ports_.at(port), is_client); };
      for (int i = 0; i < 3000 && !is_ready(); ++i) g_usleep(20000);
      ASSERT_TRUE(is_ready()) << recipe.text << job.errors();
    }
  }

  // Waits until all data has arrived: no socket has unread bytes and no output grows for one
  // second. Gives up after a minute.
  static void wait_until_received(const Jobs& jobs) {
    std::size_t written = 0;
    for (int i = 0, quiet = 0; i < 1200 && quiet < 20; ++i) {
      g_usleep(50000);
      std::size_t now = 0;
      bool is_read = true;
      for (const auto& [recipe, job] : jobs) {
        now += job->output().size();
        for (const std::string& port : recipes::ports_of(*recipe, document())) {
          is_read = is_read && support::is_all_read(ports_.at(port));
        }
      }
      quiet = is_read && now == written ? quiet + 1 : 0;
      written = now;
    }
  }

  inline static std::unique_ptr<support::TemporaryFolder> work_;
  inline static std::vector<std::unique_ptr<support::OwnPort>> held_;
  inline static std::map<std::string, int> ports_;
  const support::TemporaryFolder folder_;
};

TEST_P(Commands, ProduceTheirDocumentedResults) {
  if (recipe().is_left_out) GTEST_SKIP() << "left out, as the document says: " << recipe().text;
  if (std::getenv("ELLIPSE_PYTHON") == nullptr &&
      recipe().text.find("python3") != std::string::npos) {
    GTEST_SKIP() << "no introspection, or no Python with gi";
  }
  std::unique_ptr<support::Broker> broker;
  if (recipe().text.find("mosquitto_pub") != std::string::npos) {
    if (support::program("mosquitto").empty()) GTEST_SKIP() << "mosquitto is not installed";
    broker = std::make_unique<support::Broker>(support::program("mosquitto"));
    ports_["1883"] = std::stoi(broker->port());
    ASSERT_TRUE(broker->subscribe());
  }
  Jobs others;
  for (const Recipe& other : document().recipes) {
    if (!other.waits_for_ctrl_c || !share_a_port(other, recipe(), document())) continue;
    const std::string log = "other" + std::to_string(others.size());
    others.emplace_back(&other,
                        std::make_unique<ShellJob>(in_the_tests(other.text), file(""), log));
    wait_until_ready(other, *others.back().second);
  }
  ShellJob job(in_the_tests(recipe().text), file(""), "job");
  EXPECT_EQ(job.wait_for_end(), 0) << recipe().text << job.errors();
  std::size_t results = check(recipe(), job);
  if (!others.empty()) wait_until_received(others);
  for (const auto& [other, its_job] : others) {
    its_job->interrupt();
    EXPECT_TRUE(its_job->ends()) << other->text << its_job->errors();
    results += check(*other, *its_job);
  }
  EXPECT_GT(results, 0U) << "leaves nothing that is known here: " << recipe().text;
  if (recipe().section.starts_with("Recording")) check_clock("flight.mkv", "flight.ndjson");
}

std::vector<std::pair<const Document*, const Recipe*>> all_commands() {
  std::vector<std::pair<const Document*, const Recipe*>> all;
  for (const Document* document : {&cookbook(), &readme()}) {
    for (const Recipe& recipe : document->recipes) {
      if (!recipe.waits_for_ctrl_c) all.emplace_back(document, &recipe);
    }
  }
  return all;
}

std::string name_of(const testing::TestParamInfo<Commands::ParamType>& info) {
  const auto [document, recipe] = info.param;
  std::string name = document == &readme() ? "Readme" : "Cookbook";
  bool begins_word = true;
  for (const char c : recipe->section) {
    if (std::isalnum(c) != 0) name += static_cast<char>(begins_word ? std::toupper(c) : c);
    begins_word = std::isalnum(c) == 0;
  }
  return name + std::to_string(recipe - document->recipes.data());
}

INSTANTIATE_TEST_SUITE_P(Documents, Commands, testing::ValuesIn(all_commands()), name_of);

TEST(Documents, PairEachWaitingCommandWithAPartner) {
  for (const Recipe& waiting : cookbook().recipes) {
    if (!waiting.waits_for_ctrl_c) continue;
    const auto is_partner = [&](const Recipe& other) {
      return !other.waits_for_ctrl_c && share_a_port(waiting, other, cookbook());
    };
    EXPECT_TRUE(std::any_of(cookbook().recipes.begin(), cookbook().recipes.end(), is_partner))
        << waiting.text;
  }
}

TEST(Documents, AreParsedCompletely) {
  // Fewer means that a document was not found or not parsed.
  EXPECT_GE(cookbook().recipes.size(), 20U);
  EXPECT_EQ(cookbook().files.size(), 4U);
  EXPECT_GE(readme().recipes.size(), 4U);
}

}  // namespace
