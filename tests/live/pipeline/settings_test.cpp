// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "examples/live/pipeline/properties.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"

namespace {

using support::Answer;
using support::Client;
using support::Line;
using support::LiveProgram;
using support::property;
using support::SocketClient;
using support::value_of;
using support::wait_until;

TEST(LiveSettings, DescribesEveryPropertyOfTheElement) {
  const LiveProgram program({});
  const Answer answer = Client(program.url()).get("api/properties");
  const support::Owned<GstElement> element(gst_element_factory_make("ellipsetrack", nullptr));
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element.get()), &count);
  for (guint i = 0; i < count; ++i) {
    const bool is_setting = specs[i]->owner_type == G_OBJECT_TYPE(element.get()) &&
                            (specs[i]->flags & G_PARAM_WRITABLE) != 0 &&
                            std::string(specs[i]->name) != "evidence-file";  // no files over HTTP
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
  EXPECT_EQ(json_object_get_double_member(axis, "default"), 32768.0);
}

TEST(LiveSettings, SettingsActOnTheRunningPipeline) {
  const LiveProgram program({});
  const Client client(program.url());
  SocketClient lines(program.url(), "ws/meta");
  ASSERT_TRUE(wait_until([&] { return Line(lines.next()).ellipse("target") != nullptr; }));
  ASSERT_EQ(client.put("api/properties", R"({"min-axis":690,"tracking":"none"})").status, 200U);
  EXPECT_TRUE(wait_until([&] { return Line(lines.next()).ellipse("target") == nullptr; }));
  ASSERT_EQ(client.put("api/properties", R"({"min-axis":5})").status, 200U);
  EXPECT_TRUE(wait_until([&] { return Line(lines.next()).ellipse("target") != nullptr; }));
}

TEST(LiveSettings, SetsAllPropertiesOrNone) {
  const LiveProgram program({});
  const Client client(program.url());
  const auto expect_rejected = [&](const std::string& body, const std::string& named) {
    const Answer answer = client.put("api/properties", body);
    EXPECT_EQ(answer.status, 400U) << body;
    EXPECT_NE(answer.body.find(named), std::string::npos) << body << answer.body;
    EXPECT_EQ(value_of(client, "min-axis"), 5.0) << body;
  };
  expect_rejected(R"({"min-axis":20,"max-axis":-3})", "max-axis");
  expect_rejected(R"({"min-axis":800,"max-axis":700})", "max-axis");
  expect_rejected(R"({"min-axis":20,"interval":1.5})", "interval");
  expect_rejected(R"({"min-axis":20,"detector":"magic"})", "contours");
  expect_rejected(R"({"min-axis":20,"overlay":7})", "overlay");
  expect_rejected(R"({"min-axis":20,"roi":[1,2,3]})", "roi");
  expect_rejected(R"({"min-axis":20,"stats":1})", "stats");
  expect_rejected(R"({"min-axis":1e999})", "min-axis");
  expect_rejected(R"({"min-axis":20,"interval":1e999})", "interval");
  expect_rejected(R"({"min-axis":20,"max-processing-time":1e999})", "max-processing-time");
  expect_rejected(R"({"min-axis":20,"gravity":[1e999,0,0]})", "gravity");
  expect_rejected(R"({"min-axis":20,"roi":[1,2,-1e999,4]})", "roi");
  expect_rejected(R"({"min-axis":20,"nonsense":1})", "nonsense");
  expect_rejected(R"({"min-axis":{"a":[1]}})", "min-axis");
  expect_rejected(R"({"min-axis":20)", "JSON");
  expect_rejected("[1,2]", "object");
}

void write_calibration(const std::string& file) {
  std::ofstream(file) << "%YAML:1.0\n---\nimage_width: 640\nimage_height: 360\n"
                         "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                         "   data: [ 500., 0., 320., 0., 500., 180., 0., 0., 1. ]\n";
}

// A client can open camera files in one folder only: no other file, and no pipe, which would block
// the program.
TEST(LiveSettings, OpensCameraFilesInTheirFolderOnly) {
  const support::TemporaryFolder folder;
  const std::string cameras = folder.file("cameras");
  std::filesystem::create_directory(cameras);
  write_calibration(cameras + "/front.yaml");
  write_calibration(folder.file("other.yaml"));
  std::ofstream(cameras + "/letter.yaml") << "Dear robot,\n";
  std::filesystem::create_symlink(folder.file("other.yaml"), cameras + "/link.yaml");
  ASSERT_EQ(mkfifo((cameras + "/pipe").c_str(), 0600), 0);
  const LiveProgram program({"--cameras", cameras});
  const LiveProgram closed({});
  const Client client(program.url());
  const auto put = [](const LiveProgram& where, const std::string& file) {
    std::string body = R"({"min-axis":20,"camera-file":")";
    return Client(where.url()).put("api/properties", body + file + "\"}").status;
  };
  for (const std::string& wrong : {folder.file("other.yaml"),
                                   std::string("../other.yaml"),
                                   std::string("link.yaml"),
                                   std::string("letter.yaml"),
                                   std::string("none.yaml"),
                                   std::string("pipe"),
                                   std::string("."),
                                   std::string("/etc/passwd")}) {
    EXPECT_EQ(put(program, wrong), 400U) << wrong;
  }
  EXPECT_EQ(put(closed, cameras + "/front.yaml"), 400U);
  EXPECT_EQ(value_of(client, "min-axis"), 5.0);  // all properties or none
  EXPECT_EQ(put(program, "front.yaml"), 200U);
  const Answer now = client.get("api/properties");
  EXPECT_EQ(json_object_get_string_member(property(now, "camera-file"), "value"),
            std::filesystem::canonical(cameras + "/front.yaml"));
  EXPECT_TRUE(json_object_get_boolean_member(property(now, "camera-file"), "writable"));
  EXPECT_FALSE(json_object_get_boolean_member(
      property(Client(closed.url()).get("api/properties"), "camera-file"), "writable"));
  EXPECT_EQ(put(program, ""), 200U);
  EXPECT_EQ(put(closed, ""), 200U);
}

