// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "examples/live/pipeline/source_spec.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/live_sources.hpp"

namespace {

namespace fs = std::filesystem;
using support::Client;
using support::LiveProgram;
using support::make_pictures;
using support::make_video;
using support::TemporaryFolder;
using support::text_in;
using support::wait_until;

std::string trouble_with(const std::string& source) {
  try {
    (void)live::parse_source(source);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(LiveSource, ErrorNamesTheProblem) {
  const TemporaryFolder folder;
  EXPECT_NE(trouble_with("test:moon").find("available: approach, oblique"), std::string::npos);
  EXPECT_NE(trouble_with(folder.file("none.mkv")).find("no such file"), std::string::npos);
  EXPECT_NE(trouble_with("/dev/video77").find("no such camera"), std::string::npos);
  EXPECT_NE(trouble_with("gopher://there/is").find("gopher"), std::string::npos);
  EXPECT_NE(trouble_with(fs::path(folder.file("")).parent_path()).find("no .png or .jpg"),
            std::string::npos);
  EXPECT_NE(trouble_with("[videotestsrc ! nonsense]").find("nonsense"), std::string::npos);
  EXPECT_NE(trouble_with("[videotestsrc !").find("no such file"), std::string::npos);
  EXPECT_NE(trouble_with("").find("empty"), std::string::npos);
}

TEST(LiveSource, ParsesEachKind) {
  const TemporaryFolder folder;
  const auto kind = [](const std::string& source) { return live::parse_source(source).kind; };
  EXPECT_EQ(kind("test:dusk"), live::SourceKind::kTest);
  EXPECT_EQ(kind(make_video(folder, 1)), live::SourceKind::kFile);
  EXPECT_EQ(kind(make_pictures(folder, 1)), live::SourceKind::kFolder);
  EXPECT_EQ(kind("[videotestsrc ! videoconvert]"), live::SourceKind::kFragment);
  EXPECT_EQ(kind("rtsp://127.0.0.1/live"), live::SourceKind::kUri);
  EXPECT_TRUE(live::parse_source("rtsp://127.0.0.1/live").is_live);
  EXPECT_FALSE(live::parse_source("file:///video.mkv").is_live);
}

TEST(LiveSource, ParsesFrameRatesAsIntegersDecimalsOrFractions) {
  const auto rate = [](const std::string& text) {
    const live::FrameRate rate = live::parse_rate(text);
    return std::to_string(rate.n) + "/" + std::to_string(rate.d);
  };
  EXPECT_EQ(rate("10"), "10/1");
  EXPECT_EQ(rate("0.5"), "1/2");
  EXPECT_EQ(rate("30000/1001"), "30000/1001");
  EXPECT_EQ(rate("29.97"), "2997/100");
  for (const char* wrong : {"",
                            "0",
                            "-5",
                            "nan",
                            "inf",
                            "1e9",
                            "10/0",
                            "10/",
                            "/3",
                            "0/1",
                            "-3/-1",
                            "fast",
                            "10 ",
                            "99999999999/1"}) {
    EXPECT_THROW((void)live::parse_rate(wrong), std::invalid_argument) << wrong;
  }
}

TEST(LiveSource, PlaysFoldersAtTheGivenRate) {
  const TemporaryFolder folder;
  const std::string pictures = make_pictures(folder, 30);
  const LiveProgram program({"--source", pictures, "--fps", "10", "--allow-source-change"});
  const Client client(program.url());
  const auto rate = [&] {
    const support::Answer answer = client.get("api/source");
    return json_object_get_double_member(answer.object(), "fps");
  };
  EXPECT_TRUE(wait_until([&] { return rate() == 10.0; }));
  const std::string body = R"({"spec":")" + pictures + R"(","fps":)";
  ASSERT_EQ(client.put("api/source", body + "12.5}").status, 200U);
  EXPECT_TRUE(wait_until([&] { return rate() == 12.5; }));
  ASSERT_EQ(client.put("api/source", body + "\"24000/1001\"}").status, 200U);
  EXPECT_TRUE(wait_until([&] { return std::abs(rate() - 24000.0 / 1001.0) < 1e-9; }));
  for (const char* wrong : {"0}", "1e999}", "\"fast\"}", "[1]}"}) {
    EXPECT_EQ(client.put("api/source", body + wrong).status, 400U) << wrong;
  }
  EXPECT_EQ(client.put("api/source", R"({"spec":"test:dusk","fps":10})").status, 400U);
  LiveProgram wrong({"--source", pictures, "--fps", "nan"}, false);
  EXPECT_NE(wrong.line_with("--fps"), "");
  EXPECT_NE(wrong.wait(), 0);
  LiveProgram other({"--fps", "10"}, false);
  EXPECT_NE(other.line_with("folder"), "");
  EXPECT_EQ(other.wait(), 1);
}

// The launch line of a folder after the program has ended and removed its links to the pictures.
std::string line_of(const std::string& pictures) {
  const LiveProgram program({"--source", pictures, "--fps", "10"});
  return Client(program.url()).get("api/launch-line").body;
}

TEST(LiveSource, LaunchLineOfAFolderNamesItsPictures) {
  const TemporaryFolder folder;
  const std::string pictures = make_pictures(folder, 12);  // flight-0.jpg to flight-11.jpg
  const std::string line = line_of(pictures);
  EXPECT_NE(line.find(pictures + "/flight-%d.jpg"), std::string::npos) << line;
  gchar** words = nullptr;
  ASSERT_TRUE(g_shell_parse_argv(line.c_str(), nullptr, &words, nullptr)) << line;
  const live::Ref<gchar> words_of_line(g_strjoinv(" ", words + 1));
  g_strfreev(words);
  std::string pipeline = words_of_line.get();
  pipeline.erase(pipeline.find(" ! videoconvert"));
  int frames = 0;
  const auto count = [](GstElement*, GstBuffer*, GstPad*, gpointer data) {
    ++*static_cast<int*>(data);
  };
  const std::string failure = support::run_pipeline(
      pipeline + " ! fakesink name=end signal-handoffs=true", [&](GstElement* element) {
        const support::Owned<GstElement> end(gst_bin_get_by_name(GST_BIN(element), "end"));
        g_signal_connect(end.get(), "handoff", G_CALLBACK(+count), &frames);
      });
  EXPECT_EQ(failure, "") << line;
  EXPECT_EQ(frames, 12);
}

// Pictures without a number in their names are linked in natural order, 9 before 10.
TEST(LiveSource, LaunchLineNumbersPicturesWithOtherNames) {
  const TemporaryFolder folder;
  const std::string pictures = make_pictures(folder, 3);
  const char* const names[] = {"it's 9.jpg", "it's 10.JPG", "it's 200.jpeg"};
  for (int i = 0; i < 3; ++i) {
    fs::rename(pictures + "/flight-" + std::to_string(i) + ".jpg", pictures + "/" + names[i]);
  }
  std::string line = line_of(pictures);
  const std::size_t at = line.find("gst-launch-1.0");
  ASSERT_NE(at, std::string::npos);
  EXPECT_NE(line.find("location=", at), std::string::npos) << line;
  line.replace(at,
               std::string::npos,
               "readlink 000001.jpg 000002.jpg 000003.jpg; ls; rm *; rmdir \"$PWD\")");
  gchar* output = nullptr;
  gchar* arguments[] = {const_cast<gchar*>("sh"), const_cast<gchar*>("-c"), line.data(), nullptr};
  ASSERT_TRUE(g_spawn_sync(nullptr,
                           arguments,
                           nullptr,
                           G_SPAWN_SEARCH_PATH,
                           nullptr,
                           nullptr,
                           &output,
                           nullptr,
                           nullptr,
                           nullptr))
      << line;
  const live::Ref<gchar> owned(output);
  std::string expected;
  for (const char* name : names) expected += pictures + "/" + name + "\n";
  EXPECT_EQ(output, expected + "000001.jpg\n000002.jpg\n000003.jpg\n") << line;
}

TEST(LiveSource, InvalidFilesEndTheProgramWithTheirName) {
  const TemporaryFolder folder;
  const std::string file = folder.file("letter.mkv");
  std::ofstream(file) << "Dear robot,\n";
  LiveProgram program({"--source", file}, false);
  EXPECT_NE(program.line_with("letter.mkv"), "");
  EXPECT_EQ(program.wait(), 1);
  LiveProgram other({"--source", folder.file("none")}, false);
  EXPECT_NE(other.line_with("no such file"), "");
  EXPECT_EQ(other.wait(), 1);
}

TEST(LiveSource, ErrorsAfterAFewFramesPersist) {
  const LiveProgram program({"--source", "[ellipsetestsrc ! identity error-after=5]"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return text_in(client, "state") == "failed"; }));
  EXPECT_EQ(client.stat("frames"), 4.0);
  g_usleep(1'500'000);  // the program checks once a second for frames
  EXPECT_NE(text_in(client, "error"), "");
}

TEST(LiveSource, ChangesOverHttpOnlyIfAllowed) {
  const LiveProgram closed({});
  EXPECT_EQ(Client(closed.url()).put("api/source", R"({"spec":"test:dusk"})").status, 403U);
  const LiveProgram open({"--allow-source-change"});
  const Client client(open.url());
  ASSERT_EQ(client.put("api/properties", R"({"max-axis":444})").status, 200U);
  EXPECT_EQ(client.put("api/source", R"({"spec":"test:moon"})").status, 400U);
  EXPECT_EQ(client.put("api/source", R"({"spec":"[videotestsrc is-live=true]"})").status, 200U);
  EXPECT_EQ(text_in(client, "kind"), "fragment");
  const double frames = client.stat("frames");
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > frames + 5; }));
  EXPECT_NE(client.get("api/launch-line").body.find("max-axis=444"), std::string::npos);
}

