// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <array>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "core/tracker.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Answer;
using support::Client;
using support::Line;
using support::LiveProgram;
using support::SocketClient;
using support::wait_until;

JsonObject* property(const Answer& answer, const std::string& name) {
  JsonArray* all = json_node_get_array(answer.json());
  for (guint i = 0; i < json_array_get_length(all); ++i) {
    JsonObject* each = json_array_get_object_element(all, i);
    if (name == json_object_get_string_member(each, "name")) return each;
  }
  return nullptr;
}

double value_of(const Client& client, const std::string& name) {
  return json_object_get_double_member(property(client.get("api/properties"), name), "value");
}

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

TEST(LiveApi, DescribesEveryPropertyOfTheElement) {
  const LiveProgram program({});
  const Answer answer = Client(program.url()).get("api/properties");
  const support::Owned<GstElement> element(gst_element_factory_make("ellipsetrack", nullptr));
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element.get()), &count);
  for (guint i = 0; i < count; ++i) {
    const bool is_setting = specs[i]->owner_type == G_OBJECT_TYPE(element.get()) &&
                            (specs[i]->flags & G_PARAM_WRITABLE) != 0;
    JsonObject* described = property(answer, specs[i]->name);
    ASSERT_EQ(described != nullptr, is_setting) << specs[i]->name;
    if (!is_setting) continue;
    EXPECT_STREQ(json_object_get_string_member(described, "blurb"),
                 g_param_spec_get_blurb(specs[i]));
    EXPECT_STRNE(json_object_get_string_member(described, "group"), "other") << specs[i]->name;
    EXPECT_TRUE(json_object_has_member(described, "value")) << specs[i]->name;
    EXPECT_TRUE(json_object_has_member(described, "default")) << specs[i]->name;
  }
  g_free(specs);
  JsonObject* axis = property(answer, "max-axis");
  EXPECT_STREQ(json_object_get_string_member(axis, "unit"), "px");
  EXPECT_STREQ(json_object_get_string_member(axis, "type"), "double");
  EXPECT_EQ(json_object_get_double_member(axis, "max"), 32768.0);
  EXPECT_EQ(json_object_get_double_member(axis, "default"), 700.0);
}

TEST(LiveApi, SettingsActOnTheRunningPipeline) {
  const LiveProgram program({});
  const Client client(program.url());
  SocketClient lines(program.url(), "ws/meta");
  ASSERT_TRUE(wait_until([&] { return Line(lines.next()).ellipse("target") != nullptr; }));
  ASSERT_EQ(client.put("api/properties", R"({"min-axis":690,"tracking":"none"})").status, 200U);
  EXPECT_TRUE(wait_until([&] { return Line(lines.next()).ellipse("target") == nullptr; }));
  ASSERT_EQ(client.put("api/properties", R"({"min-axis":5})").status, 200U);
  EXPECT_TRUE(wait_until([&] { return Line(lines.next()).ellipse("target") != nullptr; }));
}

TEST(LiveApi, SetsAllPropertiesOrNone) {
  const LiveProgram program({});
  const Client client(program.url());
  const auto refused = [&](const std::string& body, const std::string& named) {
    const Answer answer = client.put("api/properties", body);
    EXPECT_EQ(answer.status, 400U) << body;
    EXPECT_NE(answer.body.find(named), std::string::npos) << body << answer.body;
    EXPECT_EQ(value_of(client, "min-axis"), 5.0) << body;
  };
  refused(R"({"min-axis":20,"max-axis":-3})", "max-axis");
  refused(R"({"min-axis":800})", "max-axis");
  refused(R"({"min-axis":20,"interval":1.5})", "interval");
  refused(R"({"min-axis":20,"detector":"magic"})", "contours");
  refused(R"({"min-axis":20,"overlay":7})", "overlay");
  refused(R"({"min-axis":20,"roi":[1,2,3]})", "roi");
  refused(R"({"min-axis":20,"stats":1})", "stats");
  refused(R"({"min-axis":20,"nonsense":1})", "nonsense");
  refused(R"({"min-axis":{"a":[1]}})", "min-axis");
  refused(R"({"min-axis":20)", "JSON");
  refused("[1,2]", "object");
}