std::vector<double> numbers_in(const Answer& answer, const std::string& name, const char* member) {
  JsonArray* array = json_object_get_array_member(property(answer, name), member);
  std::vector<double> numbers;
  for (guint i = 0; i < json_array_get_length(array); ++i) {
    numbers.push_back(json_array_get_double_element(array, i));
  }
  return numbers;
}

TEST(LiveSettings, SetsRegionsAndDirections) {
  const LiveProgram program({});
  const Client client(program.url());
  using Numbers = std::vector<double>;
  const auto set = [&](const std::string& body) {
    EXPECT_EQ(client.put("api/properties", body).status, 200U) << body;
    return client.get("api/properties");
  };
  const Answer both = set(R"({"roi":[10,20,300,200],"gravity":[0.5,-9,1]})");
  EXPECT_EQ(numbers_in(both, "roi", "value"), (Numbers{10, 20, 300, 200}));
  EXPECT_EQ(numbers_in(both, "gravity", "value"), (Numbers{0.5, -9, 1}));
  EXPECT_NE(client.get("api/launch-line").body.find("gravity=<0.5,-9,1>"), std::string::npos);
  // The reported default can be set again.
  const Answer none = set(R"({"roi":[],"gravity":[]})");
  EXPECT_EQ(numbers_in(none, "roi", "default"), Numbers());
  EXPECT_EQ(numbers_in(none, "roi", "value"), Numbers(4));
  EXPECT_EQ(numbers_in(none, "gravity", "value"), Numbers(3));
  EXPECT_EQ(client.put("api/properties", R"({"roi":[1,2,3.5,4]})").status, 400U);
  EXPECT_EQ(client.put("api/properties", R"({"gravity":[1,2]})").status, 400U);
}

TEST(LiveSettings, SetsBothValuesOfAPairAtOnce) {
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

TEST(LiveSettings, PresetsSurviveARestart) {
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

// All properties of the tracker built from a launch line, as the API reports them.
std::string built_by(const std::string& line) {
  gchar** words = nullptr;
  EXPECT_TRUE(g_shell_parse_argv(line.c_str(), nullptr, &words, nullptr)) << line;
  EXPECT_STREQ(words[0], "gst-launch-1.0");
  GError* problem = nullptr;
  const support::Owned<GstElement> pipeline(
      gst_parse_launchv(const_cast<const gchar**>(words + 1), &problem));
  g_strfreev(words);
  EXPECT_EQ(problem, nullptr) << line << problem->message;
  g_clear_error(&problem);
  const support::Owned<GstElement> track(
      gst_bin_get_by_interface(GST_BIN(pipeline.get()), GST_TYPE_PRESET));
  return live::Properties(track.get(), live::CameraFolder("")).to_json();
}

// gst-launch-1.0 sets properties one by one: no intermediate state may have a minimum above its
// maximum.
TEST(LiveSettings, LaunchLineReproducesTheSettings) {
  const LiveProgram program({"--source", "test:orbit"});
  const Client client(program.url());
  for (const char* body :
       {R"({"roi":[1,2,30,40],"gravity":[0,1,0],"overlay":"ellipse+roi","detector":"contours"})",
        R"({"min-axis":750,"max-axis":900})",
        R"({"max-target-size":30,"min-target-size":10})",
        R"({"max-axis":4,"min-axis":2})",
        R"({"edge-high":9,"edge-low":5})",
        R"({"detect-contour-overlap":0.2,"fx":577.3333333333334})",
        R"({"edge-high":50,"edge-low":40})"}) {
    ASSERT_EQ(client.put("api/properties", body).status, 200U) << body;
    EXPECT_EQ(built_by(client.get("api/launch-line").body), client.get("api/properties").body);
  }
  const std::string line = client.get("api/launch-line").body;
  EXPECT_NE(line.find(" detect-contour-overlap=0.2 "), std::string::npos) << line;
  EXPECT_NE(line.find(" fx=577.3333333333334 "), std::string::npos) << line;
}

}  // namespace