TEST(LiveSource, HeldFrameAfterAChangeIsOfTheNewSource) {
  const LiveProgram program({"--allow-source-change"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 3; }));
  const char* other = R"({"spec":"[videotestsrc is-live=true ! video/x-raw,width=128,height=96]"})";
  ASSERT_EQ(client.put("api/source", other).status, 200U);
  ASSERT_EQ(client.post("api/pause").status, 200U);
  EXPECT_TRUE(wait_until([&] { return support::number_in(client, "width") == 128; }));
  EXPECT_EQ(text_in(client, "state"), "held");
}

TEST(LiveSource, WaitsForTheFirstFrameOfACamera) {
  const LiveProgram program(
      {"--source",
       "[videotestsrc is-live=true ! video/x-raw,width=64,height=48 ! queue max-size-buffers=0 "
       "max-size-bytes=0 max-size-time=0 min-threshold-time=7000000000]"});
  const Client client(program.url());
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > 5; }));
  EXPECT_EQ(client.stat("reconnections"), 0.0);
}

// This also tests that the RTSP output can be read.
TEST(LiveSource, ReconnectsAfterALoss) {
  auto camera = std::make_unique<LiveProgram>(std::vector<std::string>{"--rtsp", "0"});
  const std::string address = LiveProgram::address_in(camera->line_with("rtsp://"));
  const std::string port =
      address.substr(address.rfind(':') + 1, address.rfind('/') - address.rfind(':') - 1);
  const LiveProgram program({"--source", address});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 5; }));
  camera.reset();
  ASSERT_TRUE(wait_until([&] { return text_in(client, "state") == "reconnecting"; }));
  EXPECT_TRUE(wait_until([&] { return !text_in(client, "error").empty(); }));
  const double frames = client.stat("frames");
  // Another program may briefly hold the port.
  ASSERT_TRUE(wait_until([&] {
    camera = std::make_unique<LiveProgram>(std::vector<std::string>{"--rtsp", port});
    return !camera->url().empty();
  }));
  EXPECT_TRUE(wait_until([&] { return client.stat("frames") > frames + 5; }));
  EXPECT_TRUE(wait_until([&] { return text_in(client, "error").empty(); }));
}

}  // namespace
