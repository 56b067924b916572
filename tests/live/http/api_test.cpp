// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "core/detection/evidence.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Answer;
using support::Client;
using support::Line;
using support::LiveProgram;
using support::SocketClient;
using support::value_of;
using support::wait_until;

cv::Mat picture_in(const std::string& message) {
  const std::vector<unsigned char> jpeg(message.begin() + 8, message.end());
  return cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE);
}

TEST(LiveApi, ServesItsPageAndNothingElse) {
  const LiveProgram program({});
  const Client client(program.url());
  const Answer page = client.get("");
  EXPECT_EQ(page.status, 200U);
  EXPECT_EQ(page.headers.at("Content-Type"), "text/html; charset=utf-8");
  EXPECT_NE(page.headers.at("Content-Security-Policy").find("default-src 'self'"),
            std::string::npos);
  for (const char* path : {"..%2f..%2fetc%2fpasswd",
                           "%2e%2e/%2e%2e/etc/passwd",
                           ".bashrc",
                           "/etc/passwd",
                           "page/index.html",
                           "index.html%00.css",
                           "nothing.html"}) {
    const guint status = client.get(path).status;
    EXPECT_TRUE(status == 404 || status == 400) << path << " " << status;
  }
}

// The pad moves by up to 40 px a frame, with motion blur: the ellipse of the previous frame would
// be far off. A new detection in the same frame, through JPEG, differs by a few px. Everything is
// read before it is checked, because a slow reader gets fewer lines.
TEST(LiveApi, PicturesAndLinesAreOfTheSameFrame) {
  const LiveProgram program({"--source", "test:dash"});
  SocketClient lines(program.url(), "ws/meta");
  SocketClient video(program.url(), "ws/video");
  std::vector<std::string> pictures;
  while (pictures.size() < 40) {
    pictures.push_back(video.next());
    ASSERT_GT(pictures.back().size(), 1000U);
    video.acknowledge(pictures.back());
  }
  std::map<guint64, std::string> line_at;
  while (line_at.empty() || line_at.rbegin()->first < SocketClient::pts_of(pictures.back())) {
    const std::string text = lines.next();
    const Line line(text);
    ASSERT_TRUE(line.is_valid()) << text << (lines.is_open() ? "" : lines.closing());
    line_at[static_cast<guint64>(line.number("pts_ns"))] = text;
  }
  int compared = 0;
  for (const std::string& message : pictures) {
    const auto found = line_at.find(SocketClient::pts_of(message));
    if (found == line_at.end()) continue;
    const Line line(found->second);
    const cv::Mat picture = picture_in(message);
    ASSERT_EQ(picture.cols, line.number("width"));
    JsonObject* target = line.ellipse("target");
    const auto detected = ellipse::Tracker().process(
        ellipse::ImageView{picture.data, picture.cols, picture.rows, picture.cols}, 0);
    if (target == nullptr || !detected) continue;
    EXPECT_NEAR(json_object_get_double_member(target, "cx"), detected->ellipse.cx, 8.0);
    EXPECT_NEAR(json_object_get_double_member(target, "cy"), detected->ellipse.cy, 8.0);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST(LiveApi, SendsTwoFramesUnacknowledgedThenTheNewest) {
  const LiveProgram program({});
  const Client client(program.url());
  SocketClient video(program.url(), "ws/video");
  const std::string first = video.next();
  const std::string second = video.next();
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 30; }));
  EXPECT_EQ(video.waiting(), 0U);
  video.send("{\"ack\":12345}");  // not the time of a sent frame
  video.send("nonsense");
  video.acknowledge(second);
  const std::string third = video.next();
  EXPECT_GT(SocketClient::pts_of(third), SocketClient::pts_of(second) + 25 * 33'333'333ULL);
}

TEST(LiveApi, EncodesNothingWithoutAViewer) {
  const LiveProgram program({"--rtsp", "0"});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 20; }));
  EXPECT_EQ(client.stat("encoded"), 0.0);
  {
    SocketClient video(program.url(), "ws/video");
    video.watch();
    ASSERT_TRUE(wait_until([&] { return video.watched() > 5; }));
  }
  ASSERT_TRUE(wait_until([&] { return client.stat("viewers") == 0; }));
  const double encoded = client.stat("encoded");
  EXPECT_GT(encoded, 5.0);
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 20; }));
  EXPECT_LE(client.stat("encoded"), encoded + 1);  // the one in transit
}

TEST(LiveApi, EventsCarryTheLines) {
  const LiveProgram program({});
  std::istringstream text(support::read_stream(program.url() + "api/events", "\n\n", 10));
  std::vector<gint64> numbers;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("data: ")) continue;
    const Line event(line.substr(6));
    if (!event.is_valid()) continue;  // cut off at the end
    numbers.push_back(event.number("frame"));
  }
  ASSERT_GT(numbers.size(), 5U);
  const bool is_whole = Client(program.url()).stat("lines_lost") == 0.0;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    EXPECT_GT(numbers[i], numbers[i - 1]);
    if (is_whole) {
      EXPECT_EQ(numbers[i], numbers[i - 1] + 1);
    }
  }
}

TEST(LiveApi, ShutsDownCleanlyWithAllKindsOfClients) {
  LiveProgram program({});
  const SocketClient video(program.url(), "ws/video");
  const SocketClient lines(program.url(), "ws/meta");
  std::thread events(
      [&] { support::read_stream(program.url() + "api/events", "\n\n", 1'000'000); });
  std::thread mjpeg(
      [&] { support::read_stream(program.url() + "video.mjpeg", "X-PTS", 1'000'000); });
  const Client client(program.url());
  EXPECT_TRUE(
      wait_until([&] { return client.stat("viewers") == 2 && client.stat("listeners") == 2; }));
  EXPECT_EQ(program.stop(), 0);
  events.join();
  mjpeg.join();
}