TEST(LiveApi, SetsPairsThatPassEachOther) {
  const LiveProgram program({});
  const Client client(program.url());
  for (const char* body :
       {R"({"min-axis":800,"max-axis":900})",
        R"({"max-axis":40,"min-axis":10})",
        R"({"edge-high":50,"edge-low":40})",
        R"({"edge-low":5,"edge-high":9})",
        R"({"edge-high":0,"edge-low":80})",
        R"({"roi":[10,20,300,200],"overlay":"ellipse+axes","roi-type":"face"})"}) {
    EXPECT_EQ(client.put("api/properties", body).status, 200U) << body;
  }
  EXPECT_EQ(value_of(client, "min-axis"), 10.0);
  EXPECT_EQ(value_of(client, "edge-low"), 80.0);
  const Answer answer = client.get("api/properties");
  EXPECT_STREQ(json_object_get_string_member(property(answer, "overlay"), "value"), "ellipse+axes");
  JsonArray* roi = json_object_get_array_member(property(answer, "roi"), "value");
  EXPECT_EQ(json_array_get_int_element(roi, 3), 200);
}

// The pad moves by up to 40 px a frame, blurred by it: an ellipse of the frame before would be far
// off, one of the same frame, seen once more through JPEG and without a past, by a few px.
TEST(LiveApi, EachPictureHasTheEllipseOfItsOwnFrame) {
  const LiveProgram program({"--source", "test:dash"});
  SocketClient lines(program.url(), "ws/meta");
  SocketClient video(program.url(), "ws/video");
  int compared = 0;
  for (int i = 0; i < 40; ++i) {
    const std::string message = video.next();
    ASSERT_GT(message.size(), 1000U);
    video.acknowledge(message);
    const auto pts = static_cast<gint64>(SocketClient::pts_of(message));
    Line line(lines.next());
    while (line.is_valid() && line.number("pts_ns") < pts) line = Line(lines.next());
    ASSERT_EQ(line.number("pts_ns"), pts);
    const cv::Mat picture = picture_in(message);
    ASSERT_EQ(picture.cols, line.number("width"));
    JsonObject* target = line.ellipse("target");
    const auto seen = ellipse::Tracker().process(
        ellipse::ImageView{picture.data, picture.cols, picture.rows, picture.cols}, 0);
    if (target == nullptr || !seen) continue;
    EXPECT_NEAR(json_object_get_double_member(target, "cx"), seen->ellipse.cx, 8.0);
    EXPECT_NEAR(json_object_get_double_member(target, "cy"), seen->ellipse.cy, 8.0);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST(LiveApi, WhoDoesNotAcknowledgeGetsTwoFramesAndThenTheNewest) {
  const LiveProgram program({});
  const Client client(program.url());
  SocketClient video(program.url(), "ws/video");
  const std::string first = video.next();
  const std::string second = video.next();
  const double frames = client.stat("frames");
  ASSERT_TRUE(wait_until([&] { return client.stat("frames") > frames + 30; }));
  EXPECT_EQ(video.waiting(), 0U);
  video.send("{\"ack\":12345}");  // no frame that was sent
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
  EXPECT_LE(client.stat("encoded"), encoded + 1);  // the one that was on its way
}

TEST(LiveApi, EventsAreTheLines) {
  const LiveProgram program({});
  std::istringstream text(support::read_stream(program.url() + "api/events", "\n\n", 10));
  gint64 frame = -1;
  for (std::string line; std::getline(text, line) && frame < 1000;) {
    if (!line.starts_with("data: ")) continue;
    const Line event(line.substr(6));
    if (!event.is_valid()) continue;  // cut off at the end
    if (frame >= 0) {
      EXPECT_EQ(event.number("frame"), frame + 1);
    }
    frame = event.number("frame");
  }
  EXPECT_GT(frame, 5);
}

TEST(LiveApi, MjpegIsForWhatKnowsNoWebSocket) {
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

TEST(LiveApi, TheTargetIsAskedForByItself) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.poll("api/target").object() != nullptr; }));
  EXPECT_GT(json_object_get_double_member(client.get("api/target").object(), "semi_major"), 20.0);
}

int count_of(const Answer& answer, const char* reason) {
  JsonObject* counts = json_object_get_object_member(answer.object(), "counts");
  return static_cast<int>(json_object_get_int_member_with_default(counts, reason, 0));
}