TEST(LiveApi, ServesMjpeg) {
  const LiveProgram program({});
  const std::string text =
      support::read_stream(program.url() + "video.mjpeg", "Content-Length: ", 4);
  const std::size_t start = text.find("\r\n\r\n") + 4;
  const int size = std::stoi(text.substr(text.find("Content-Length: ") + 16));
  const std::string jpeg = text.substr(start, static_cast<std::size_t>(size));
  const cv::Mat picture =
      cv::imdecode(std::vector<unsigned char>(jpeg.begin(), jpeg.end()), cv::IMREAD_GRAYSCALE);
  EXPECT_EQ(picture.cols, 640);
}

TEST(LiveApi, HeadRequestsDoNotCountAsViewers) {
  const LiveProgram program({});
  const Client client(program.url());
  EXPECT_EQ(client.ask("HEAD", "").status, 200U);
  EXPECT_NE(client.ask("HEAD", "video.mjpeg").status, 200U);
  EXPECT_EQ(client.ask("HEAD", "api/events").status, 405U);
  EXPECT_EQ(client.stat("viewers") + client.stat("listeners"), 0.0);
}

TEST(LiveApi, MetricsAreWellFormed) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 5; }));
  std::istringstream text(client.get("metrics").body);
  int samples = 0;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("# HELP ellipse_") || line.starts_with("# TYPE ellipse_")) continue;
    const std::size_t space = line.rfind(' ');
    ASSERT_TRUE(line.starts_with("ellipse_") && space != std::string::npos) << line;
    std::size_t used = 0;
    EXPECT_GE(std::stod(line.substr(space + 1), &used), 0.0) << line;
    EXPECT_EQ(used, line.size() - space - 1) << line;
    if (line.starts_with("ellipse_frames_total ")) {
      EXPECT_GT(std::stod(line.substr(21)), 5.0);
    }
    ++samples;
  }
  EXPECT_GT(samples, 15);
}

TEST(LiveApi, ServesTheTarget) {
  const LiveProgram program({});
  const Client client(program.url());
  Answer answer;
  ASSERT_TRUE(wait_until([&] { return (answer = client.get("api/target")).object() != nullptr; }));
  EXPECT_GT(json_object_get_double_member(answer.object(), "semi_major"), 20.0);
}

// Number of candidates in an analysis with measured features.
int count_measured(const Answer& answer) {
  JsonArray* candidates = json_object_get_array_member(answer.object(), "candidates");
  int measured = 0;
  for (guint i = 0; i < json_array_get_length(candidates); ++i) {
    JsonObject* candidate = json_array_get_object_element(candidates, i);
    if (!json_object_has_member(candidate, "evidence")) continue;
    ++measured;
    JsonArray* evidence = json_object_get_array_member(candidate, "evidence");
    EXPECT_EQ(json_array_get_length(evidence), ellipse::kFeatures);
    double sum = 0.0;
    for (guint k = 0; k < json_array_get_length(evidence); ++k) {
      sum +=
          json_object_get_double_member(json_array_get_object_element(evidence, k), "contribution");
    }
    const double log_odds = ellipse::built_in_evidence().bias + sum;
    // Accepted candidates may have other odds at other scales.
    if (json_object_get_boolean_member(candidate, "found")) continue;
    EXPECT_NEAR(json_object_get_double_member(candidate, "probability"),
                1.0 / (1.0 + std::exp(-log_odds)),
                1e-6);
  }
  return measured;
}

int count_of(const Answer& answer, const char* reason) {
  JsonObject* counts = json_object_get_object_member(answer.object(), "counts");
  return static_cast<int>(json_object_get_int_member_with_default(counts, reason, 0));
}

TEST(LiveApi, AnalysisNamesTheReasonsOfRejection) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > 0; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  const Answer now = client.post("api/analyze", R"({"stage":"edges"})");
  ASSERT_EQ(now.status, 200U) << now.body;
  EXPECT_GE(count_of(now, "accepted"), 1);
  EXPECT_GE(count_measured(now), 1);
  const std::string url = json_object_get_string_member(now.object(), "picture");
  gsize size = 0;
  const support::Ref<guchar> png(g_base64_decode(url.substr(url.find(',') + 1).c_str(), &size));
  const cv::Mat picture =
      cv::imdecode(std::vector<unsigned char>(png.get(), png.get() + size), cv::IMREAD_COLOR);
  EXPECT_GT(picture.cols, 100);

  const Answer strict =
      client.post("api/analyze", R"({"properties":{"detector":"contours","min-axis":600}})");
  EXPECT_EQ(count_of(strict, "accepted"), 0);
  EXPECT_EQ(count_measured(strict), 0);
  EXPECT_GE(count_of(strict, "too-small"), 1);
  EXPECT_EQ(json_object_get_int_member(strict.object(), "pts_ns"),
            json_object_get_int_member(now.object(), "pts_ns"));
  EXPECT_EQ(value_of(client, "min-axis"), 5.0);  // the pipeline's own value
  EXPECT_EQ(client.post("api/analyze", R"({"stage":"magic"})").status, 400U);
  EXPECT_EQ(client.post("api/analyze", R"({"properties":{"min-axis":0}})").status, 400U);
  EXPECT_EQ(client.post("api/analyze", R"({"properties":7})").status, 400U);
}

}  // namespace