TEST(LiveApi, AnAnalysisNamesWhyWhatIsRefused) {
  const LiveProgram program({});
  const Client client(program.url());
  ASSERT_TRUE(wait_until([&] { return client.poll("api/target").object() != nullptr; }));
  ASSERT_EQ(client.post("api/pause").status, 200U);
  const Answer now = client.post("api/analyze", R"({"stage":"edges"})");
  ASSERT_EQ(now.status, 200U) << now.body;
  EXPECT_GE(count_of(now, "accepted"), 1);
  const std::string url = json_object_get_string_member(now.object(), "picture");
  gsize size = 0;
  const support::Ref<guchar> png(g_base64_decode(url.substr(url.find(',') + 1).c_str(), &size));
  const cv::Mat picture =
      cv::imdecode(std::vector<unsigned char>(png.get(), png.get() + size), cv::IMREAD_COLOR);
  EXPECT_GT(picture.cols, 100);

  const Answer strict =
      client.post("api/analyze", R"({"properties":{"detector":"contours","min-axis":600}})");
  EXPECT_EQ(count_of(strict, "accepted"), 0);
  EXPECT_GE(count_of(strict, "too-small"), 1);
  EXPECT_EQ(json_object_get_int_member(strict.object(), "pts_ns"),
            json_object_get_int_member(now.object(), "pts_ns"));
  EXPECT_EQ(value_of(client, "min-axis"), 5.0);  // of the pipeline
  EXPECT_EQ(client.post("api/analyze", R"({"stage":"magic"})").status, 400U);
  EXPECT_EQ(client.post("api/analyze", R"({"properties":{"min-axis":0}})").status, 400U);
  EXPECT_EQ(client.post("api/analyze", R"({"properties":7})").status, 400U);
}

TEST(LiveApi, PresetsSurviveARestart) {
  const support::TemporaryFolder home;
  g_setenv("XDG_DATA_HOME", home.file("").c_str(), TRUE);
  {
    const LiveProgram program({});
    const Client client(program.url());
    ASSERT_EQ(client.put("api/properties", R"({"max-axis":321,"detector":"contours"})").status,
              200U);
    EXPECT_EQ(client.ask("PUT", "api/presets/my%20robot").status, 200U);
    EXPECT_EQ(client.ask("PUT", "api/presets/a%5Bb").status, 400U);
    EXPECT_EQ(client.post("api/presets/none/load").status, 400U);
    EXPECT_EQ(client.ask("DELETE", "api/presets/Keipour%202021").status, 400U);
  }
  const LiveProgram program({"--preset", "my robot"});
  const Client client(program.url());
  EXPECT_EQ(value_of(client, "max-axis"), 321.0);
  ASSERT_EQ(client.post("api/presets/Keipour%202021/load").status, 200U);
  EXPECT_EQ(value_of(client, "max-axis"), 700.0);
  EXPECT_NE(client.get("api/presets").body.find("my robot"), std::string::npos);
  EXPECT_EQ(client.ask("DELETE", "api/presets/my%20robot").status, 200U);
  EXPECT_EQ(client.get("api/presets").body.find("my robot"), std::string::npos);
  g_unsetenv("XDG_DATA_HOME");
}

TEST(LiveApi, TheLaunchLineBuildsThisVeryElement) {
  const LiveProgram program({"--source", "test:orbit"});
  const Client client(program.url());
  ASSERT_EQ(client
                .put("api/properties",
                     R"({"min-axis":750,"max-axis":900,"roi":[1,2,30,40],"overlay":"ellipse+roi"})")
                .status,
            200U);
  const std::string line = client.get("api/launch-line").body;
  gchar** words = nullptr;
  ASSERT_TRUE(g_shell_parse_argv(line.c_str(), nullptr, &words, nullptr)) << line;
  ASSERT_STREQ(words[0], "gst-launch-1.0");
  const support::Owned<GstElement> pipeline(
      gst_parse_launchv(const_cast<const gchar**>(words + 1), nullptr));
  g_strfreev(words);
  ASSERT_NE(pipeline, nullptr) << line;
  const support::Owned<GstElement> track(
      gst_bin_get_by_interface(GST_BIN(pipeline.get()), GST_TYPE_PRESET));
  ASSERT_NE(track, nullptr);
  gdouble min = 0.0;
  g_object_get(track.get(), "min-axis", &min, nullptr);
  EXPECT_EQ(min, 750.0);
}

}  // namespace
